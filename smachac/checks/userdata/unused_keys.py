"""Declared keys that a state does not use (SM306): outputs that neither functions of a script nor
the code of a built-in state type write, and inputs that no part of a sent message reads."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from smachac.analysis.accesses import callback_names, received_part, unreceived_outputs
from smachac.analysis.code_slots import code_slots, userdata_parameter
from smachac.analysis.context import Context
from smachac.analysis.error_recovery import undeclared_writes
from smachac.analysis.message_code import leaf_definitions
from smachac.analysis.uses import place_of
from smachac.checks.findings.help_text import calls
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import both, listed
from smachac.ir import nodes
from smachac.ir.leaf import functions, variable_of
from smachac.ir.message_types import PARTS, Definitions
from smachac.ir.nodes import DEFINITION_KINDS, Container, Key, Leaf, StateType, VariableRole
from smachac.ir.script_code import USERDATA, fields_of, free_names
from smachac.ir.traversal import remapping


class Unwritten(NamedTuple):
    """An output key that a state never writes; `names` are the keys that its type can write.

    `slots`: the field of the state whose keys receive the fields of a response or result.
    """

    path: str
    leaf: Leaf
    key: Key
    names: tuple[str, ...]
    slots: str = ""


def unwritten_keys(context: Context) -> tuple[Unwritten, ...]:
    """The output keys that states of a machine never write: they are neither keys of the state type
    nor those of a function of the script."""
    return context.at_containers(_unwritten_in, context.machine.state_types)


def _unwritten_in(
    path: str, container: Container, types: Mapping[str, StateType]
) -> Iterator[Unwritten]:
    if isinstance(container, nodes.Iterator) and not container.sugar:
        return  # its child can use keys that it does not declare
    for child in container.children:
        if child.outputs and isinstance(child, Leaf) and not (child.open or child.stand_in):
            yield from _unwritten(f"{path}/{child.name}", child, types)


def _unwritten(path: str, leaf: Leaf, types: Mapping[str, StateType]) -> Iterator[Unwritten]:
    type_ = types.get(leaf.type)
    part = received_part(leaf)
    if part is not None and type_ is not None:
        slots = next(
            (name for name, variable in type_.variables.items() if variable.role == part), ""
        )
        unset = unreceived_outputs(leaf) if slots else ()
        yield from (Unwritten(path, leaf, key, (), slots) for key in leaf.outputs
                    if key.name in unset)  # fmt: skip
        return
    results = [key for key in leaf.outputs if key.role == "result"]
    if not results or type_ is None or not _writes_only_known(leaf, type_):
        return
    undeclared = undeclared_writes(leaf)
    guess = guesser(key.name for key in leaf.outputs)
    made = {*callback_names(leaf), *(guess(name) for name in undeclared)}
    unmade = [key for key in results if key.name not in made]
    if len(unmade) == 1 and len(undeclared) == 1:
        return  # SM308 names both
    names = _names(type_) if leaf.built_in else ()
    yield from (Unwritten(path, leaf, key, names) for key in unmade)


def _writes_only_known(leaf: Leaf, type_: StateType) -> bool:
    """Whether a state writes nothing but keys of its type and those of its callbacks. In a type of
    the user, keys with the role of results are those of callbacks."""
    roles = {variable.role for variable in type_.variables.values()}
    if not leaf.built_in:
        return bool(functions(leaf, "callbacks"))
    if "output_function" in roles:
        held = variable_of(leaf, "output_function")
        return held is None or held.value.data is None
    if "callbacks" in roles:
        callbacks = functions(leaf, "callbacks")
        return callbacks is not None and bool(callbacks or _names(type_))
    return "conditions" in roles


def _names(type_: StateType) -> tuple[str, ...]:
    """The keys that the code of a state type writes."""
    every = [*(key.name for key in type_.output_keys), *type_.listed_outputs]
    return tuple(dict.fromkeys(name for name in every if name != "*"))


def read_unwritten(context: Context) -> Mapping[tuple[str, str], tuple[str, str]]:
    """Such keys, and outputs of containers that nothing in them sets, that a state reads but
    nothing else sets: by the path and the key of the state that never writes them, the path and the
    key of the container."""
    scopes = context.absorbed_flow.scopes
    missing = {(key.scope.path, key.key) for key in context.missing_keys("unset", "nowhere")}
    never = {
        (unwritten.path, unwritten.key.name): remapping(unwritten.leaf)[unwritten.key.name]
        for unwritten in context.of_machine(unwritten_keys)
        if unwritten.leaf.built_in
    }
    for path, scope in scopes.items() if missing else ():
        never |= {(path, key): outer for key, outer in scope.outputs.items()
                  if key not in scope.uses.provided}  # fmt: skip
    found: dict[tuple[str, str], tuple[str, str]] = {}
    for (path, key), name in never.items():
        outer = path.rpartition("/")[0], name
        if outer not in missing or outer[0] not in scopes:
            continue
        writers = scopes[outer[0]].uses.writers(name)
        if all((use.path, use.key) in never for use in writers):
            found[path, key] = outer
    return found


def unwritten_finding(found: Unwritten, *, read: bool) -> Finding | None:
    """The finding on such a key. `read`: a state reads it, but it is unset; a state whose
    conditions alone are code of the script is harmless otherwise."""
    path, leaf, key, names, _ = found
    if not read and variable_of(leaf, "conditions") is not None:
        return None
    span = place_of(leaf, key)
    message = (
        f"`{leaf.name}` declares the output key `{key.name}`, but none of its functions sets it"
    )
    callback = f"add a callback: `callbacks: {{{key.name}: 'lambda ud: ...'}}`"
    help = f"remove `{key.name}` from the `output_keys` of `{leaf.name}`, or {callback}"
    if names:
        message = f"`{leaf.name}` never writes `{key.name}`: `{leaf.type}` writes {listed(names)}"
        free = [name for name in names if all(output.name != name for output in leaf.outputs)]
        meant = guesser(free)(key.name) or (free[0] if free else None)
        outer = remapping(leaf)[key.name]
        if meant is not None:
            help = f"write `output_keys: [{meant}]` and `remapping: {{{meant}: {outer}}}`"
        if any(variable.role == "callbacks" for variable in leaf.variables):
            help += f", or {callback}"
    return Finding(
        span=span,
        message=message,
        arguments=("output", key.name),
        help=help,
        effect="a state that reads the key afterwards finds it unset, or with an older value",
        related=calls(leaf, span),
        severity=Severity.ERROR if read else None,
        node=path,
    )


def unreceived_finding(
    every: Sequence[Unwritten], definitions: Definitions, *, read: bool
) -> Finding:
    """The finding on the output keys of one state that receive no field of a response or result.
    `read`: a state reads one of them, but it is unset."""
    path, leaf, key, _, slots = every[0]
    part, span = received_part(leaf) or "response", place_of(leaf, key)
    names = [unwritten.key.name for unwritten in every]
    kinds = [one for _, found in leaf_definitions(leaf, definitions) for one in found]
    known = {field.name for one in kinds for field in one.part(part).fields}
    others = [name for name in names if kinds and name not in known]
    held = next((variable for variable in leaf.variables if variable.name == slots), None)
    listed_ = held is not None and held.value.data
    fits = [name for name in names if name not in others]
    help = f"add `{slots}: [{', '.join(fits)}]` to `{leaf.name}`"
    if listed_:
        help = f"add {both(fits)} to the `{slots}` of `{leaf.name}`"
    if not fits:
        help = f"the {part} has no field {listed(others)}: set the key in `{part}_cb`"
        if known:
            help += f", or list a field of the {part} in `{slots}`: {listed(sorted(known))}"
    what = f"key {both(names)}" if len(names) == 1 else f"keys {both(names)}"
    them = "it" if len(names) == 1 else "them"
    return Finding(
        span=span,
        message=f"`{leaf.name}` declares the output {what}, but neither `{slots}` nor one of its"
        f" functions sets {them}",
        arguments=("output", *names),
        help=help,
        effect="a state that reads the key afterwards finds it unset, or with an older value",
        related=calls(leaf, span),
        severity=Severity.ERROR if read else None,
        node=path,
    )


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
