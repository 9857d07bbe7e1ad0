"""Null guards: the userdata keys that cannot be null after an outcome of a state, because a
condition of the script has compared them with None."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from typing import NamedTuple

from smachac.ir.leaf import functions
from smachac.ir.nodes import Leaf, Node
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.script_code import script_code
from smachac.ir.traversal import inputs_from, outcome_names

Keys = frozenset[str]
NONE: Keys = frozenset()


class _Facts(NamedTuple):
    """The keys that are not null where a condition is true, and where it is false."""

    true: Keys = NONE
    false: Keys = NONE


def excludes_null(child: Node, key: str, outcome: str) -> bool:
    """Whether a key of the container is not null, or was perhaps tested, when a state has ended
    with an outcome. A state that reads the key as a nullable type and has several outcomes can test
    it in its code."""
    if not isinstance(child, Leaf) or outcome == child.catches != "":
        return False
    own = inputs_from(child, key)
    if not own or outcome == PREEMPTED:
        return False
    known = guards(child)
    if known:
        return not known.get(outcome, NONE).isdisjoint(key.name for key in own)
    several = len([name for name in outcome_names(child) if name != PREEMPTED]) > 1
    return several and any(key.type.name == "optional" for key in own)


def guards(leaf: Leaf) -> Mapping[str, Keys]:
    """The keys of a leaf that are not null, by outcome; empty if it has no conditions."""
    conditions = functions(leaf, "conditions")
    if not conditions:
        return {}
    found: dict[str, Keys] = {}
    before = NONE
    for outcome in outcome_names(leaf):
        if outcome not in conditions:
            continue
        facts = _facts_of(conditions[outcome].text)
        found[outcome] = before | facts.true
        before |= facts.false
    return {name: found.get(name, before) for name in outcome_names(leaf)}


def _facts_of(text: str) -> _Facts:
    """The facts of a condition: a function of the userdata, or code about `ud`."""
    found = script_code(text).function
    return _Facts() if found is None else _facts(*found)


def _facts(body: ast.expr, names: Keys) -> _Facts:
    match body:
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            facts = _facts(operand, names)
            return _Facts(facts.false, facts.true)
        case ast.BoolOp(op=op, values=values):
            parts = [_facts(value, names) for value in values]
            any_true = frozenset.union(*(part.true for part in parts))
            any_false = frozenset.union(*(part.false for part in parts))
            all_true = frozenset.intersection(*(part.true for part in parts))
            all_false = frozenset.intersection(*(part.false for part in parts))
            if isinstance(op, ast.And):
                return _Facts(any_true, all_false)
            return _Facts(all_true, any_false)
        case ast.Compare(left=left, ops=[op], comparators=[ast.Constant(value=None)]):
            return _compared(op, _key(left, names))
        case ast.Compare(left=ast.Constant(value=None), ops=[op], comparators=[right]):
            return _compared(op, _key(right, names))
        case ast.Call(func=ast.Name(id="bool"), args=[argument]):
            return _facts(argument, names)
        case ast.Call(func=ast.Name(id="isinstance"), args=[argument, _]):
            return _Facts(_key(argument, names))
    return _Facts(_key(body, names))


def _compared(op: ast.cmpop, key: Keys) -> _Facts:
    """The facts of a comparison with None."""
    if isinstance(op, ast.IsNot | ast.NotEq):
        return _Facts(true=key)
    return _Facts(false=key) if isinstance(op, ast.Is | ast.Eq) else _Facts()


def _key(body: ast.expr, names: Keys) -> Keys:
    """The userdata key that code reads; none if it is other code."""
    match body:
        case ast.Attribute(value=ast.Name(id=owner), attr=key) if owner in names:
            return frozenset([key])
        case ast.Subscript(value=ast.Name(id=owner), slice=ast.Constant(value=str() as key)) if (
            owner in names
        ):
            return frozenset([key])
        case ast.NamedExpr(value=value):
            return _key(value, names)
    return NONE
