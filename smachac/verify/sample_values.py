"""Sample values by type: what leaves write in test cases."""

from __future__ import annotations

from smachac.analysis.type_inference import infer
from smachac.ir.nodes import Iterator, Leaf, Machine
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import containers, remapping, walk
from smachac.ir.types import ANY, Type
from smachac.verify.shared_keys import contended_keys

FLAT = (0.0, 0.0, 0.0, 1.0)
"""The identity rotation as a quaternion x, y, z, w."""


def sample_value(type_: Type, number: int) -> object:
    """A value of a type, as a script would write it; different numbers give different values if the
    type has several.

    For an unknown type the value is a list, so that an iterator can use it; for a type known by
    name only, it is None.
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
            return sample_value(inner, number)
        case "one_of" | "literal", choices if choices:
            return choices[number % len(choices)]
        case "any", _:
            return [number, number + 1]
        case "list" | "dict", items:
            return _collection(type_.name, items, 2, number)
        case "array", (_, int() as size):
            return _collection("list", type_.args, size, number)
        case "tuple", parts:
            return [sample_value(part, number) for part in parts if isinstance(part, Type)]
        case "mapping" | "record", pairs:
            return {
                str(name): sample_value(part, number)
                for name, part in zip(pairs[::2], pairs[1::2], strict=True)
                if isinstance(part, Type)
            }
        case name, _:
            return _struct(name, number)


def _collection(name: str, items: tuple[Type | int | str, ...], size: int, number: int) -> object:
    inside = next((item for item in items if isinstance(item, Type)), Type("int"))
    values = [sample_value(inside, number + at) for at in range(size)]
    return {f"k{at}": value for at, value in enumerate(values)} if name == "dict" else values


def _struct(name: str, number: int) -> object:
    """A struct as scripts write it: the first four as lists, the others as mappings."""
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


def sample_inputs(machine: Machine) -> dict[str, object]:
    """Values for the declared inputs of a machine that its script does not preset."""
    preset = {preset.key for preset in machine.root.userdata}
    return {
        key.name: sample_value(key.type, number)
        for number, key in enumerate(machine.root.inputs)
        if key.name not in preset
    }


class SampleValues:
    """The values that the leaves of a machine write in test cases.

    Every visit writes different values, so that a value identifies its origin. Exception: where
    branches of a concurrence share keys, all values of one type are equal.
    """

    def __init__(self, machine: Machine) -> None:
        self._types = infer(machine)
        self._iterators = {
            path for path, node in containers(machine.root) if isinstance(node, Iterator)
        }
        self._numbers = {path: number for number, (path, _) in enumerate(walk(machine.root))}
        self._contended = tuple(f"{path}/" for path in contended_keys(machine))

    def outputs(
        self, path: str, leaf: Leaf, outcome: str, visit: int
    ) -> tuple[tuple[str, object], ...]:
        """The outputs that a leaf writes at a visit with an outcome."""
        bound = {key for _, keys in leaf.writes for key in keys}
        here = {key for name, keys in leaf.writes if name == outcome for key in keys}
        number = 1 if path.startswith(self._contended) else self._numbers[path] + visit
        return tuple(
            (key.name, sample_value(self.type_of(path, leaf, key.name), number))
            for key in leaf.outputs
            if (key.name in here if key.name in bound else outcome != PREEMPTED)
        )

    def type_of(self, path: str, leaf: Leaf, key: str) -> Type:
        """The inferred type of the key in the container; if it is unknown, the type of the output.

        The child of an iterator sees the keys of the iterator under their own names
        (docs/semantics.md, Iterator).
        """
        around = path.rpartition("/")[0]
        outer = key if around in self._iterators else remapping(leaf)[key]
        type_ = self._types.keys.get((around, outer), ANY)
        return self._types.outputs[path, key] if type_ == ANY else type_
