"""Keyword names and members of SMACH that code written for it uses beside the documented API."""

from __future__ import annotations

import enum
from typing import Any

import pytest

from smachac.runtime import smach
from smachac.runtime.smach import log, settings, user_data, util


def state(outcome: Any = "done", inputs: Any = (), outputs: Any = ()) -> smach.CBState:
    return smach.CBState(
        lambda ud: outcome, outcomes=[outcome], input_keys=[*inputs], output_keys=[*outputs]
    )


class Label(str, enum.Enum):
    FIRST = "FIRST"
    SECOND = "SECOND"


LABELS = [(Label.FIRST, Label.SECOND), (1, 2), (0, 1), (1, 0)]


def machine(first: Any, second: Any, **keywords: Any) -> smach.StateMachine:
    with (sm := smach.StateMachine(["done"])):
        smach.StateMachine.add(first, state(), {"done": second})
        smach.StateMachine.add(second, state(), {"done": "done"})
    return sm


def test_callbacks_by_keyword() -> None:
    sm, called = machine("A", "B"), []
    sm.register_start_cb(start_cb=lambda ud, initial: called.append("start"))
    sm.register_transition_cb(transition_cb=lambda ud, active: called.append("transition"))
    sm.register_termination_cb(termination_cb=lambda ud, last, outcome: called.append(outcome))
    sm.execute()
    assert called == ["start", "transition", "done"]


def test_update_by_keyword() -> None:
    ud, more = smach.UserData(), smach.UserData()
    more.key = 1
    ud.update(other_userdata=more)
    view = smach.Remapper(ud, ["key"], ["key"])
    more.key = 2
    view.update(other_userdata=more)
    assert ud.key == 2


def test_cb_state_by_keyword() -> None:
    assert state().execute(ud=smach.UserData()) == "done"


@pytest.mark.parametrize(("first", "second"), LABELS)
def test_labels_that_are_no_plain_strings(first: Any, second: Any) -> None:
    sm, seen = machine(first, second), []
    sm.register_transition_cb(lambda ud, active: seen.append(active))
    assert sm.execute() == "done"
    assert seen == [[second]]
    assert sm.get_initial_states() == [first]
    sm.set_initial_state([second])
    assert sm.execute() == "done"


@pytest.mark.parametrize(("first", "second"), LABELS)
def test_labels_in_other_containers(first: Any, second: Any) -> None:
    with (sequence := smach.Sequence(["done"], "done")):
        smach.Sequence.add(first, state())
        smach.Sequence.add(second, state())
    assert sequence.execute() == "done"
    with (both := smach.Concurrence(["done"], "done", outcome_map={"done": {first: "done"}})):
        smach.Concurrence.add(first, state())
        smach.Concurrence.add(second, state())
    assert both.execute() == "done"
    with (each := smach.Iterator(["done"], [], [], it=[1], exhausted_outcome="done")):
        smach.Iterator.set_contained_state(first, state(), loop_outcomes=["done"])
    assert each.execute() == "done"


def test_outcomes_that_are_numbers() -> None:
    with (sm := smach.StateMachine([0, 1])):  # type: ignore[list-item]
        smach.StateMachine.add("A", state(0), {0: "B"})  # type: ignore[dict-item]
        smach.StateMachine.add("B", state(1))
    assert sm.execute() == 1  # type: ignore[comparison-overlap]


class Logged(smach.UserData):
    """Userdata that keeps a log of item access."""

    def __init__(self) -> None:
        super().__init__()
        self._log: list[str] = []

    def __getitem__(self, key: str) -> Any:
        self._log.append(f"read {key}")
        return super().__getitem__(key)

    def __setitem__(self, key: str, value: Any) -> None:
        self._log.append(f"write {key}")
        super().__setitem__(key, value)


def count(ud: Any) -> str:
    ud.n = ud.n + 1
    return "done"


@pytest.mark.parametrize("compat", [False, True])
def test_item_access_of_a_subclass(compat: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(settings, "compat", compat)
    parent = Logged()
    parent["n"] = 1
    inner = smach.CBState(count, outcomes=["done"], input_keys=["n"], output_keys=["n"])
    with (sm := smach.StateMachine(["done"], ["n"], ["n"])):
        smach.StateMachine.add("A", inner)
    sm.userdata = Logged()
    assert sm.execute(parent) == "done"
    assert parent._log == ["write n", "read n", "write n"]
    assert sm.userdata._log == ["write n", "read n", "write n", "read n"]
    assert smach.Remapper(parent, ["n"]).keys() == ["n"]


def test_state_specification() -> None:
    sm = smach.StateMachine(["done"])
    sm.check_state_spec("A", state(), {"done": "B"})
    with pytest.raises(smach.InvalidTransitionError):
        sm.check_state_spec("A", state(), {"gone": "B"})


def test_an_overridden_check_of_the_specification_is_called() -> None:
    class Checked(smach.StateMachine):
        def check_state_spec(self, label: str, state: smach.State, transitions: Any) -> None:
            raise ValueError(label)

    sm = Checked(["done"])
    with pytest.raises(ValueError, match="A"), sm:
        Checked.add("A", state())
    assert sm._initial_state_label == "A"


def test_settings_by_their_old_modules(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("loginfo", "logwarn", "logdebug", "logerr", "is_shutdown"):
        monkeypatch.setattr(settings, name, getattr(settings, name))
    lines: list[str] = []
    log.set_loggers(lines.append, lines.append, lines.append, lines.append)
    smach.logwarn("seen")
    util.set_shutdown_check(lambda: True)
    assert lines == ["seen"]
    assert util.is_shutdown()
    assert smach.is_shutdown()


def test_constants() -> None:
    class Pose:
        def __init__(self) -> None:
            self.x = 1
            self.parts = [self]

    constant = user_data.get_const(Pose())
    assert isinstance(constant, user_data.Const)
    assert constant.x == 1
    with pytest.raises(TypeError):
        constant.x = 2
    with pytest.raises(TypeError):
        del constant.x
    assert user_data.get_const(3) == 3
    assert user_data.get_const([1]) == [1]


def test_fields_that_extensions_read() -> None:
    seen: list[object] = []

    def look(ud: Any) -> str:
        seen.append((sm._current_label, sm._current_state is sm._states["A"]))
        seen.append(dict(both._child_outcomes))
        return "done"

    with (both := smach.Concurrence(["done"], "done")):
        smach.Concurrence.add("X", smach.CBState(look, outcomes=["done"]))
    with (sm := smach.StateMachine(["done"])):
        smach.StateMachine.add("A", both, {"done": "done"})
    assert sm._current_label is None
    assert sm._current_state is None
    assert sm._initial_state_label == "A"
    assert sm._transitions == {"A": {"done": "done"}}
    assert both._child_outcomes == {}
    assert sm.execute() == "done"
    assert seen == [("A", True), {"X": None}]
    assert both._states.keys() == {"X"}
