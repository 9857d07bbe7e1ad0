"""Conditions that hide a later one: an outcome of a state that never comes, because an earlier
condition is true whenever its own is (SM203)."""

from __future__ import annotations

import ast
import math
from collections.abc import Iterator
from typing import NamedTuple

from smachac.checks.findings.help_text import calls, other_place
from smachac.checks.findings.value_places import place_of_part
from smachac.diagnostics.diagnostic import Finding
from smachac.diagnostics.source import Span
from smachac.ir.leaf import default_outcome, functions, variable, variable_of
from smachac.ir.nodes import Leaf, Node
from smachac.ir.script_code import script_code
from smachac.ir.traversal import outcome_names


class _Range(NamedTuple):
    """The numbers of a key for which a condition is true; a bound counts itself if it is closed.
    `exact`: for all of them, and not only for some."""

    key: str
    least: float = -math.inf
    least_closed: bool = True
    most: float = math.inf
    most_closed: bool = True
    exact: bool = True

    def covers(self, other: _Range) -> bool:
        """Whether this range has all numbers of another one."""
        above = (self.least, not self.least_closed) <= (other.least, not other.least_closed)
        below = (-self.most, not self.most_closed) <= (-other.most, not other.most_closed)
        return self.key == other.key and above and below


def hidden_conditions(path: str, node: Node) -> Iterator[Finding]:
    """The conditions of a state that are never the first true one."""
    held = variable_of(node, "conditions") if isinstance(node, Leaf) else None
    if held is None or not isinstance(node, Leaf):
        return
    conditions = functions(node, "conditions") or {}
    known: list[tuple[str, _Range]] = []
    default = variable(node, "default_outcome") or default_outcome(node)
    for name in outcome_names(node) if len(conditions) > 1 else ():
        found = _range(conditions[name].text) if name in conditions else None
        if found is None:
            continue
        first = next((pair for pair in known if pair[1].covers(found)), None)
        if first is not None and name != default:
            yield _hidden(path, node, held.value.span, (first[0], name), found.covers(first[1]))
        if found.exact:
            known.append((name, found))


def _hidden(path: str, leaf: Leaf, conditions: Span, names: tuple[str, str], same: bool) -> Finding:
    """`names`: the outcome of the earlier condition, and that of the hidden one. `same`: both are
    true for the same values."""
    first, later = names
    span = place_of_part(conditions, (later,), key=True)
    help = f"list `{later}` before `{first}` in the `outcomes` of `{leaf.name}`"
    return Finding(
        span=span,
        message=f"`{leaf.name}` never ends with `{later}`: whenever this condition is true, that of"
        f" `{first}` is true, which comes first",
        arguments=(later, first),
        help=help if not same else "correct one of the two conditions: they are the same",
        related=(
            *other_place(place_of_part(conditions, (first,), key=True), "the earlier condition"),
            *calls(leaf, span),
        ),
        node=path,
    )


def _range(text: str) -> _Range | None:
    """The numbers of one key for which a condition is true; None if it is no comparison of one key
    with constants. Of parts with `and`, those about another key count as true."""
    found = script_code(text).function
    if found is None:
        return None
    body, names = found
    parts = body.values if isinstance(body, ast.BoolOp) and isinstance(body.op, ast.And) else [body]
    ranges = [_compared(part, names) for part in parts]
    known = [range_ for some in ranges for range_ in some]
    if not known:
        return None
    exact = all(ranges) and len({range_.key for range_ in known}) == 1
    key = known[0].key
    least, least_open = max((range_.least, not range_.least_closed) for range_ in known
                            if range_.key == key)  # fmt: skip
    most, most_open = min(
        (range_.most, range_.most_closed) for range_ in known if range_.key == key
    )
    return _Range(key, least, not least_open, most, most_open, exact)


def _compared(node: ast.expr, names: frozenset[str]) -> list[_Range]:
    """The ranges of a comparison, all of which hold; none if it is another expression."""
    if not isinstance(node, ast.Compare):
        return []
    found: list[_Range] = []
    sides = [node.left, *node.comparators]
    for left, sort, right in zip(sides, node.ops, sides[1:], strict=False):
        key, number = _key(left, names), _number(right)
        inverted = False
        if key is None or number is None:
            key, number, inverted = _key(right, names), _number(left), True
        if key is None or number is None:
            return []
        match sort:
            case ast.Eq():
                found.append(_Range(key, number, True, number, True))
            case ast.Gt() | ast.GtE() | ast.Lt() | ast.LtE():
                closed = isinstance(sort, ast.GtE | ast.LtE)
                above = isinstance(sort, ast.Gt | ast.GtE) != inverted
                found.append(
                    _Range(key, least=number, least_closed=closed)
                    if above
                    else _Range(key, most=number, most_closed=closed)
                )
            case _:
                return []
    return found


def _key(node: ast.expr, names: frozenset[str]) -> str | None:
    """The key of the userdata that an expression reads."""
    match node:
        case ast.Attribute(value=ast.Name(id=name), attr=key) if name in names:
            return key
        case ast.Subscript(value=ast.Name(id=name), slice=ast.Constant(value=str(key))):
            return key if name in names else None
    return None


def _number(node: ast.expr) -> float | None:
    match node:
        case ast.Constant(value=int() | float() as value) if not isinstance(value, bool):
            return float(value)
        case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=int() | float() as value)):
            return -float(value)
    return None
