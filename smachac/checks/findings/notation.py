"""Code in helps, in the language in which a machine is written: YAML in scripts, or Python."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

from smachac.diagnostics.spelling import written_name
from smachac.ir.nodes import Leaf, Node

UNDECIDED = "..."
"""In code in place of a name that is not certain."""


def is_python(node: Node) -> bool:
    """Whether a state is written in Python, with the calls of SMACH."""
    return node.span.source.language == "python"


def entry(node: Node, key: str, value: str) -> str:
    """An entry of a mapping from names to names: `done: PLACE`, or `'done': 'PLACE'`."""
    return f"{_word(node, key)}: {_word(node, value)}"


def entries(node: Node, pairs: Iterable[tuple[str, str]]) -> str:
    """Entries of a mapping from names to names, with commas."""
    return ", ".join(entry(node, key, value) for key, value in pairs)


def mapping(node: Node, part: str, pairs: Iterable[tuple[str, str]]) -> str:
    """A field that maps names to names: `remapping: {pose: goal}`, or
    `remapping={'pose': 'goal'}`."""
    return field(node, part, f"{{{entries(node, pairs)}}}")


def rule(node: Node, outcome: str, conditions: Iterable[tuple[str, str]]) -> str:
    """A rule of an outcome map: `lost: {LEFT: failed}`, or `'lost': {'LEFT': 'failed'}`."""
    return f"{_word(node, outcome)}: {{{entries(node, conditions)}}}"


def _word(node: Node, text: str) -> str:
    if text == UNDECIDED:
        return text
    return repr(text) if is_python(node) else written_name(text)


def names(node: Node, part: str, listed: Iterable[str]) -> str:
    """A field that is a list of names: `input_keys: [pose]`, or `input_keys=['pose']`."""
    if is_python(node):
        return f"{part}={[*listed]!r}"
    return f"{part}: [{', '.join(listed)}]"


def name(node: Node, part: str, text: str) -> str:
    """A field that is one name: `default_outcome: failed`, or `default_outcome='failed'`."""
    return field(node, part, _word(node, text))


def field(node: Node, part: str, code: str) -> str:
    """A field with code that is already in the language of the state."""
    return f"{part}={code}" if is_python(node) else f"{part}: {code}"


def initial_values(container: Node, values: Iterable[tuple[str, str]]) -> str:
    """Initial values of keys of a container: `userdata: {tries: 0}`, or `userdata.tries = 0`."""
    if is_python(container):
        return "; ".join(f"userdata.{key} = {value}" for key, value in values)
    return f"userdata: {{{', '.join(f'{key}: {value}' for key, value in values)}}}"


def is_function(leaf: Leaf) -> bool:
    """Whether the code of a state is a function, as that of a CBState."""
    return leaf.class_facts is not None and leaf.class_facts.is_function


def code_of(leaf: Leaf) -> str:
    """The code of a state type: that of a class, or a function."""
    return f"`{leaf.type}`" if is_function(leaf) else f"the code of `{leaf.type}`"


def own_key(leaf: Leaf, role: Literal["input", "output"]) -> str:
    """A key that the interface of a state type declares, or its class, or the state."""
    if is_function(leaf):
        return f"one of the {role} keys of `{leaf.name}`"
    return f"one of its {role} keys" if is_python(leaf) else f"an {role} key of its interface"


def declared(leaf: Leaf) -> str:
    """The owner of the names that a state declares: the interface of its type, its class, or the
    state itself if its code is a function."""
    if not is_python(leaf):
        return f"the interface `{leaf.type}`"
    return f"`{leaf.name}`" if is_function(leaf) else f"`{leaf.type}`"
