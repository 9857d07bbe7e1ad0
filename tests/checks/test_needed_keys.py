"""Keys that the condition of a built-in state needs (SM301, SM303), keys of a class that are one
slip (SM308, SM310), and keys that containers in containers lose (SM307)."""

from __future__ import annotations

import pytest

from tests.trust.judged_repairs import printed
from tests.trust.project_text import analysed

Row = tuple[str, str, str]


def reported(files: dict[str, str]) -> list[Row]:
    return [
        (item.code, item.span.text, item.help or "")
        for item in analysed(files).report
        if item.code != "SM207"
    ]


GUARDED = """\
name: polish
template: ROSBase
outcomes: [ok, failed]
userdata: {limit: 45.0}
states:
  - GUARDED:
      template: StateMachine
      outcomes: [good, bad]
INPUTS      states:
        - WATCH:
            STATE
            input_keys: [limit]
            transitions: {GOOD: good, BAD: bad, preempted: bad}
      transitions: {good: ok, bad: failed}
"""
MONITOR = """template: MonitorState
            topic: /a
            msg_type: std_msgs/Float32
            max_checks: 3
            cond_cb: 'lambda ud, msg: msg.data < ud.limit'"""
CONDITION = """template: ConditionState
            cond_cb: 'lambda ud: ud.limit > 3'"""


@pytest.mark.parametrize(
    ("state", "outcomes"),
    [(MONITOR, ("valid", "invalid")), (CONDITION, ("'true'", "'false'"))],
)
def test_a_key_that_a_condition_reads_in_a_container(state: str, outcomes: tuple[str, str]) -> None:
    text = GUARDED.replace("STATE", state)
    text = text.replace("GOOD", outcomes[0]).replace("BAD", outcomes[1])
    help = "write `input_keys: [limit]` in `GUARDED`"
    without = text.replace("INPUTS", "")
    assert reported({"main.yml": without}) == [("SM303", "limit", help)]
    assert reported({"main.yml": text.replace("INPUTS", "      input_keys: [limit]\n")}) == []
    unset = text.replace("INPUTS", "").replace("userdata: {limit: 45.0}\n", "")
    assert [row[:2] for row in reported({"main.yml": unset})] == [("SM301", "limit")]
    tested = unset.replace("ud.limit", "(ud.limit if 'limit' in ud else 4)".replace("'", '"'))
    assert reported({"main.yml": tested}) == []


MEASURE = {
    "main.yml": """\
name: sm
template: Base
outcomes: [ok]
userdata: {point: [0.1, 0.2]}
states:
  - SHOOT: {template: Measure, transitions: {measured: SHOW}}
  - SHOW:
      template: PrintUserdataState
      input_keys: [deviation]
      transitions: {succeeded: ok}
""",
    "templates/Measure.yml": """\
name: Measure
input_keys: {point: "list[float]"}
output_keys: {deviation: float}
outcomes: {measured: {}}
writes: {measured: [deviation]}
code: {python: "cell.measure:Measure"}
""",
    "cell/__init__.py": "",
    "cell/measure.py": """\
import smach


class Measure(smach.State):
    def __init__(self):
        super().__init__(outcomes=["measured"], input_keys=["point"], output_keys=["deviation"])

    def execute(self, userdata):
        x, y = userdata.point
        userdata.deviation = x - y
        return "measured"
""",
}


@pytest.mark.parametrize(
    ("old", "new", "row"),
    [
        ("userdata.deviation =", "userdata.dev =", ("SM308", "dev", "write `userdata.deviation`")),
        ("userdata.point", "userdata.target", ("SM310", "target", "write `userdata.point`")),
    ],
)
def test_an_unknown_key_and_the_only_one_without_a_use(old: str, new: str, row: Row) -> None:
    text = MEASURE["cell/measure.py"]
    assert reported(MEASURE) == []
    assert reported({**MEASURE, "cell/measure.py": text.replace(old, new)}) == [row]
    both = text.replace(old, f"{new} 0\n        {old}" if "=" in old else f"{old}, {new}")
    changed = reported({**MEASURE, "cell/measure.py": both})
    assert [item[:2] for item in changed] == [row[:2]]
    assert changed[0][2] != row[2]


COUNT = """\
name: inspection
template: Base
outcomes: [good, defects]
userdata: {parts: [1, 2], found: 0}
states:
  - ALL:
      template: Iterator
      outcomes: [done]
      input_keys: [parts, found]
OUTPUTS      it: parts
      it_label: part
      exhausted_outcome: done
      loop_outcomes: [next]
      final_outcome_map: {next: done}
      transitions: {done: JUDGE}
      states:
        - ONE:
            template: StateMachine
            outcomes: [next]
            input_keys: [part, found]
            output_keys: [found]
            states:
              - LOOK:
                  template: ScriptedState
                  outcomes: [seen]
                  input_keys: [part]
                  transitions: {seen: COUNT}
              - COUNT:
                  template: CallbacksState
                  input_keys: [found]
                  output_keys: [found]
                  callbacks: {found: 'lambda ud: ud.found + 1'}
                  transitions: {succeeded: next}
  - JUDGE:
      template: ConditionalOutcomeState
      outcomes: [bad]
      input_keys: [found]
      callbacks: {bad: 'lambda ud: ud.found > 0'}
      default_outcome: fine
      transitions: {bad: defects, fine: good}
"""


def test_a_count_that_a_loop_keeps() -> None:
    help = "write `output_keys: [found]` in `ALL`"
    assert reported({"main.yml": COUNT.replace("OUTPUTS", "")}) == [("SM307", "ALL", help)]
    whole = COUNT.replace("OUTPUTS", "      output_keys: [found]\n")
    assert reported({"main.yml": whole}) == []


def test_a_count_for_the_loop_alone() -> None:
    begin = COUNT.index("  - JUDGE")
    text = COUNT.replace("OUTPUTS", "")[: begin - len("OUTPUTS")].replace(
        "done: JUDGE", "done: good"
    )
    assert [row[0] for row in reported({"main.yml": text})] == ["SM203"]


LABEL = """\
name: sm
template: Base
outcomes: [ok]
states:
  - LOCATE:
      template: CallbacksState
      output_keys: [label]
      callbacks: {label: 'lambda ud: "bolt"'}
      transitions: {succeeded: LOG}
  - LOG: {template: Log, REMAPPINGtransitions: {logged: ok}}
"""
LOG = "name: Log\ninput_keys: {name: str}\noutcomes: {logged: {}}\n"


def test_an_unread_key_of_the_type_of_one_that_nothing_sets() -> None:
    files = {"main.yml": LABEL.replace("REMAPPING", ""), "templates/Log.yml": LOG}
    errors = [row for row in printed(files) if row[0] in ("SM301", "SM305")]
    assert errors == [("SM301", "LOG", "write `remapping: {name: label}` in `LOG`")]
    files["main.yml"] = LABEL.replace("REMAPPING", "remapping: {name: label}, ")
    assert [row for row in reported(files) if row[0] in ("SM301", "SM305")] == []
