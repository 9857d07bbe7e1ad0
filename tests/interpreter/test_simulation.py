"""Runs whose steps are chosen one by one: where they stand, and the scenario of their choices."""

from __future__ import annotations

import random
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, seed, settings
from hypothesis import strategies as st

from smachac.diagnostics.source import Source
from smachac.driver import analyse_script
from smachac.frontend.text.data_files import plain
from smachac.frontend.text.yaml_tree import parse
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run
from smachac.interpreter.result import Event
from smachac.interpreter.scenario import (
    ScenarioStep,
    read_scenario,
    scenario_behaviour,
    scenario_text,
)
from smachac.interpreter.simulation import Choice, Position, chosen_scenario, simulate
from smachac.ir.nodes import Leaf, Machine
from smachac.ir.traversal import outcome_names, walk
from smachac.ir.written import written
from tests.strategies.full_machines import busy_machines
from tests.strategies.machines import valid_machines
from tests.support.examples import examples, seeds
from tests.support.sugared_scripts import random_script

SLOW = list(HealthCheck)

EXAMPLES = Path(__file__).parents[2] / "examples"

SCRIPT = """\
name: sm
outcomes: [done, lost, stopped]
userdata: {count: 1}
states:
  - BOTH:
      template: Concurrence
      outcomes: [ok, bad]
      default_outcome: bad
      outcome_map: {ok: {LEFT: ok, RIGHT: ok}}
      transitions: {ok: LIMITED, bad: lost}
      states:
        - LEFT: {template: ScriptedState, outcomes: [ok, bad], output_keys: [place]}
        - RIGHT: {template: ScriptedState, outcomes: [ok, bad]}
  - LIMITED:
      template: ScriptedState
      outcomes: [ok, bad]
      timeout: 5 min
      retry: {on: [bad], max: 3, delay: 10 s}
      transitions: {ok: TEST, exhausted: lost, timeout: lost, preempted: stopped}
  - TEST:
      template: ConditionalOutcomeState
      input_keys: [count]
      outcomes: [yes, no]
      callbacks: {"yes": "lambda ud: ud.count > 0"}
      default_outcome: "no"
      transitions: {"yes": done, "no": lost}
"""


def machine_of(text: str) -> Machine:
    machine = analyse_script(Source("sm.yml", text)).machine
    assert machine is not None
    return machine


def automatic(machine: Machine) -> set[str]:
    parts = written(machine).parts.values()
    return {part.full for part in parts if part.role in ("timer", "pause")}


def position(machine: Machine, choices: list[Choice]) -> Position:
    found = simulate(machine, choices, automatic(machine))
    assert found.performed == len(choices)
    return found


def replayed(machine: Machine, choices: list[Choice], schedule: tuple[str, ...]) -> list[Event]:
    """The trace of the scenario of the choices, written to a file and read again."""
    text = scenario_text(chosen_scenario(choices).steps)
    tree = parse(Source("scenario.yml", text), [])
    assert tree is not None
    scenario, problems = read_scenario(plain(tree), machine)
    assert problems == []
    events: list[Event] = []
    behaviour = scenario_behaviour(scenario, machine, builtin_behaviour())
    run(machine, behaviour, events.append, schedule=schedule)
    return events


def ends(outcome: str) -> ScenarioStep:
    return ScenarioStep(outcome=outcome)


def test_branches_wait_together_and_go_on_in_any_order() -> None:
    machine = machine_of(SCRIPT)
    left, right = "sm/BOTH/LEFT", "sm/BOTH/RIGHT"
    assert position(machine, []).waiting == (left, right)
    for first, second in ((left, right), (right, left)):
        here = position(machine, [Choice(first, ends("ok"))])
        assert here.waiting == (second,)
        choices = [Choice(first, ends("ok")), Choice(second, ends("ok"))]
        (limited,) = position(machine, choices).waiting
        assert written(machine).state(limited) == "sm/LIMITED"


def test_time_passes_only_where_a_state_waits() -> None:
    machine = machine_of(SCRIPT)
    both = [Choice("sm/BOTH/LEFT", ends("ok")), Choice("sm/BOTH/RIGHT", ends("ok"))]
    (limited,) = position(machine, both).waiting
    again = position(machine, [*both, Choice(limited, ends("bad"))])
    assert (again.waiting, again.time) == ((limited,), 10.0)  # the pause before the second try
    late = position(machine, [*both, Choice(limited, ScenarioStep(wait=True))])
    assert late.result is not None
    assert (late.result.outcome, late.time) == ("lost", 300.0)
    slow = position(machine, [*both, Choice(limited, ScenarioStep(outcome="ok", after=299.0))])
    assert (slow.waiting, slow.time) == (("sm/TEST",), 299.0)


def test_own_code_stops_and_errors() -> None:
    machine = machine_of(SCRIPT)
    both = [Choice("sm/BOTH/LEFT", ends("ok")), Choice("sm/BOTH/RIGHT", ends("ok"))]
    (limited,) = position(machine, both).waiting
    stopped = position(machine, [*both, Choice(limited, ScenarioStep(stop=True))])
    assert stopped.result is not None
    assert stopped.result.outcome == "stopped"
    test = [*both, Choice(limited, ends("ok")), Choice("sm/TEST", ScenarioStep(run=True))]
    result = position(machine, test).result
    assert result is not None
    assert result.outcome == "done"
    failed = position(machine, [Choice("sm/BOTH/LEFT", ScenarioStep(error="no camera"))])
    assert failed.stopped == {"sm/BOTH/RIGHT"}
    assert failed.waiting == ("sm/BOTH/RIGHT",)
    result = position(
        machine, [Choice("sm/BOTH/LEFT", ScenarioStep(error="no camera")), both[1]]
    ).result
    assert result is not None
    assert str(result.error) == "sm/BOTH/LEFT: no camera"


def test_a_choice_that_does_not_fit_ends_the_run() -> None:
    machine = machine_of(SCRIPT)
    left = Choice("sm/BOTH/LEFT", ends("ok"))
    for wrong in (
        Choice("sm/TEST", ends("yes")),
        Choice("sm/BOTH/RIGHT", ends("open")),
        Choice("sm/BOTH/RIGHT", ScenarioStep(outcome="ok", writes=(("place", 1),))),
        Choice("sm/GONE", ends("ok")),
    ):
        found = simulate(machine, [left, wrong, left], automatic(machine))
        assert (found.performed, found.waiting) == (1, ("sm/BOTH/RIGHT",))


def test_the_last_steps_are_written_once() -> None:
    held, own = ends("ok"), ScenarioStep(run=True)
    choices = [Choice("a", held), Choice("b", own), Choice("a", held), Choice("b", own)]
    assert chosen_scenario(choices).steps == {"a": (held,)}
    mixed = [Choice("b", own), Choice("b", held), Choice("b", held)]
    assert chosen_scenario(mixed).steps == {"b": (own, held)}


def random_walk(machine: Machine, chance: random.Random, most: int) -> list[Choice]:
    """Choices at random until the machine ends, at most so many."""
    leaves = {path: node for path, node in walk(machine.root) if isinstance(node, Leaf)}
    choices: list[Choice] = []
    here = position(machine, choices)
    while here.result is None and len(choices) < most:
        path = chance.choice(here.waiting)
        keys = [key.name for key in leaves[path].outputs]
        step = ScenarioStep(
            outcome=chance.choice(outcome_names(leaves[path])),
            writes=tuple((key, chance.choice(VALUES)) for key in keys),
            stop=chance.random() < 0.05,
            after=chance.choice([0.0, 0.0, 0.25, 70.0]),
        )
        others = [
            ScenarioStep(run=True),
            ScenarioStep(error="broken: # 'x'", stop=chance.random() < 0.2),
            ScenarioStep(wait=True, outcome=step.outcome),
        ]
        choices.append(Choice(path, step if chance.random() < 0.85 else chance.choice(others)))
        here = position(machine, choices)
    return choices


VALUES = (
    0.1,
    1e22,
    float("inf"),
    [1, [2.5]],
    {"a": {"b": None}},
    "yes",
    "12",
    "\N{GREEK SMALL LETTER PI}: #",
    "",
    True,
    -3,
)


@pytest.mark.parametrize("number", seeds(20, 60, 300))
def test_the_scenario_of_choices_gives_the_same_trace(number: int) -> None:
    machine = random_script(number).machine()
    choices = random_walk(machine, random.Random(number), 60)
    here = position(machine, choices)
    if here.result is not None:
        assert replayed(machine, choices, here.schedule) == list(here.events)


@pytest.mark.parametrize(
    "name", ["03_concurrence", "07_iterator", "13_recovery", "14_delivery_round"]
)
def test_the_scenario_of_an_example_gives_the_same_trace(name: str) -> None:
    machine = analyse_script(EXAMPLES / name / "main.yml").machine
    assert machine is not None
    ended = 0
    for number in range(6):
        choices = random_walk(machine, random.Random(number), 80)
        here = position(machine, choices)
        if here.result is not None:
            ended += 1
            assert replayed(machine, choices, here.schedule) == list(here.events)
    assert ended


@seed(0)
@settings(max_examples=examples(200), database=None, deadline=None, suppress_health_check=SLOW)
@given(st.one_of(valid_machines(), busy_machines().map(lambda drawn: drawn[0])), st.randoms())
def test_the_scenario_of_any_machine_gives_the_same_trace(
    machine: Machine, chance: random.Random
) -> None:
    choices = random_walk(machine, chance, 40)
    here = position(machine, choices)
    assert position(machine, choices) == here
    if here.result is not None:
        assert replayed(machine, choices, here.schedule) == list(here.events)
    for count in range(len(choices)):
        before = simulate(machine, choices[:count], automatic(machine))
        assert list(before.events) == list(here.events[: len(before.events)])
        assert choices[count].path in before.waiting
