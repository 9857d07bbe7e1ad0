"""Scenarios: read from plain data, and scenario_behaviour out."""

from __future__ import annotations

from typing import Any

import pytest

import smachac
from smachac.diagnostics.source import Source
from smachac.driver import analyse_script
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run
from smachac.interpreter.scenario import (
    PlainStep,
    Scenario,
    ScenarioProblem,
    ScenarioStep,
    plain_steps_by_path,
    read_scenario,
    scenario_behaviour,
)
from smachac.ir.nodes import Machine
from smachac.sweep.play import FailedError, play, played_behaviour
from tests.support.ir_machines import concurrence, iterator, leaf, machine, ran, short


def picking() -> Machine:
    """Two containers that both hold a GRASP, a CHECK between them, and an iterator."""
    pick = machine(
        "PICK",
        "ok failed",
        leaf("GRASP", {"succeeded": "ok", "aborted": "failed"}, outs="width"),
        to={"ok": "CHECK", "failed": "PICK"},
        outs="width",
    )
    check = leaf("CHECK", {"true": "PLACE", "false": "PICK"})
    place = machine("PLACE", "ok", leaf("GRASP", {"succeeded": "ok"}), to={"ok": "EACH"})
    each = iterator("EACH", "exhausted", leaf("LOOK", outcomes="seen"), to={"exhausted": "done"})
    return Machine(root=machine("sm", "done", pick, check, place, each))


def read(states: Any) -> tuple[Scenario, list[str]]:
    scenario, problems = read_scenario({"states": states}, picking())
    return scenario, ["; ".join(filter(None, problem[:2])) for problem in problems]


def test_the_forms_of_a_scenario() -> None:
    scenario, problems = read(
        {
            "sm/PICK/GRASP": [
                {"outcome": "aborted"},
                {"outcome": "succeeded", "set": {"width": 1}},
            ],
            "CHECK": False,
            "PLACE/GRASP": ["succeeded"],
            "LOOK": {"set": {"anything": [1]}},
        }
    )
    assert problems == []
    assert scenario.steps == {
        "sm/PICK/GRASP": (
            ScenarioStep(outcome="aborted"),
            ScenarioStep(outcome="succeeded", writes=(("width", 1),)),
        ),
        "sm/CHECK": (ScenarioStep(outcome="false"),),
        "sm/PLACE/GRASP": (ScenarioStep(outcome="succeeded"),),
        "sm/EACH/LOOK": (ScenarioStep(writes=(("anything", [1]),)),),
    }


@pytest.mark.parametrize(
    ("states", "problem"),
    [
        ({"GRASP": "succeeded"}, "`GRASP` may be any of `sm/PICK/GRASP`, `sm/PLACE/GRASP`"),
        ({"PICK": "ok"}, "`PICK` is a container: it ends as its states make it end"),
        ({"CHEKC": True}, "there is no state `CHEKC`; did you mean `CHECK`?"),
        (
            {"sm/PICK/GRAPS": "x"},
            "there is no state `sm/PICK/GRAPS`; did you mean `sm/PICK/GRASP`?",
        ),
        (
            {"PICK/GRASP": "suceeded"},
            "sm/PICK/GRASP, step 1: `suceeded` is not one of its outcomes; did you mean"
            " `succeeded`?",
        ),
        (
            {"PICK/GRASP": ["aborted", {"outcome": "succeeded", "set": {"widht": 1}}]},
            "sm/PICK/GRASP, step 2: `widht` is not one of its output keys; did you mean `width`?",
        ),
        (
            {"CHECK": {"outcom": "true"}},
            "sm/CHECK, step 1: unknown key `outcom`; did you mean `outcome`?",
        ),
        (
            {"CHECK": 3},
            "sm/CHECK, step 1: a step is an outcome, or a mapping with `outcome` and `set`",
        ),
        ({"CHECK": {"set": 3}}, "sm/CHECK, step 1: `set` is a mapping of userdata keys to values"),
        ({"CHECK": {"wait": 1}}, "sm/CHECK, step 1: `wait` is true or false"),
        ({"CHECK": {"stop": "yes"}}, "sm/CHECK, step 1: `stop` is true or false"),
        ({"CHECK": []}, "`CHECK` has no steps; write `CHECK: [true]`, or remove it"),
        (
            {"CHECK": True, "sm/CHECK": True},
            "`CHECK` and `sm/CHECK` are the same state; write all its steps in one list",
        ),
    ],
)
def test_what_is_wrong_is_told(states: Any, problem: str) -> None:
    (found,) = read(states)[1]
    assert found.startswith(problem)


@pytest.mark.parametrize("given", [None, [], {"states": []}, {"other": {}}])
def test_a_scenario_is_a_mapping_of_states(given: Any) -> None:
    scenario, problems = read_scenario(given, picking())
    assert scenario.steps == {}
    assert problems == [
        ScenarioProblem(
            "a scenario is a mapping with `states`: a mapping of paths",
            "write `states: {GRASP: [succeeded]}`",
        )
    ]


def test_a_misspelt_key_is_named() -> None:
    assert read_scenario({"statez": {"CHECK": True}}, picking())[1] == [
        ScenarioProblem(
            "a scenario is a mapping with `states`: a mapping of paths", "did you mean `states`?"
        )
    ]


def test_other_keys_beside_states_are_told() -> None:
    assert read_scenario({"states": {}, "state": {}}, picking())[1] == [
        ScenarioProblem("unknown key `state`; a scenario has `states` and `fill`", "remove `state`")
    ]


def test_a_problem_names_its_key_and_step() -> None:
    states = {"PICK/GRASP": ["aborted", "lost"], "CHEKC": True, "sm/CHECK": []}
    _, problems = read_scenario({"states": states}, picking())
    assert [problem[2:] for problem in problems] == [
        ("PICK/GRASP", 2),
        ("CHEKC", None),
        ("sm/CHECK", None),
    ]


def test_a_scenario_is_acted_out_and_the_rest_acts_itself() -> None:
    scenario = Scenario(
        steps={
            "PICK/GRASP": (
                ScenarioStep(outcome="aborted"),
                ScenarioStep(outcome="succeeded", writes=(("width", [5]),)),
            ),
            "CHECK": (ScenarioStep(outcome="false"), ScenarioStep(outcome="true")),
        }
    )
    given = picking()
    result, events = ran(given.root, scenario_behaviour(scenario, given, builtin_behaviour()))
    assert [line for line in short(events) if "exit" in line and line.count("/") > 1] == [
        "exit sm/PICK/GRASP aborted",
        "exit sm/PICK/GRASP succeeded",
        "exit sm/PICK/GRASP succeeded",
        "exit sm/PLACE/GRASP succeeded",
    ]
    assert short(events).count("write sm/PICK/GRASP width [5]") == 2
    assert result.userdata == {"width": [5]}


def stoppable() -> Machine:
    """A race between a leaf that can be stopped and one that ends, and a leaf behind it."""
    slow = leaf("SLOW", outcomes="done preempted")
    race = concurrence(
        "RACE",
        "won over",
        slow,
        leaf("FAST", outcomes="done"),
        default="over",
        rules=(("won", {"SLOW": "preempted"}),),
        join="any",
        to={"won": "LAST", "over": "over"},
    )
    last = leaf("LAST", {"done": "done", "preempted": "stopped"})
    return Machine(root=machine("sm", "done over stopped", race, last))


@pytest.mark.parametrize(
    ("states", "outcome"),
    [
        ({"SLOW": {"wait": True}}, "done"),
        ({"SLOW": "done", "FAST": {"wait": True}}, "over"),
        ({"SLOW": {"wait": True}, "LAST": {"stop": True}}, "stopped"),
        ({"SLOW": {"wait": True}, "LAST": {"error": "no power"}}, None),
    ],
)
def test_steps_that_wait_stop_the_machine_or_fail(states: Any, outcome: str | None) -> None:
    given = stoppable()
    scenario, problems = read_scenario({"states": states}, given)
    assert problems == []
    result, _ = ran(given.root, scenario_behaviour(scenario, given, builtin_behaviour()))
    assert result.outcome == outcome
    told = result.error.message if result.error is not None else None
    assert told == (None if outcome else "no power")


def test_a_step_without_outcome_ends_as_usual() -> None:
    given = picking()
    scenario = Scenario(steps={"sm/PICK/GRASP": (ScenarioStep(writes=(("width", 1),)),)})
    result, _ = ran(
        given.root, scenario_behaviour(scenario, given, builtin_behaviour()), max_steps=4
    )
    assert result.scopes["sm/PICK"] == {"width": 1}


def test_a_scenario_as_plain_rows() -> None:
    scenario = Scenario(
        steps={
            "PICK/GRASP": (ScenarioStep(writes=(("width", 5),)), ScenarioStep(outcome="aborted")),
            "CHECK": (),
        }
    )
    assert plain_steps_by_path(scenario, picking()) == {
        "sm/PICK/GRASP": [
            PlainStep("succeeded", {"width": 5}, False, "", False),
            PlainStep("aborted", {}, False, "", False),
        ],
        "sm/CHECK": [],
    }


def test_a_scenario_for_no_leaf_is_refused() -> None:
    scenario = Scenario(steps={"GRASP": (ScenarioStep(outcome="x"),)})
    with pytest.raises(ValueError, match="may be any of"):
        scenario_behaviour(scenario, picking(), builtin_behaviour())


SUGAR = """\
name: sm
template: Base
outcomes: [done, failed]
states:
  - LEG:
      template: StateMachine
      outcomes: [done, failed]
      transitions: {done: done, failed: failed}
      states:
        - DRIVE:
            template: ScriptedState
            outcomes: [there, stuck, preempted]
            timeout: 5
            retry: {max: 2, on: [stuck]}
            transitions: {there: done, preempted: failed, timeout: failed,
                          exhausted: failed}
"""


DRIVE = "sm/LEG/DRIVE/TIMED/DRIVE"
TIMER = "sm/LEG/DRIVE/TIMED/TIMER"


@pytest.mark.parametrize(
    ("path", "leaf"),
    [
        *((name, DRIVE) for name in ("DRIVE", "LEG/DRIVE", "sm/LEG/DRIVE", "TIMED/DRIVE", DRIVE)),
        *((name, TIMER) for name in ("TIMER", "DRIVE (timeout)/TIMER", "DRIVE/TIMER", TIMER)),
    ],
)
def test_a_state_with_sugar_has_the_path_that_the_script_shows(path: str, leaf: str) -> None:
    loaded = smachac.load(SUGAR, name="main.yml")
    outcome = "there" if leaf == DRIVE else "succeeded"
    scenario, found = read_scenario({"states": {path: outcome}}, loaded)
    assert not found
    assert list(scenario.steps) == [leaf]
    assert read_scenario({"states": {"LEG/DRIV": "there"}}, loaded)[1]


@pytest.mark.parametrize(
    ("states", "message"),
    [
        (
            {"DRIVE": "there", "sm/LEG/DRIVE/TIMED/DRIVE": "there"},
            "`DRIVE` and `sm/LEG/DRIVE/TIMED/DRIVE` are the same state",
        ),
        ({"DRIVE": "lost"}, "sm/LEG/DRIVE, step 1: `lost` is not one"),
        ({"DRIVE (retry)": "there"}, "`DRIVE (retry)` is a container"),
        ({"sm/LEG/DRIVES": "there"}, "did you mean `sm/LEG/DRIVE`?"),
    ],
)
def test_problems_of_a_scenario_show_the_path_of_the_script(
    states: dict[str, str], message: str
) -> None:
    _, found = read_scenario({"states": states}, smachac.load(SUGAR, name="main.yml"))
    assert any(message in f"{item.message}; {item.help}" for item in found), found


def test_an_outcome_is_drawn_from_its_probabilities() -> None:
    given = picking()
    scenario, problems = read(
        {"PICK/GRASP": {"outcome": {"succeeded": 0.7, "aborted": 0.3}}, "CHECK": True}
    )
    assert problems == []
    assert scenario.steps["sm/PICK/GRASP"] == (
        ScenarioStep(chances=(("succeeded", 0.7), ("aborted", 0.3))),
    )

    def tries(seed: int) -> int:
        _, events = ran(given.root, scenario_behaviour(scenario, given, builtin_behaviour(), seed))
        return sum(e["event"] == "exit" and e["path"] == "sm/PICK/GRASP" for e in events)

    counts = [tries(seed) for seed in range(300)]
    assert counts == [tries(seed) for seed in range(300)]
    first = counts.count(1) / 300
    assert 0.62 < first < 0.78
    assert max(counts) > 2


@pytest.mark.parametrize(
    ("chances", "problem"),
    [
        ({"succeeded": 0.7, "abortd": 0.3}, "`abortd` is not one of its outcomes; did you mean"),
        ({"succeeded": 0.7}, "the probabilities of its outcomes add up to 0.7, not to 1"),
        ({"succeeded": 70, "aborted": 30}, "`succeeded` is a number from 0 to 1"),
        ({"succeeded": True}, "`succeeded` is a number from 0 to 1"),
        ({}, "add up to 0, not to 1"),
    ],
)
def test_wrong_probabilities(chances: Any, problem: str) -> None:
    (found,) = read({"PICK/GRASP": {"outcome": chances}})[1]
    assert problem in found


def test_a_wait_ends_with_the_request_also_without_the_outcome_preempted() -> None:
    """`FAST` has no `preempted`: it ends with the outcome of its step when `SLOW` ends."""
    given = stoppable()
    scenario, problems = read_scenario({"states": {"SLOW": "done", "FAST": {"wait": True}}}, given)
    assert problems == []
    result, events = ran(given.root, scenario_behaviour(scenario, given, builtin_behaviour()))
    assert "exit sm/RACE/FAST done" in short(events)
    assert result.time == 0


STEPS = """\
name: sm
outcomes: [done, lost, stopped]
userdata: {count: 1}
states:
  - LOOK:
      template: ScriptedState
      outcomes: [found, nothing]
      output_keys: [place, label]
      transitions: {found: TEST, nothing: lost}
  - TEST:
      template: ConditionalOutcomeState
      input_keys: [count]
      outcomes: ["yes", "no"]
      callbacks: {"yes": "lambda ud: ud.count > 0"}
      default_outcome: "no"
      transitions: {"yes": LIMITED, "no": lost}
  - LIMITED:
      template: ScriptedState
      outcomes: [ok]
      timeout: 30 s
      transitions: {ok: done, timeout: lost, preempted: stopped}
"""


def played(data: Any) -> tuple[str | None, float, list[tuple[str, object]]]:
    """The outcome and the time of a run with a scenario, and what was written."""
    machine = analyse_script(Source("main.yml", STEPS)).machine
    assert machine is not None
    scenario, problems = read_scenario(data, machine)
    assert problems == []
    events: list[Any] = []
    result = run(machine, played_behaviour(machine, scenario, 0), events.append)
    written = [(event["key"], event["value"]) for event in events if event["event"] == "write"]
    return result.outcome, result.time, written


@pytest.mark.parametrize(
    ("after", "outcome", "time"),
    [("20 s", "done", 20.0), (29.5, "done", 29.5), ("40 s", "lost", 40.0), ("1 h", "lost", 3600.0)],
)
def test_a_step_takes_time(after: object, outcome: str, time: float) -> None:
    assert played({"states": {"LIMITED": {"outcome": "ok", "after": after}}})[:2] == (outcome, time)


@pytest.mark.parametrize("after", ["soon", -1, True, "5 parsec", None, [3]])
def test_what_is_no_time(after: object) -> None:
    _, problems = read({"CHECK": {"after": after}})
    assert problems == ["sm/CHECK, step 1: `after` is a time, such as `30 s`, `5 min` or `2 h`"]


def test_a_step_can_be_the_own_code_of_the_state() -> None:
    assert played({"states": {"TEST": [{"run": True}]}})[0] == "done"
    assert played({"states": {"TEST": ["no"]}})[0] == "lost"
    _, problems = read({"CHECK": {"run": True, "outcome": True}})
    assert problems == ["sm/CHECK, step 1: a step with `run` has no `outcome`"]


@pytest.mark.parametrize(
    ("states", "outcome", "written"),
    [
        ({}, "done", ["label", "place"]),
        ({"LOOK": "found"}, "done", ["label", "place"]),
        ({"LOOK": {"set": {"place": 7}}}, "done", ["label", "place"]),
        ({"LOOK": {"error": "no camera"}}, None, []),
    ],
)
def test_keys_are_filled_by_their_types(
    states: object, outcome: str | None, written: list[str]
) -> None:
    found = played({"fill": True, "states": states})
    assert found[0] == outcome
    assert sorted(key for key, _ in found[2]) == written
    assert ("place", 7) in found[2] or "LOOK" not in str(states) or "set" not in str(states)
    assert played({"states": states})[2] == [pair for pair in found[2] if pair == ("place", 7)]


def test_what_is_no_fill() -> None:
    _, problems = read_scenario({"fill": "yes", "states": {}}, picking())
    assert problems == [ScenarioProblem("`fill` is true or false", "write `fill: true`")]


READS = """\
name: sm
outcomes: [done]
states:
  - LOOK: {template: ScriptedState, outcomes: [ok], output_keys: [place], transitions: {ok: GO}}
  - GO:
      template: ConditionalOutcomeState
      input_keys: [place]
      outcomes: [far]
      callbacks: {far: "lambda ud: len(ud.place) > 1"}
      default_outcome: far
      transitions: {far: done}
"""


def test_the_help_for_a_key_that_nothing_has_written() -> None:
    machine = analyse_script(Source("main.yml", READS)).machine
    assert machine is not None
    with pytest.raises(FailedError) as caught:
        play(machine, Scenario(steps={}), 0, None, lambda event: None)
    message, place, help_ = str(caught.value).splitlines()
    assert message == "sm/GO: reads `place`, which holds nothing"
    assert place.startswith("  --> main.yml:5")
    assert help_ == "help: write it with `set` in an earlier step, or `fill: true` in the scenario"
    assert play(machine, Scenario(steps={}, fill=True), 0, None, lambda event: None) == "done"
