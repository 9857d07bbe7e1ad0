"""Plausible constants: values that states could have written, by type."""

from __future__ import annotations

from smachac.analysis.type_inference import infer
from smachac.ir.nodes import Iterator, Leaf, Machine
from smachac.ir.traversal import PREEMPTED, containers, remapping, walk
from smachac.ir.types import ANY, Type
from smachac.verify.shared_keys import contended

FLAT = (0.0, 0.0, 0.0, 1.0)
"""The quaternion x, y, z, w of no rotation."""


def constant(type_: Type, number: int) -> object:
    """A value of a type as a script would write it; other numbers give other values, if there are
    any.

    Of nothing known it is a list, which an iterator can go through; of a type that is known by name
    alone, nothing.
    """
    match type_.name, type_.args:
        case "bool", _:
            return number % 2 == 0
        case "int", _:
            return number
        case "float", _:
            return number + 0.5
        case "str", _:
            return f"text {number}"
        case "optional", (Type() as inner,):
            return constant(inner, number)
        case "one_of" | "literal", choices if choices:
            return choices[number % len(choices)]
        case "any", _:
            return [number, number + 1]
        case "list" | "dict", items:
            return _collection(type_.name, items, 2, number)
        case "array", (_, int() as size):
            return _collection("list", type_.args, size, number)
        case "tuple", parts:
            return [constant(part, number) for part in parts if isinstance(part, Type)]
        case "record", pairs:
            return {
                str(name): constant(part, number)
                for name, part in zip(pairs[::2], pairs[1::2], strict=True)
                if isinstance(part, Type)
            }
        case name, _:
            return _struct(name, number)


def _collection(name: str, items: tuple[Type | int | str, ...], size: int, number: int) -> object:
    inside = next((each for each in items if isinstance(each, Type)), Type("int"))
    values = [constant(inside, number + at) for at in range(size)]
    return {f"k{at}": value for at, value in enumerate(values)} if name == "dict" else values


def _struct(name: str, number: int) -> object:
    """As scripts write them: the first four as lists, the others as mappings."""
    point = [number + 0.5, 0.25, 0.75]
    match name:
        case "Point":
            return point
        case "Quaternion":
            return list(FLAT)
        case "Pose" | "Transform":
            return [point, list(FLAT)]
        case "PoseStamped":
            return {"frame_id": "base", "stamp": number + 0.5, "pose": [point, list(FLAT)]}
        case "JointState":
            numbers = [number + 0.5]
            return {"name": ["joint"], "position": numbers, "velocity": [0.0], "effort": [0.0]}
    return None if name == "none" or "/" in name or "." in name else number


def given(machine: Machine) -> dict[str, object]:
    """What a machine that declares inputs finds there, where its script does not preset them."""
    preset = {each.key for each in machine.root.userdata}
    return {
        key.name: constant(key.type, number)
        for number, key in enumerate(machine.root.inputs)
        if key.name not in preset
    }


class Constants:
    """What the leaves of a machine write when a scenario speaks for them.

    Every visit writes something else, so that a value tells where it comes from; but where two
    branches of a concurrence share keys, all that is of one type is the same.
    """

    def __init__(self, machine: Machine) -> None:
        self._types = infer(machine)
        self._iterators = {
            path for path, node in containers(machine.root) if isinstance(node, Iterator)
        }
        self._numbers = {path: number for number, (path, _) in enumerate(walk(machine.root))}
        self._alike = tuple(f"{path}/" for path in contended(machine))

    def written(
        self, path: str, leaf: Leaf, outcome: str, visit: int
    ) -> tuple[tuple[str, object], ...]:
        """The outputs that a leaf writes on an outcome, at that visit."""
        bound = {key for _, keys in leaf.writes for key in keys}
        here = {key for name, keys in leaf.writes if name == outcome for key in keys}
        number = 1 if path.startswith(self._alike) else self._numbers[path] + visit
        return tuple(
            (key.name, constant(self._type(path, leaf, key.name), number))
            for key in leaf.outputs
            if (key.name in here if key.name in bound else outcome != PREEMPTED)
        )

    def _type(self, path: str, leaf: Leaf, key: str) -> Type:
        """The type of the key of the container, which the child of an iterator sees as it is
        (smach-semantics I7); else what is known of the output."""
        around = path.rpartition("/")[0]
        outer = key if around in self._iterators else remapping(leaf).get(key, key)
        type_ = self._types.keys.get((around, outer), ANY)
        return self._types.outputs[path, key] if type_ == ANY else type_
