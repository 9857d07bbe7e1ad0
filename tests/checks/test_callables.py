"""Functions in a script: callable, arguments, results, and the places of the findings."""

from __future__ import annotations

import re

import pytest

from smachac.diagnostics.diagnostic import Diagnostic, Severity
from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.loader import memory_library
from tests.support.typed_machines import BUILT_IN

KINDS = ("SM003", "SM004", "SM016", "SM019", "SM306", "SM308", "SM310", "SM311", "SM312",
         "SM316", "SM317", "SM318")  # fmt: skip

HEAD = """
name: sm
template: {base}
outcomes: [done, other, aborted, preempted]
userdata: {{n: 0, seen: [1, 2], word: abc, zero: 0, pose: {{type: Pose, value: [0, 0, 0]}}}}
output_keys: [n, seen, word, zero, pose]
states:
  - A:
      input_keys: [{inputs}]
"""

SLOTS = {
    "callback": """
      template: CallbacksState
      output_keys: [n]
      callbacks: {n: CODE}
      transitions: {succeeded: done}
""",
    "condition": """
      template: ConditionalOutcomeState
      outcomes: [low]
      callbacks: {low: CODE}
      default_outcome: other
      transitions: {low: done, other: other}
""",
    "time": """
      template: SleepState
      time: CODE
      transitions: {succeeded: done}
""",
    "it": """
      template: Iterator
      it: CODE
      it_label: x
      outcomes: [done]
      exhausted_outcome: done
      loop_outcomes: [succeeded]
      states: [{B: {template: PrintUserdataState, input_keys: [x]}}]
      transitions: {done: done}
""",
    "request_cb": """
      template: ServiceState
      service_namespace: /x
      service: std_srvs/Trigger
      request_cb: CODE
      transitions: {succeeded: done, aborted: aborted, preempted: preempted}
""",
    "response_cb": """
      template: ServiceState
      service_namespace: /x
      service: std_srvs/Trigger
      response_cb: CODE
      transitions: {succeeded: done, aborted: aborted, preempted: preempted}
""",
    "request": """
      template: ServiceState
      service_namespace: /x
      service: std_srvs/Trigger
      request: CODE
      transitions: {succeeded: done, aborted: aborted, preempted: preempted}
""",
    "service": """
      template: ServiceState
      service_namespace: /x
      service: CODE
      transitions: {succeeded: done, aborted: aborted, preempted: preempted}
""",
    "goal": """
      template: SimpleActionState
      action_server_namespace: /x
      action: actionlib/TestAction
      goal: CODE
      transitions: {succeeded: done, aborted: aborted, preempted: preempted}
""",
    "msg_type": """
      template: WaitForMsgState
      topic: /x
      msg_type: CODE
      transitions: {succeeded: done, aborted: aborted, preempted: preempted}
""",
    "goal_cb": """
      template: SimpleActionState
      action_server_namespace: /x
      action: actionlib/TestAction
      goal_cb: CODE
      transitions: {succeeded: done, aborted: aborted, preempted: preempted}
""",
    "result_cb": """
      template: SimpleActionState
      action_server_namespace: /x
      action: actionlib/TestAction
      result_cb: CODE
      transitions: {succeeded: done, aborted: aborted, preempted: preempted}
""",
    "msg_cb": """
      template: WaitForMsgState
      topic: /x
      msg_type: std_msgs/String
      output_keys: [n]
      msg_cb: CODE
      transitions: {succeeded: done, aborted: aborted, preempted: preempted}
""",
}


def found(slot: str, code: str, **files: str) -> list[Diagnostic]:
    """The findings about the code in a slot of a state that reads the keys which the code names."""
    keys = [key for key in ("n", "seen", "word", "zero", "pose") if re.search(rf"\b{key}\b", code)]
    base = "Base" if slot in ("callback", "condition", "time", "it") else "ROSBase"
    text = HEAD.format(base=base, inputs=", ".join(keys)) + SLOTS[slot][1:].replace("CODE", code)
    report = analyse(Source("main.yml", text), memory_library(files, BUILT_IN), []).report
    return [item for item in report if item.code in KINDS]


def shown(slot: str, code: str) -> list[tuple[str, str]]:
    return [(item.code, item.span.text) for item in found(slot, code)]


@pytest.mark.parametrize(
    ("slot", "code", "expected"),
    [
        ("callback", "'ud.n + 1'", ("SM316", "ud")),
        ("callback", "ud.n", ("SM316", "ud")),
        ("callback", "'n + 1'", ("SM316", "'n + 1'")),
        ("callback", "'3'", ("SM316", "'3'")),
        ("callback", "'len(ud.seen)'", ("SM316", "ud")),
        ("condition", "'ud.n > 0'", ("SM316", "ud")),
        ("condition", "'True'", ("SM316", "'True'")),
        ("time", "'`ud.n + 1`'", ("SM316", "ud")),
        ("time", "'lambda ud: ud.n'", ("SM316", "'lambda ud: ud.n'")),
        ("it", "ud.seen", ("SM316", "ud")),
        ("it", "range(ud.n)", ("SM316", "ud")),
        ("response_cb", "ud.n", ("SM316", "ud")),
        ("callback", "'lambda: 3'", ("SM317", "lambda")),
        ("callback", "'lambda ud, x: x'", ("SM317", "ud, x")),
        ("condition", "'lambda ud, x: x'", ("SM317", "ud, x")),
        ("time", "'`lambda: 3`'", ("SM317", "lambda")),
        ("it", "'`lambda ud, x: [x]`'", ("SM317", "ud, x")),
        ("request_cb", "'lambda request: None'", ("SM317", "request")),
        ("request_cb", "'lambda request, ud: None'", ("SM317", "request, ud")),
        ("response_cb", "'lambda ud: None'", ("SM317", "ud")),
        ("goal_cb", "'lambda goal, ud: None'", ("SM317", "goal, ud")),
        ("result_cb", "'lambda ud, result: None'", ("SM317", "ud, result")),
        ("result_cb", "'lambda ud, result, status: None'", ("SM317", "ud, result, status")),
        ("msg_cb", "'lambda ud, msg: True'", ("SM317", "ud, msg")),
        ("callback", "'lambda ud: ud.seen.append(3)'", ("SM318", "ud.seen.append(3)")),
        ("condition", "'lambda ud: ud.seen.append(3)'", ("SM318", "ud.seen.append(3)")),
        ("condition", "'lambda ud: print(ud.n)'", ("SM318", "print(ud.n)")),
        ("condition", "'lambda ud: None'", ("SM318", "None")),
        ("time", "'`lambda ud: ud.word`'", ("SM318", "ud.word")),
        ("response_cb", "'lambda ud, r: \"suceeded\"'", ("SM318", '"suceeded"')),
        ("result_cb", "'lambda ud, status, r: True'", ("SM318", "True")),
        ("callback", "'lambda u: ud.n'", ("SM019", "ud")),
        ("it", "'`lambda u: ud.seen`'", ("SM019", "ud")),
        ("response_cb", "'lambda u, r: ud.n'", ("SM019", "ud")),
        ("callback", "'lambda ud: n + 1'", ("SM019", "n")),
        ("callback", "'lambda ud: (lambda u: (k := u))(ud.n) + k'", ("SM019", "k")),
        ("callback", "'lambda ud: ud.n + true'", ("SM019", "true")),
        ("request_cb", "'lambda ud, request: fill(request)'", ("SM019", "fill")),
        ("service", "Trigger", ("SM019", "Trigger")),
        ("msg_type", "Strin", ("SM019", "Strin")),
        ("request", "SetBoolRequest(True)", ("SM019", "SetBoolRequest")),
        ("goal", "FooGoal(goal=1)", ("SM019", "FooGoal")),
        ("callback", "'lambda ud: ud.m'", ("SM310", "m")),
        ("goal_cb", "'lambda ud, goal: ud.m'", ("SM310", "m")),
        ("response_cb", "'lambda u, response: u.m'", ("SM310", "m")),
        ("time", "'`lambda ud: ud.m`'", ("SM310", "m")),
        ("callback", "'lambda ud: ud[\"m\"]'", ("SM310", '"m"')),
        ("callback", "'lambda ud: ud.pose.positon'", ("SM311", "positon")),
        ("callback", "'lambda ud: ud.n.x + 1'", ("SM311", "x")),
        ("callback", "'lambda ud: 1 + ud.n / 0'", ("SM311", "ud.n / 0")),
        ("callback", "'lambda ud: [1, 2][5]'", ("SM311", "[1, 2][5]")),
        ("callback", "'lambda ud: lenn(ud.seen)'", ("SM019", "lenn")),
        ("callback", "'lambda ud: ud.n && 1'", ("SM016", "&&")),
        ("condition", "'lambda ud: ud.n = 1'", ("SM016", "=")),
    ],
)  # fmt: skip
def test_a_fault_in_code_is_marked_at_its_token(
    slot: str, code: str, expected: tuple[str, str]
) -> None:
    assert shown(slot, code) == [expected]


@pytest.mark.parametrize(
    ("slot", "code"),
    [
        ("callback", "'lambda userdata: userdata.n'"),
        ("callback", "'lambda u: u.n'"),
        ("callback", "'lambda ud, step=2: ud.n + step'"),
        ("callback", "'lambda *every: len(every)'"),
        ("callback", "len"),
        ("callback", "math.sqrt"),
        ("callback", "'functools.partial(max, 3)'"),
        ("callback", "'lambda ud: None'"),
        ("callback", "'lambda ud: [ud for ud in ud.seen]'"),
        ("callback", "'lambda ud: (lambda u: u + 1)(ud.n)'"),
        ("callback", "'lambda ud: sum(x for x in ud.seen)'"),
        ("callback", "'lambda ud: ud.seen.pop()'"),
        ("callback", "'lambda ud: ud.word.index(\"a\")'"),
        ("callback", "'lambda ud: {\"a\": 1}.update'"),
        ("callback", "'lambda ud: ud.n / ud.zero if ud.zero else 0'"),
        ("callback", "'lambda ud: \"%s\" % 0'"),
        ("callback", "'lambda ud: ud.n if ud.n is not None else 0'"),
        ("callback", "'lambda ud: ud[\"n\"] == 1'"),
        ("callback", "'lambda ud: (k := ud.n) is not None and k + 1 > 12'"),
        ("callback", "'lambda ud: any((k := x) > 1 for x in ud.seen) and k'"),
        ("callback", "'lambda ud: (lambda u: (k := u) + k)(ud.n)'"),
        ("condition", "'lambda ud: ud.seen'"),
        ("condition", "'lambda ud: 3'"),
        ("condition", "'lambda ud: not ud.n'"),
        ("time", "3"),
        ("time", "'`lambda ud: ud.n * 2`'"),
        ("time", "math.pi"),
        ("it", "seen"),
        ("it", "[1, 2]"),
        ("it", "range(3)"),
        ("it", "'`lambda ud: ud.seen`'"),
        ("it", "'`lambda: [1]`'"),
        ("service", "std_srvs.srv.Trigger"),
        ("msg_type", "String"),
        ("request", "TriggerRequest()"),
        ("goal", "TestGoal(goal=1)"),
        ("request_cb", "'lambda ud, request: None'"),
        ("goal_cb", "'lambda ud, goal: fill(ud, goal) if ud.n else None'".replace("fill", "print")),
        ("request_cb", "'lambda _, r: r'"),
        ("response_cb", '\'lambda ud, r: "succeeded" if r.success else "aborted"\''),
        ("response_cb", "'lambda ud, r: None'"),
        ("result_cb", "'lambda ud, status, result: \"aborted\" if status else None'"),
        ("result_cb", "'lambda *all: None'"),
        ("msg_cb", "'lambda msg, ud: msg.data'"),
        ("msg_cb", "'lambda m, u: True'"),
    ],
)
def test_unusual_code_without_a_fault(slot: str, code: str) -> None:
    assert shown(slot, code) == []


@pytest.mark.parametrize(
    ("slot", "code", "cured"),
    [
        ("callback", "'ud.n + 1'", "'lambda ud: ud.n + 1'"),
        ("callback", "ud.n", "'lambda ud: ud.n'"),
        ("time", "'`ud.n`'", "'`lambda ud: ud.n`'"),
        ("time", "'lambda ud: ud.n'", "'`lambda ud: ud.n`'"),
        ("it", "ud.seen", "seen"),
        ("callback", "'lambda u: ud.n + ud.zero'", "'lambda u: u.n + u.zero'"),
        ("callback", "'lambda ud: n + n'", "'lambda ud: ud.n + ud.n'"),
        ("callback", "'lambda ud: true'", "'lambda ud: True'"),
        ("condition", "'lambda ud: ud.n = 1'", "'lambda ud: ud.n == 1'"),
        ("condition", "'lambda ud: !ud.n && ud.zero'", "'lambda ud: not ud.n and ud.zero'"),
        ("callback", "'lambda ud: ud.pose.positon'", "'lambda ud: ud.pose.position'"),
    ],
)
def test_certain_cures(slot: str, code: str, cured: str) -> None:
    (item, *_) = found(slot, code)
    text = item.span.source.text
    for edit in sorted(item.finding.edits, key=lambda edit: -edit.span.start):
        text = text[: edit.span.start] + edit.text + text[edit.span.end :]
    assert text == item.span.source.text.replace(code, cured)
    assert code != cured


def test_a_result_of_only_some_runs_is_a_warning() -> None:
    (item,) = found("condition", "'lambda ud: ud.seen.sort() if ud.n else True'")
    assert (item.code, item.severity) == ("SM318", Severity.WARNING)


def test_a_user_s_state_type_states_the_same_facts() -> None:
    interface = (
        "name: Watch\n"
        "variables: {on_event: {role: function, arguments: [event, userdata], returns: outcome}}\n"
        'input_keys: {"*": {}}\noutcomes: {succeeded: {}, aborted: {}}\ncode: {python: "w:W"}\n'
    )
    slot = """
      template: Watch
      on_event: CODE
      transitions: {succeeded: done, aborted: aborted}
"""
    SLOTS["own"] = slot
    try:
        codes = [
            [item.code for item in found("own", code, **{"templates/Watch.yml": interface})]
            for code in (
                "'`lambda ud, event: None`'",
                "'`lambda event: None`'",
                "'`lambda event, ud: \"suceeded\"`'",
                "'`lambda event, ud: \"succeeded\"`'",
            )
        ]
    finally:
        del SLOTS["own"]
    assert codes == [["SM317"], ["SM317"], ["SM318"], []]


def test_a_function_in_quotes_is_no_wrong_number() -> None:
    interface = (
        "name: Wait\nvariables: {time: {type: float<s>, role: duration}}\noutcomes: {done: {}}\n"
        'code: {python: "w:W"}\n'
    )
    text = "name: sm\noutcomes: [done]\nstates: [{A: {template: Wait, time: 'lambda ud: 3'}}]\n"
    library = memory_library({"templates/Wait.yml": interface}, BUILT_IN)
    report = analyse(Source("main.yml", text), library, []).report
    assert [item.code for item in report if item.code in ("SM304", "SM316")] == ["SM316"]


def test_faults_of_the_facts_are_reported() -> None:
    interface = "name: W\nvariables: {f: {role: function, returns: valeu}}\noutcomes: {done: {}}\n"
    text = "name: sm\noutcomes: [done]\nstates: [{A: {template: W, f: null}}]\n"
    files = {"templates/W.yml": interface}
    report = analyse(Source("main.yml", text), memory_library(files, BUILT_IN), []).report
    assert [(item.code, item.help) for item in report if item.code == "SM004"] == [
        ("SM004", "did you mean `value`?")
    ]


def test_a_key_that_is_written_as_an_argument() -> None:
    (item,) = found("condition", "'lambda ud, zero: ud.n < zero'")
    assert item.code == "SM317"
    assert item.finding.help == "begin it with `lambda ud:`, and read `zero` as `ud.zero`"


@pytest.mark.parametrize("slot", ["condition", "time"])
def test_a_method_that_is_not_called(slot: str) -> None:
    code = "'lambda ud: ud.word.isdigit'"
    items = found(slot, code if slot == "condition" else "'`lambda ud: ud.word.isdigit`'")
    assert [item.code for item in items] == ["SM318"]
    assert "the method `isdigit` without a call" in items[0].message
    assert items[0].finding.help == "call it: `ud.word.isdigit()`"


def test_a_key_of_unknown_type_may_have_such_an_attribute() -> None:
    assert shown("condition", "'lambda ud: ud.pose.isdigit'")[:1] != [("SM318", "ud.pose.isdigit")]
    assert shown("condition", "'lambda ud: ud.word.isdigit()'") == []


def test_a_duration_with_a_unit_is_corrected_at_its_preset() -> None:
    text = (
        "name: sm\ntemplate: Base\noutcomes: [done, preempted]\nuserdata: {wait: 2s}\nstates:\n"
        "  - A:\n      template: SleepState\n      input_keys: [wait]\n"
        "      time: '`lambda ud: ud.wait`'\n      transitions: {succeeded: done}\n"
    )
    report = analyse(Source("main.yml", text), memory_library({}, BUILT_IN), []).report
    (item,) = [item for item in report if item.code == "SM318"]
    assert item.finding.help == "write the number without its unit: `2`"
    assert [place.span.text for place in item.finding.related] == ["2s"]


def test_a_function_that_returns_nothing() -> None:
    (item,) = found("time", "'`lambda ud: time.sleep(2.5)`'")
    assert (item.code, item.finding.help) == ("SM318", "write the number of seconds: `2.5`")
    assert shown("condition", "'lambda ud: random.shuffle(ud.seen)'") == [
        ("SM318", "random.shuffle(ud.seen)")
    ]
    assert shown("callback", "'lambda ud: time.sleep(1)'") == []


def test_swapped_arguments_have_no_other_findings() -> None:
    (item,) = found("msg_cb", "'lambda ud, msg: msg.data'")
    assert item.code == "SM317"
    assert item.finding.help == "begin it with `lambda msg, ud:`"


def test_a_param_in_code() -> None:
    text = (
        "name: sm\noutcomes: [done]\nparams: {limit: 3, other: 4}\nuserdata: {n: 1}\nstates:\n"
        "  - A:\n      template: ConditionalOutcomeState\n      outcomes: [low]\n"
        "      input_keys: [n]\n      callbacks: {low: CODE}\n      default_outcome: high\n"
        "      transitions: {low: done, high: done}\n"
    )
    wrong = text.replace("CODE", "'lambda ud: ud.n < params.limit'")
    report = analyse(Source("main.yml", wrong), memory_library({}, BUILT_IN), []).report
    assert [(item.code, item.span.text) for item in report] == [
        ("SM306", "other"),
        ("SM019", "params"),
    ]
    help = report[1].help or ""
    meant = "['lambda ud: ud.n < ', [params, limit]]"
    assert help == f"a param is looked up outside of code: write `{meant}`"
    right = text.replace("CODE", meant).replace(", other: 4", "")
    assert analyse(Source("main.yml", right), memory_library({}, BUILT_IN), []).report == []


@pytest.mark.parametrize(
    ("code", "part"),
    [
        ("lambda ud: ud.n > '1'", "ud.n > '1'"),
        ("lambda ud: ud.n + ud.word == 3", "ud.n + ud.word"),
        ("lambda ud: len(ud.n) > 0", "len(ud.n)"),
    ],
)
def test_operations_in_the_function_of_a_condition_state(code: str, part: str) -> None:
    state = f"""
      template: ConditionState
      cond_cb: "{code}"
      transitions: {{'true': done, 'false': other}}
"""
    script = HEAD.format(base="Base", inputs="n, word") + state
    found = analyse(Source("main.yml", script), memory_library({}, BUILT_IN), []).report
    assert [item.span.text for item in found if item.code == "SM311"] == [part]
