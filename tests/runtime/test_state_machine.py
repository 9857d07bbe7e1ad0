"""Running state machines: rules M4 to M16, T3."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.runtime import smach
from tests.support.examples import examples


def leaf(
    *results: str | BaseException | None,
    outcomes: tuple[str, ...] = ("done",),
    io: tuple[str, ...] = (),
    do: Callable[[Any], object] = lambda ud: None,
) -> smach.State:
    """A state that gives or raises one result after the other, after `do(userdata)`."""
    remaining = list(results) or list(outcomes[:1])

    def run(ud: Any) -> str | None:
        do(ud)
        result = remaining.pop(0) if len(remaining) > 1 else remaining[0]
        if isinstance(result, BaseException):
            raise result
        return result

    return smach.CBState(run, outcomes=outcomes, io_keys=list(io))


def machine_of(*states: smach.State, outcomes: tuple[str, ...] = ("done",)) -> smach.StateMachine:
    """A machine of states labelled A, B, ..., without explicit transitions."""
    machine = smach.StateMachine(outcomes)
    with machine:
        for label, state in zip("ABCDEF", states, strict=False):
            smach.StateMachine.add(label, state)
    return machine


def test_an_inconsistent_machine_returns_none_and_runs_nothing() -> None:
    ran: list[object] = []
    machine = machine_of(leaf("gone", outcomes=("gone",), do=ran.append))
    machine.register_start_cb(lambda *args: ran.append(args))
    assert machine.execute() is None
    assert ran == []
    assert not machine.is_running()


@pytest.mark.parametrize("result", [None, "other", ["unhashable"]])
def test_an_unregistered_outcome_is_an_invalid_transition(result: Any) -> None:
    with pytest.raises(smach.InvalidTransitionError, match="returned"):
        machine_of(leaf(result)).execute()


def test_an_outcome_registered_late_has_no_transition() -> None:
    state = leaf("late", outcomes=("done",))
    machine = machine_of(state, outcomes=("done", "late"))
    state.register_outcomes(["late"])
    with pytest.raises(smach.InvalidTransitionError, match="registered after"):
        machine.execute()


def test_a_label_shadows_an_outcome_for_explicit_targets_only() -> None:
    machine = smach.StateMachine(["B"])
    with machine:
        smach.StateMachine.add("A", leaf("go", outcomes=("go",)), {"go": "B"})
        smach.StateMachine.add("B", leaf("B", outcomes=("B",)))
    visited: list[str] = []
    machine.register_transition_cb(lambda ud, labels: visited.extend(labels))
    assert machine.execute() == "B"
    assert visited == ["B"]


def test_exceptions_arrive_as_user_code_errors_with_their_cause() -> None:
    cause = ValueError("broken gripper")
    machine = machine_of(leaf(cause, "done"))
    with pytest.raises(smach.InvalidUserCodeError, match="broken gripper") as caught:
        machine.execute()
    assert caught.value.__cause__ is cause
    assert str(caught.value) == "state 'A' of type CBState failed: ValueError: broken gripper"
    assert machine.get_active_states() == ["A"]
    assert not machine.is_running()
    assert machine.execute() == "done"


def test_user_code_errors_pass_as_the_same_object() -> None:
    error = smach.InvalidUserCodeError("mine")
    with pytest.raises(smach.InvalidUserCodeError) as caught:
        machine_of(machine_of(leaf(error))).execute()
    assert caught.value is error


@pytest.mark.parametrize("kind", [KeyboardInterrupt, SystemExit])
def test_what_stops_the_process_passes(kind: type[BaseException]) -> None:
    machine = machine_of(machine_of(leaf(kind(), "done")))
    with pytest.raises(kind):
        machine.execute()
    assert machine.execute() == "done"


def test_the_class_of_an_error_depends_on_the_depth() -> None:
    inner = machine_of(leaf("other"))
    with pytest.raises(smach.InvalidUserCodeError) as caught:
        machine_of(inner).execute()
    assert isinstance(caught.value.__cause__, smach.InvalidTransitionError)
    inconsistent = machine_of(leaf("gone", outcomes=("gone",)))
    with pytest.raises(smach.InvalidTransitionError):
        machine_of(inconsistent).execute()


def test_a_machine_is_not_re_entrant() -> None:
    machine = smach.StateMachine(["done"])
    with machine:
        smach.StateMachine.add("A", leaf(do=lambda ud: machine.execute()))
    with pytest.raises(smach.InvalidUserCodeError) as caught:
        machine.execute()
    assert isinstance(caught.value.__cause__, smach.InvalidStateError)
    assert not machine.is_running()


def test_shutdown_ends_without_an_outcome(monkeypatch: pytest.MonkeyPatch) -> None:
    down: list[bool] = []
    monkeypatch.setattr(smach, "is_shutdown", lambda: bool(down))

    def shut_down(ud: Any) -> None:
        ud.x = 1
        down.append(True)

    first = leaf(io=("x",), do=shut_down)
    machine = smach.StateMachine(["done"], output_keys=["x"])
    with machine:
        smach.StateMachine.add("A", first, {"done": "B"})
        smach.StateMachine.add("B", leaf())
    ended: list[object] = []
    machine.register_termination_cb(lambda *args: ended.append(args))
    parent: dict[str, int] = {}
    assert machine.execute(parent) is None
    assert machine.get_active_states() == ["B"]
    assert (ended, parent) == ([], {"x": 1})


def test_states_may_be_added_while_the_machine_runs() -> None:
    machine = smach.StateMachine(["done", "B"])

    def add(ud: Any) -> None:
        with machine:
            smach.StateMachine.add("B", leaf())

    with machine:
        state = leaf("go", "go", outcomes=("go",), do=add)
        smach.StateMachine.add("A", state, {"go": "B"})
    visited: list[str] = []
    machine.register_transition_cb(lambda ud, labels: visited.extend(labels))
    assert machine.execute() == "done"
    assert visited == ["B"]


def test_one_state_object_under_two_labels() -> None:
    visits: list[Any] = []
    state = leaf(io=("k",), do=lambda ud: visits.append(ud.k))
    machine = smach.StateMachine(["done"])
    with machine:
        smach.StateMachine.add("A", state, {"done": "B"}, {"k": "x"})
        smach.StateMachine.add("B", state, {"done": "done"}, {"k": "y"})
    machine.userdata.x, machine.userdata.y = 1, 2
    machine.execute()
    assert visits == [1, 2]


class Duck:
    """What a machine needs of a state, and no more."""

    def get_registered_outcomes(self) -> tuple[str, ...]:
        return ("done",)

    def get_registered_input_keys(self) -> tuple[str, ...]:
        return ("x",)

    def get_registered_output_keys(self) -> tuple[str, ...]:
        return ("x",)

    def execute(self, ud: Any) -> str:
        ud.x = ud.x + 1
        return "done"


def test_states_are_duck_typed() -> None:
    duck: Any = Duck()
    machine = machine_of(duck)
    machine.userdata.x = 1
    assert machine.execute() == "done"
    assert machine.userdata.x == 2


def test_constants_are_written_before_each_entry() -> None:
    seen: list[int] = []

    def work(ud: Any) -> None:
        seen.append(ud.k)
        ud.k = 0

    state = leaf("again", "done", outcomes=("again", "done"), io=("k",), do=work)
    machine = smach.StateMachine(["done"])
    with machine:
        smach.StateMachine.add("A", state, {"again": "A"}, {"k": "x"}, constants={"x": 7})
    machine.execute()
    assert seen == [7, 7]
    assert machine.userdata.x == 0


def test_keys_registered_late_count() -> None:
    state = leaf(do=lambda ud: setattr(ud, "late", 1))
    machine = machine_of(state)
    machine.execute()
    state.register_output_keys(["late"])
    machine.execute()
    assert machine.userdata.keys() == ["late"]


def test_the_userdata_may_be_replaced_between_runs() -> None:
    machine = machine_of(leaf(io=("n",), do=lambda ud: setattr(ud, "n", ud.n + 1)))
    machine.userdata.n = 0
    machine.execute()
    machine.userdata = smach.UserData()
    machine.userdata.n = 10
    machine.execute()
    assert machine.userdata.n == 11


LABELS = ["A", "B", "C", "D"]


@settings(max_examples=examples(60))
@given(
    table=st.fixed_dictionaries(
        {label: st.lists(st.sampled_from([*LABELS, "end"]), max_size=2) for label in LABELS}
    ),
    choices=st.lists(st.integers(0, 2), min_size=1, max_size=25),
)
def test_a_machine_takes_the_path_of_a_dict_loop(
    table: dict[str, list[str]], choices: list[int]
) -> None:
    targets = {
        label: {**{str(n): target for n, target in enumerate(row)}, "end": "end"}
        for label, row in sorted(table.items())
    }

    def walker() -> Callable[[str, list[str]], str]:
        rest = list(choices)

        def step(label: str, path: list[str]) -> str:
            path.append(label)
            choice = str(rest.pop(0)) if rest else "end"
            return choice if choice in targets[label] else "end"

        return step

    expected: list[str] = []
    step, state = walker(), "A"
    while state in targets:
        state = targets[state][step(state, expected)]
    path: list[str] = []
    move = walker()
    machine = smach.StateMachine(["end"])
    with machine:
        for label, row in targets.items():
            visit = smach.CBState(lambda ud, at: move(at, path), [label], outcomes=list(row))
            smach.StateMachine.add(label, visit, row)
    assert machine.execute() == state == "end"
    assert path == expected
