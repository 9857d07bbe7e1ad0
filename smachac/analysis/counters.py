"""Counters: userdata keys to which one state adds a number, and the states that compare them."""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from typing import NamedTuple, TypeAlias

from smachac.analysis.def_use import around
from smachac.analysis.definite_assignment import DataFlow, UserdataScope
from smachac.ir.leaf import functions, variable
from smachac.ir.nodes import Key, Leaf, Node, is_number
from smachac.ir.script_code import script_code
from smachac.ir.traversal import inputs_from, outcome_names, outputs_to, remapping

DEFAULT = "default"
"""The outcome of a state with conditions if none is true, unless it has another default."""

Number: TypeAlias = "int | float"


class Test(NamedTuple):
    """A state that compares a key with numbers: `decide` gives its outcome for a value of the key.
    `limits` are the numbers."""

    leaf: Leaf
    decide: Callable[[Number], str]
    limits: tuple[Number, ...]


class Counters:
    """The counters of a machine."""

    def __init__(self, flow: DataFlow) -> None:
        self._known = _Constants(flow)

    def tests(self, scope: UserdataScope, key: str) -> Iterator[tuple[Leaf, Number, Test]]:
        """The tests of the counter in a key of a container, each with the state that counts and
        what it adds."""
        readers = {use.node.name: use.node for use in scope.uses.readers(key)}
        written = {use.node.name for use in scope.uses.writers(key)}
        counters = [child for name, child in readers.items() if name in written]
        if len(counters) != 1 or not isinstance(counters[0], Leaf):
            return
        counter = counters[0]
        added = _added(self._known, scope, counter, key)
        for leaf in readers.values() if added else ():
            test = _test(self._known, scope, leaf, key) if leaf is not counter else None
            if test is not None:
                yield counter, added, test


class _Constants:
    """The numbers that code of a machine always has."""

    def __init__(self, flow: DataFlow) -> None:
        self._flow = flow
        self._written: dict[str, AbstractSet[str] | None] = {}

    def number(
        self, scope: UserdataScope, leaf: Leaf, tree: ast.expr, names: AbstractSet[str]
    ) -> Number | None:
        """The value of code: a literal, or a key that nothing sets; None if not known."""
        match tree:
            case ast.Constant(value=value) if is_number(value):
                return value
            case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=value)) if is_number(value):
                return -value
        key = _field(tree, names)
        return None if key is None else self._initial(scope, remapping(leaf)[key])

    def _initial(self, scope: UserdataScope, key: str) -> Number | None:
        """The initial value of a key that no state sets; None if it has another one, or none."""
        while True:
            written = self._written_in(scope)
            presets = [
                preset.value.data for preset in scope.container.userdata if preset.key == key
            ]
            if written is None or key in written:
                return None
            if key not in scope.inputs:
                value = presets[0] if presets else None
                return value if is_number(value) else None
            outer = around(self._flow, scope.path)
            if presets or outer is None:
                return None
            scope, key = self._flow.scopes[outer], scope.inputs[key]

    def _written_in(self, scope: UserdataScope) -> AbstractSet[str] | None:
        """The keys that states of a container may set; None if they may set any key."""
        if scope.path not in self._written:
            steps = [step.writes for several in scope.steps.values() for step in several]
            anything = any(writes.anything for writes in steps)
            keys = frozenset[str]().union(*(writes.perhaps for writes in steps))
            self._written[scope.path] = None if anything else keys
        return self._written[scope.path]


def _own_name(keys: Sequence[Key]) -> str | None:
    return keys[0].name if keys else None


def _added(known: _Constants, scope: UserdataScope, leaf: Leaf, key: str) -> Number:
    """What a state adds to a key each time; 0 if that is not known."""
    source, target = _own_name(inputs_from(leaf, key)), _own_name(outputs_to(leaf, key))
    code = (functions(leaf, "callbacks") or {}).get(target or "")
    body = script_code(code.text).function if code is not None else None
    if body is None:
        return 0
    tree, names = body
    match tree:
        case ast.BinOp(left=left, op=ast.Add() | ast.Sub() as op, right=right):
            sign = 1 if isinstance(op, ast.Add) else -1
            if _field(left, names) == source:
                return sign * (known.number(scope, leaf, right, names) or 0)
            if _field(right, names) == source and sign == 1:
                return known.number(scope, leaf, left, names) or 0
    return 0


_COMPARED: Mapping[type[ast.cmpop], Callable[[Number, Number], bool]] = {
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
}


def _test(known: _Constants, scope: UserdataScope, leaf: Node, key: str) -> Test | None:
    """The test of a key; None if a state decides otherwise, or by more than this key."""
    if not isinstance(leaf, Leaf) or leaf.open:
        return None
    conditions = functions(leaf, "conditions")
    own, default = _own_name(inputs_from(leaf, key)), variable(leaf, "default_outcome") or DEFAULT
    named = {input_.name for input_ in leaf.inputs}.intersection(outcome_names(leaf))
    if not conditions or not isinstance(default, str) or not named <= conditions.keys():
        return None
    compared: list[tuple[str, Callable[[Number, Number], bool], Number, bool]] = []
    for outcome in outcome_names(leaf):
        if outcome in conditions:
            body = script_code(conditions[outcome].text).function
            match body:
                case (ast.Compare(left=left, ops=[op], comparators=[right]), names):
                    inverted = _field(right, names) == own
                    value, other = (right, left) if inverted else (left, right)
                    limit = known.number(scope, leaf, other, names)
                    if _field(value, names) != own or limit is None or type(op) not in _COMPARED:
                        return None
                    compared.append((outcome, _COMPARED[type(op)], limit, inverted))
                case _:
                    return None

    def decide(value: Number) -> str:
        for outcome, holds, limit, inverted in compared:
            if holds(limit, value) if inverted else holds(value, limit):
                return outcome
        return default

    return Test(leaf, decide, tuple(limit for _, _, limit, _ in compared))


def _field(tree: ast.expr, names: AbstractSet[str]) -> str | None:
    """The userdata key that code reads; None if it is other code."""
    match tree:
        case ast.Attribute(value=ast.Name(id=owner), attr=key) if owner in names:
            return key
        case ast.Subscript(value=ast.Name(id=owner), slice=ast.Constant(value=str() as key)) if (
            owner in names
        ):
            return key
    return None
