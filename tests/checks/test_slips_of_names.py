"""Names, outcomes and durations that are wrong in one certain way: the help is what to write."""

from __future__ import annotations

import pytest

from tests.checks.test_first_scripts import PATROL, reported
from tests.repair.slips import slip
from tests.trust.judged_repairs import printed

GRAB = "transitions: {held: BOTH, slipped: LET_GO}"
RULE = "outcome_map: {ready: {LIGHT: done, DRIVE: done}}"


def patrol(old: str, new: str) -> list[tuple[str, str, str | None]]:
    assert old in PATROL
    return reported({"main.yml": PATROL.replace(old, new)})


@pytest.mark.parametrize(
    ("limit", "help"),
    [
        ("1m30s", "write it with one unit: `90s`"),
        ("1h 30min", "write it with one unit: `5400s`"),
        ("20 sec", "write it as `20s`"),
        ("5 apples", "write it as `20s`, `500ms`, `1.5min` or `1h`"),
    ],
)
def test_a_duration_in_another_form(limit: str, help: str) -> None:
    assert patrol(GRAB, f"timeout: {limit}\n      {GRAB}") == [("SM004", limit, help)]


def test_the_only_outcome_without_a_transition_is_meant() -> None:
    steps = "transitions: {held: BOTH, exhausted: LET_GO, preempted: aborted}"
    found = patrol(GRAB, f"retry: {{on: [failed], max: 3}}\n      {steps}")
    assert found == [("SM004", "failed", "write `slipped`, which has no transition")]


def test_outcomes_of_two_branches_that_are_swapped() -> None:
    branches = "- LIGHT: {template: ScriptedState, outcomes: [done]}"
    assert branches in PATROL
    main = PATROL.replace(branches, branches.replace("done", "lit, dark")).replace(
        RULE, "outcome_map: {ready: {LIGHT: lit, DRIVE: done}}"
    )
    found = slip({"main.yml": main}, "LIGHT: lit, DRIVE: done", "LIGHT: done, DRIVE: lit")
    assert found.is_shown
    assert found.is_restored


def test_transitions_of_a_branch_are_one_finding() -> None:
    branch = "- DRIVE: {template: ScriptedState, outcomes: [done, lost]"
    found = patrol(branch, f"{branch}, transitions: {{done: LIGHT, lost: LIGHT}}")
    help = (
        "remove them: the rules in `outcome_map` decide how `BOTH` ends; for an order put the"
        " states into a Sequence in one branch"
    )
    assert [item for item in found if item[0] == "SM101"] == [("SM101", "done", help)]


def test_the_only_outcome_of_all_states_of_a_sequence() -> None:
    text = """\
name: sm
outcomes: [done, failed]
states:
  - PREPARE:
      template: Sequence
      outcomes: [done, failed]
      connector_outcome: finished
      transitions: {done: done, failed: failed}
      states:
        - A: {template: ScriptedState, outcomes: [ok, failed]}
        - B: {template: ScriptedState, outcomes: [ok, failed]}
"""
    found = reported({"main.yml": text})
    help = "write `ok`, with which each of its states can end"
    assert [item for item in found if item[0] == "SM201"] == [("SM201", "finished", help)]


INTERFACE = """\
name: Move
variables: {VARIABLES}
input_keys: {KEYS}
outcomes: {OUTCOMES}
code: {python: "cell.arm:Move"}
"""


@pytest.mark.parametrize(
    ("part", "text", "marked", "help"),
    [
        ("VARIABLES", "fast: true", "true",
         "write `bool`; a default value is written `{type: bool, default: true}`"),
        ("VARIABLES", "speed: {type: 0.5}", "0.5",
         "write `float`; a default value is written `{type: float, default: 0.5}`"),
        ("KEYS", "goal: {room: str, floor: int}", "{room: str, floor: int}",
         "write `{type: {room: str, floor: int}}`"),
        ("KEYS", "goal: {typ: str}", "typ", "did you mean `type`?"),
        ("OUTCOMES", "moved: {}, blocked: {}, failure: true", "failure",
         "write it below the outcome that it describes: `blocked: {failure: true}`"),
    ],
)  # fmt: skip
def test_an_interface_with_one_slip(part: str, text: str, marked: str, help: str) -> None:
    interface = INTERFACE.replace(part, text).replace("VARIABLES", "").replace("KEYS", "")
    interface = interface.replace("OUTCOMES", "moved: {}, blocked: {}")
    main = """\
name: sm
outcomes: [done, stuck]
states:
  - MOVE: {template: Move, transitions: {moved: done, blocked: stuck}}
"""
    found = reported({"main.yml": main, "templates/Move.yml": interface})
    slips = [item for item in found if item[0] in ("SM003", "SM004")]
    assert [(item[1], item[2]) for item in slips] == [(marked, help)]
    assert {item[0] for item in found} <= {"SM003", "SM004", "SM301", "SM005"}


def test_a_param_that_the_sub_script_has_under_another_name() -> None:
    pick = """\
- PICK:
    template: StateMachine
    outcomes: [succeeded]
    params: {force: 1.0}
    states:
      - REST: {template: SleepState, time: [params, force], transitions: {succeeded: succeeded}}
"""
    main = """\
name: sm
outcomes: [succeeded]
states:
  - A: {script: pick, params: {grip_force: 2.0}, transitions: {succeeded: succeeded}}
"""
    found = reported({"main.yml": main, "pick.yml": pick})
    assert ("SM306", "grip_force", "write `force`, the param that is used here") in found


def test_an_input_that_nothing_reads_is_meant() -> None:
    text = """\
name: sm
outcomes: [done, failed]
userdata: {light_bin: [[0.4, 0.3, 0.1], [0.0, 0.0, 0.0, 1.0]]}
states:
  - SORT:
      template: StateMachine
      outcomes: [done]
      input_keys: [light_bin]
      transitions: {done: done}
      states:
        - PUT: {template: ScriptedState, input_keys: [bin], outcomes: [ok], transitions: {ok: done}}
"""
    ((code, place, help),) = printed({"main.yml": text.replace(", failed", "")})
    assert (code, place) == ("SM301", "bin")
    assert help.startswith("did you mean `light_bin`?")
    other = reported({"main.yml": text.replace(", failed", "").replace("light_bin", "speed")})
    assert {item[0] for item in other} == {"SM301", "SM306"}


WATCHED = """\
name: sm
outcomes: [done, failed]
states:
  - CUT:
      template: Concurrence
      outcomes: [cut, fault]
      default_outcome: fault
      outcome_map: {RULES}
      transitions: {cut: done, fault: failed}
      states:
        - MILL: {template: ScriptedState, outcomes: [finished, preempted]}
        - WATCH: {template: Watch}
"""
WATCH = "outcomes: {overload: {failure: true}, preempted: {}}\nblocking: true\n"


@pytest.mark.parametrize(
    ("rules", "expected"),
    [
        ("cut: {MILL: finished, WATCH: preempted}", ["SM407"]),
        ("fault: {MILL: finished, WATCH: preempted}, cut: {MILL: finished}", []),
        ("cut: {MILL: preempted, WATCH: preempted}", []),
    ],
)
def test_a_rule_for_a_branch_that_nothing_preempts(rules: str, expected: list[str]) -> None:
    files = {"main.yml": WATCHED.replace("RULES", rules), "templates/Watch.yml": WATCH}
    assert [item[0] for item in reported(files) if item[0] == "SM407"] == expected


def test_a_wait_of_a_given_time_ends_by_itself() -> None:
    main = WATCHED.replace("RULES", "cut: {MILL: finished}, fault: {WATCH: succeeded}")
    main = main.replace("{template: Watch}", "{template: SleepState, time: 2}")
    codes = [item[0] for item in reported({"main.yml": main})]
    assert "SM402" in codes
    assert "SM407" not in codes


@pytest.mark.parametrize(
    ("value", "found"),
    [
        ("{name: press, x: 2,5, y: 1.5}", [("SM004", "2,5", "write `2.5`")]),
        ("[{name: press, x: 0.5, y: -1,0}]", [("SM004", "-1,0", "write `-1.0`")]),
        ("{2: 0, 5: 1}", []),
        ("{x: 2, y}", []),
        ("[2,5]", []),
    ],
)
def test_a_decimal_comma_in_a_mapping(value: str, found: list[tuple[str, str, str]]) -> None:
    text = f"""\
name: sm
outcomes: [done]
userdata: {{spot: {value}}}
states:
  - SHOW: {{template: PrintUserdataState, input_keys: [spot], transitions: {{succeeded: done}}}}
"""
    assert reported({"main.yml": text}) == found


def test_a_copied_state_that_was_not_renamed() -> None:
    text = """\
name: sm
outcomes: [done]
states:
  - DROP_LEFT: {template: ScriptedState, outcomes: [ok], transitions: {ok: DROP_RIGHT}}
  - DROP_LEFT: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}
"""
    help = "rename one of the two to `DROP_RIGHT`, to which transitions lead"
    assert reported({"main.yml": text}) == [("SM106", "DROP_LEFT", help)]
    misspelt = text.replace("DROP_RIGHT", "DROP_LEFTT")
    assert {code for code, *_ in reported({"main.yml": misspelt})} == {"SM101", "SM106"}


def test_a_remapping_the_wrong_way_round_is_one_finding() -> None:
    text = """\
name: sm
outcomes: [done]
userdata: {a: 1, b: 2}
states:
  - SHOW:
      template: ScriptedState
      input_keys: [x, y]
      outcomes: [ok]
      remapping: {a: x, b: y}
      transitions: {ok: done}
"""
    found = [item for item in reported({"main.yml": text}) if item[0] == "SM302"]
    help = 'the key of the state comes first: write `{x: a, "y": b}`'
    assert found == [("SM302", "a", help)]


def test_a_failure_of_another_name_in_a_rule() -> None:
    main = PATROL.replace(RULE, "outcome_map: {ready: {LIGHT: done, DRIVE: failed}}")
    main = main.replace("lost", "aborted")
    found = [item for item in reported({"main.yml": main}) if item[0] == "SM403"]
    assert found == [("SM403", "failed", "did you mean `aborted`?")]


def test_a_param_that_all_calls_give_under_another_name() -> None:
    main = """\
name: sm
outcomes: [done]
states:
  - ONE: {script: part, params: {what: 1.5}, transitions: {succeeded: TWO, preempted: done}}
  - TWO: {script: part, params: {what: 2.5}, transitions: {succeeded: done, preempted: done}}
"""
    part = "- PART: {template: SleepState, time: [params, object]}\n"
    found = reported({"main.yml": main, "part.yml": part})
    help = "write `object:` in place of `what:`, or add it"
    assert found == [("SM015", "what", help)]
    alone = main.replace("what: 2.5", "object: 2.5")
    assert reported({"main.yml": alone, "part.yml": part}) == [("SM015", "what", help)]
    assert slip(
        {"main.yml": main, "part.yml": part.replace("object", "what")}, "what]", "object]"
    ).is_restored
    right = {"main.yml": alone.replace("what", "object"), "part.yml": part}
    assert slip(right, "object: 1.5", "what: 1.5").is_restored


def test_a_param_of_one_call_with_the_name_of_a_param_of_an_inner_call() -> None:
    main = """\
name: sm
outcomes: [done]
states:
  - ONE: {script: part, params: {times: 1.5}, transitions: {succeeded: TWO, preempted: done}}
  - TWO: {script: part, params: {time: 2.5}, transitions: {succeeded: done, preempted: done}}
"""
    part = """\
- PART:
    template: StateMachine
    outcomes: [succeeded, preempted]
    states:
      - A: {template: SleepState, time: [params, times], transitions: {succeeded: B}}
      - B: {script: inner, params: {time: 3.0}}
"""
    inner = "- INNER: {template: SleepState, time: [params, time]}\n"
    files = {"main.yml": main, "part.yml": part, "inner.yml": inner}
    found = [item for item in reported(files) if item[0] == "SM015"]
    assert found == [("SM015", "time", "did you mean `times`?")]


ORDER = """\
name: sm
outcomes: [done]
states:
  - DOWN: {template: ScriptedState, outcomes: [ok], transitions: {ok: LIFT}}
  - CLOSE: {template: ScriptedState, outcomes: [ok], transitions: {ok: LIFT}}
  - LIFT: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}
"""


def test_a_state_past_which_the_state_before_leads() -> None:
    help = "write `ok: CLOSE` in `DOWN`, or remove `CLOSE` if its work is not needed"
    assert reported({"main.yml": ORDER}) == [("SM201", "CLOSE", help)]
    close = "CLOSE: {template: ScriptedState, outcomes: [ok], transitions: {ok: "
    other = ORDER.replace(f"{close}LIFT", f"{close}done")
    help = "add a transition to `CLOSE`, or remove `CLOSE`"
    assert reported({"main.yml": other}) == [("SM201", "CLOSE", help)]


JUDGE = """\
name: sm
outcomes: [done, failed]
userdata: {n: 0}
states:
  - JUDGE:
      template: ConditionalOutcomeState
      outcomes: [some, none_left]
      input_keys: [n]
      callbacks: {some: 'lambda ud: ud.n > 0'}
      default_outcome: none
      transitions: {some: done, none_left: failed}
"""


def test_a_misspelt_default_outcome_is_one_finding() -> None:
    found = reported({"main.yml": JUDGE})
    assert found == [("SM104", "none", "write `default_outcome: none_left`")]
    assert reported({"main.yml": JUDGE.replace("outcome: none", "outcome: none_left")}) == []


LOOK = """\
name: sm
outcomes: [done]
userdata: {rounds: 0}
states:
  - LOOK:
      template: ScriptedState
      outcomes: [ok]
      output_keys: {pose: Pose}
      steps: [{outcome: ok, set: {pose: [[0, 0, 0], [0, 0, 0, 1]]}}]
      transitions: {ok: GRASP}
  - GRASP:
      template: ScriptedState
      input_keys: [KEY, rounds]
      outcomes: [ok]
      transitions: {ok: done}
"""


@pytest.mark.parametrize(
    ("key", "help"),
    [
        (
            "found_pose",
            "write `remapping: {pose: found_pose}` in `LOOK`, whose `pose` nothing reads",
        ),
        ("target", None),
    ],
)
def test_an_output_that_nothing_reads(key: str, help: str | None) -> None:
    found = [item for item in reported({"main.yml": LOOK.replace("KEY", key)})
             if item[0] == "SM301"]  # fmt: skip
    assert len(found) == 1
    assert (found[0][2] == help) is (help is not None)


def test_a_key_that_a_loop_must_have_as_input() -> None:
    main = """\
name: sm
outcomes: [done]
userdata: {items: [1, 2], total: 0}
output_keys: [total]
states:
  - EACH:
      template: StateMachine
      outcomes: [ok]
      input_keys: [one]
      output_keys: [total]
      for_each: {item: one, in: items}
      transitions: {ok: done, preempted: done}
      states:
        - ADD:
            template: CallbacksState
            input_keys: [one, total]
            output_keys: [total]
            callbacks: {total: 'lambda ud: ud.total + ud.one'}
            transitions: {succeeded: ok}
"""
    found = [item for item in reported({"main.yml": main}) if item[0] in ("SM301", "SM303")]
    assert len(found) == 1
    assert "`input_keys: [one, total]` in `EACH`" in (found[0][2] or "")
