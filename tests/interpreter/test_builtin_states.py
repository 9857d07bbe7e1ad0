"""What the built-in state types do in the interpreter."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pytest

from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.result import InterpreterResult
from tests.support.ir_machines import leaf, machine, ran, short


def single(
    type: str, outcomes: str, *, held: Mapping[str, Any] = {}, seed: int = 0, **more: Any
) -> InterpreterResult:
    """The run of a machine of one leaf, whose outcomes are those of the machine."""
    to = {name: name for name in outcomes.split()}
    root = machine("sm", outcomes, leaf("A", to, type=type, **more), held=held)
    return ran(root, builtin_behaviour(seed), seed=seed)[0]


def message(result: InterpreterResult) -> str:
    assert result.error is not None
    assert result.error.kind == "behaviour"
    return result.error.message


@pytest.mark.parametrize(
    ("outcomes", "outcome"),
    [("aborted succeeded", "succeeded"), ("no true", "true"), ("left right", "left")],
)
def test_an_unknown_type_ends_well_if_it_can(outcomes: str, outcome: str) -> None:
    assert single("MoveIt", outcomes).outcome == outcome


def test_an_open_leaf_without_outcomes_ends_along_a_transition() -> None:
    node = leaf("A", {"found": "end"}, open=True)
    root = machine("sm", "end", node)
    assert ran(root, builtin_behaviour())[0].outcome == "end"


def test_a_scripted_state_takes_a_step_at_each_visit() -> None:
    steps = [{"outcome": "again", "set": {"k": [1]}}, {"outcome": "done", "set": {"k": 2, "j": 3}}]
    node = leaf("A", {"again": "A", "done": "end"}, type="ScriptedState", outs="j k", steps=steps)
    result, events = ran(machine("sm", "end", node), builtin_behaviour())
    assert result.outcome == "end"
    assert [line for line in short(events) if line.startswith("write")] == [
        "write sm/A k [1]",
        "write sm/A k 2",
        "write sm/A j 3",
    ]


@pytest.mark.parametrize("type", ["CallbacksState", "RandomOutcomeState", "DeleteFileState"])
def test_callbacks_are_called_first_in_the_order_of_their_keys(type: str) -> None:
    code = {"b": "`lambda ud: ud.a + 1`", "a": "`lambda ud: 1`"}
    node = leaf("A", {"x": "end"}, type=type, ins="a", outs="a b", callbacks=code)
    result, events = ran(machine("sm", "end", node, held={"a": 0}), builtin_behaviour())
    assert result.outcome == "end"
    lines = [line for line in short(events) if line.startswith("write")]
    assert lines == ["write sm/A a 1", "write sm/A b 2"]


def test_the_last_step_repeats_and_no_steps_are_the_first_outcome() -> None:
    assert single("ScriptedState", "b succeeded").outcome == "b"
    node = leaf("A", {"x": "A"}, type="ScriptedState", steps=[{"outcome": "x"}])
    result, _ = ran(machine("sm", "end", node), builtin_behaviour(), max_steps=3)
    assert result.steps == 3


def test_callbacks_run_in_the_order_of_their_keys() -> None:
    result = single(
        "CallbacksState",
        "succeeded",
        ins="n m",
        outs="n m",
        remaps={"m": "other"},
        held={"n": 1, "other": 5},
        callbacks={"n": "`lambda ud: ud.n + ud.m`", "m": "`lambda: 10`"},
    )
    assert result.userdata == {"n": 11, "other": 10}


@pytest.mark.parametrize(
    ("level", "outcome"), [(5, "low"), (15, "middle"), (50, "high"), (30, "high")]
)
def test_the_first_true_condition_in_the_order_of_the_outcomes_wins(
    level: int, outcome: str
) -> None:
    result = single(
        "ConditionalOutcomeState",
        "low middle high",
        ins="level",
        held={"level": level},
        callbacks={"middle": "`lambda ud: ud.level < 20`", "low": "`lambda ud: ud.level < 10`"},
        default_outcome="high",
    )
    assert result.outcome == outcome


@pytest.mark.parametrize(
    ("type", "variables", "text"),
    [
        ("CallbacksState", {"callbacks": {"n": "`[x for x in y]`"}}, "Python code, which is not"),
        ("CallbacksState", {"callbacks": {"n": "`lambda ud: 1 / 0`"}}, "ZeroDivisionError"),
        ("CallbacksState", {"callbacks": {"n": 3}}, "the callback `n` is no expression"),
        ("CallbacksState", {"callbacks": [1]}, "`callbacks` is no mapping"),
        ("ConditionalOutcomeState", {"callbacks": {}}, "there is no `default_outcome`"),
        ("SleepState", {}, "`time` is no number of seconds"),
        ("ScriptedState", {"steps": [1]}, "step 1 is no mapping"),
    ],
)
def test_what_cannot_be_done_is_an_error(type: str, variables: Any, text: str) -> None:
    assert text in message(single(type, "succeeded", outs="n", **variables))


@pytest.mark.parametrize(("ins", "kind"), [("n", "missing-key"), ("", "undeclared-read")])
def test_a_key_that_a_callback_may_not_read_is_named(ins: str, kind: str) -> None:
    callbacks = {"n": "`lambda ud: ud.n + 1`"}
    result = single("CallbacksState", "succeeded", ins=ins, outs="n", callbacks=callbacks)
    assert result.error is not None
    assert result.error.kind == kind
    assert "`n`" in result.error.message


def drawn(runs_seed: int = 0, names: str = "A", **variables: Any) -> list[str]:
    """What random leaves end with on the way through twenty visits of each."""
    nodes = [
        leaf(
            name,
            dict.fromkeys(("left", "right"), following),
            type="RandomOutcomeState",
            **variables,
        )
        for name, following in zip(names, names[1:] + names[:1], strict=True)
    ]
    events = ran(
        machine("sm", "end", *nodes), builtin_behaviour(runs_seed), max_steps=20 * len(names)
    )[1]
    return [event["outcome"] for event in events if event["event"] == "exit"]


def test_random_outcomes_follow_the_seed() -> None:
    assert set(drawn()) == {"left", "right"}
    assert drawn(1) == drawn(1) != drawn(2)
    assert drawn(1, seed=5) == drawn(2, seed=5) != drawn(1)
    both = drawn(1, "AB")
    assert both[::2] == drawn(1) != both[1::2]
    same = drawn(1, "AB", seed=0)
    assert same[::2] == same[1::2] == drawn(2, seed=0)


def test_sleep_takes_virtual_time() -> None:
    result = single("SleepState", "succeeded", time=2.5)
    assert (result.outcome, result.time) == ("succeeded", 2.5)


def test_a_leaf_that_was_asked_to_stop_says_preempted() -> None:
    node = leaf("A", {"succeeded": "end", "preempted": "stopped"})
    root = machine("sm", "end stopped", node)
    assert ran(root, builtin_behaviour(), preempt_at=[1])[0].outcome == "stopped"
    assert ran(root, builtin_behaviour())[0].outcome == "end"


def test_expressions_that_need_the_robot_stand_for_themselves() -> None:
    node = leaf(
        "A",
        {"x": "x"},
        type="ScriptedState",
        outs="k",
        steps=[{"outcome": "x", "set": {"k": "`rospy.Time.now()`"}}],
    )
    root = machine("sm", "x", node, held={"sum": "`1 + 1`", "f": "`lambda: 1`"})
    result, events = ran(root, builtin_behaviour())
    assert result.userdata["sum"] == 2
    assert "write sm/A k 'rospy.Time.now()'" in short(events)
