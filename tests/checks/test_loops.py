"""Unbounded loops in machines made by hand, and the loops that are fine."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from smachac.diagnostics.diagnostic import Severity
from smachac.ir.nodes import Leaf, Node, StateMachine
from smachac.ir.types import Type
from tests.support.ir_machines import iterator, leaf, machine, value
from tests.support.rule_findings import blocking, found, looping, one, report
from tests.trust.project_text import analysed

RETRY = {"ok": "done", "failed": "A"}


@pytest.mark.parametrize(
    "children",
    [
        [leaf("A", RETRY)],
        [blocking(leaf("A", RETRY))],
        [leaf("A", {**RETRY, "preempted": "done"})],
        [leaf("A", {"ok": "done", "failed": "B"}), leaf("B", {"ok": "A", "preempted": "done"})],
        [leaf("A", {"ok": "done", "failed": "B"}), leaf("B", {"ok": "A", "failed": "A"})],
        [leaf("A", {"ok": "B", "failed": "A"}), leaf("B", {"again": "A", "ok": "done"})],
        [leaf("A", {"done": "done", "failed": "A"}, open=True)],
    ],
    ids=["self", "blocking", "preempted", "recovery", "recovery fails", "in a bigger loop", "open"],
)
def test_tries_without_a_bound(children: list[Node]) -> None:
    assert found(machine("sm", "done", *children), "SM204") == ["SM204 sm/A"]


@pytest.mark.parametrize(
    "children",
    [
        [leaf("A", {**RETRY, "error": "done"})],
        [leaf("A", {"ok": "done", "failed": "B"}), leaf("B", {"go": "A", "enough": "done"})],
        [leaf("A", {"ok": "done", "failed": "B"}), leaf("B", {"ok": "A", "failed": "done"})],
        [leaf("A", {"no": "A", "yes": "done"})],
        [leaf("A", {"ok": "B"}), leaf("B", {"below": "A", "enough": "done"})],
        [leaf("A", {"ok": "done", "failed": "B"}), leaf("B", {"ok": "done"})],
        [leaf("A", {"ok": "A", "failed": "done"})],
        [leaf("A", {"failed": "A"}, outcomes="failed", open=True)],
    ],
    ids=[
        "another failure leaves", "counter", "recovery gives up", "poll", "count up", "no loop",
        "success loops", "open, with unknown outcomes",
    ],
)  # fmt: skip
def test_loops_that_are_bounded_or_not_known(children: list[Node]) -> None:
    assert found(machine("sm", "done", *children), "SM204") == []


def test_the_witness_of_a_retry_leads_round() -> None:
    root = machine("sm", "done", leaf("GO", {"x": "A"}), leaf("B", {"x": "A"}),
                   leaf("A", {"ok": "done", "failed": "B"}))  # fmt: skip
    item = one(root, "SM204")
    assert item.finding.path_labels == ("A", "(failed)", "B", "(x)", "A")
    assert item.severity is Severity.WARNING


def test_the_last_to_be_tried_again_is_named() -> None:
    ask = blocking(leaf("ASK", {"yes": "A", "no": "done", "timeout": "ASK"}))
    root = machine("sm", "done", leaf("A", {"ok": "done", "failed": "ASK"}), ask)
    assert found(root, "SM204") == ["SM204 sm/ASK"]


def test_a_machine_that_goes_on_must_wait_somewhere() -> None:
    def pair(first: Leaf, second: Node) -> StateMachine:
        return looping(machine("sm", "", first, second))

    a, b = leaf("A", {"x": "B"}), leaf("B", {"x": "A"})
    assert found(pair(a, b), "SM204") == ["SM204 sm/A"]
    assert one(pair(a, b), "SM204").finding.path_labels == ("A", "(x)", "B", "(x)", "A")
    assert found(pair(a, blocking(b)), "SM204") == []
    assert found(pair(a, replace(b, open=True)), "SM204") == []
    inside = machine("B", "x", blocking(leaf("C", {"x": "x"})), to={"x": "A"})
    assert found(pair(a, inside), "SM204") == []
    assert found(pair(leaf("A", {"x": "B", "y": "A"}), blocking(b)), "SM204") == ["SM204 sm/A"]


def test_starting_over_is_what_a_machine_that_goes_on_does() -> None:
    a = blocking(leaf("A", {"ok": "B", "failed": "A"}))
    root = looping(machine("sm", "", a, leaf("B", {"x": "A"})))
    assert found(root, "SM204") == []


def test_what_runs_until_it_is_preempted_must_wait() -> None:
    monitor = leaf("A", {"x": "A", "preempted": "done"})
    assert found(machine("sm", "done", monitor), "SM204") == ["SM204 sm/A"]
    assert found(machine("sm", "done", blocking(monitor)), "SM204") == []
    tries = blocking(leaf("A", {"ok": "B", "failed": "A", "preempted": "done"}))
    assert found(machine("sm", "done", tries, leaf("B", {"x": "A"})), "SM204") == []


def test_a_trap_is_not_a_loop_as_well() -> None:
    root = machine("sm", "done", leaf("A", {"ok": "done", "x": "B"}), leaf("B", {"failed": "B"}))
    assert found(root) == ["SM202 sm/B"]


def test_an_iterator_bounds_its_tries() -> None:
    node = iterator("TRY", "exhausted ok", leaf("A", outcomes="ok failed"), loop="failed",
                    items=[1, 2, 3], final={"failed": "exhausted"},
                    to={"ok": "done", "exhausted": "lost"})  # fmt: skip
    assert report(machine("sm", "done lost", node)) == []


def asking(*keys: str, to: dict[str, str], types: str = "int", **more: Any) -> Leaf:
    """A state that ends as a condition over keys says."""
    text = " + ".join(f"ud.{key}" for key in keys)
    made = leaf("ASK", to, ins=" ".join(keys), callbacks={"again": f"`lambda ud: {text} < 3`"},
                type="ConditionalOutcomeState", **more)  # fmt: skip
    variables = tuple(replace(variable, role="conditions") for variable in made.variables)
    inputs = tuple(replace(key, type=Type(types)) for key in made.inputs)
    return replace(made, variables=variables, inputs=inputs)


AGAIN = {"again": "A", "enough": "done"}


@pytest.mark.parametrize(
    ("states", "ends"),
    [
        ([leaf("A", {"ok": "ASK"}), asking("n", to=AGAIN)], True),
        ([leaf("A", {"ok": "done", "failed": "ASK"}), asking("n", to=AGAIN)], True),
        ([leaf("A", {"ok": "ASK"}, ins="n"), asking("n", "m", to=AGAIN)], True),
        ([leaf("A", {"ok": "ASK"}), asking("n", to=AGAIN, types="str")], True),
        ([leaf("A", {"ok": "ASK"}, outs="n"), asking("n", to=AGAIN)], False),
        ([leaf("A", {"ok": "ASK"}, outs="k", remaps={"k": "n"}), asking("n", to=AGAIN)], False),
        ([leaf("A", {"ok": "ASK"}, outs="m"), asking("n", "m", to=AGAIN)], False),
        ([leaf("A", {"ok": "ASK"}, open=True), asking("n", to=AGAIN)], False),
        ([leaf("A", {"ok": "ASK"}), asking("n", to=AGAIN, types="any")], False),
        ([leaf("A", {"ok": "ASK", "far": "done"}), asking("n", to=AGAIN, types="bool")], False),
        ([leaf("A", {"ok": "ASK"}), asking("n", to={"again": "done", "enough": "done"})], False),
        ([machine("A", "ok", leaf("IN", {"ok": "ok"}, outs="n"), to={"ok": "ASK"}),
          asking("n", to=AGAIN)], False),
    ],
    ids=["counter", "retry", "read elsewhere", "a setting ends it", "written", "remapped",
         "one of two", "open", "type not known", "a setting beside", "no loop", "lost inside"],
)  # fmt: skip
def test_a_condition_that_never_changes(states: list[Node], ends: bool) -> None:
    root = machine("sm", "done", *states, held={"m": 2})
    assert found(root, "SM213") == (["SM213 sm/ASK"] if ends else [])


@pytest.mark.parametrize(
    ("cut", "expected"),
    [
        (leaf("COUNT", {"ok": "ASK"}, ins="n", outs="n"), ["SM201 sm/COUNT"]),
        (leaf("COUNT", {"ok": "ASK"}, outs="k", remaps={"k": "n"}), ["SM201 sm/COUNT"]),
        (leaf("COUNT", {"ok": "done"}, outs="n"), ["SM201 sm/COUNT"]),
        (machine("COUNT", "ok", leaf("IN", {"ok": "ok"}, outs="n"), outs="n", to={"ok": "ASK"}),
         ["SM201 sm/COUNT"]),
        (leaf("COUNT", {"ok": "ASK"}, outs="m"), ["SM201 sm/COUNT", "SM213 sm/ASK"]),
    ],
    ids=["counter", "remapped", "leads elsewhere", "container", "another key"],
)  # fmt: skip
def test_the_state_that_changes_a_condition_is_cut_off(cut: Node, expected: list[str]) -> None:
    root = machine("sm", "done", leaf("A", {"ok": "ASK"}), cut, asking("n", to=AGAIN))
    assert [*found(root, "SM201"), *found(root, "SM213")] == expected


def test_a_condition_in_python_can_change_by_itself() -> None:
    ask = asking("n", to=AGAIN)
    code = replace(ask.variables[0], value=value({"again": "`lambda ud: clock() < ud.n`"}))
    root = machine("sm", "done", leaf("A", {"ok": "ASK"}), replace(ask, variables=(code,)))
    assert found(root, "SM213") == []


LOOP = """\
name: sm
template: Base
outcomes: [done, failed, preempted]
userdata: {n: 3}
states:
  - WORK:
      template: ScriptedState
      outcomes: [succeeded, aborted]
      for_each: {item: i, in: ITEMS, on: [ON]}
      transitions: {succeeded: done, aborted: failed, preempted: preempted}
"""


@pytest.mark.parametrize(
    ("items", "on", "expected"),
    [
        ("itertools.count()", "succeeded, aborted", ["SM202 itertools.count()"]),
        ("'`itertools.count(1, 2)`'", "succeeded, aborted", ["SM202 '`itertools.count(1, 2)`'"]),
        ("itertools.repeat(1)", "succeeded, aborted", ["SM202 itertools.repeat(1)"]),
        (
            "'`lambda ud: itertools.cycle([1])`'",
            "succeeded, aborted",
            ["SM202 '`lambda ud: itertools.cycle([1])`'"],
        ),
        ("itertools.count()", "succeeded", []),
        ("'`itertools.repeat(1, 2)`'", "succeeded, aborted", []),
        ("'`itertools.repeat(1, times=2)`'", "succeeded, aborted", []),
        ("'`itertools.chain([1], [2])`'", "succeeded, aborted", []),
        ("range(3)", "succeeded, aborted", []),
    ],
)
def test_items_without_an_end(items: str, on: str, expected: list[str]) -> None:
    text = LOOP.replace("ITEMS", items).replace("[ON]", f"[{on}]")
    traps = [item for item in analysed({"main.yml": text}).report if item.code == "SM202"]
    assert [f"SM202 {trap.span.text}" for trap in traps] == expected
