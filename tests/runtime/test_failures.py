"""Failures of user code: the state that failed, the lines of user code, the missing key."""

from __future__ import annotations

import traceback
from collections.abc import Iterator
from typing import Any

import pytest

from smachac.runtime import smach
from smachac.runtime.smach.failures import RUNTIME
from smachac.targets.python.runner import failure_text


def divide() -> float:
    return 1 / 0


class Grasp(smach.State):
    def __init__(self) -> None:
        super().__init__(["done"], input_keys=["pose", "width"])

    def execute(self, userdata: Any) -> str:
        divide()
        return "done"


class Reads(Grasp):
    """Reads a key by its name."""

    def __init__(self, key: str) -> None:
        super().__init__()
        self.key = key

    def execute(self, userdata: Any) -> str:
        userdata[self.key]
        return "done"


class Renamed(Grasp):
    def execute(self, userdata: Any) -> str:
        try:
            divide()
        except ZeroDivisionError as error:
            raise RuntimeError("no grasp\nis possible") from error
        return "done"


@pytest.fixture
def logged() -> Iterator[list[str]]:
    """The lines of the error log."""
    lines: list[str] = []
    before = smach.loginfo, smach.logwarn, smach.logdebug, smach.logerr
    smach.set_loggers(before[0], before[1], before[2], lines.append)
    yield lines
    smach.set_loggers(*before)


def nested(leaf: smach.State, remapping: dict[str, str] | None = None) -> smach.StateMachine:
    """A machine with the leaf GRASP in an iterator in a concurrence in a concurrence."""
    root = smach.StateMachine(["done"])
    root.userdata.pose = 1
    outer = smach.Concurrence(["done"], "done", input_keys=["pose"])
    inner = smach.Concurrence(["done"], "done", input_keys=["pose"])
    each = smach.Iterator(["done"], ["pose"], [], it=[1])
    machine = smach.StateMachine(["done"], input_keys=["pose"])
    with root:
        smach.StateMachine.add("OUTER", outer)
        with outer:
            smach.Concurrence.add("INNER", inner)
            with inner:
                smach.Concurrence.add("EACH", each)
                with each:
                    smach.Iterator.set_contained_state("ITEM", machine, loop_outcomes=["done"])
                    with machine:
                        smach.StateMachine.add("GRASP", leaf, remapping=remapping)
    return root


def failure(leaf: smach.State, remapping: dict[str, str] | None = None) -> BaseException:
    with pytest.raises(smach.InvalidUserCodeError) as caught:
        nested(leaf, remapping).execute()
    return caught.value


def test_the_error_names_the_state_that_failed(logged: list[str]) -> None:
    error = failure(Grasp())
    assert str(error) == ("state 'GRASP' of type Grasp failed: ZeroDivisionError: division by zero")
    assert isinstance(error.__cause__, ZeroDivisionError)


@pytest.mark.parametrize("compat", [False, True])
def test_only_lines_of_user_code_are_in_the_traceback_and_the_log(
    compat: bool, logged: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(smach, "compat", compat)
    error = failure(Grasp())
    frames = traceback.extract_tb(error.__cause__.__traceback__ if error.__cause__ else None)
    assert [frame.name for frame in frames] == ["execute", "divide"]
    shown = "".join(traceback.format_exception(error))
    assert shown.count(RUNTIME) == 1  # the call by which user code runs the machine
    with_lines = [line for line in logged if "return 1 / 0" in line]
    assert len(with_lines) == compat  # otherwise only the code that catches the error reports it
    assert RUNTIME not in "".join(logged)


@pytest.mark.parametrize(
    ("key", "remapping", "message"),
    [
        ("width", {}, "KeyError: userdata key 'width' is absent; present: ['pose']"),
        (
            "width",
            {"width": "posee"},
            "KeyError: userdata key 'width' ('posee' of the container) is absent; did you mean"
            " 'pose'? present: ['pose']",
        ),
        (
            "widht",
            {},
            "InvalidUserCodeError: userdata key 'widht' is read, but is no input key; did you mean"
            " 'width'? input keys: ['pose', 'width']",
        ),
    ],
)
def test_the_missing_key_is_named(
    logged: list[str], key: str, remapping: dict[str, str], message: str
) -> None:
    error = failure(Reads(key), remapping)
    assert str(error) == f"state 'GRASP' of type Reads failed: {message}"
    assert failure_text(error).splitlines()[0] == message
    assert isinstance(error.__cause__, KeyError | smach.InvalidUserCodeError)


def test_a_cause_within_user_code_comes_after_the_lines(logged: list[str]) -> None:
    lines = failure_text(failure(Renamed())).splitlines()
    assert lines[0] == "RuntimeError: no grasp"
    assert lines[1].endswith('raise RuntimeError("no grasp\\nis possible") from error')
    assert lines[2:] == ["  caused by ZeroDivisionError: division by zero"]


def test_a_callback_that_fails_is_named(logged: list[str]) -> None:
    both = smach.Concurrence(["done"], "done", outcome_cb=lambda outcomes: str(1 / 0))
    with both:
        smach.Concurrence.add("A", smach.CBState(lambda userdata: "done", outcomes=["done"]))
    with pytest.raises(smach.InvalidUserCodeError) as caught:
        both.execute()
    assert str(caught.value) == "outcome_cb failed: ZeroDivisionError: division by zero"
