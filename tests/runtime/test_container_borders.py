"""What crosses the border of a container, and who hears of it: rules V1 to V7, X1 to X5, L2."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from smachac.runtime import smach


def leaf(
    error: BaseException | None = None,
    io: tuple[str, ...] = (),
    do: Callable[[Any], object] = lambda ud: None,
) -> smach.State:
    """A state that does something to the userdata, then raises or ends."""

    def run(ud: Any) -> str:
        do(ud)
        if error is not None:
            raise error
        return "done"

    return smach.CBState(run, outcomes=["done"], io_keys=list(io))


def machine_of(state: smach.State) -> smach.StateMachine:
    """A machine of one state, A."""
    machine = smach.StateMachine(["done"])
    with machine:
        smach.StateMachine.add("A", state)
    return machine


def nested(do: Callable[[Any], object], error: BaseException | None = None) -> smach.StateMachine:
    """A machine with inputs a and b, outputs b and c, of one state that has all three."""
    inner = smach.StateMachine(["done"], input_keys=["a", "b"], output_keys=["b", "c"])
    with inner:
        smach.StateMachine.add("A", leaf(error, io=("a", "b", "c"), do=do))
    return inner


@pytest.mark.parametrize("kind", [dict, smach.UserData])
def test_declared_keys_cross_the_border_by_reference(kind: type[Any]) -> None:
    def work(ud: Any) -> None:
        ud.a.append(1)
        ud.b = "new"

    parent = kind()
    parent["a"], parent["b"], parent["c"] = [], "old", "kept"
    inner = nested(work)
    inner.execute(parent)
    assert (parent["a"], parent["b"], parent["c"]) == ([1], "new", "kept")


def test_a_nested_machine_is_remapped() -> None:
    outer = smach.StateMachine(["done"])
    with outer:
        inner = nested(lambda ud: setattr(ud, "c", ud.a + 1))
        smach.StateMachine.add("IN", inner, remapping={"a": "x", "c": "y", "b": "z"})
    outer.userdata.x = 1
    outer.execute()
    assert outer.userdata.y == 2
    assert outer.userdata.keys() == ["x", "y"]


def test_only_missing_inputs_at_a_border_are_warnings(monkeypatch: pytest.MonkeyPatch) -> None:
    warnings: list[str] = []
    monkeypatch.setattr(smach, "logwarn", warnings.append)
    inner = nested(lambda ud: None)
    inner.userdata.a = "kept from before"
    assert inner.execute({}) == "done"
    assert len(warnings) == 1
    assert "'a', 'b'" in warnings[0]
    assert inner.userdata.a == "kept from before"


def test_nothing_leaves_after_an_exception() -> None:
    inner = nested(lambda ud: setattr(ud, "b", "half"), ValueError())
    parent = {"a": 1, "b": "old"}
    with pytest.raises(smach.InvalidUserCodeError):
        inner.execute(parent)
    assert parent["b"] == "old"
    assert inner.userdata.b == "half"


def test_a_container_run_by_a_leaf_obeys_the_leafs_keys() -> None:
    inner = nested(lambda ud: None)
    outer = machine_of(leaf(io=("a",), do=inner.execute))
    outer.userdata.a = 1
    with pytest.raises(smach.InvalidUserCodeError, match="no input key"):
        outer.execute()


def test_callbacks_in_order_with_their_arguments() -> None:
    calls: list[Any] = []
    inner = machine_of(leaf())
    outer = smach.StateMachine(["done"])
    with outer:
        smach.StateMachine.add("A", inner, {"done": "B"})
        smach.StateMachine.add("B", leaf())
    for name, machine in (("outer", outer), ("inner", inner)):
        machine.register_start_cb(lambda ud, *a, n=name: calls.append((n, "start", *a)), [1])
        machine.register_transition_cb(lambda ud, *a, n=name: calls.append((n, "to", *a)), [2])
        machine.register_termination_cb(lambda ud, *a, n=name: calls.append((n, "end", *a)))
    outer.register_termination_cb(lambda *_: calls.append(outer.get_active_states()))
    outer.execute()
    assert calls == [
        ("outer", "start", ["A"], 1),
        ("inner", "start", ["A"], 1),
        ("inner", "end", ["A"], "done"),
        ("outer", "to", ["B"], 2),
        ("outer", "end", ["B"], "done"),
        ["None"],
    ]


def test_callbacks_see_inputs_and_may_change_outputs() -> None:
    inner = nested(lambda ud: None)
    inner.register_start_cb(lambda ud, labels: setattr(ud, "c", ud.a))
    inner.register_termination_cb(lambda ud, labels, outcome: setattr(ud, "b", outcome))
    parent = {"a": 1, "b": 2}
    inner.execute(parent)
    assert parent == {"a": 1, "b": "done", "c": 1}


def test_a_raising_callback_skips_the_rest_of_its_list_only() -> None:
    calls: list[str] = []

    def broken(*args: object) -> None:
        raise RuntimeError

    machine = machine_of(leaf())
    machine.register_start_cb(broken)
    machine.register_start_cb(lambda *args: calls.append("skipped"))
    machine.register_termination_cb(lambda *args: calls.append("run"))
    assert machine.execute() == "done"
    assert calls == ["run"]


def test_info_lines_of_a_run(monkeypatch: pytest.MonkeyPatch) -> None:
    lines: list[str] = []
    monkeypatch.setattr(smach, "loginfo", lines.append)
    machine = smach.StateMachine(["done"])
    with machine:
        smach.StateMachine.add("A", leaf(), {"done": "B"})
        smach.StateMachine.add("B", leaf())
    machine.userdata.key = 1
    machine.execute()
    start, transition, end = lines
    assert "'A'" in start
    assert "key" in start
    assert "'A':'done'-->'B'" in transition
    assert "'B'" in end
    assert "'done'" in end
