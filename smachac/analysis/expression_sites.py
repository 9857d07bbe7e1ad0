"""Expression sites: the portable code of a machine, with the types of the keys that it reads."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from typing import TypeAlias

from smachac.analysis.code_slots import code_of
from smachac.analysis.expression_errors import Fault, expression_faults, function_faults
from smachac.analysis.expression_types import body_of, keys_read
from smachac.analysis.fixed_lists import has_fixed_length, key_of, lacks_entry
from smachac.analysis.item_errors import has_item_code, item_faults, item_keys
from smachac.analysis.type_inference import Cell, Types
from smachac.analysis.type_lattice import join, mapping
from smachac.ir import nodes
from smachac.ir.expressions import Expr, Index
from smachac.ir.leaf import functions
from smachac.ir.nodes import Expression, Leaf, Node, StateType, Struct, VariableType
from smachac.ir.script_code import script_code
from smachac.ir.traversal import OuterNames, expressions, expressions_in, outcome_names, remapping
from smachac.ir.types import ANY, Type
from smachac.records import dataclass, field

FunctionFaults: TypeAlias = "Callable[[str, Type], tuple[Fault, ...]]"
"""The faults of the text of a function over userdata of a type."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ExpressionSite:
    """An expression of a state, with the cells of the keys that it reads.

    `types` are the types of the keys; None where the expression is no function over userdata.
    """

    path: str
    node: Node
    expression: Expression
    types: dict[str, Type] | None = None
    state_types: Mapping[str, StateType] = field(default_factory=dict, repr=False)
    cells: dict[str, Cell] = field(default_factory=dict)

    def faults(self, of_function: FunctionFaults) -> tuple[Fault, ...]:
        """The faults of the expression; those of a function come from `of_function`."""
        text = self.expression.text
        if self.types is not None:
            found = of_function(text, mapping(self.types.items()))
        else:
            tree = script_code(text).portable
            found = () if tree is None else expression_faults(tree)
        return tuple(fault for fault in found if not fault.length or self.lengths_hold(fault))

    def lengths_hold(self, fault: Fault) -> bool:
        """Whether the lists of a fault have a fixed length: by a declaration, or because no state
        can lengthen the list of the script."""
        if all(map(_is_declared, (self.cells[key] for key in fault.keys if key in self.cells))):
            return True
        return fault.always and self.is_initial(fault.expr, fault.word)

    def is_initial(self, expr: Expr, entry: str) -> bool:
        """Whether an expression reads an item of an initial value with a fixed length, or the entry
        of an initial mapping, which no state adds."""
        tree = script_code(self.expression.text).portable
        if tree is None or not isinstance(expr, Index):
            return False
        key = key_of(expr.value, body_of(tree)[1])
        if key in self.cells and entry:
            return lacks_entry(self.cells[key], entry, self.state_types)
        return key in self.cells and has_fixed_length(self.cells[key])


def _is_declared(cell: Cell) -> bool:
    flows = [alike[0] for alike in cell.flows.values() if not alike[0].judged]
    return cell.declared != ANY or all(flow.origin.how == "declared" for flow in flows)


def faulty_sites(
    states: Iterable[tuple[str, Node]], types: Types, state_types: Mapping[str, StateType]
) -> Iterator[tuple[ExpressionSite, Fault]]:
    """The type errors in the portable code of every state. A function that states share, over keys
    of the same types, is judged once."""
    of_function = cache(_faults_of_function)
    for site in expression_sites(states, types, state_types):
        for fault in site.faults(of_function):
            yield site, fault


def _faults_of_function(text: str, userdata: Type) -> tuple[Fault, ...]:
    """The faults of a function over userdata, those in its code for items included."""
    found = function_faults(text, userdata)
    return found + item_faults(text, userdata) if has_item_code(text) else found


def expression_sites(
    states: Iterable[tuple[str, Node]], types: Types, state_types: Mapping[str, StateType]
) -> Iterator[ExpressionSite]:
    """The portable code of every state."""
    for path, node in states:
        for expression, written in _expressions(path, node, types, state_types):
            if written is not None:
                yield _over(path, node, expression, written, types, state_types)
            else:
                yield ExpressionSite(path=path, node=node, expression=expression)


Written = dict[str, Type]
"""The keys of a container, with the types of what was written since the state began."""


def _expressions(
    path: str, node: Node, types: Types, state_types: Mapping[str, StateType]
) -> Iterator[tuple[Expression, Written | None]]:
    """The expressions of a state, in the order of the script; those that are called with its
    userdata come with what was written before, the others with None."""
    if not isinstance(node, Leaf):
        items = node.items.data if isinstance(node, nodes.Iterator) and node.items else None
        for expression in expressions(node):
            yield expression, {} if expression is items else None
        return
    called = _called(path, node, types) if node.variables else {}
    known = state_types.get(node.type)
    for held in node.variables:
        data = held.value.data
        if held.role in ("callbacks", "conditions") and isinstance(data, Struct):
            for key, value in data.entries:
                for expression in expressions_in(value):
                    yield expression, called.get(key) if expression is value else None
        elif known is not None and _is_function_of_userdata(known.variables.get(held.name)):
            code = code_of(data, held.value)
            if code is not None:
                yield code, {}
        else:
            called_alone = held.role in ("function", "duration")
            for expression in expressions_in(data):
                yield expression, {} if called_alone and expression is data else None


def _is_function_of_userdata(fact: VariableType | None) -> bool:
    """Whether a variable holds one function, which the state calls with its userdata alone."""
    return fact is not None and fact.unquoted == "function" and fact.arguments == ("userdata",)


def _called(path: str, leaf: Leaf, types: Types) -> dict[str, Written]:
    """By name of a callback or condition the keys that are written before it is called."""
    callbacks = functions(leaf, "callbacks") or {}
    conditions = functions(leaf, "conditions") or {}
    found: dict[str, Written] = {}
    names = remapping(leaf)
    written: Written = {}
    for key in sorted(callbacks):
        found[key] = dict(written)
        written[names[key]] = types.outputs.get((path, key), ANY)
    for name in outcome_names(leaf) if conditions else ():
        if name in conditions:
            found[name] = written
    return found


def _over(
    path: str,
    node: Node,
    expression: Expression,
    written: Written,
    types: Types,
    state_types: Mapping[str, StateType],
) -> ExpressionSite:
    """The site of code that is called with userdata. `written`: the keys that were written before,
    since the state began."""
    names = remapping(node) if isinstance(node, Leaf) else OuterNames()
    cells = {
        key: types.cells[path, key]
        for key in sorted({*keys_read(expression), *item_keys(expression.text)})
        if (path, key) in types.cells
    }
    held: dict[str, Type] = {}
    for key, cell in cells.items():
        held[key] = cell.declared if cell.declared != ANY else cell.holds or ANY
        outer = names[key]
        if outer in written:
            held[key] = join(held[key], written[outer])
    return ExpressionSite(
        path=path,
        node=node,
        expression=expression,
        types=held,
        state_types=state_types,
        cells=cells,
    )
