"""Turns of the branches of concurrences: by a schedule, and every order there is."""

from __future__ import annotations

from itertools import islice
from math import comb
from pathlib import Path
from typing import Any

import pytest

from smachac.commands.cli import main
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.explore import explore
from smachac.interpreter.interpreter import run
from smachac.interpreter.result import Event
from smachac.interpreter.scheduler import ScheduleError
from smachac.ir.nodes import Machine, StateMachine
from tests.support.ir_machines import acting, concurrence, leaf, machine, ran


def row(name: str, length: int) -> StateMachine:
    """A machine of leaves that follow one another."""
    names = [f"{name}{number}" for number in range(length)]
    follow = [*names[1:], "x"]
    children = [
        leaf(here, {"x": to}, outs="seen", ins="seen")
        for here, to in zip(names, follow, strict=True)
    ]
    return machine(name, "x", *children, ins="seen")


def beside(*children: Any) -> StateMachine:
    names = {child.name: child for child in children}
    held: dict[str, Any] = {"seen": []}
    inner = concurrence("C", "x", *names.values(), default="x", to={"x": "x"}, ins="seen")
    return machine("sm", "x", inner, held=held)


def notes(userdata: Any) -> str:
    """A leaf that notes its turn."""
    userdata["seen"].append(userdata._path.rpartition("/")[2])
    return "x"


def orders_of(root: StateMachine) -> list[str]:
    names = {f"{name}{number}": notes for name in "ABC" for number in range(4)}
    found = explore(Machine(root=root), lambda: acting(names))
    return [" ".join(result.userdata["seen"]) for result in found]  # type: ignore[arg-type]


@pytest.mark.parametrize(("left", "right"), [(1, 1), (2, 1), (3, 2), (4, 4)])
def test_two_branches_have_every_order_once(left: int, right: int) -> None:
    orders = orders_of(beside(row("A", left), row("B", right)))
    assert len(orders) == len(set(orders)) == comb(left + right, left)


def test_three_branches_have_every_order_once() -> None:
    orders = orders_of(beside(row("A", 2), row("B", 1), row("C", 1)))
    assert len(orders) == len(set(orders)) == 12


def test_without_concurrences_there_is_one_order() -> None:
    assert len(orders_of(machine("sm", "x", row("A", 3), held={"seen": []}))) == 1


def test_the_choices_of_a_run_are_a_schedule_that_repeats_it() -> None:
    root = beside(row("A", 3), row("B", 3))
    seen = set()
    for seed in range(10):
        result, events = ran(root, seed=seed)
        turns = [choice.taken for choice in result.choices]
        seen.add(tuple(turns))
        assert ran(root, schedule=turns)[1] == events
    assert len(seen) > 5


def test_what_a_schedule_leaves_open_goes_to_the_first_branch() -> None:
    root = beside(row("A", 2), row("B", 2))
    result, _ = ran(root, schedule=["B"])
    assert [choice.taken for choice in result.choices] == ["sm/C/B", "sm/C/A", "sm/C/A"]


def test_a_turn_of_a_branch_that_cannot_go_on_is_refused() -> None:
    with pytest.raises(ScheduleError, match="turn 2 is `D`, but `A`, `B` can go on"):
        ran(beside(row("A", 2), row("B", 2)), schedule=["A", "D"])


RACE = """
name: sm
template: Base
outcomes: [left, right]
states:
  - BOTH:
      template: Concurrence
      outcomes: [left, right]
      default_outcome: left
      join: any
      outcome_map:
        left: {LEFT: x}
        right: {RIGHT: x}
      states:
        - LEFT: {template: ScriptedState, outcomes: [x, preempted]}
        - RIGHT: {template: ScriptedState, outcomes: [x, preempted]}
"""

TOLD = """\
2 orders of branches tried, all there are:
     1  outcome: left
        --schedule LEFT
     1  outcome: right
        --schedule RIGHT
a race: the result depends on which branch is first
"""


def files(tmp_path: Path, text: str) -> list[str]:
    (tmp_path / "main.yml").write_text(text, encoding="utf-8")
    (tmp_path / "plain.yml").write_text("states: {}", encoding="utf-8")
    return ["run", str(tmp_path / "main.yml"), "--mock", str(tmp_path / "plain.yml")]


def test_orders_tell_a_race(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = files(tmp_path, RACE)
    assert main([*arguments, "--orders", "10"]) == 1
    assert capsys.readouterr().out == TOLD


def test_orders_that_agree(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = files(tmp_path, RACE.replace("join: any", "join: all"))
    assert main([*arguments, "--orders", "1"]) == 0
    assert "1 order of branches tried, not all:" in capsys.readouterr().out
    assert main([*arguments, "--orders", "5"]) == 0
    assert "2 orders of branches tried, all there are:" in capsys.readouterr().out


def test_a_schedule_on_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = files(tmp_path, RACE.replace("join: any", "join: all"))
    assert main([*arguments, "--schedule", "RIGHT"]) == 0
    turns = capsys.readouterr().out
    assert turns.index("RIGHT  ") < turns.index("LEFT  ")
    assert main([*arguments, "--schedule", "UP"]) == 1
    assert "--schedule: turn 1 is `UP`, but `LEFT`, `RIGHT` can go on" in capsys.readouterr().err
    assert main([*arguments[:2], "--schedule", "UP"]) == 2


def test_exploring_is_lazy() -> None:
    orders = explore(Machine(root=beside(row("A", 4), row("B", 4))), lambda: acting({}))
    assert len(list(islice(orders, 3))) == 3


def test_a_turn_ends_with_the_end_of_a_nested_branch() -> None:
    """After the end of a branch in a nested concurrence every branch of the outer one can be
    next."""
    inner_leaves = (leaf("X", outcomes="x"), leaf("Y", outcomes="y"))
    inner = concurrence("IN", "done", *inner_leaves, default="done")
    outer = concurrence(
        "OUT", "done", inner, leaf("Z", outcomes="z"), default="done", to={"done": "done"}
    )
    root = machine("sm", "done", outer)
    order = {"X": 0, "Z": 1, "Y": 2}
    lines: list[str] = []

    def observe(event: Event) -> None:
        name = str(event["path"]).rpartition("/")[2]
        if event["event"] == "exit" and name in order:
            lines.append(name)

    run(Machine(root=root), builtin_behaviour(), observe, schedule=["IN", "X", "Z"])
    assert lines == ["X", "Z", "Y"]
