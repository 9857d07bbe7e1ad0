"""The modules of the state package: one class for each state type, as the FlexBE App reads them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from keyword import iskeyword

from smachac.ir.nodes import Key, Leaf, Machine
from smachac.ir.traversal import walk
from smachac.records import dataclass
from smachac.targets import comment, made_by
from smachac.targets.flexbe.names import own_outcomes
from smachac.targets.python.formatter import docstring

Interface = tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]]
"""The outcomes, input keys and output keys of a state."""

TAKEN = {
    *("Autonomy", "Behavior", "Logger", "EventState"),
    *("OperatableStateMachine", "ConcurrencyContainer", "PriorityContainer"),
    *("Join", "Loop", "node", "self", "str"),
}
"""Names of a behavior that no class of a state may have."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StateClass:
    """The class of a state type and its module. `interface` is None where states of the type differ
    in it: then it has parameters for it."""

    name: str
    module: str
    type: str
    interface: Interface | None
    key_types: tuple[tuple[str, str], ...]


def interface_of(leaf: Leaf) -> Interface:
    """The interface of a state in FlexBE."""
    inputs = tuple(key.name for key in leaf.inputs)
    outputs = tuple(key.name for key in leaf.outputs)
    return own_outcomes(leaf), inputs, outputs


def state_classes(machine: Machine) -> Mapping[str, StateClass]:
    """The class of each state, by its path."""
    leaves = {path: node for path, node in walk(machine.root) if isinstance(node, Leaf)}
    interfaces: dict[str, set[Interface]] = {}
    for leaf in leaves.values():
        interfaces.setdefault(leaf.type, set()).add(interface_of(leaf))
    taken = {name.lower() for name in TAKEN}
    made: dict[str, StateClass] = {}
    for leaf in leaves.values():
        if leaf.type in made:
            continue
        (*_, interface) = found = interfaces[leaf.type]
        name = _class_name(leaf.type, taken)
        made[leaf.type] = StateClass(
            name=name,
            module=_module_name(name),
            type=leaf.type,
            interface=interface if len(found) == 1 else None,
            key_types=tuple((key.name, _type_word(key)) for key in (*leaf.inputs, *leaf.outputs)),
        )
    return {path: made[leaf.type] for path, leaf in leaves.items()}


def _module_name(name: str) -> str:
    word = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()
    return word if word.endswith("_state") else f"{word}_state"


def _class_name(type_: str, taken: set[str]) -> str:
    """A name that differs from the others in more than case and `_`, as file names need."""
    word = re.sub(r"\W+", "_", type_, flags=re.ASCII).strip("_") or "State"
    word = f"State_{word}" if word[0].isdigit() or iskeyword(word) else word
    name, count = word, 2
    while name.lower().replace("_", "") in taken:
        name, count = f"{word}{count}", count + 1
    taken.add(name.lower().replace("_", ""))
    return name


def state_text(machine: Machine, state: StateClass, package: str) -> str:
    """The module of a class."""
    if state.interface is None:
        given = "outcomes, input_keys, output_keys"
        interface = [f"{name}={name}" for name in given.split(", ")]
        lines = [
            "--  outcomes  list  The outcomes of the state.",
            "--  input_keys  list  The keys that it reads.",
            "--  output_keys  list  The keys that it writes.",
        ]
    else:
        given = ""
        outcomes, inputs, outputs = state.interface
        interface = [f"outcomes={[*outcomes]!r}"]
        interface += [f"input_keys={[*inputs]!r}"] if inputs else []
        interface += [f"output_keys={[*outputs]!r}"] if outputs else []
        types = dict(state.key_types)
        lines = [f">#  {key}  {types[key]}  An input." for key in inputs]
        lines += [f"#>  {key}  {types[key]}  An output." for key in outputs]
        lines += [f"<=  {name}  An outcome." for name in outcomes]
    doc = comment(f"The state type {state.type} of the script.")
    body = "\n".join(f"    {docstring(line)}".rstrip() for line in [doc, "", *lines])
    before = f"self, {given}" if given else "self"
    arguments = (",\n" + " " * 25).join(interface)
    return f"""\
# {made_by(machine)}
from {package}.smachac_flexbe import EventState


class {state.name}(EventState):
    \"""
{body}
    \"""

    def __init__({before}):
        super().__init__({arguments})
"""


def _type_word(key: Key) -> str:
    """The type of a key as one word."""
    return re.sub(r"\s+", "", str(key.type)) or "object"
