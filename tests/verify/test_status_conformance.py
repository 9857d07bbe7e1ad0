"""Statuses of runs are accepted; statuses with a changed, missing or added state are not."""

from __future__ import annotations

import contextlib
import io
from typing import Any

import pytest
from hypothesis import HealthCheck, given, seed, settings

from smachac.diagnostics.source import Source
from smachac.driver import analyse, build
from smachac.ir.nodes import Checked, Machine
from smachac.ir.written import written
from smachac.runtime.container_tree import containers
from smachac.runtime.tracing import trace
from smachac.targets.python import TARGET
from smachac.verify.coverage import Coverage
from smachac.verify.status_conformance import Status, in_order, judge_statuses, status_of
from smachac.verify.trace_report import JudgedTrace
from tests.strategies.full_machines import busy_machines
from tests.support.silent_smach import silent_smach
from tests.support.typed_machines import BUILT_IN, with_state_types

SCRIPT = """\
name: sm
outcomes: [done, lost]
states:
  - FIND:
      template: StateMachine
      outcomes: [found, none]
      states:
        - LOOK: {template: ScriptedState, outcomes: [seen, no_], transitions: {seen: GO, no_: none}}
        - GO: {template: ScriptedState, outcomes: [ok], transitions: {ok: found}}
      transitions: {found: BOTH, none: lost}
  - BOTH:
      template: Concurrence
      outcomes: [all, some]
      default_outcome: some
      outcome_map: {all: {LEFT: ok, RIGHT: ok}}
      states:
        - LEFT: {template: ScriptedState, outcomes: [ok, bad]}
        - RIGHT: {template: ScriptedState, outcomes: [ok, bad]}
      transitions: {all: TRY, some: lost}
  - TRY:
      template: ScriptedState
      outcomes: [ok, bad]
      retry: {on: [bad], max: 3}
      transitions: {ok: done, exhausted: lost, preempted: lost}
"""

RUN = (
    "sm FIND", "sm/FIND LOOK", "sm/FIND GO", "sm/FIND : found",
    "sm BOTH", "sm/BOTH LEFT RIGHT", "sm/BOTH RIGHT", "sm/BOTH", "sm/BOTH : all",
    "sm TRY", "sm/TRY TRY", "sm/TRY TRY", "sm/TRY TRY", "sm/TRY TRY : ok", "sm None : done",
)  # fmt: skip
"""The statuses of a run: the path, the active states, and the outcome after a colon."""


def statuses(lines: tuple[str, ...] | list[str]) -> list[Status]:
    found = []
    for number, line in enumerate(lines):
        words, _, outcome = line.partition(":")
        path, *active = words.split()
        end = outcome.strip() or None
        found.append(Status(stamp=float(number), path=path, active=tuple(active), outcome=end))
    return found


def machine() -> Machine:
    found = analyse(Source("main.yml", SCRIPT), BUILT_IN, []).checked
    assert found is not None
    return found


def judged(lines: tuple[str, ...] | list[str]) -> tuple[JudgedTrace, Coverage]:
    taken = Coverage(machine())
    return judge_statuses(machine(), "bag", statuses(lines), taken, written(machine())), taken


def reason(lines: tuple[str, ...] | list[str]) -> tuple[int, str]:
    """The number of the first status that is not allowed, and the reason."""
    fault = judged(lines)[0].fault
    assert fault is not None
    return fault[:2]


def test_a_run_is_allowed_and_covers_its_transitions() -> None:
    trace, taken = judged(RUN)
    assert (trace.fault, trace.events, trace.outcome) == (None, len(RUN), "done")
    found = {f"{item.path} {item.outcome} {item.target}" for item in taken.covered}
    assert found == {
        "sm/FIND/LOOK seen sm/FIND/GO", "sm/FIND/GO ok sm/FIND:found", "sm/FIND found sm/BOTH",
        "sm/BOTH all sm/TRY", "sm/BOTH all sm/BOTH:all", "sm/TRY ok sm:done",
        "sm/TRY/TRY bad sm/TRY/TRY", "sm/TRY/TRY ok sm/TRY:ok",
    }  # fmt: skip


@pytest.mark.parametrize("start", range(1, len(RUN)))
def test_a_recording_may_begin_in_the_middle_and_end_early(start: int) -> None:
    assert judged(RUN[start:])[0].fault is None
    assert judged(RUN[:start])[0].fault is None


def test_several_runs_may_follow_each_other() -> None:
    trace, _ = judged([*RUN, *RUN[:2]])
    assert (trace.fault, trace.outcome) == (None, None)


@pytest.mark.parametrize(
    ("changes", "at", "message"),
    [
        ({4: "sm TRY"}, 5, "`found` of `sm/FIND` does not lead to `sm/TRY`"),
        ({3: "sm BOTH"}, 4, "`sm/FIND` is left before its end"),
        ({3: "sm/FIND : none"}, 4, "no outcome of `sm/FIND/GO` leads to `sm/FIND:none`"),
        ({2: "sm/FIND HIDE"}, 3, "the script has no state `sm/FIND/HIDE`"),
        ({2: "sm/FIND/GO HIDE"}, 3, "the script has no container `sm/FIND/GO`"),
        ({2: "other X"}, 3, "the script has no container `other`"),
        ({1: "sm/FIND GO"}, 2, "`sm/FIND/GO` is active first, in the script `sm/FIND/LOOK` is"),
        ({8: "sm/BOTH : lost"}, 9, "`sm/BOTH` ends with `lost`, which is none of its outcomes"),
        ({14: "sm None : lost"}, 15, "`ok` of the retry of `sm/TRY` does not lead to `sm:lost`"),
        ({4: "sm/FIND : found"}, 5, "`sm/FIND` has ended already"),
        ({4: "sm/FIND LOOK"}, 5, "`sm/FIND` has ended already"),
    ],
)
def test_a_changed_status_is_refused(changes: dict[int, str], at: int, message: str) -> None:
    lines = [changes.get(number, line) for number, line in enumerate(RUN)]
    assert reason(lines) == (at, message)


def test_a_container_starts_only_while_it_is_active() -> None:
    lines = [*RUN[:4], "sm BOTH", "sm/FIND LOOK"]
    assert reason(lines)[0] == 6


def test_statuses_are_sorted_by_time_unless_the_clock_was_set_back() -> None:
    first, second, third = statuses(["sm A", "sm/A B", "sm C"])
    assert in_order([first, third, second]) == [first, second, third]
    back = third._replace(stamp=-1.0)
    assert in_order([first, back, second]) == [first, back, second]


@pytest.mark.parametrize(
    ("info", "outcome", "complete"),
    [
        ("(['A'],)", None, True),
        ("(['A'], 'done')", "done", True),
        ("('A', 'done')", "done", True),
        ("(<smach.user_data.UserData object at 0x7f>, ['A']), {}", None, False),
        ("(" * 10_000, None, False),
    ],
)
def test_the_outcome_is_in_the_info(info: str, outcome: str | None, complete: bool) -> None:
    fields = {"path": "/sm/A", "active_states": ["B"], "info": info}
    assert status_of(fields, 1.5) == Status(1.5, "sm/A", ("B",), outcome, complete)


def test_of_statuses_without_starts_and_ends_the_names_are_judged() -> None:
    found = [
        status._replace(complete=False) for status in statuses(["sm BOTH", "sm FIND", "sm HIDE"])
    ]
    fault = judge_statuses(machine(), "bag", found, Coverage(machine()), written(machine())).fault
    assert fault is not None
    assert fault[:2] == (3, "the script has no state `sm/HIDE`")


@pytest.mark.parametrize("info", ["HEARTBEAT", "Initial state", "REMOTE_INIT"])
def test_repeated_statuses_are_left_out(info: str) -> None:
    assert status_of({"path": "/sm", "active_states": [], "info": info}, 0.0) is None


def of_program(machine: Machine, asked: tuple[str, int]) -> list[Status]:
    """The statuses of the generated program; `asked`: the visit in which it is to stop."""
    report: list[Any] = []
    typed = with_state_types(machine)
    ((name, text),) = build(Checked(typed), TARGET, BUILT_IN, report).items()
    module: dict[str, Any] = {"__name__": "generated"}
    exec(compile(text, name, "exec"), module)
    found: list[Status] = []
    visits: list[str] = []

    def observe(event: Any) -> None:
        if event["event"] == "enter":
            visits.append(event["path"])
            if event["path"] == asked[0] and visits.count(asked[0]) == asked[1]:
                root.request_preempt()

    def report_on(path: str, container: Any) -> None:
        def changed(userdata: object, *what: object) -> None:
            active = container.get_active_states()
            fields = {"path": path, "active_states": active, "info": repr(what)}
            status = status_of(fields, 0.0)
            assert status is not None
            found.append(status)

        container.register_start_cb(changed)
        container.register_transition_cb(changed)
        container.register_termination_cb(changed)

    with silent_smach(), contextlib.redirect_stdout(io.StringIO()):
        root = module["build"]()
        for path, container in containers(f"/{machine.root.name}", root):
            report_on(path, container)
        trace.attach(root, machine.root.name, observe)
        with contextlib.suppress(Exception):
            root.execute()
    return found


@seed(0)
@settings(max_examples=60, database=None, suppress_health_check=list(HealthCheck))
@given(busy_machines())
@pytest.mark.slow
def test_runs_of_generated_programs_are_allowed(drawn: tuple[Machine, tuple[str, int]]) -> None:
    machine, asked = drawn
    found = of_program(machine, asked)
    judged = judge_statuses(machine, "run", found, Coverage(machine), written(machine))
    assert judged.fault is None, found[judged.fault[0] - 1]
