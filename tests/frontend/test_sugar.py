"""Time limits, retries and loops over items: what becomes of them when they run."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import smachac
from smachac.diagnostics.diagnostic import Finding, Report
from smachac.diagnostics.source import Source
from smachac.frontend.script.sugar import duration
from smachac.frontend.text.yaml_tree import parse
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run
from smachac.interpreter.result import Event, InterpreterResult
from smachac.interpreter.scenario import read_scenario, scenario_behaviour
from tests.trust.project_text import analysed

SCRIPT = """
name: sm
template: Base
outcomes: [succeeded, aborted, preempted, timeout, exhausted]
userdata: {todo: [1, 2, 3]}
states:
  - WORK:
      { template: ScriptedState, outcomes: [succeeded, aborted, preempted], SUGAR }
"""


def played(
    folder: Path, sugar: str, script: str, steps: Any, **options: Any
) -> tuple[InterpreterResult, list[str]]:
    """A run of one state with sugar: the result, and what each state ended with, in order."""
    path = folder / "main.yml"
    path.write_text(script.replace("SUGAR", sugar), encoding="utf-8")
    machine = smachac.load(path)
    scenario, problems = read_scenario({"states": steps}, machine)
    assert problems == []
    events: list[Event] = []
    result = run(
        machine,
        scenario_behaviour(scenario, machine, builtin_behaviour()),
        events.append,
        **options,
    )
    return result, [f"{e['path']} {e['outcome']}" for e in events if e["event"] == "exit"]


@pytest.mark.parametrize(
    ("sugar", "steps", "outcome", "visits"),
    [
        ("timeout: 1s", ["succeeded"], "succeeded", 1),
        ("timeout: 1s", ["aborted"], "aborted", 1),
        ("retry: {on: [aborted], max: 3}", ["succeeded"], "succeeded", 1),
        ("retry: {on: [aborted], max: 3}", ["aborted", "aborted", "succeeded"], "succeeded", 3),
        ("retry: {on: [aborted], max: 3}", ["aborted"], "exhausted", 3),
        ("retry: {on: [aborted], max: 1, delay: 1s}", ["aborted"], "exhausted", 1),
        ("retry: {on: [aborted, preempted], max: 2}", ["preempted", "succeeded"], "succeeded", 2),
        ("for_each: {item: one, in: todo}", ["succeeded"], "succeeded", 3),
        ("for_each: {item: one, in: todo}", ["succeeded", "aborted"], "aborted", 2),
        ("for_each: {item: one, in: []}", ["aborted"], "succeeded", 0),
        ("for_each: {item: one, in: [a, b], on: [aborted]}", ["aborted"], "aborted", 2),
        (
            "for_each: {item: one, in: todo}, retry: {on: [aborted], max: 2}",
            ["aborted", "succeeded", "succeeded", "aborted", "succeeded"],
            "succeeded",
            5,
        ),
    ],
)
def test_outcomes(tmp_path: Path, sugar: str, steps: list[str], outcome: str, visits: int) -> None:
    result, exits = played(tmp_path, sugar, SCRIPT, {"WORK": steps})
    assert result.outcome == outcome
    path = "sm/WORK/TRIES/WORK" if "for_each" in sugar and "retry" in sugar else "sm/WORK/WORK"
    path = "sm/WORK/TRY/WORK" if "delay" in sugar else path
    assert sum(line.split()[0] == path for line in exits) == visits


SLOW = SCRIPT.replace(
    "ScriptedState, outcomes: [succeeded, aborted, preempted]", "SleepState, time: 60"
)


def test_a_time_limit_counts_virtual_time_and_asks_the_state_to_stop(tmp_path: Path) -> None:
    result, exits = played(tmp_path, "timeout: 2.5s", SLOW, {})
    assert (result.outcome, result.time) == ("timeout", 2.5)
    assert exits == ["sm/WORK/TIMER succeeded", "sm/WORK/WORK preempted", "sm/WORK timeout"]


def test_a_state_that_ignores_the_request_is_waited_for(tmp_path: Path) -> None:
    text = SLOW.replace(
        "template: SleepState, time: 60",
        "template: StateMachine, outcomes: [succeeded, preempted], states: ["
        "{NAP: {template: SleepState, time: 60,"
        " transitions: {succeeded: succeeded, preempted: NAP_ON}}},"
        "{NAP_ON: {template: SleepState, time: 7, transitions: {succeeded: succeeded}}}]",
    )
    result, exits = played(tmp_path, "timeout: 2s", text, {})
    assert (result.outcome, result.time) == ("timeout", 9.0)
    assert exits[-3:] == [
        "sm/WORK/WORK/NAP_ON succeeded",
        "sm/WORK/WORK succeeded",
        "sm/WORK timeout",
    ]


def test_the_pause_between_tries_and_the_limit_of_each(tmp_path: Path) -> None:
    sugar = "timeout: 2s, retry: {on: [timeout], max: 3, delay: 10s}"
    result, _ = played(tmp_path, sugar, SLOW, {})
    assert (result.outcome, result.time) == ("exhausted", 3 * 2 + 2 * 10)


@pytest.mark.parametrize(
    "sugar", ["timeout: 90s", "retry: {on: [succeeded], max: 9}", "for_each: {item: one, in: todo}"]
)
def test_a_request_to_stop_goes_through(tmp_path: Path, sugar: str) -> None:
    result, _ = played(tmp_path, sugar, SLOW, {}, preempt_at=[1])
    assert result.outcome == "preempted"


def test_a_request_during_the_pause_ends_the_tries(tmp_path: Path) -> None:
    sugar = "retry: {on: [aborted], max: 3, delay: 5s}"
    result, exits = played(tmp_path, sugar, SCRIPT, {"WORK": "aborted"}, preempt_at=[3])
    assert result.outcome == "preempted"
    assert exits[2:] == [
        "sm/WORK/TRY aborted",
        "sm/WORK/TRY/PAUSE preempted",
        "sm/WORK/TRY preempted",
        "sm/WORK preempted",
    ]


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        ("20s", 20),
        ("500ms", 0.5),
        ("1.5min", 90),
        ("1.5 min", 90),
        ("1h", 3600),
        ("3", 3),
        ("0.25", 0.25),
        (".5s", 0.5),
        ("0", 0),
    ],
)
def test_durations(text: str, seconds: float) -> None:
    tree = parse(Source("x.yml", text), [])
    assert tree is not None
    assert duration(tree, []) == seconds


@pytest.mark.parametrize("tries", [0, 10_001, 10**12, -1, "many", 1.5, True])
def test_no_number_of_tries(tries: object, tmp_path: Path) -> None:
    sugar = f"retry: {{on: [aborted], max: {tries}}}".replace("True", "true")
    (tmp_path / "main.yml").write_text(SCRIPT.replace("SUGAR", sugar), encoding="utf-8")
    found = smachac.check(tmp_path / "main.yml")
    assert [item.code for item in found if item.severity.value == "error"] == ["SM004"]


@pytest.mark.parametrize(
    "text", ["-1s", "1 week", "soon", "true", "null", "[1]", "1e3s", "s", "1S"]
)
def test_no_durations(text: str) -> None:
    tree = parse(Source("x.yml", text), [])
    report: Report = []
    assert tree is not None
    assert duration(tree, report) is None
    assert [item.code for item in report] == ["SM004"]


@pytest.mark.parametrize(
    "sugar", ["retry: {on: [bad], max: 2, delay: 1s}", "for_each: {item: one, in: [1]}"]
)
def test_sugar_of_a_container_without_outcomes_is_an_error(tmp_path: Path, sugar: str) -> None:
    (tmp_path / "main.yml").write_text(
        f"name: sm\ntemplate: Base\noutcomes: [done]\nstates:\n"
        f"  - A:\n      template: StateMachine\n      {sugar}\n      states:\n"
        "        - B: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}\n",
        encoding="utf-8",
    )
    report = smachac.check(tmp_path / "main.yml")
    (item,) = [item for item in report if item.code == "SM004"]
    assert item.help == "add `outcomes: [...]` to this state"


def test_a_variable_of_the_state_type_comes_first(tmp_path: Path) -> None:
    templates = tmp_path / "templates"
    templates.mkdir()
    (templates / "Wait.yml").write_text(
        "name: Wait\nvariables: {timeout: {type: float}}\noutcomes: {done: {}}\n"
        "code: {python: 'robot:Wait'}\n",
        encoding="utf-8",
    )
    (templates / "Open.tpl.py").write_text("{% block body %}{% endblock %}", encoding="utf-8")
    (tmp_path / "main.yml").write_text(
        "name: sm\ntemplate: Base\noutcomes: [done]\nstates:\n"
        "  - WAIT: {template: Wait, timeout: 3, transitions: {done: OPEN}}\n"
        "  - OPEN: {template: Open, timeout: 3, transitions: {done: done}}\n",
        encoding="utf-8",
    )
    for child in smachac.load(tmp_path / "main.yml").root.children:
        assert type(child).__name__ == "Leaf"
        assert [variable.name for variable in getattr(child, "variables", ())] == ["timeout"]


def faults(sugar: str, transitions: str, folder: Path) -> dict[str, Finding]:
    """The errors in a script with sugar, by code."""
    path = folder / "main.yml"
    text = SCRIPT.replace("SUGAR", f"{sugar}, transitions: {transitions}")
    path.write_text(text, encoding="utf-8")
    return {item.code: item.finding for item in smachac.check(path)}


def test_a_transition_on_an_outcome_that_retry_replaces_is_explained(tmp_path: Path) -> None:
    sugar = "retry: {on: [aborted], max: 3}"
    found = faults(sugar, "{succeeded: succeeded, aborted: aborted}", tmp_path)
    help = found["SM102"].help or ""
    assert help.startswith("write `exhausted:` in place of `aborted:`;")


@pytest.mark.parametrize("items", ["3", "true", "{a: 1}", "null"])
def test_a_loop_over_no_list_is_a_wrong_shape(items: str, tmp_path: Path) -> None:
    found = faults(f"for_each: {{item: one, in: {items}}}", "{succeeded: succeeded}", tmp_path)
    assert found["SM004"].message.startswith("expected a list or the name of a key, found ")


def test_retries_without_outcomes_never_exhaust(tmp_path: Path) -> None:
    found = faults("retry: {on: [], max: 3}", "{succeeded: succeeded}", tmp_path)
    assert "`on` of `retry`" in (found["SM203"].help or "")


WRONG = """
name: sm
template: Base
outcomes: [done, failed, preempted]
states:
  - A:
      template: ScriptedState
      outcomes: [ok, failed, preempted]
      SUGAR
      transitions: {ok: done, preempted: preempted, TARGETS}
"""
LIMITED = "timeout: failed, failed: failed"


@pytest.mark.parametrize(
    ("sugar", "targets", "code", "help"),
    [
        ("retry: {on: [failed], times: 3}", "exhausted: failed", "SM003", "did you mean `max`?"),
        ("retry: {on: [failed], mx: 3}", "exhausted: failed", "SM003", None),
        ("retry: {on: [failed], max: three}", "exhausted: failed", "SM004",
         "write a whole number, such as `3`"),
        ("retry: {on: [failed], max: 0}", "exhausted: failed", "SM004",
         "write `max: 1` or more, or remove `retry` if one try is enough"),
        ("retry: {on: [failed]}", "exhausted: failed", "SM005", None),
        ("retry: {max: 3}", "exhausted: failed", "SM005", None),
        ("retry: 3", "exhausted: failed", "SM004", None),
        ("retry: {on: [failed], max: 3, delay: 2 sec}", "exhausted: failed", "SM004", None),
        ("timeout: 20 sec", LIMITED, "SM004", None),
        ("timeout: 0", LIMITED, "SM004", "write it as `20s`, or remove it"),
    ],
)  # fmt: skip
def test_wrong_sugar_has_no_consequences(
    sugar: str, targets: str, code: str, help: str | None, tmp_path: Path
) -> None:
    path = tmp_path / "main.yml"
    path.write_text(WRONG.replace("SUGAR", sugar).replace("TARGETS", targets), encoding="utf-8")
    found = {x.code: x.finding for x in smachac.check(path) if x.severity.value != "info"}
    # A part whose misspelling is not certain is also a missing one.
    assert found.keys() - {"SM005"} <= {code}
    assert help in (None, found[code].help)


@pytest.mark.parametrize("sugar", ["timeout: 20 sec", "retry: {on: [failed], times: 3}"])
def test_wrong_sugar_adds_no_outcome_that_the_script_does_not_use(
    sugar: str, tmp_path: Path
) -> None:
    path = tmp_path / "main.yml"
    text = WRONG.replace("SUGAR", sugar).replace("TARGETS", "failed: failed")
    path.write_text(text, encoding="utf-8")
    found = [item.code for item in smachac.check(path) if item.severity.value != "info"]
    assert found in (["SM003"], ["SM004"])


@pytest.mark.parametrize("loop", ["for_each: {item: i, in: count}", "LOOP"])
def test_a_loop_over_a_number(loop: str, tmp_path: Path) -> None:
    state = f"template: ScriptedState\n      {loop}\n      input_keys: [i]\n      outcomes: [ok]"
    if loop == "LOOP":
        state = (
            "template: Iterator\n      input_keys: [count]\n      outcomes: [ok]\n"
            "      it: count\n      it_label: i\n      exhausted_outcome: ok\n"
            "      loop_outcomes: [ok]\n      states:\n"
            "        - S: {template: ScriptedState, input_keys: [i], outcomes: [ok]}"
        )
    text = (
        "name: sm\ntemplate: Base\noutcomes: [done, preempted]\nuserdata: {count: VALUE}\n"
        f"states:\n  - A:\n      {state}\n      transitions: {{ok: done}}\n"
    )
    path = tmp_path / "main.yml"
    path.write_text(text.replace("VALUE", "3"), encoding="utf-8")
    (item,) = [item for item in smachac.check(path) if item.code == "SM304"]
    assert item.span.text == "count"
    assert [place.span.text for place in item.finding.related] == ["3"]
    path.write_text(text.replace("VALUE", "[3]"), encoding="utf-8")
    assert [item for item in smachac.check(path) if item.code == "SM304"] == []


@pytest.mark.parametrize(
    "sugar",
    [
        "retry: {on: [aborted, timeout], max: 3, timeout: 20s}",
        "for_each: {item: n, in: [1, 2], on: [done], timeout: 20s}",
    ],
)
def test_a_time_limit_inside_belongs_beside(sugar: str) -> None:
    text = f"""
name: sm
template: Base
outcomes: [done, aborted, exhausted, preempted, timeout]
states:
  - A:
      template: ScriptedState
      outcomes: [done, aborted]
      {sugar}
"""
    name = sugar.partition(":")[0]
    report = analysed({"main.yml": text}).report
    told = [(item.code, item.span.text, item.help) for item in report if item.code == "SM003"]
    assert told == [("SM003", "timeout", f"write `timeout: 20s` beside `{name}`")]
    assert not any(item.code == "SM004" for item in report)
