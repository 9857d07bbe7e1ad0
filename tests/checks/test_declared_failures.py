"""Failures that interfaces and scripts declare, and those that words of names mean."""

from __future__ import annotations

import pytest

from smachac.diagnostics.diagnostic import Severity
from smachac.ir.outcome_names import is_failure
from tests.trust.project_text import analysed

GRASP = """\
outcomes: {grasped: {}, lost: {failure: true}, timeout: {failure: false}, preempted: {}}
claims: [arm]
"""


def found(main: str, **files: str) -> list[str]:
    """The codes and lines of what is found above an info."""
    given = {f"templates/{name}.yml": text for name, text in files.items()}
    report = analysed({"main.yml": main, **given}).report
    return [
        f"{item.code} {item.span.line}" for item in report if item.severity is not Severity.INFO
    ]


@pytest.mark.parametrize(
    "name",
    ["aborted", "grasp_failed", "graspFailed", "GRASP_FAILED", "timed_out", "arm_timed_out",
     "failed_2", "not_found_error", "time_out_error", "Timeout", "fail"],
)  # fmt: skip
def test_names_of_failures(name: str) -> None:
    assert is_failure(name)


@pytest.mark.parametrize(
    "name",
    ["no_error", "not_failed", "error_free", "without_error", "noError",
     "never_aborted", "failed_over", "terror", "unabort_ed", "errors", "", "1", "default"],
)  # fmt: skip
def test_names_of_no_failures(name: str) -> None:
    assert not is_failure(name)


FLAT = """\
name: sm
template: Base
outcomes: [succeeded, failed]
states:
  - PICK:
      template: Grasp
      transitions: {grasped: PLACE, lost: LOST, timeout: PLACE, preempted: failed}
  - PLACE:
      template: ScriptedState
      outcomes: [done]
      transitions: {done: succeeded}
"""


@pytest.mark.parametrize(("target", "line"), [("succeeded", ["SM206 7"]), ("failed", [])])
def test_a_declared_failure_that_ends_as_a_success(target: str, line: list[str]) -> None:
    assert found(FLAT.replace("LOST", target), Grasp=GRASP) == line


def test_an_undeclared_failure_of_that_name_is_none() -> None:
    grasp = GRASP.replace("lost: {failure: true}", "lost: {}")
    assert found(FLAT.replace("LOST", "succeeded"), Grasp=grasp) == []


def test_a_script_declares_an_outcome_of_a_state_type_again() -> None:
    again = "outcomes: {lost: {failure: false}}\n      transitions: {grasped"
    text = FLAT.replace("LOST", "succeeded").replace("transitions: {grasped", again)
    assert found(text, Grasp=GRASP) == []


POLL = """\
name: sm
template: Base
outcomes: [succeeded, failed, preempted]
states:
  - POLL:
      template: Take
      retry: {on: [nothing], max: 5, delay: 250ms}
      transitions: {taken: succeeded, jam: failed, exhausted: succeeded, preempted: preempted}
"""


@pytest.mark.parametrize(
    ("nothing", "limit", "line"),
    [
        ("failure: false", "", []),
        ("failure: true", "", ["SM206 8"]),
        ("", "", ["SM206 8"]),
        ("failure: false", "timeout: 2s\n      ", []),
        ("", "timeout: 2s\n      ", ["SM206 9"]),
    ],
)
def test_tries_that_end_as_declared(nothing: str, limit: str, line: list[str]) -> None:
    taken = f"taken: {{}}, nothing: {{{nothing}}}, jam: {{failure: true}}"
    take = f"outcomes: {{{taken}, preempted: {{}}}}"
    text = POLL.replace("retry", f"{limit}retry").replace(
        "[nothing]", "[nothing, timeout]" if limit else "[nothing]"
    )
    assert found(text, Take=take) == line


def test_retries_of_a_declared_failure_have_no_limit() -> None:
    assert found(FLAT.replace("LOST", "PICK"), Grasp=GRASP) == ["SM204 7"]
    unfailing = GRASP.replace("failure: true", "failure: false")
    assert "SM204 7" not in found(FLAT.replace("LOST", "PICK"), Grasp=unfailing)


def test_a_declared_failure_without_a_transition() -> None:
    text = FLAT.replace(", lost: LOST", "").replace("failed]", "failed, lost]")
    assert found(text, Grasp=GRASP) == ["SM105 5"]
    assert found(text, Grasp=GRASP.replace("failure: true", "failure: false")) == []


CONTAINER = """\
name: sm
template: Base
outcomes: {succeeded: {doc: Everything is in its place.}, gone: {failure: true}}
states:
  - WORK:
      template: StateMachine
      outcomes: {ready: {}, gone: {failure: FAILURE}, stuck: {}}
      states:
        - TRY:
            template: ScriptedState
            outcomes: [fine, lost, stuck]
            transitions: {fine: ready, lost: gone, stuck: stuck}
      transitions: {ready: succeeded, gone: WORK, stuck: gone}
"""


def test_a_container_declares_its_failures() -> None:
    assert found(CONTAINER.replace("FAILURE", "true")) == ["SM204 13"]
    assert "SM204 13" not in found(CONTAINER.replace("FAILURE", "false"))


DECLARED_LOOP = """\
name: sm
template: Base
outcomes: [succeeded, failed]
userdata: {parts: [a, b]}
states:
  - PICK:
      template: Grasp
      for_each: {item: part, in: parts, on: [grasped, OTHER]}
      transitions: {grasped: succeeded, preempted: failed, timeout: failed, lost: failed}
"""


@pytest.mark.parametrize(("other", "lines"), [("lost", ["SM404 8"]), ("timeout", [])])
def test_a_loop_that_continues_after_a_declared_failure(other: str, lines: list[str]) -> None:
    given = DECLARED_LOOP.replace("OTHER", other).replace(f", {other}: failed", "")
    assert found(given, Grasp=GRASP) == lines


def test_outcomes_are_a_list_or_a_mapping() -> None:
    assert found(CONTAINER.replace("FAILURE", "1"))[0] == "SM004 7"
    assert found(CONTAINER.replace("failure: FAILURE", "failur: true"))[0] == "SM003 7"
    assert found(FLAT.replace("LOST", "failed"), Grasp=GRASP.replace("failure", "fialure"))[:2] == [
        "SM003 1",
        "SM003 1",
    ]


BOTH = """\
name: sm
template: Base
outcomes: [ready, failed]
states:
  - BOTH:
      template: Concurrence
      outcomes: [ready, failed]
      default_outcome: failed
      outcome_map:
        ready: RULE
      states:
        - GRASP: {template: Grasp}
        - LIGHTS: {template: ScriptedState, outcomes: [done, aborted]}
      transitions: {ready: ready, failed: failed}
"""


@pytest.mark.parametrize(
    ("rule", "lines"),
    [
        ("{GRASP: grasped}", ["SM404 10"]),
        ("{GRASP: grasped, LIGHTS: any}", []),
        ("{GRASP: grasped, LIGHTS: done}", []),
        ("{LIGHTS: done}", ["SM404 10"]),
        ("{LIGHTS: done, GRASP: any}", []),
        ("{GRASP: grasped, LIGTHS: any}", ["SM403 10"]),
        ("{GRASP: any, LIGHTS: any}", ["SM403 10"]),
    ],
)
def test_a_rule_ignores_a_branch_with_any(rule: str, lines: list[str]) -> None:
    assert sorted(found(BOTH.replace("RULE", rule), Grasp=GRASP)) == sorted(lines)


def test_any_may_be_the_name_of_an_outcome() -> None:
    text = BOTH.replace("[done, aborted]", "[any, aborted]")
    given = analysed({"main.yml": text.replace("RULE", "{GRASP: grasped, LIGHTS: any}"),
                      "templates/Grasp.yml": GRASP})  # fmt: skip
    assert given.machine is not None
    (rule,) = given.machine.root.children[0].rules  # type: ignore[union-attr]
    assert [(one.child, one.outcome) for one in rule.when] == [
        ("GRASP", "grasped"),
        ("LIGHTS", "any"),
    ]


LOOP = """\
name: sm
template: Base
outcomes: [succeeded, failed, preempted]
userdata: {parts: [a, b]}
states:
  - VISIT:
      template: ScriptedState
      outcomes: [done, aborted, stuck]
      input_keys: [parts]
      for_each: {item: part, in: parts, on: [done, aborted]}
      transitions: {done: succeeded, stuck: failed}
"""


def test_a_loop_over_failures_that_ends_with_a_success() -> None:
    assert found(LOOP) == ["SM404 10"]
    assert found(LOOP.replace("done: succeeded", "done: failed")) == ["SM203 3"]
    assert found(LOOP.replace("on: [done, aborted]", "on: [done, stuck]").replace("stuck:", "aborted:")) == []  # fmt: skip  # noqa: E501
    meant = LOOP.replace(
        "[done, aborted, stuck]", "{done: {}, aborted: {failure: false}, stuck: {}}"
    )
    assert found(meant) == []
    declared = LOOP.replace("on: [done, aborted]", "on: [done, stuck]").replace(
        "[done, aborted, stuck]", "{done: {}, aborted: {}, stuck: {failure: true}}"
    )
    assert found(declared.replace("stuck: failed", "aborted: failed")) == ["SM404 10"]


ITERATOR = """\
name: sm
template: Base
outcomes: [succeeded, failed, preempted]
states:
  - EACH:
      template: Iterator
      outcomes: [END, aborted]
      it: [1, 2]
      it_label: part
      loop_outcomes: [done, aborted]
      exhausted_outcome: END
      states:
        - ONE: {template: ScriptedState, outcomes: [done, aborted], input_keys: [part]}
      transitions: {END: succeeded, aborted: failed, done: failed}
"""


@pytest.mark.parametrize(("end", "lines"), [("succeeded", ["SM404 10"]), ("all_visited", [])])
def test_an_iterator_over_failures(end: str, lines: list[str]) -> None:
    text = ITERATOR.replace("END", end).replace(
        ", aborted]\n      it", ", aborted, done]\n      it"
    )
    assert [line for line in found(text) if line.startswith("SM4")] == lines


LIMIT = """\
name: sm
template: Base
outcomes: [succeeded, failed]
states:
  - WAIT:
      template: ScriptedState
      outcomes: [pressed, preempted]
      timeout: 10s
      transitions: {pressed: succeeded, timeout: succeeded, preempted: failed}
"""


def test_a_limit_of_a_wait_may_be_a_success() -> None:
    assert found(LIMIT) == []
    own = LIMIT.replace("      timeout: 10s\n", "").replace("[pressed,", "[pressed, timeout,")
    assert found(own) == []
    outcomes = "{pressed: {}, preempted: {}, timeout: {failure: true}}"
    assert found(own.replace("[pressed, timeout, preempted]", outcomes)) == ["SM206 8"]
