"""Input keys of states that send a goal or a request, which no part of the state reads."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping

from smachac.analysis.code_slots import code_slots, userdata_parameter
from smachac.analysis.context import Context
from smachac.analysis.message_code import leaf_definitions
from smachac.analysis.uses import place_of
from smachac.checks.help_text import calls
from smachac.diagnostics.diagnostic import Finding
from smachac.diagnostics.spelling import guesser
from smachac.ir.leaf import variable_of
from smachac.ir.message_types import PARTS
from smachac.ir.nodes import DEFINITION_KINDS, Key, Leaf, StateType, VariableRole
from smachac.ir.script_code import USERDATA, fields_of, free_names

SENDERS: tuple[VariableRole, ...] = ("service_type", "action_type")
"""The roles of the types of what a state sends."""


def unsent_keys(context: Context) -> Iterator[Finding]:
    """The input keys of built-in states with a goal or a request that neither a list of keys nor
    a function of the state names (SM306): the message is sent without them."""
    types = context.machine.state_types
    for path, leaf in context.leaves_with_variables:
        if not leaf.built_in or leaf.open or not leaf.inputs:
            continue
        roles: list[VariableRole] = [sender for sender in SENDERS if variable_of(leaf, sender)]
        role = roles[0] if roles else None
        used = _keys_used(leaf, types) if role is not None else None
        if role is None or used is None or not used <= {key.name for key in leaf.inputs}:
            continue
        part = PARTS[DEFINITION_KINDS[role]][0]
        for key in leaf.inputs:
            if key.name not in used and guesser(used)(key.name) is None:
                yield _unsent(context, path, leaf, key, part)


def _keys_used(leaf: Leaf, types: Mapping[str, StateType]) -> set[str] | None:
    """The keys that a state names in its lists and reads in its functions; None if not known."""
    known = types[leaf.type].variables if leaf.type in types else {}
    used: set[str] = set()
    functions = {slot.name: slot for slot in code_slots(leaf, types)}
    for held in leaf.variables:
        fact, data = known.get(held.name), held.value.data
        if fact is None or data is None:
            continue
        if fact.keys:
            if not isinstance(data, tuple) or not all(isinstance(value, str) for value in data):
                return None
            used |= {str(value) for value in data} if fact.keys == "input" else set()
        elif fact.arguments is not None:
            slot = functions.get(held.name)
            name = userdata_parameter(slot) if slot is not None else None
            tree = slot.tree if slot is not None else None
            if not isinstance(tree, ast.Lambda) or name is None:
                return None
            if any(name.id in USERDATA for name in free_names(tree)):
                return None  # SM019: another name for the userdata was meant
            fields = fields_of(tree.body, frozenset([name]))
            if fields is None:
                return None
            used |= {*fields.read, *fields.tested}
    return used


def _unsent(context: Context, path: str, leaf: Leaf, key: Key, part: str) -> Finding:
    span = place_of(leaf, key)
    definitions = [one for _, found in leaf_definitions(leaf, context.machine.definitions)
                   for one in found]  # fmt: skip
    fits = all(one.part(part).field(key.name) is not None for one in definitions)
    given = any(
        held.value.data is not None and (held.role == part or held.name == f"{part}_cb")
        for held in leaf.variables
    )
    add = f"write `{part}_slots: [{key.name}]`"
    if not fits:
        add = f"set a field of the {part} in `{part}_cb`: the {part} has no field `{key.name}`"
    return Finding(
        span=span,
        message=f"`{leaf.name}` declares the input key `{key.name}`, but neither `{part}_slots` nor"
        " one of its functions reads it",
        arguments=("input", key.name),
        help=f"{add}; or remove `{key.name}` from the `input_keys` of `{leaf.name}`",
        effect=f"the {part} is sent without its value"
        if given
        else f"the {part} is sent empty: each field has its default value",
        related=calls(leaf, span),
        node=path,
    )
