"""Values that only Python computes: sample values replace them in the machine and in the program.

The interpreter does not evaluate Python beyond the portable expressions. Where such code gives the
items of an iterator or an initial value of userdata, verify plays both sides with a sample.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import NamedTuple

from smachac.analysis.type_inference import Types, infer
from smachac.interpreter.evaluator import can_evaluate
from smachac.ir.expressions import Lambda, parse_expression
from smachac.ir.nodes import (
    Container,
    Data,
    Iterator,
    Leaf,
    Machine,
    Node,
    Preset,
    StateMachine,
    Struct,
    Value,
)
from smachac.ir.traversal import containers, expressions_in
from smachac.ir.types import ANY
from smachac.records import replace
from smachac.verify.sample_values import sample_value

ITEMS = ""
"""The key of a sample that replaces the items of an iterator."""


class Sample(NamedTuple):
    """A value for the key of a container, or for the items of an iterator (`ITEMS`)."""

    path: str
    key: str
    value: object


def with_samples(machine: Machine) -> tuple[Machine, tuple[Sample, ...]]:
    """The machine in which no items and no preset need Python, and the samples in it."""
    samples: dict[str, list[Sample]] = {}
    types: Types | None = None
    for path, node in containers(machine.root):
        for key in _keys_of_python(node):
            types = types or infer(machine)
            held = node.item_key if key == ITEMS and isinstance(node, Iterator) else key
            type_ = types.keys.get((path, held), ANY)
            value = sample_value(type_, len(samples))
            if key == ITEMS:
                value = [sample_value(type_, number) for number in (1, 2)]
            samples.setdefault(path, []).append(Sample(path, key, value))
    if not samples:
        return machine, ()
    root = _replaced(machine.root, machine.root.name, samples)
    assert isinstance(root, StateMachine)
    return replace(machine, root=root), tuple(sample for row in samples.values() for sample in row)


def _keys_of_python(node: Container) -> list[str]:
    """The keys of a container whose initial values the interpreter cannot compute, and ITEMS."""
    found = [preset.key for preset in node.userdata if _needs_python(preset.value.data, ())]
    if isinstance(node, Iterator) and node.items is not None:
        data = node.items.data
        if _needs_python(data, ("ud", "userdata")):
            found.append(ITEMS)
    return found


def _needs_python(data: Data, names: Collection[str]) -> bool:
    """Whether a value has code that the interpreter does not evaluate. A function is no such code:
    it stays in the value as it is."""
    for expression in expressions_in(data):
        expr = parse_expression(expression.text)
        if isinstance(expr, Lambda) and not names:
            continue
        if expr is None or not can_evaluate(expr, names):
            return True
    return False


def _replaced(node: Node, path: str, samples: dict[str, list[Sample]]) -> Node:
    if isinstance(node, Leaf):
        return node
    given = {sample.key: sample.value for sample in samples.get(path, ())}
    children = tuple(_replaced(child, f"{path}/{child.name}", samples) for child in node.children)
    presets = tuple(_preset(preset, given) for preset in node.userdata)
    node = replace(node, children=children, userdata=presets)
    if isinstance(node, Iterator) and node.items is not None and ITEMS in given:
        node = replace(node, items=Value(data=_data(given[ITEMS]), span=node.items.span))
    return node


def _preset(preset: Preset, given: dict[str, object]) -> Preset:
    if preset.key not in given:
        return preset
    return replace(preset, value=Value(data=_data(given[preset.key]), span=preset.value.span))


def _data(value: object) -> Data:
    """A sample as the value of a script."""
    match value:
        case list():
            return tuple(map(_data, value))
        case dict():
            return Struct(entries=tuple((str(key), _data(part)) for key, part in value.items()))
        case None | bool() | int() | float() | str():
            return value
    raise TypeError(value)
