"""Iterators: one state, once for each item."""

from __future__ import annotations

from collections.abc import Iterable

from smachac.ir.nodes import Expression, Iterator
from smachac.ir.types import Type
from smachac.targets.cpp.expressions import cpp_expression, cpp_function
from smachac.targets.cpp.inside import (
    CAUGHT,
    NO_OUTCOME,
    Inside,
    Lines,
    called,
    guarded,
    indented,
    results,
)
from smachac.targets.cpp.plan import place
from smachac.targets.cpp.types import UnportableError, cpp_literal, cpp_type, cpp_value
from smachac.targets.cpp.words import identifier


def iterator(inside: Inside) -> Lines:
    """The body of the function of an iterator."""
    node = inside.node
    assert isinstance(node, Iterator)
    final = dict(node.final_map)
    done = inside.ends(final.get(node.exhausted_outcome, node.exhausted_outcome))
    items = _items(inside, node)
    if items is None or not node.children:
        return [f"return {done};"]
    child = node.children[0]
    item = f"ud.{identifier(node.item_key)}"
    state = f"State::{identifier(child.name)}"
    ways: Lines = []
    for name in results(child):
        ways.append(f"case {inside.outcome(child, name)}:")
        ways += indented(_round(inside, node, name))
    caught: Lines = []
    if child.catches:
        told = _over(node, [child.catches])
        ways_out = _round(inside, node, child.catches)
        caught = [CAUGHT, told, *(line for line in ways_out if line != "continue;")]
    before, outcome = called(inside, child)
    if outcome != "outcome":
        before, outcome = [*before, f"const auto outcome = {outcome};"], "outcome"
    steps = [
        "run.enter(places, state);",
        *before,
        _over(node, results(child)),
        "switch (outcome) {",
        *ways,
        "}",
        NO_OUTCOME,
    ]
    return [
        *items,
        "if (items.empty()) {",
        f"  return {done};",
        "}",
        f"const auto state = {state};",
        "smachac::Round round(run.stop, places[0], items.size());",
        "for (const auto &item : items) {",
        f"  {item}.hold(item);",
        *([f"  // {place(child)}"] if place(child) else []),
        *indented(guarded(steps, caught)),
        "}",
        f"return {done};",
    ]


def _over(node: Iterator, outcomes: Iterable[str]) -> str:
    """The statement that ends an item, and notes where it matters whether that ends them all."""
    matters = any(name in node.loop_outcomes for name in outcomes)
    return f"{'const bool over = ' if matters else ''}round.over();"


def _round(inside: Inside, node: Iterator, name: str) -> Lines:
    """Where an iterator's state leads with an outcome."""
    final = dict(node.final_map)
    told = cpp_literal(name)
    end = f"return run.end(places, state, {told}, {inside.ends(final.get(name, name))});"
    if name not in node.loop_outcomes:
        return [end]
    done = inside.ends(final.get(node.exhausted_outcome, node.exhausted_outcome))
    return [
        *("if (over) {", f"  {end}", "}"),
        *("if (round.last()) {", f"  return run.end(places, state, {told}, {done});", "}"),
        *(f"run.again(places, state, {told});", "continue;"),
    ]


def _items(inside: Inside, node: Iterator) -> Lines | None:
    """The statement that finds the items; None where there are none."""
    wanted = inside.scope.key(node.item_key)
    if node.items_key:
        type_ = inside.scope.key(node.items_key)
        if type_.name not in ("list", "array"):
            raise UnportableError(f"`{node.items_key}` is `{type_}`, not a list of items")
        need = f"smachac::need(ud.{identifier(node.items_key)}, {cpp_literal(node.items_key)})"
        return [f"const auto items = {need};"]
    if node.items is None or node.items.data == ():
        return None
    listed = Type("list", (wanted,))
    if isinstance(node.items.data, Expression):
        spelt = {key: inside.scope.read(key, key) for key in inside.scope.keys}
        body, names = cpp_function(node.items.data.text, spelt)
        return [f"const {cpp_type(listed)} items = {cpp_expression(body, names, listed).text};"]
    if not isinstance(node.items.data, tuple):
        raise UnportableError("its items are no list")
    listed = Type("array", (wanted, len(node.items.data)))
    return [f"const {cpp_type(listed)} items = {cpp_value(node.items.data, listed)};"]
