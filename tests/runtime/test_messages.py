"""Exceptions of user code that cannot be printed: the runtime names their type."""

from __future__ import annotations

import pytest

from smachac.runtime import smach
from smachac.runtime.messages import message_of
from smachac.runtime.tracing import trace


class UnprintableError(Exception):
    """An exception whose `__str__` raises."""

    def __str__(self) -> str:
        raise RuntimeError("no text")


def broken(userdata: object) -> str:
    raise UnprintableError


def test_the_message_of_an_exception() -> None:
    assert message_of(ValueError("too far")) == "too far"
    assert message_of(UnprintableError()) == ""


def test_a_branch_that_raises_one_is_named() -> None:
    both = smach.Concurrence(["done"], "done")
    with both:
        smach.Concurrence.add("LEFT", smach.CBState(broken, outcomes=["done"]))
    with pytest.raises(smach.InvalidStateError, match="failed: UnprintableError"):
        both.execute()


def test_a_construction_that_raises_one_goes_on_outwards() -> None:
    machine = smach.StateMachine(["done"])
    with pytest.raises(UnprintableError), machine:
        raise UnprintableError
    assert not machine.is_opened()


def test_an_observer_that_raises_one_ends_the_trace_only(
    capsys: pytest.CaptureFixture[str],
) -> None:
    machine = smach.StateMachine(["done"])
    with machine:
        smach.StateMachine.add("A", smach.CBState(lambda ud: "done", outcomes=["done"]))

    def observe(event: trace.Event) -> None:
        raise UnprintableError

    trace.attach(machine, "sm", observe)
    assert machine.execute() == "done"
    assert "the trace stops here: UnprintableError" in capsys.readouterr().err
