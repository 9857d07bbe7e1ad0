"""Pause, step, breakpoints, forced outcomes and stops of machines that run: of the runtime, in
threads, and of the interpreter."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from typing import Any, Literal

import pytest

from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run as interpret
from smachac.interpreter.scenario import Scenario, ScenarioStep, scenario_behaviour
from smachac.ir.nodes import Machine, StateMachine
from smachac.runtime.tracing.trace import attach, script
from smachac.view.control import Control, ControlError
from tests.support.ir_machines import concurrence, iterator, leaf, machine
from tests.support.smach_machines import built

pytestmark = pytest.mark.usefixtures("silent_smach")

Engine = Literal["runtime", "interpreter"]
engines = pytest.mark.parametrize("engine", ["runtime", "interpreter"])

LONG = 60.0
"""Seconds after which a test fails that waits for what does not come."""

TO = {"bad": "failed", "preempted": "stopped"}
"""Where the other outcomes of the leaves lead."""


def line() -> StateMachine:
    """A, then B with B1 and B2 inside, then C; all leaves end with `ok`."""
    inner = machine(
        "B",
        "ok failed stopped",
        leaf("B1", {"ok": "B2", **TO}),
        leaf("B2", {"ok": "ok", **TO}),
        to={"ok": "C", "failed": "failed", "stopped": "stopped"},
    )
    first, last = leaf("A", {"ok": "B", **TO}), leaf("C", {"ok": "done", **TO})
    return machine("sm", "done failed stopped", first, inner, last)


def pair() -> StateMachine:
    """A concurrence of LEFT and RIGHT."""
    both = concurrence(
        "BOTH",
        "done other",
        leaf("LEFT", outcomes="ok bad preempted"),
        leaf("RIGHT", outcomes="ok bad preempted"),
        default="other",
        rules=(("done", {"LEFT": "ok", "RIGHT": "ok"}),),
        to={"done": "done", "other": "stopped"},
    )
    return machine("sm", "done stopped", both)


def paths_of_leaves(node: Any, path: str) -> list[str]:
    children = getattr(node, "children", ())
    return [
        each for child in children for each in paths_of_leaves(child, f"{path}/{child.name}")
    ] or [path]


class Run:
    """A machine that runs in a thread of its own, under a control."""

    def __init__(
        self,
        root: StateMachine,
        engine: Engine,
        *,
        paused: bool = True,
        shown: Mapping[str, str] = {},
    ) -> None:
        self.control = Control(shown, paused=paused)
        self.events: list[Mapping[str, Any]] = []
        self.outcome: str | None = None
        self.machine = built(Machine(root=root)) if engine == "runtime" else None
        self._root = root
        self._thread = threading.Thread(target=self._go, daemon=True)

    def _go(self) -> None:
        root, leaves = self._root, paths_of_leaves(self._root, self._root.name)
        if self.machine is not None:
            script(self.machine, root.name, {path: [("ok", {})] for path in leaves})
            attach(self.machine, root.name, self.events.append, gate=self.control)
            self.outcome = self.machine.execute()
        else:
            whole = Machine(root=root)
            rows = {path: (ScenarioStep(outcome="ok", writes=()),) for path in leaves}
            behaviour = scenario_behaviour(Scenario(steps=rows), whole, builtin_behaviour())
            result = interpret(whole, behaviour, self.events.append, gate=self.control)
            self.outcome = result.outcome
        self.control.ended()

    def __enter__(self) -> Run:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.control.release()  # a failed test must not leave a thread that waits
        self._thread.join(LONG)
        assert not self._thread.is_alive()

    def ends(self) -> str | None:
        """Wait for the end; the outcome."""
        self._thread.join(LONG)
        assert not self._thread.is_alive(), self.control.status()
        return self.outcome

    def waits_at(self, *paths: str) -> dict[str, Any]:
        """Wait until exactly these states wait; the status."""
        wanted = set(paths)
        found = self.control.wait_for(
            lambda status: {each["path"] for each in status["at"]} == wanted, LONG
        )
        status = self.control.status()
        assert found, status
        return status

    def entered(self) -> list[str]:
        return [event["path"] for event in self.events if event["event"] == "enter"]

    def exits(self) -> dict[str, str]:
        return {each["path"]: each["outcome"] for each in self.events if each["event"] == "exit"}


@engines
def test_a_paused_run_waits_before_each_state(engine: Engine) -> None:
    with Run(line(), engine) as run:
        order = ["sm/A", "sm/B", "sm/B/B1", "sm/B/B2", "sm/C"]
        for number, path in enumerate(order):
            status = run.waits_at(path)
            assert run.entered() == order[:number]
            assert status["paused"]
            assert not status["ended"]
            run.control.act("step")
        assert run.ends() == "done"
        assert run.entered() == order
    assert run.control.status()["ended"]
    assert not run.control.status()["paused"]


@engines
def test_resume_lets_a_run_go_to_its_end(engine: Engine) -> None:
    with Run(line(), engine) as run:
        run.waits_at("sm/A")
        run.control.act("resume")
        assert run.ends() == "done"


@engines
def test_a_breakpoint_stops_before_its_state(engine: Engine) -> None:
    with Run(line(), engine) as run:
        run.waits_at("sm/A")
        run.control.act("break", "sm/B/B2")
        assert run.control.status()["breakpoints"] == [{"path": "sm/B/B2", "outcome": None}]
        run.control.act("resume")
        assert run.waits_at("sm/B/B2")["paused"]
        assert run.entered() == ["sm/A", "sm/B", "sm/B/B1"]
        run.control.act("resume")
        assert run.ends() == "done"


@engines
def test_a_breakpoint_that_is_removed_stops_nothing(engine: Engine) -> None:
    with Run(line(), engine) as run:
        run.waits_at("sm/A")
        run.control.act("break", "sm/B/B2")
        run.control.act("unbreak", "sm/B/B2")
        run.control.act("resume")
        assert run.ends() == "done"
    assert not run.control.armed


@engines
def test_a_breakpoint_on_an_outcome_stops_after_the_state(engine: Engine) -> None:
    with Run(line(), engine) as run:
        run.waits_at("sm/A")
        run.control.act("break", "sm/A", "bad")
        run.control.act("break", "sm/B/B1", "ok")
        run.control.act("resume")
        (at,) = run.waits_at("sm/B/B1")["at"]
        assert at == {
            "path": "sm/B/B1", "outcome": "ok", "outcomes": ("ok", "bad", "preempted")
        }  # fmt: skip
        assert run.entered()[-1] == "sm/B/B1"
        assert "sm/B/B1" not in run.exits()
        run.control.act("resume")
        assert run.ends() == "done"


@engines
def test_a_forced_outcome_replaces_the_state_that_waits(engine: Engine) -> None:
    with Run(line(), engine) as run:
        run.waits_at("sm/A")
        run.control.act("outcome", "sm/A", "bad")
        assert run.ends() == "failed"
    kinds = [(event["event"], event.get("forced", False)) for event in run.events]
    assert kinds == [
        *[("start", False), ("enter", False), ("exit", True), ("transition", False)],
        ("finish", False),
    ]


@engines
def test_a_forced_outcome_of_a_container_skips_its_states(engine: Engine) -> None:
    with Run(line(), engine) as run:
        run.waits_at("sm/A")
        run.control.act("step")
        run.waits_at("sm/B")
        run.control.act("outcome", "sm/B", "ok")
        run.waits_at("sm/C")
        run.control.act("resume")
        assert run.ends() == "done"
    assert run.entered() == ["sm/A", "sm/B", "sm/C"]


@engines
def test_a_forced_outcome_replaces_that_of_a_state_that_has_ended(engine: Engine) -> None:
    with Run(line(), engine) as run:
        run.waits_at("sm/A")
        run.control.act("break", "sm/A", "ok")
        run.control.act("resume")
        run.waits_at("sm/A")
        run.control.act("outcome", None, "bad")
        assert run.ends() == "failed"
    assert run.exits() == {"sm/A": "bad"}


@engines
def test_only_an_outcome_of_a_state_that_waits_can_be_forced(engine: Engine) -> None:
    with Run(line(), engine) as run:
        run.waits_at("sm/A")
        with pytest.raises(ControlError, match="`no` is not an outcome of `sm/A`"):
            run.control.act("outcome", "sm/A", "no")
        with pytest.raises(ControlError, match="`sm/C` does not wait"):
            run.control.act("outcome", "sm/C", "ok")
        run.waits_at("sm/A")
        run.control.act("resume")
        assert run.ends() == "done"
        with pytest.raises(ControlError, match="the run has ended"):
            run.control.act("step")


@engines
def test_a_stop_ends_a_run_that_waits(engine: Engine) -> None:
    with Run(line(), engine) as run:
        run.control.act("break", "sm/C")
        run.waits_at("sm/A")
        run.control.act("stop")
        assert run.ends() == "stopped"
    assert "preempt" in [event["event"] for event in run.events]


@pytest.mark.parametrize("where", ["sm/B", "sm/B/B2"])
def test_a_request_from_elsewhere_ends_a_run_that_waits(where: str) -> None:
    with Run(line(), "runtime") as run:
        run.waits_at("sm/A")
        run.control.act("break", where)
        run.control.act("resume")
        run.waits_at(where)
        assert run.machine is not None
        run.machine.request_preempt()  # what Ctrl-C does
        assert run.ends() == "stopped"


@engines
def test_a_stop_reaches_the_state_that_waits(engine: Engine) -> None:
    with Run(line(), engine) as run:
        run.waits_at("sm/A")
        run.control.act("break", "sm/C")
        run.control.act("resume")
        run.waits_at("sm/C")
        run.control.act("stop")
        assert run.ends() == "stopped"
    assert run.exits()["sm/C"] == "preempted"


def test_all_branches_of_a_concurrence_wait() -> None:
    with Run(pair(), "runtime") as run:
        run.waits_at("sm/BOTH")
        run.control.act("step")
        run.waits_at("sm/BOTH/LEFT", "sm/BOTH/RIGHT")
        run.control.act("step", "sm/BOTH/RIGHT")
        run.waits_at("sm/BOTH/LEFT")
        run.control.act("outcome", "sm/BOTH/LEFT", "bad")
        assert run.ends() == "stopped"
    assert run.exits() == {"sm/BOTH/RIGHT": "ok", "sm/BOTH/LEFT": "bad", "sm/BOTH": "other"}


def test_a_stop_ends_all_branches_that_wait() -> None:
    with Run(pair(), "runtime") as run:
        run.waits_at("sm/BOTH")
        run.control.act("step")
        run.waits_at("sm/BOTH/LEFT", "sm/BOTH/RIGHT")
        run.control.act("stop")
        assert run.ends() == "stopped"
    assert run.exits()["sm/BOTH/LEFT"] == run.exits()["sm/BOTH/RIGHT"] == "preempted"


def test_the_interpreter_takes_the_branches_one_by_one() -> None:
    with Run(pair(), "interpreter") as run:
        for path in ("sm/BOTH", "sm/BOTH/LEFT", "sm/BOTH/RIGHT"):
            run.waits_at(path)
            run.control.act("step")
        assert run.ends() == "done"


def loop() -> StateMachine:
    """An iterator over three items."""
    each = iterator(
        "EACH",
        "exhausted found",
        machine("ONE", "next found", leaf("TRY", {"ok": "next", "bad": "found"})),
        items=[1, 2, 3],
        loop="next",
        to={"exhausted": "stopped", "found": "done"},
    )
    return machine("sm", "done stopped", each)


@engines
def test_the_items_of_an_iterator_wait_too(engine: Engine) -> None:
    with Run(loop(), engine) as run:
        for path in ("sm/EACH", "sm/EACH/ONE", "sm/EACH/ONE/TRY"):
            run.waits_at(path)
            run.control.act("step")
        run.waits_at("sm/EACH/ONE")
        run.control.act("outcome", "sm/EACH/ONE", "found")
        assert run.ends() == "done"
    last = [event for event in run.events if event["event"] == "transition"][-2:]
    assert [(each["path"], each["to"]) for each in last] == [
        ("sm/EACH/ONE", "sm/EACH:found"),
        ("sm/EACH", "sm:done"),
    ]


@engines
def test_a_run_that_is_not_paused_meets_no_gate(engine: Engine) -> None:
    with Run(line(), engine, paused=False) as run:
        assert run.ends() == "done"
        assert not run.control.armed


@engines
def test_paths_are_those_of_the_script(engine: Engine) -> None:
    with Run(line(), engine, shown={"sm/A": "sm/A (retry)"}) as run:
        run.waits_at("sm/A (retry)")
        run.control.act("step", "sm/A (retry)")
        run.waits_at("sm/B")
        run.control.act("resume")
        assert run.ends() == "done"


def test_an_unknown_action_is_an_error() -> None:
    with pytest.raises(ControlError, match="there is no action `jump`"):
        Control().act("jump")
    with pytest.raises(ControlError, match="there is no action `break`"):
        Control().act("break")
    with pytest.raises(ControlError, match="there is no state `sm/X`"):
        Control(places={"sm/A"}).act("break", "sm/X")
    control = Control()
    control.ended()
    with pytest.raises(ControlError, match="the run has ended"):
        control.act("stop")


def test_a_stop_before_the_machine_is_ready_is_remembered() -> None:
    requests: list[str] = []
    control = Control(paused=True)
    control.act("stop")
    assert not control.armed, "nothing waits"
    assert control.status()["stopping"]
    control.act("stop")
    control.opened(lambda: requests.append("stop"))
    assert requests == ["stop"]
    control.act("stop")
    assert requests == ["stop", "stop"]
