"""State, CBState and declared callbacks, errors and loggers: rules S1 to S8, E1, L1, L3."""

from __future__ import annotations

import pickle
from collections.abc import Iterator
from typing import Any

import pytest

from smachac.runtime import smach


@pytest.fixture
def _hooks_restored() -> Iterator[None]:
    loggers = smach.loginfo, smach.logwarn, smach.logdebug, smach.logerr
    check = smach.is_shutdown
    yield
    smach.set_loggers(*loggers)
    smach.set_shutdown_check(check)


def test_keys_and_outcomes_are_sets_in_order() -> None:
    state = smach.State(["b", "a", "b"], ["i"], ["o"], ["io"])
    assert state.get_registered_outcomes() == ("b", "a")
    assert state.get_registered_input_keys() == ("i", "io")
    assert state.get_registered_output_keys() == ("o", "io")
    state.register_outcomes(["c"])
    state.register_input_keys(["i2"])
    state.register_output_keys(["o2"])
    state.register_io_keys(["io2"])
    assert state.get_registered_outcomes() == ("b", "a", "c")
    assert state.get_registered_input_keys() == ("i", "io", "i2", "io2")
    assert state.get_registered_output_keys() == ("o", "io", "o2", "io2")


def test_everything_is_optional() -> None:
    state = smach.State()
    assert state.get_registered_outcomes() == ()
    with pytest.raises(NotImplementedError):
        state.execute(smach.UserData())


@pytest.mark.parametrize("keys", [("a",), {"a"}, "a"])
def test_keys_must_be_lists(keys: Any) -> None:
    with pytest.raises(TypeError):
        smach.State(["done"], input_keys=keys)
    with pytest.raises(TypeError):
        smach.State(["done"], output_keys=keys)


def test_outcomes_may_be_any_iterable() -> None:
    assert smach.State("ab").get_registered_outcomes() == ("a", "b")


def test_preempt_flag() -> None:
    state = smach.State(["done"])
    for clear in (state.service_preempt, state.recall_preempt):
        state.request_preempt()
        assert state.preempt_requested()
        clear()
        assert not state.preempt_requested()


def test_cb_state_passes_arguments() -> None:
    calls: list[Any] = []

    def work(ud: smach.UserData, *args: int, **kwargs: int) -> str:
        calls.append((ud, args, kwargs))
        return "done"

    state = smach.CBState(work, [1, 2], {"three": 3}, outcomes=["done"], io_keys=["k"])
    ud = smach.UserData()
    assert state.execute(ud) == "done"
    assert calls == [(ud, (1, 2), {"three": 3})]
    assert state.get_registered_input_keys() == ("k",)


def test_cb_state_takes_over_a_declared_interface() -> None:
    @smach.cb_interface(outcomes=["done"], input_keys=["x"], output_keys=["y"])
    def work(ud: smach.UserData) -> str:
        ud.y = ud.x + 1
        return "done"

    assert smach.has_smach_interface(work)
    assert not smach.has_smach_interface(len)
    state = smach.CBState(work, outcomes=["more"], input_keys=["z"])
    assert state.get_registered_outcomes() == ("more", "done")
    assert state.get_registered_input_keys() == ("z", "x")
    assert state.get_registered_output_keys() == ("y",)
    ud = smach.UserData()
    ud.x = 1
    assert work(ud) == "done"
    assert ud.y == 2


def test_cb_interface_keeps_io_keys() -> None:
    declared = smach.CBInterface(len, ["done"], ["i"], ["o"], ["io"])
    assert declared.get_registered_input_keys() == ("i", "io")
    assert declared.get_registered_output_keys() == ("o", "io")


@pytest.mark.parametrize(
    "kind",
    [
        smach.InvalidStateError,
        smach.InvalidTransitionError,
        smach.InvalidConstructionError,
        smach.InvalidUserCodeError,
    ],
)
def test_errors_are_logged_where_they_are_made_as_in_smach_only_with_compat(
    kind: type[smach.exceptions.SmachError], monkeypatch: pytest.MonkeyPatch
) -> None:
    errors: list[str] = []
    monkeypatch.setattr(smach, "logerr", errors.append)
    kind("reported by the code that catches it")
    assert not errors
    monkeypatch.setattr(smach, "compat", True)
    error = kind("what went wrong")
    assert errors == [f"{kind.__name__}: what went wrong"]
    assert isinstance(error, smach.exceptions.SmachError)
    assert str(pickle.loads(pickle.dumps(error))) == "what went wrong"
    with pytest.raises(TypeError):
        kind()  # type: ignore[call-arg]


def test_default_loggers_print_a_line_but_for_debugging(
    capsys: pytest.CaptureFixture[str],
) -> None:
    for logger in (smach.loginfo, smach.logwarn, smach.logdebug, smach.logerr):
        logger("a message")
    lines = capsys.readouterr().out.splitlines()
    assert lines == ["[ INFO ] a message", "[ WARN ] a message", "[ ERROR ] a message"]


@pytest.mark.usefixtures("_hooks_restored")
def test_loggers_are_set_in_the_order_info_warn_debug_error() -> None:
    seen: list[str] = []
    smach.set_loggers(*(lambda m, n=name: seen.append(n + m) for name in "iwde"))
    smach.loginfo("1")
    smach.logwarn("2")
    smach.logdebug("3")
    smach.logerr("4")
    assert seen == ["i1", "w2", "d3", "e4"]


@pytest.mark.usefixtures("_hooks_restored")
def test_a_logger_that_does_nothing_is_recognised() -> None:
    smach.set_loggers(lambda *a: None, print, print, print)
    assert smach.loginfo is smach.log.quiet
    smach.set_loggers(print, print, print, print)
    assert smach.loginfo is print


@pytest.mark.usefixtures("_hooks_restored")
def test_shutdown_check() -> None:
    assert smach.is_shutdown() is False
    smach.set_shutdown_check(lambda: True)
    assert smach.is_shutdown() is True
