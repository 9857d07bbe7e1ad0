"""Pause, step, breakpoints, forced outcomes and stops of machines that run: of the runtime, in
threads, and of the interpreter."""

from __future__ import annotations

import threading
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, Literal

import pytest

from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run as interpret
from smachac.interpreter.scenario import Scenario, ScenarioStep, scenario_behaviour
from smachac.ir.nodes import Machine, StateMachine
from smachac.ir.traversal import outcome_names
from smachac.ir.written import written
from smachac.runtime.tracing.trace import attach, script
from smachac.view.control import Control, ControlError
from tests.ir.test_script_paths import EACH, LIMIT, RETRY
from tests.ir.test_script_paths import machine as scripted
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
        ends: Mapping[str, Sequence[str]] = {},
    ) -> None:
        view = written(Machine(root=root))
        self.control = Control(view, paused=paused)
        self._ends = ends
        self.events: list[Mapping[str, Any]] = []
        self.outcome: str | None = None
        self.machine = built(Machine(root=root)) if engine == "runtime" else None
        self._root = root
        self._thread = threading.Thread(target=self._go, daemon=True)

    def _go(self) -> None:
        root, leaves = self._root, paths_of_leaves(self._root, self._root.name)
        if self.machine is not None:
            script(
                self.machine,
                root.name,
                {path: [(end, {}) for end in self._of(path)] for path in leaves},
            )
            attach(self.machine, root.name, self.events.append, gate=self.control)
            self.outcome = self.machine.execute()
        else:
            whole = Machine(root=root)
            rows = {
                path: tuple(ScenarioStep(outcome=end, writes=()) for end in self._of(path))
                for path in leaves
            }
            behaviour = scenario_behaviour(Scenario(steps=rows), whole, builtin_behaviour())
            result = interpret(whole, behaviour, self.events.append, gate=self.control)
            self.outcome = result.outcome
        self.control.ended()

    def _of(self, path: str) -> Sequence[str]:
        """The outcomes of the visits of a leaf; the last one repeats."""
        return self._ends.get(path, ["ok"])

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
        assert run.control.status()["breakpoints"] == [
            {"path": "sm/B/B2", "outcome": None, "round": None}
        ]
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
            "path": "sm/B/B1", "outcome": "ok", "round": None,
            "outcomes": ("ok", "bad", "preempted"),
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


def drive(sugar: str) -> StateMachine:
    """DRIVE with fields that make containers; it leads to the end of the machine."""
    root = scripted(sugar).root
    assert isinstance(root, StateMachine)
    (state,) = root.children
    own = outcome_names(state)
    kept = tuple(step for step in state.transitions if step.outcome in own)
    return replace(root, children=(replace(state, transitions=kept),))


LIMITED_TRIES = f"{RETRY}; {LIMIT}"
INNERMOST = "sm/DRIVE/TIMED/DRIVE"


def tries(engine: Engine, *ends: str) -> Run:
    return Run(
        drive(LIMITED_TRIES), engine, ends={INNERMOST: ends, "sm/DRIVE/TIMED/TIMER": ["preempted"]}
    )


@engines
def test_a_state_with_tries_waits_once_for_each_visit(engine: Engine) -> None:
    with tries(engine, "aborted", "succeeded") as run:
        (at,) = run.waits_at("sm/DRIVE")["at"]
        assert at["outcomes"] == ("succeeded", "timeout", "preempted", "exhausted", "aborted")
        run.control.act("step")
        assert run.ends() == "done"
    assert run.entered().count(INNERMOST) == 2


@engines
def test_each_try_is_a_breakpoint_of_its_own(engine: Engine) -> None:
    with tries(engine, "aborted", "aborted", "succeeded") as run:
        run.waits_at("sm/DRIVE")
        run.control.act("break", "sm/DRIVE", None, "try")
        run.control.act("resume")
        for number in range(3):
            (at,) = run.waits_at("sm/DRIVE")["at"]
            assert at["round"] == "try"
            assert run.entered().count(INNERMOST) == number
            run.control.act("resume")
        assert run.ends() == "done"


@engines
def test_a_forced_timeout_acts_on_the_time_limit(engine: Engine) -> None:
    with tries(engine, "succeeded") as run:
        run.waits_at("sm/DRIVE")
        run.control.act("outcome", "sm/DRIVE", "timeout")
        assert run.ends() == "failed"
    assert run.exits() == {"sm/DRIVE/TIMED": "timeout", "sm/DRIVE": "timeout"}
    assert not run.control.armed


@engines
def test_forced_used_up_tries_act_on_the_tries(engine: Engine) -> None:
    with tries(engine, "succeeded") as run:
        run.waits_at("sm/DRIVE")
        run.control.act("outcome", "sm/DRIVE", "exhausted")
        assert run.ends() == "failed"
    assert run.exits() == {"sm/DRIVE": "exhausted"}


@engines
def test_a_forced_outcome_of_one_try_leads_to_the_next_one(engine: Engine) -> None:
    with tries(engine, "succeeded") as run:
        run.waits_at("sm/DRIVE")
        run.control.act("outcome", "sm/DRIVE", "aborted")
        assert run.ends() == "done"
    forced = [event["path"] for event in run.events if event.get("forced")]
    assert forced == [INNERMOST]
    assert run.entered().count(INNERMOST) == 2


@engines
def test_the_end_of_a_try_can_be_a_breakpoint(engine: Engine) -> None:
    with tries(engine, "aborted", "succeeded") as run:
        run.waits_at("sm/DRIVE")
        run.control.act("break", "sm/DRIVE", "aborted")
        run.control.act("break", "sm/DRIVE", "succeeded")
        run.control.act("resume")
        (at,) = run.waits_at("sm/DRIVE")["at"]
        assert at["outcome"] == "aborted"
        run.control.act("resume")
        (at,) = run.waits_at("sm/DRIVE")["at"]
        assert at["outcome"] == "succeeded"
        run.control.act("resume")
        assert run.ends() == "done"


def test_a_forced_outcome_of_a_loop_ends_the_loop() -> None:
    with Run(drive(EACH), "interpreter", ends={"sm/DRIVE/DRIVE": ["succeeded"]}) as run:
        run.waits_at("sm/DRIVE")
        run.control.act("outcome", "sm/DRIVE", "succeeded")
        assert run.ends() == "done"
    assert run.exits() == {"sm/DRIVE": "succeeded"}


def test_each_item_is_a_breakpoint_of_its_own() -> None:
    with Run(drive(EACH), "interpreter", ends={"sm/DRIVE/DRIVE": ["succeeded"]}) as run:
        run.waits_at("sm/DRIVE")
        run.control.act("break", "sm/DRIVE", None, "item")
        run.control.act("step")
        for number in range(2):
            (at,) = run.waits_at("sm/DRIVE")["at"]
            assert at["round"] == "item"
            assert run.entered().count("sm/DRIVE/DRIVE") == number
            run.control.act("step")
        assert run.ends() == "done"


def test_an_unknown_action_is_an_error() -> None:
    with pytest.raises(ControlError, match="there is no action `jump`"):
        Control().act("jump")
    with pytest.raises(ControlError, match="there is no action `break`"):
        Control().act("break")
    with pytest.raises(ControlError, match="there is no state `sm/X`"):
        Control(written(Machine(root=line()))).act("break", "sm/X")
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
