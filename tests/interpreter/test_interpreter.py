"""State machines, sequences, iterators and userdata in the interpreter."""

from __future__ import annotations

from typing import Any

import pytest

from smachac.diagnostics.source import Source, Span
from smachac.interpreter.interpreter import Interpreter, run
from smachac.interpreter.userdata import Userdata
from smachac.ir.nodes import Leaf, Machine, StateMachine
from tests.support.ir_machines import iterator, leaf, machine, ran, sequence, short


def test_events_of_a_nested_machine_come_in_order() -> None:
    inner = machine("B", "yes", leaf("C", {"done": "yes"}, outs="k"), to={"yes": "end"})

    def write(userdata: Userdata) -> str:
        userdata["k"] = (1, 2)
        return "done"

    result, events = ran(machine("sm", "end", leaf("A", {"go": "B"}), inner), {"C": write})
    assert result.outcome == "end"
    assert short(events) == [
        "start sm",
        "enter sm/A",
        "exit sm/A go",
        "transition sm/A go -> sm/B",
        "enter sm/B",
        "enter sm/B/C",
        "write sm/B/C k [1, 2]",
        "exit sm/B/C done",
        "transition sm/B/C done -> sm/B:yes",
        "exit sm/B yes",
        "transition sm/B yes -> sm:end",
        "finish sm end",
    ]
    assert [event["seq"] for event in events] == list(range(1, len(events) + 1))


def test_events_carry_the_place_in_the_script() -> None:
    source = Source("scripts/pick/main.yml", "name: sm\nstates:\n- A:\n")
    node = Leaf(name="A", type="T", open=True, span=Span(source, 19, 20))
    events: list[dict[str, Any]] = []
    root = machine("sm", "end", node)
    run(Machine(root=root), lambda *_: "end", events.append)
    assert "src" not in events[0]
    assert (events[1]["path"], events[1]["src"]) == ("sm/A", "main.yml:3")
    assert list(events[1]) == ["seq", "event", "path", "t", "src"]


def test_m1_starts_at_the_initial_state() -> None:
    root = machine("sm", "end", leaf("A", {"x": "end"}), leaf("B", {"x": "end"}), initial="B")
    assert "enter sm/A" not in short(ran(root)[1])


def test_m5_a_transition_to_itself_enters_again() -> None:
    root = machine("sm", "end", leaf("A", {"again": "A", "done": "end"}))
    result, events = ran(root, {"A": ["again", "again", "done"]})
    assert (result.outcome, result.steps) == ("end", 3)
    assert short(events)[3] == "transition sm/A again -> sm/A"


def test_m7_a_name_of_a_state_and_an_outcome_means_the_state() -> None:
    def root(to: str) -> Any:
        return machine("sm", "B end", leaf("A", {"B": to}), leaf("B", {"x": "end"}))

    assert ran(root("B"))[0].outcome == "end"
    assert ran(root("=B"))[0].outcome == "B"


@pytest.mark.parametrize(
    ("root", "outcome", "kind", "path"),
    [
        (machine("sm", "end"), "x", "no-state", "sm"),
        (machine("sm", "end", machine("A", "x", to={"x": "end"})), "x", "no-state", "sm/A"),
        (machine("sm", "end", leaf("A", {"x": "end"}), initial="B"), "x", "no-target", "sm"),
        (machine("sm", "end", leaf("A", {"x": "nowhere"})), "x", "no-target", "sm/A"),
        (machine("sm", "end", leaf("A", outcomes="x")), "x", "no-transition", "sm/A"),
        (machine("sm", "end", leaf("A", {"x": "end"}, open=True)), "y", "no-transition", "sm/A"),
        (machine("sm", "end", leaf("A", {"x": "end"})), "y", "undeclared-outcome", "sm/A"),
    ],
)
def test_a_graph_that_leads_nowhere_is_an_error(
    root: StateMachine, outcome: str, kind: str, path: str
) -> None:
    result, events = ran(root, {"A": outcome})
    assert result.outcome is None
    assert result.error is not None
    assert (result.error.kind, result.error.path) == (kind, path)
    assert short(events)[-1] == f"error {path} {result.error.message}"


def test_m9_v4_an_exception_ends_the_run_and_keeps_outputs_inside() -> None:
    def fail(userdata: Userdata) -> str:
        userdata["k"] = 1
        raise RuntimeError("stuck")

    inner = machine("B", "x", leaf("C", {"x": "x"}, outs="k"), outs="k", to={"x": "end"})
    result, events = ran(machine("sm", "end", inner), {"C": fail})
    assert result.error is not None
    assert (result.error.kind, result.error.path) == ("behaviour", "sm/B/C")
    assert result.error.message == "RuntimeError: stuck"
    assert result.scopes == {"sm": {}, "sm/B": {"k": 1}}
    assert short(events)[-2:] == ["write sm/B/C k 1", "error sm/B/C RuntimeError: stuck"]


def test_a_machine_without_end_is_stopped() -> None:
    root = machine("sm", "end", leaf("A", {"x": "A"}))
    result, _ = ran(root, max_steps=10)
    assert str(result.error) == "sm/A: did not end after 10 states"
    assert result.error is not None
    assert result.error.kind == "no-end"
    assert result.steps == 10


def test_a_machine_that_loops_without_leaves_is_stopped() -> None:
    empty = iterator("A", "exhausted", leaf("B", outcomes="x"), items=[], to={"exhausted": "A"})
    result, _ = ran(machine("sm", "end", empty), max_steps=10)
    assert result.error is not None
    assert result.error.kind == "no-end"


def test_q1_a_sequence_follows_its_transitions() -> None:
    steps = sequence("S", "ok", "ok", leaf("A", {"ok": "B"}), leaf("B", {"ok": "ok"}))
    root = machine("sm", "ok", steps)
    result, events = ran(machine("sm", "ok", *root.children))
    assert result.error is not None
    assert result.error.kind == "no-transition"
    assert "transition sm/S/B ok -> sm/S:ok" in short(events)


def test_m14_v3_userdata_and_visits_stay_between_runs() -> None:
    seen: list[int] = []

    def count(path: str, node: Leaf, visit: int, userdata: Userdata) -> str:
        seen.append(visit)
        userdata["n"] = [*userdata["n"], visit] if "n" in userdata else [visit]  # type: ignore[misc]
        return "x"

    root = machine("sm", "x", leaf("A", {"x": "x"}, ins="n", outs="n"))
    interpreter = Interpreter(Machine(root=root), count)
    first, second = interpreter.execute(), interpreter.execute()
    assert seen == [1, 2]
    assert (first.userdata, second.userdata) == ({"n": [1]}, {"n": [1, 2]})


def reading(*keys: str) -> Any:
    def read(userdata: Userdata) -> str:
        for key in keys:
            userdata[key]
        return "x"

    return read


@pytest.mark.parametrize(
    ("ins", "remaps", "kind", "message"),
    [
        ("k", {}, "missing-key", "reads `k`, which holds nothing"),
        ("k", {"k": "j"}, "missing-key", "reads `k` (`j` of its container), which holds nothing"),
        ("", {}, "undeclared-read", "reads `k`, which is not one of its inputs"),
    ],
)
def test_r2_r3_what_is_absent_or_undeclared_cannot_be_read(
    ins: str, remaps: Any, kind: str, message: str
) -> None:
    root = machine("sm", "x", leaf("A", {"x": "x"}, ins=ins, outs="k", remaps=remaps))
    result, _ = ran(root, {"A": reading("k")})
    assert result.error is not None
    assert (result.error.kind, result.error.message) == (kind, message)


def test_r4_a_write_to_an_undeclared_key_is_dropped() -> None:
    def write(userdata: Userdata) -> str:
        userdata["k"] = 1
        return "x"

    root = machine("sm", "x", leaf("A", {"x": "x"}, ins="k"), held={"k": 0})
    result, events = ran(root, {"A": write})
    assert result.userdata == {"k": 0}
    assert not [event for event in events if event["event"] == "write"]


def test_r5_r6_remapping_is_one_step_and_may_swap() -> None:
    def swap(userdata: Userdata) -> str:
        assert ("a" in userdata, "c" in userdata, userdata.keys()) == (True, False, ["a", "b"])
        userdata["a"], userdata["b"] = userdata["b"], userdata["a"]
        return "x"

    node = leaf("A", {"x": "x"}, ins="a b", outs="a b", remaps={"a": "b", "b": "a", "c": "a"})
    result, events = ran(machine("sm", "x", node, held={"a": 1, "b": 2}), {"A": swap})
    assert result.userdata == {"a": 2, "b": 1}
    assert short(events)[2:4] == ["write sm/A a 1", "write sm/A b 2"]


def test_an_open_leaf_sees_every_key() -> None:
    def work(userdata: Userdata) -> str:
        assert userdata.keys() == ["inner", "k"]
        userdata["new"] = userdata["inner"]
        return "anything"

    node = leaf("A", {"anything": "x"}, outcomes="x", open=True, remaps={"inner": "outer"})
    result, _ = ran(machine("sm", "x", node, held={"outer": 7, "k": 1}), {"A": work})
    assert result.userdata == {"outer": 7, "k": 1, "new": 7}


def test_v1_v4_v5_a_container_copies_what_it_declares() -> None:
    def work(userdata: Userdata) -> str:
        userdata["made"] = userdata["given"]
        userdata["hidden"] = 3
        return "x"

    inside = leaf("B", {"x": "x"}, ins="given", outs="made hidden")
    inner = machine(
        "A",
        "x",
        inside,
        ins="given absent",
        outs="made never",
        remaps={"given": "g", "made": "m"},
        held={"given": 0, "absent": 5},
        to={"x": "x"},
    )
    result, _ = ran(machine("sm", "x", inner, held={"g": 9}), {"B": work})
    assert result.userdata == {"g": 9, "m": 9}
    assert result.scopes["sm/A"] == {"given": 9, "absent": 5, "made": 9, "hidden": 3}


def test_v6_values_are_shared() -> None:
    def push(userdata: Userdata) -> str:
        items = userdata["items"]
        assert isinstance(items, list)
        items.append(1)
        return "x"

    inner = machine("A", "x", leaf("B", {"x": "x"}, ins="items"), ins="items", to={"x": "x"})
    assert ran(machine("sm", "x", inner, held={"items": []}), {"B": push})[0].userdata == {
        "items": [1]
    }
    fresh = ran(machine("sm", "x", inner, held={"items": []}), {"B": "x"})[0].userdata
    assert fresh == {"items": []}


def test_v7_a_parent_gives_inputs_and_gets_outputs() -> None:
    def double(userdata: Userdata) -> str:
        userdata["n"] = str(userdata["n"]) * 2
        return "x"

    root = machine("sm", "x", leaf("A", {"x": "x"}, ins="n", outs="n"), ins="n", outs="n")
    parent: dict[str, object] = {"n": "a"}
    Interpreter(Machine(root=root), lambda p, n, v, u: double(u)).execute(parent)
    assert parent == {"n": "aa"}


def test_i2_i5_an_iterator_runs_its_child_for_each_item() -> None:
    child = leaf("C", outcomes="next stop")
    each = iterator(
        "I",
        "none stop",
        child,
        items=["a", "b"],
        item_key="item",
        loop="next",
        final={"exhausted": "none", "next": "wrong"},
        to={"none": "end", "stop": "end"},
    )
    seen = []

    def look(userdata: Userdata) -> str:
        seen.append(userdata["item"])
        return "next"

    result, events = ran(machine("sm", "end", each), {"C": look})
    assert seen == ["a", "b"]
    assert result.scopes["sm/I"] == {"item": "b"}
    transitions = [line for line in short(events) if line.startswith("transition")]
    assert transitions == [
        "transition sm/I/C next -> sm/I/C",
        "transition sm/I/C next -> sm/I:none",
        "transition sm/I none -> sm:end",
    ]
    _, events = ran(machine("sm", "end", each), {"C": "stop"})
    assert "transition sm/I/C stop -> sm/I:stop" in short(events)


def test_i2_no_items_end_at_once() -> None:
    each = iterator("I", "exhausted", leaf("C", outcomes="x"), items=[], to={"exhausted": "end"})
    result, events = ran(machine("sm", "end", each))
    assert result.outcome == "end"
    assert not [event for event in events if event["path"] == "sm/I/C"]


def test_i7_i8_the_child_of_an_iterator_sees_every_key_and_items_come_from_userdata() -> None:
    def work(userdata: Userdata) -> str:
        userdata["sum"] = int(str(userdata["sum"])) + int(str(userdata["it_data"]))
        return "next"

    each = iterator(
        "I",
        "exhausted",
        leaf("C", outcomes="next"),
        items_key="todo",
        loop="next",
        ins="todo sum",
        outs="sum",
        to={"exhausted": "end"},
    )
    root = machine("sm", "end", each, held={"todo": [1, 2, 4], "sum": 0})
    assert ran(root, {"C": work})[0].userdata["sum"] == 7


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"items_key": "todo"}, "finds no items: its userdata has no `todo`"),
        ({"items_key": "n"}, "its items cannot be gone through: 3"),
        ({}, "its items cannot be gone through: None"),
    ],
)
def test_items_that_are_none_are_an_error(options: Any, message: str) -> None:
    each = iterator("I", "exhausted", leaf("C", outcomes="x"), held={"n": 3}, **options)
    result, _ = ran(machine("sm", "end", each))
    assert result.error is not None
    assert (result.error.kind, result.error.path) == ("no-items", "sm/I")
    assert result.error.message == message


def test_userdata_given_to_a_run_goes_over_presets() -> None:
    root = machine("sm", "x", leaf("A", {"x": "x"}), held={"k": 1, "j": [1, {"a": None}]})
    result, _ = ran(root, userdata={"k": 2})
    assert result.userdata == {"k": 2, "j": [1, {"a": None}]}


def test_values_that_json_cannot_say_are_shown_by_repr() -> None:
    def write(userdata: Userdata) -> str:
        for given in (object(), float("nan"), {1: (2,)}):
            userdata["k"] = given
        return "x"

    _, events = ran(machine("sm", "x", leaf("A", {"x": "x"}, outs="k")), {"A": write})
    shown = [event["value"] for event in events if event["event"] == "write"]
    assert shown == ["<object object>", "nan", {"1": [2]}]


def test_two_hundred_machines_inside_one_another_run() -> None:
    node: Any = leaf("L", {"x": "x"})
    for depth in range(200):
        node = machine(f"M{depth}", "x", node, to={"x": "x"})
    result, events = ran(machine("sm", "x", node))
    assert result.outcome == "x"
    assert len(events) == 2 + 201 * 3


def test_i7_the_state_of_an_iterator_is_not_remapped() -> None:
    each = iterator(
        "I",
        "none",
        leaf("L", outcomes="next", ins="x", remaps={"x": "it_data"}),
        items=[7],
        exhausted="none",
        loop="next",
        to={"none": "end"},
    )

    def read(userdata: Userdata) -> str:
        return str(userdata["x"])

    result, _ = ran(machine("sm", "end", each), {"L": read})
    assert result.error is not None
    assert result.error.kind == "missing-key"
