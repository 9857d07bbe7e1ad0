"""SMACH machines on the simulated clock: the same run whatever the threads do, and no hang."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from smachac import sim
from smachac.runtime import smach
from smachac.sim import smach_bridge
from smachac.sim.clock import Clock, Skill

OUTCOMES = ["succeeded", "aborted", "preempted"]


class Waits(smach.State):
    """Lets steps pass on a clock and writes (step, name) when it begins and ends."""

    def __init__(self, bench: Bench, name: str, count: int, fails: bool = False) -> None:
        super().__init__(outcomes=OUTCOMES)
        self.bench, self.name, self.count, self.fails = bench, name, count, fails

    def execute(self, userdata: Any) -> str:
        bench = self.bench
        bench.log.append((bench.steps, f"{self.name} begins"))
        outcome: str = bench.clock.run(self.passing())
        bench.log.append((bench.steps, f"{self.name} {outcome}"))
        if self.fails:
            raise RuntimeError(f"{self.name} is broken")
        return outcome

    def passing(self) -> Skill[str]:
        for _ in range(self.count):
            if self.preempt_requested():
                self.service_preempt()
                return "preempted"
            yield
        return "succeeded"


class Bench:
    """A clock that counts, with what was shown and logged."""

    def __init__(self) -> None:
        self.steps = 0
        self.log: list[tuple[int, str]] = []
        self.shown: list[tuple[str, ...]] = []
        self.lost: list[Any] = []
        self.clock = Clock(self.step, patience=60.0, left_behind=self.lost.append)

    def step(self) -> None:
        self.steps += 1

    def state(self, name: str, count: int, fails: bool = False) -> Waits:
        return Waits(self, name, count, fails)

    def run(self, machine: Any) -> str | None:
        show = lambda paths, began: self.shown.append(paths)  # noqa: E731
        smach_bridge.attach(machine, self.clock, show, "sm")
        outcome: str | None = machine.execute()
        assert self.lost == []
        return outcome


def both(*states: tuple[str, Any], any_ends: bool = False) -> Any:
    """A Concurrence of these states."""
    container = smach.Concurrence(
        outcomes=OUTCOMES,
        default_outcome="succeeded",
        child_termination_cb=(lambda outcomes: True) if any_ends else None,
    )
    with container:
        for label, state in states:
            smach.Concurrence.add(label, state)
    return container


def chain(*states: tuple[str, Any]) -> Any:
    """A Sequence of these states."""
    container = smach.Sequence(outcomes=OUTCOMES, connector_outcome="succeeded")
    with container:
        for label, state in states:
            smach.Sequence.add(label, state)
    return container


def repeated(run: Callable[[], Bench]) -> Bench:
    """The bench after one run; four more have to give the same log."""
    first = run()
    assert all(run().log == first.log for _ in range(4))
    return first


def test_branches_run_in_lockstep_and_the_root_goes_on_after() -> None:
    def run() -> Bench:
        bench = Bench()
        fork = both(
            ("A", chain(("A1", bench.state("a1", 3)), ("A2", bench.state("a2", 4)))),
            ("B", bench.state("b", 5)),
        )
        machine = chain(("FIRST", bench.state("f", 2)), ("BOTH", fork), ("L", bench.state("l", 1)))
        assert bench.run(machine) == "succeeded"
        return bench

    bench = repeated(run)
    assert bench.steps == 2 + 7 + 1
    assert bench.log[2:] == [
        (2, "a1 begins"),
        (2, "b begins"),
        (5, "a1 succeeded"),
        (5, "a2 begins"),
        (7, "b succeeded"),
        (9, "a2 succeeded"),
        (9, "l begins"),
        (10, "l succeeded"),
    ]


def test_the_first_to_end_stops_the_others_at_a_fixed_step() -> None:
    def run() -> Bench:
        bench = Bench()
        bench.run(
            both(
                ("SHORT", bench.state("short", 3)),
                ("LONG", bench.state("long", 1000)),
                ("DEEP", chain(("IN", bench.state("in", 1000)))),
                any_ends=True,
            )
        )
        return bench

    bench = repeated(run)
    assert bench.log[3:] == [
        (3, "short succeeded"),
        (3, "long preempted"),
        (3, "in preempted"),
    ]


def test_nested_concurrences_keep_step() -> None:
    def run() -> Bench:
        bench = Bench()
        inner = both(("X", bench.state("x", 2)), ("Y", bench.state("y", 4)))
        bench.run(
            both(
                ("LEFT", chain(("INNER", inner), ("Z", bench.state("z", 3)))),
                ("RIGHT", bench.state("w", 6)),
            )
        )
        return bench

    bench = repeated(run)
    ends = [entry for entry in bench.log if entry[1].endswith("succeeded")]
    assert ends == [
        (2, "x succeeded"),
        (4, "y succeeded"),
        (6, "w succeeded"),
        (7, "z succeeded"),
    ]


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
def test_a_raising_branch_stops_the_others_and_hangs_nobody() -> None:
    def run() -> Bench:
        bench = Bench()
        with pytest.raises(smach.InvalidStateError):
            bench.run(
                both(("BAD", bench.state("bad", 3, fails=True)), ("B", bench.state("b", 1000)))
            )
        assert bench.clock.run(bench.state("after", 1).passing()) == "succeeded"
        return bench

    bench = repeated(run)
    assert bench.log[2:] == [(3, "bad succeeded"), (3, "b preempted")]


def test_a_machine_may_be_run_again_and_on_another_clock() -> None:
    logs = []
    machine: Any = None
    states: list[Waits] = []
    for _ in range(2):
        bench = Bench()
        if machine is None:
            states = [bench.state("a", 2), bench.state("b", 3)]
            machine = both(("A", states[0]), ("B", states[1]))
        for state in states:
            state.bench = bench
        bench.run(machine)
        assert machine.execute() == "succeeded"
        assert bench.steps == 6
        logs.append(sorted(bench.log))
    assert logs[0] == logs[1]


def test_the_active_states_are_shown_in_the_order_of_their_branches() -> None:
    bench = Bench()
    fork = both(("A", bench.state("a", 3)), ("B", chain(("IN", bench.state("in", 3)))))
    bench.run(chain(("FIRST", bench.state("f", 1)), ("BOTH", fork), ("LAST", bench.state("l", 1))))
    assert bench.shown[0] == ("sm/FIRST",)
    assert bench.shown[2] == ("sm/BOTH/A", "sm/BOTH/B/IN")
    assert bench.shown[3] == ("sm/LAST",)


def test_a_state_under_two_labels_takes_both_branches() -> None:
    bench = Bench()
    state = bench.state("twin", 3)
    assert bench.run(both(("A", state), ("B", state))) == "succeeded"
    assert bench.steps == 3


def test_a_real_world_gives_the_same_hash_under_threads() -> None:
    pytest.importorskip("pybullet")

    class Moves(smach.State):
        def __init__(self, world: sim.World) -> None:
            super().__init__(outcomes=OUTCOMES)
            self.arm = world.arm()

        def execute(self, userdata: Any) -> str:
            goal = self.arm.solve_ik([[0.5, 0.2, 0.2], [1, 0, 0, 0]])
            return self.arm.move_to_joints(goal or [], 1.0, self.preempt_requested).outcome

    class Closes(smach.State):
        def __init__(self, world: sim.World) -> None:
            super().__init__(outcomes=OUTCOMES)
            self.world = world

        def execute(self, userdata: Any) -> str:
            self.world.sleep(0.3)
            return self.world.arm().grip("open", self.preempt_requested).outcome

    def run() -> tuple[str, float, str]:
        with sim.World(seed=0, patience=60.0) as world:
            machine = both(("MOVE", Moves(world)), ("CLOSE", Closes(world)), any_ends=True)
            world.attach(machine)
            world.attach(machine)
            machine.execute()
            assert world.events == []
            return world.hash(), world.time, world.caption

    first = run()
    assert all(run() == first for _ in range(2))
    assert first[2] == "sm/MOVE + sm/CLOSE"
