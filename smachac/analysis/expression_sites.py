"""The portable code of a machine, with what is known of the types that it is over."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from smachac.analysis.accesses import callbacks
from smachac.analysis.context import once, states, types_of
from smachac.analysis.expression_errors import Fault, expression_faults, function_faults
from smachac.analysis.expression_types import keys_read, parsed
from smachac.analysis.type_inference import Place, Types
from smachac.analysis.type_lattice import join, record
from smachac.ir import nodes
from smachac.ir.leaf import CALLING, variable
from smachac.ir.nodes import Expression, Leaf, Machine, Node
from smachac.ir.traversal import expressions, outcome_names, remapping
from smachac.ir.types import ANY, Type


@dataclass(frozen=True, slots=True, kw_only=True)
class Code:
    """An expression of a state, and where the keys that it reads are.

    `types` are those of the keys. None where it is no function over userdata.
    """

    path: str
    node: Node
    expression: Expression
    types: dict[str, Type] | None = None
    places: dict[str, Place] = field(default_factory=dict)

    def faults(self) -> tuple[Fault, ...]:
        text = self.expression.text
        if self.types is not None:
            found = function_faults(text, record(self.types.items()))
        else:
            tree = parsed(text)
            found = () if tree is None else expression_faults(tree)
        return tuple(fault for fault in found if not fault.length or self.lengths_hold(fault))

    def lengths_hold(self, fault: Fault) -> bool:
        """Whether lists stay as long as they are: a script's own may grow in a state's hands, only
        a declaration says that they do not."""
        return all(
            map(_is_declared, (self.places[key] for key in fault.keys if key in self.places))
        )


def _is_declared(place: Place) -> bool:
    flows = [alike[0] for alike in place.flows.values() if not alike[0].judged]
    return place.declared != ANY or all(flow.origin.how == "declared" for flow in flows)


@once
def faults_of(machine: Machine) -> list[tuple[Code, Fault]]:
    """What is wrong with the code of a machine."""
    return [(code, fault) for code in codes(machine) for fault in code.faults()]


def codes(machine: Machine) -> Iterator[Code]:
    """The code of every state, as far as it is portable."""
    types = types_of(machine)
    for path, node in states(machine):
        over_userdata = dict(_functions(path, node, types))
        for expression in expressions(node):
            known = over_userdata.get(id(expression))
            if known is not None:
                yield _over(path, node, expression, known, types)
            else:
                yield Code(path=path, node=node, expression=expression)


Written = dict[str, Type]
"""The keys of a container, with the types of what was written since the state began."""


def _functions(path: str, node: Node, types: Types) -> Iterator[tuple[int, Written]]:
    """The expressions that are called with the userdata of the state, by `id`."""
    items = node.items.data if isinstance(node, nodes.Iterator) and node.items else None
    if isinstance(items, Expression):
        yield id(items), {}
    if not isinstance(node, Leaf):
        return
    if node.type == "SleepState" and isinstance(time := variable(node, "time"), Expression):
        yield id(time), {}
    functions = callbacks(node) or {}
    if node.type == "ConditionalOutcomeState":
        for name in outcome_names(node):
            if name in functions:
                yield id(functions[name]), {}
    elif node.type in CALLING:
        names = remapping(node)
        written: Written = {}
        for key in sorted(functions):
            yield id(functions[key]), dict(written)
            written[names.get(key, key)] = types.outputs.get((path, key), ANY)


def _over(path: str, node: Node, expression: Expression, written: Written, types: Types) -> Code:
    names = remapping(node) if isinstance(node, Leaf) else {}
    places = {
        key: types.places[path, key]
        for key in sorted(keys_read(expression))
        if (path, key) in types.places
    }
    held: dict[str, Type] = {}
    for key, place in places.items():
        held[key] = place.declared if place.declared != ANY else place.holds or ANY
        outer = names.get(key, key)
        if outer in written:
            held[key] = join(held[key], written[outer])
    return Code(path=path, node=node, expression=expression, types=held, places=places)
