"""The fields of a state, each read once into a typed field.

Reported are unknown fields (SM003), values of the wrong shape (SM004) and missing fields (SM005).
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from smachac.diagnostics.diagnostic import Diagnostic, Related, Report, did_you_mean
from smachac.diagnostics.repair import Edit
from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.spelling import (
    MOST_EXPLAINED,
    guesser_of,
    is_plain,
    written_name,
)
from smachac.diagnostics.wording import listed
from smachac.frontend import schema
from smachac.frontend.errors.script import (
    Choice,
    Owner,
    missing_variable,
    one_of_many,
    unknown_variable,
    unused_variable,
    wrong_shape,
)
from smachac.frontend.resolved_script import State
from smachac.frontend.schema import FieldOwner
from smachac.frontend.script.extra_keys import check_interface
from smachac.frontend.script.missing_outcomes import outcomes_used
from smachac.frontend.script.params import Scope
from smachac.frontend.script.sugar import NAMES, is_own, read_sugar
from smachac.frontend.text.fields import (
    READERS,
    YAML_1_1_BOOLEANS,
    Pairs,
    as_outcomes,
    listed_keys,
    name_of,
    wrong,
)
from smachac.frontend.text.unquoted import check_name, check_unquoted
from smachac.frontend.text.values import as_value, as_written
from smachac.frontend.text.yaml_tree import Entry, Map, Scalar, Seq, Tree, is_known_wrong
from smachac.frontend.types import value_facts
from smachac.ir.nodes import (
    StateType,
    Struct,
    Value,
    Variable,
    VariableType,
)
from smachac.ir.types import ANY, EXAMPLES

Entries = Mapping[str, Entry]
"""Fields by long name, as written; the entry's key is the name as written."""

_FIELDS = frozenset(State._fields) & frozenset(schema.VARIABLES)
"""The fields of the schema that a state keeps; tests compare their types with the readers'."""

_ALL_FIELDS = frozenset(schema.VARIABLES)

FIELDS_OF_STATES = tuple(schema.names_for("state"))

TEMPLATE_WORDS = frozenset(
    ["action", "behavior", "behaviour", "class", "kind", "skill", "state", "state_type", "type"]
)
"""Words that other tools use for `template`."""

_READ_ELSEWHERE = frozenset(["template", "states", "types", *NAMES])
"""The fields that need more than their value to be read: the library, or the state type."""

_BASE_VARIABLES = ("node_name", "function_name", "manifest")
"""The fields of the base that are variables of every base type."""


class FieldTable(NamedTuple):
    """What follows from the names of the fields of a state, its owner and its state type alone, so
    that it is found once for all states that have these in common.

    `others`: there are fields that neither the schema nor the interface of the type has. `shapes`:
    the fields of the schema that are read, with their shapes. `missing`: the required fields that
    are missing. `variables`: the fields that are variables of the type. Those in `lists` must be
    lists of keys, those in `listed` add keys to a field of the schema, and those in `unquoted` are
    text that programs contain without quotes.
    """

    owner: FieldOwner
    others: bool
    shapes: tuple[tuple[str, str], ...]
    missing: tuple[str, ...]
    variables: tuple[tuple[str, VariableType | None], ...]
    lists: tuple[str, ...]
    listed: tuple[tuple[str, str], ...]
    unquoted: tuple[tuple[str, VariableType], ...]


def field_table(names: Collection[str], owner: FieldOwner, type_: StateType) -> FieldTable:
    """The table for states with fields of these long names."""
    own, known = schema.OWN_FIELDS[owner], type_.variables
    required = [*schema.REQUIRED[owner], *(key for key in known if known[key].required)]
    given = [(key, variable) for key, variable in known.items() if key in names]
    keys = [(key, type_) for key, type_ in given if type_.keys in ("input", "output")]
    if owner == "base":
        called = [key for key in (*_BASE_VARIABLES, *known) if key in names]
    else:
        called = [key for key in names if key not in own or (key in NAMES and is_own(key, type_))]
    shapes = [
        (key, row.shape)
        for key, row in ((key, schema.VARIABLES.get(key)) for key in names)
        if row is not None and (key in own or _is_field(key, owner, type_))
    ]
    return FieldTable(
        owner=owner,
        others=any(key not in own and key not in known for key in names),
        shapes=tuple(row for row in shapes if row[0] not in _READ_ELSEWHERE),
        missing=tuple(key for key in required if key not in names),
        variables=tuple((key, known.get(key)) for key in called),
        lists=tuple(key for key, type_ in keys if type_.type == ANY),
        listed=tuple((f"{type_.keys}_keys", key) for key, type_ in keys),
        unquoted=tuple(
            (key, type_) for key, type_ in given if type_.unquoted or type_.role == "qos"
        ),
    )


def read_fields(
    name: Word,
    entries: Entries,
    type_: StateType,
    table: FieldTable,
    report: Report,
    *,
    scope: Scope,
    inner: Word | None,
) -> dict[str, Any]:
    """The fields of a state, as arguments of State.

    `table` is that of the names of `entries`. `scope` are the params in its scope; `inner` is its
    name in the sub-script, if it is called.
    """
    owner = table.owner
    before = len(report)
    rejected: set[str | None] = set()
    if table.others:
        read, rejected = _known_fields(entries, owner, type_, report)
    else:
        read = _fields_of_schema(table, entries, report)
    if len(report) > before and "transitions" in read:
        read["transitions"] = _recovered_booleans(read["transitions"], type_, report, before)
    if owner != "base" or read.get("name") is None or is_known_wrong(entries["name"].value):
        read["name"] = name
    if owner == "state" and "default_outcome" in entries and "default_outcome" not in read:
        given = entries["default_outcome"].value
        read["default_outcome"] = None if is_known_wrong(given) else name_of(given)
    if not NAMES.isdisjoint(entries):
        written = (word.text for word, _ in read.get("input_keys", ()))
        inputs = (*written, *(key.name for key in type_.input_keys))
        read["sugar"] = read_sugar(entries, type_, read.get("outcomes", ()), inputs, report)
    if "outcomes" in schema.REQUIRED[owner] and "outcomes" not in entries:
        read["outcomes"] = outcomes_used(entries)
    if owner == "state" and not type_.open:
        check_interface(read, type_, report)
    for key in table.lists:
        _check_list(entries[key].value, report)
    for part, key in table.listed:
        read[part] = (*read.get(part, ()), *listed_keys(entries[key].value))
    missing = [key for key in table.missing if key not in rejected]
    unquoted = [(key, variable) for key, variable in table.unquoted
                if not _is_name_for_type(key, variable, entries, missing, report)]  # fmt: skip
    if missing:
        _report_missing(missing, entries, owner, type_, read, inner, report)
    if table.variables:
        read["variables"] = tuple(_variables(table, entries, type_))
    if owner == "base" and "function_name" in entries:
        check_unquoted(entries["function_name"].value, "name", report)
    for key, variable in unquoted:
        _check_unquoted(entries[key].value, variable, report)
    if type_.prints_itself:
        read["written"] = tuple(_written(read["name"], entries, scope))
    return read


def _recovered_booleans(steps: Pairs, type_: StateType, report: Report, begin: int) -> Pairs:
    """The transitions, with the outcomes `true` and `false` of the type in place of other words for
    booleans, such as `yes`; the help of their finding (SM004) has the outcome that is meant. The
    findings of this state begin at the number `begin`."""
    names = {outcome.name for outcome in type_.outcomes}
    places = {diagnostic.span: number for number, diagnostic in enumerate(report[begin:], begin)}
    found: list[tuple[Word, Word]] = []
    for word, target in steps:
        meant = YAML_1_1_BOOLEANS.get(word.text, "")
        if meant in names and word.text not in names and word.span in places:
            message = f"`{word.text}` is a boolean for many YAML parsers, not an outcome"
            help = f"write the outcome in quotes: '{meant}'"
            report[places[word.span]] = wrong_shape(
                word.span, message, help, arguments=("boolean", word.text)
            )
            word = Word(meant, word.span)
        found.append((word, target))
    return tuple(found)


def accepts(type_: StateType, name: str) -> bool:
    """Whether a state type has a variable, or accepts any."""
    return name in type_.variables or type_.any_variable


def with_recovered_fields(
    entries: dict[str, Entry], owner: FieldOwner, type_: StateType, report: Report
) -> dict[str, Entry]:
    """The fields, with those of unknown names also under the names that are meant, where that is
    certain: then one misspelt name is one finding. The role of a variable means the variable, as
    `conditions` in a ConditionalOutcomeState, and so does its name in another framework. Fields
    whose name and value have changed places are reported."""
    own = schema.OWN_FIELDS[owner]
    if own.issuperset(entries):
        return entries
    unknown = [
        key
        for key in entries
        if key not in own and (not accepts(type_, key) or _is_unused(key, type_))
    ]
    if not unknown:
        return entries
    guess = guesser_of((*schema.names_for(owner), *type_.variables))
    meant = {
        guess.unique_match(str(entries[key].key.value)): entries[key] for key in reversed(unknown)
    }
    roles: dict[str, str] = {
        variable.role: name for name, variable in type_.variables.items() if variable.role
    }
    meant |= {roles[key]: entries[key] for key in unknown if key in roles}
    for words in type_.other_names.values():
        meant |= {words[key]: entries[key] for key in unknown if key in words}
    other = next((entries[key] for key in unknown if key in TEMPLATE_WORDS), None)
    if other is not None and owner != "base":
        meant["template"] = other
    return {name: entry for name, entry in meant.items() if name is not None} | entries


def recovered_params(entries: Entries) -> Entry | None:
    """The field that is certainly a misspelt `params` (SM003)."""
    if _ALL_FIELDS.issuperset(entries):
        return None
    for key, entry in entries.items():
        is_map = key not in schema.VARIABLES and isinstance(entry.value, Map)
        if is_map and guesser_of(FIELDS_OF_STATES).unique_match(key) == "params":
            return entry
    return None


def _is_unused(key: str, type_: StateType) -> bool:
    """Whether a template that accepts any variable has no use of this one."""
    return type_.used is not None and key not in type_.used and key not in type_.variables


def has_wrong_transitions(entries: Mapping[str, Entry], fields: Mapping[str, object]) -> bool:
    """Whether the transitions of a state have a wrong shape, which was reported: then it may lead
    anywhere."""
    given = entries.get("transitions")
    return given is not None and not isinstance(given.value, Map) and not fields.get("transitions")


def has_unknown_outcomes(entries: Mapping[str, Entry], fields: Mapping[str, Any]) -> bool:
    """Whether a look-up in the outcomes of a state failed, which was reported. `fields` are those
    that were read: an outcome that is not known is not among them."""
    given = entries.get("outcomes")
    if given is None or isinstance(given.value, Scalar):
        return given is not None and is_known_wrong(given.value)
    items = given.value.items if isinstance(given.value, Seq) else ()
    return len(items) > len(fields.get("outcomes", ())) and any(map(is_known_wrong, items))


def _known_fields(
    entries: Entries, owner: FieldOwner, type_: StateType, report: Report
) -> tuple[dict[str, Any], set[str | None]]:
    """The fields of the schema, read, and for each unknown field the one that it looks like. An
    outcome beside the transitions is read as one of them."""
    read: dict[str, Any] = {}
    misplaced_transitions: list[tuple[Word, Word]] = []
    meant: set[str | None] = set()
    known_here, unknown = schema.OWN_FIELDS[owner], 0
    for key, entry in entries.items():
        if key in known_here or (key in schema.VARIABLES and _is_field(key, owner, type_)):
            if key not in _READ_ELSEWHERE:
                value = _read(key, schema.VARIABLES[key].shape, entry, report)
                if key in _FIELDS and (key != "name" or owner == "base"):
                    read[key] = value
        elif key in type_.variables:
            continue  # a rule checks it against its type
        elif type_.any_variable:
            if not type_.prints_itself and ("template" in entries or key not in TEMPLATE_WORDS):
                check_name(key, entry.key.span, report)
            if type_.used is not None and key not in type_.used:
                words = [*schema.names_for(owner), *type_.used]
                word = Word(str(entry.key.value), entry.key.span)
                template = Owner(type_.name, f"`{type_.name}`")
                report.append(unused_variable(word, template, words))
        else:
            known = schema.names_for(owner)
            word = Word(str(entry.key.value), entry.key.span)
            unknown += 1
            if unknown > MOST_EXPLAINED:
                report.append(one_of_many(word, _owner_of(owner, type_, of_type=owner == "state")))
                continue
            whose = _owner_of(owner, type_, of_type=owner == "state")
            own = [*type_.variables]
            also = [name for name, item in entries.items() if item is entry and name != key]
            sure = also[0] if also else None
            as_key = _as_key(word, entry, entries, type_)
            help = f"`{word.text}` is an input key: {as_key}" if as_key is not None else None
            target = name_of(entry.value) if key in _outcomes(entries, type_) else None
            if target is not None:
                misplaced_transitions.append((word, target))
                help = f"`{word.text}` is an outcome: write its transition inside `transitions:`"
            needed = sure if sure is not None and _is_required(sure, owner, type_) else None
            free = [name for name in (*known, *own) if name not in entries]
            owners = schema.special_owners(word.text)
            choice = Choice(likely=sure, required=needed, own=own, free=free, owners=owners)
            report.append(unknown_variable(word, whose, known, choice, help=help))
            if as_key is not None:
                read["misplaced_keys"] = (*read.get("misplaced_keys", ()), word.text)
            meant.add(guesser_of((*dict.fromkeys((*known, *own)),))(word.text))
            if len(own) == 1:
                meant.add(own[0])  # the message names the only variable
    if misplaced_transitions:
        read["transitions"] = (*read.get("transitions", ()), *misplaced_transitions)
    return read, meant


def _fields_of_schema(table: FieldTable, entries: Entries, report: Report) -> dict[str, Any]:
    """The fields of the schema, read, of a state without unknown fields."""
    read: dict[str, Any] = {}
    for key, shape in table.shapes:
        value = _read(key, shape, entries[key], report)
        if key in _FIELDS and (key != "name" or table.owner == "base"):
            read[key] = value
    return read


def _is_required(key: str, owner: FieldOwner, type_: StateType) -> bool:
    variable = type_.variables.get(key)
    return key in schema.REQUIRED[owner] or (variable is not None and variable.required)


def _as_key(word: Word, entry: Entry, entries: Entries, type_: StateType) -> str | None:
    """How to set an input key of a state type that is written as a variable; None for others."""
    names = {*(key.name for key in type_.input_keys), *type_.listed_inputs} - {"*"}
    if word.text not in names:
        return None
    text = entry.value.span.text
    given = text if "\n" not in text and len(text) <= LONGEST_VALUE else "..."
    held = next((key.type.name for key in type_.input_keys if key.name == word.text), "any")
    field = "userdata"
    if held not in ("any", "str", "one_of", "optional") and _is_plain_word(entry.value):
        field = "remapping"  # a name cannot be the value: it is that of another key
    help = f"write `{field}: {{{word.text}: {given}}}`"
    keys = entries.get("input_keys")
    if keys is None and word.text not in type_.listed_inputs:
        return help
    listed_here = (
        [] if keys is None else keys.value.span.text.replace(",", " ").strip("[]{}").split()
    )
    return help if word.text in listed_here else f"{help} and add `{word.text}` to its `input_keys`"


def _is_plain_word(tree: Tree) -> bool:
    """Whether a value is one name without quotes."""
    return (
        isinstance(tree, Scalar)
        and tree.plain
        and isinstance(tree.value, str)
        and tree.value.isidentifier()
    )


LONGEST_VALUE = 60
"""In characters; a longer value is not repeated in a help."""


def _is_field(key: str, owner: FieldOwner, type_: StateType) -> bool:
    """Whether a name is that of a field of the schema here. A variable that a type of the user
    declares has its own type, also under the name of a field of containers, such as `it`."""
    owners = schema.VARIABLES[key].owners
    own = owners and not type_.built_in
    return owner in owners or (key in type_.variables and not own)


def _read(key: str, shape: str, entry: Entry, report: Report) -> object:
    """The value of a field of the schema; one of the wrong shape, and a name that is none of the
    choices of the field, are reported."""
    if shape == "name" and not isinstance(entry.value, Scalar):
        wrong(entry.value, "name", report, _one_name(key, entry))
        return None
    value = READERS[shape](entry.value, report)
    choices = schema.FIELD_CHOICES.get(key, ())
    for word in _chosen(value) if choices else ():
        if word.text and word.text not in choices:
            message = f"`{word.text}` is not a value of `{key}`"
            help = did_you_mean(word.text, choices) or f"use one of {listed(choices)}"
            arguments = ("choice", key, word.text)
            report.append(wrong_shape(word.span, message, help, arguments=arguments))
    return value


def _chosen(value: object) -> list[Word]:
    """The words of a field that are its values: the only one, or those of pairs."""
    if isinstance(value, Word):
        return [value]
    return [word for _, word in value] if isinstance(value, tuple) else []


def _one_name(key: str, entry: Entry) -> str | None:
    """The help for a list or a mapping in place of one name: the only name in it, or where several
    can be written."""
    value = entry.value
    trees = [entry.value for entry in value.entries] if isinstance(value, Map) else []
    trees = [*value.items] if isinstance(value, Seq) else trees
    words = [name_of(tree) for tree in trees]
    if len(words) == 1 and words[0] is not None:
        return f"write one name: `{entry.key.value}: {words[0].text}`"
    return _SEVERAL.get(key)


_SEVERAL = {
    "initial": "write one state; to begin several at once, put them into a Concurrence",
    "on_error": "write one state; errors of one state have their own `error:` in its `transitions`",
    "robot": "write one robot; several robots in one world are a description with `parts:`",
    "scene": "write one file, which has the bodies of all",
}
"""The help for a field with one name that has several."""


def _outcomes(entries: Entries, type_: StateType) -> set[str]:
    """The names of the outcomes that a state has."""
    given = as_outcomes(entries["outcomes"].value, []) if "outcomes" in entries else ()
    return {outcome.name for outcome in (*type_.outcomes, *given)}


def _report_missing(
    missing: Sequence[str],
    entries: Entries,
    owner: FieldOwner,
    type_: StateType,
    read: Mapping[str, Any],
    inner: Word | None,
    report: Report,
) -> None:
    """Reports the required fields that are missing (SM005). `read` are the fields that were
    read."""
    name: Word = read["name"]
    for key in missing:
        whose = _owner_of(owner, type_, of_type=key in type_.variables)
        related: tuple[Related, ...] = ()
        place = name.span
        if inner is not None and key in schema.REQUIRED[owner]:
            place = inner.span  # one finding for all calls
            related = (Related(span=name.span, message="in the sub-script called here"),)
        elif inner is not None:
            related = (Related(span=inner.span, message="the sub-script does not set it"),)
        variable = type_.variables.get(key)
        example = _example(variable) if variable is not None else ""
        if key == "outcomes" and read.get(key):
            example = f"[{', '.join(item.name for item in read[key])}]"
        params = entries.get("params")
        entry = params.value.get(key) if params and isinstance(params.value, Map) else None
        help = _with_type(key, variable)
        if entry is not None:
            place = entry.key.span
            help = f"write `{key}:` beside `params:`; `params` has only constants for look-ups"
        report.append(missing_variable(place, key, whose, related, example, help=help))


TYPE_EXAMPLES = {
    "message_type": ("the messages", "std_msgs/Float32"),
    "service_type": ("the service", "std_srvs/Trigger"),
    "action_type": ("the action", "actionlib/TestAction"),
}
"""What has a type of each kind, and the name of such a type, as a script writes it."""


def _with_type(name: str, variable: VariableType | None) -> str | None:
    """The help for a missing variable that names a type of ROS: an example, because the script does
    not contain the type. None for other variables."""
    if variable is None or variable.unquoted != "type" or variable.role not in TYPE_EXAMPLES:
        return None
    what, example = TYPE_EXAMPLES[variable.role]
    return f"add `{name}` with the type of {what}, such as `{name}: {example}`"


def _is_name_for_type(
    key: str, variable: VariableType, entries: Entries, missing: list[str], report: Report
) -> bool:
    """Whether a variable for a type of ROS has the name of a service or action in its place, for
    which the one missing variable is: this is reported, and that variable is not missing then."""
    text = name_of(entries[key].value)
    if variable.role not in TYPE_EXAMPLES or text is None or not text.text.startswith("/"):
        return False
    if len(missing) != 1:
        return False
    what, example = TYPE_EXAMPLES[variable.role]
    message = f"`{text.text}` is a name, but `{key}` is the type of {what}"
    help = f"write `{missing.pop()}: {text.text}`, and `{key}: {example}` with the type that it has"
    report.append(wrong_shape(text.span, message, help, arguments=(key, text.text)))
    return True


def _example(variable: VariableType) -> str:
    """A value that the variable can have; empty if there is no short one."""
    limits = variable.limits
    if variable.unquoted == "function" and variable.arguments:
        names = ("ud" if argument == "userdata" else argument for argument in variable.arguments)
        return f"'lambda {', '.join(names)}: True'"
    if variable.type.name == "one_of":
        return written_name(str(variable.type.args[0]))
    if limits is not None and limits.choices:
        return str(limits.choices[0])
    if variable.role in value_facts.NAMES:
        return "..."  # an example that is no name of the robot is wrong
    text = EXAMPLES.get(variable.type.name, "")
    if limits is None or variable.type.name not in ("float", "int"):
        return text
    if limits.least < float(text) < limits.most:
        return text
    low = limits.least if math.isfinite(limits.least) else limits.most - 2
    high = limits.most if math.isfinite(limits.most) else low + 2
    middle = low / 2 + high / 2
    shown = str(round(middle)) if variable.type.name == "int" else f"{middle:.4g}"
    if "e" in shown:
        return "..."
    if variable.type.name == "float" and "." not in shown:
        shown += ".0"
    inside = low < float(shown) < high or (float(shown) in (low, high) and not limits.exclusive)
    return shown if inside else "..."


def _check_list(value: Tree, report: Report) -> None:
    """Reports one name in place of a list of keys: a program reads its letters as the keys."""
    if isinstance(value, Scalar) and isinstance(value.value, str) and is_plain(value.value):
        wrong(value, "keys", report)


def _variables(table: FieldTable, entries: Entries, type_: StateType) -> Iterator[Variable]:
    """The variables of the state type that a script sets: all fields that are not the owner's."""
    for name, known in table.variables:
        entry, row = entries[name], schema.VARIABLES.get(name)
        named = row is not None and row.shape == "name" and _is_field(name, table.owner, type_)
        if named and not isinstance(entry.value, Scalar):
            continue  # reported
        role = known.role if known is not None else ""
        called = name == "callbacks" or role in ("callbacks", "conditions")
        value = as_value(entry.value, code=called)
        declared = known.type if known is not None else ANY
        yield Variable(
            name=name,
            type=declared,
            role=role,
            takes_userdata=known is not None
            and known.unquoted == "function"
            and (known.arguments or ())[:1] == ("userdata",),
            value=value,
            span=entry.key.span,
        )


def _check_unquoted(value: Tree, variable: VariableType, report: Report) -> None:
    """The shape of a variable that programs contain without quotes."""
    if variable.unquoted:
        check_unquoted(value, variable.unquoted, report)
    if variable.role == "qos":
        _check_qos(value, report)


def _check_qos(tree: Tree, report: Report) -> None:
    """The quality of service of a topic of ROS 2: a preset, a depth, or policies."""
    from smachac.runtime.ros2_qos import POLICIES, faults

    value: object = ()  # a list is none
    if isinstance(tree, Scalar):
        value = tree.value
    elif isinstance(tree, Map):
        value = {str(entry.key.value): getattr(entry.value, "value", ()) for entry in tree.entries}
    for fault in faults(value):
        help = "write a preset such as `sensor_data`, a depth, or policies such as"
        help += " `{reliability: best_effort, durability: volatile, depth: 5}`"
        entry = tree.get(fault.key) if isinstance(tree, Map) else None
        place = tree if entry is None else entry.value
        if entry is not None and fault.key == "depth":
            help = "write a whole number, such as `depth: 1`"
        elif entry is not None and fault.key not in (*POLICIES, "preset"):
            place = entry.key
        if fault.known:
            listed = ", ".join(f"`{text}`" for text in fault.known)
            choice = f"write one of {listed}" if entry is not None else help
            help = did_you_mean(place.span.text.strip("\"'"), fault.known) or choice
        effect = "ROS 2 has no such quality of service: the program could not use the topic"
        policy = next((name for name, known in POLICIES.items() if value in known), None)
        if policy is not None:
            help = f"`{value}` is a value of `{policy}`: write `{{{policy}: {value}}}`"
            effect = "the program could not use the topic"
        arguments = ("qos", fault.text)
        report.append(wrong_shape(place.span, fault.text, help, arguments=arguments, effect=effect))


def _written(name: Word, entries: Entries, scope: Scope) -> Iterator[Variable]:
    """All fields of a state and the params in its scope, as SMACHA's templates need them."""
    for key, entry in entries.items():
        if key not in ("template", "states", "params"):
            yield Variable(name=key, value=as_written(entry.value), span=entry.key.span)
    if scope:
        params = tuple((key, as_written(tree).data) for key, tree in scope.items())
        value = Value(data=Struct(entries=params), span=name.span)
        yield Variable(name="params", value=value, span=name.span)


def _owner_of(owner: FieldOwner, type_: StateType, *, of_type: bool) -> Owner:
    """The owner of a variable: the state type, or an owner of the schema."""
    if of_type:
        return Owner(type_.name, f"state type `{type_.name}`")
    if owner == "base":
        return Owner(owner, "the script")
    return Owner(owner, "a state" if owner == "state" else f"a container of type `{owner}`")


NAME_WORDS = frozenset(["name", "state", "id"])
"""The keys under which other tools write the name of a state."""


def name_as_field(entry: Entry, name: Word) -> Diagnostic:
    """SM004 for a state whose name is written as a field."""
    key, span = str(entry.key.value), entry.key.span
    message = f"`{key}` is no field of a state: the name of a state is the key of its item"
    edit = Edit(span=Span(span.source, span.start, name.span.end), text=f"{name.span.text}:")
    help = f"write `- {name.text}:` in place of `- {key}: {name.text}`"
    return wrong_shape(span, message, help, arguments=(key, name.text), edits=(edit,))


def is_field(entry: Entry) -> bool:
    """Whether a further key of an item in a list of states is a field of its state, which is
    indented too little, and not another state."""
    name = str(entry.key.value)
    if schema.LONG.get(name, name) in FIELDS_OF_STATES:
        return True
    empty = isinstance(entry.value, Scalar) and entry.value.value is None
    return not isinstance(entry.value, Map) and not empty


def with_further_states(items: tuple[Tree, ...]) -> Iterator[Tree]:
    """The items of a list of states. A further state in one item, which is reported there, is also
    an item of its own, so that it counts as a state."""
    for item in items:
        yield item
        if not isinstance(item, Map) or len(item.entries) < 2:
            continue
        if isinstance(item.entries[0].value, Map):
            for entry in item.entries[1:]:
                if isinstance(entry.value, Map) and not is_field(entry):
                    yield Map((entry,), entry.key.span)


def second_key(name: Word, fields: Map, other: Entry) -> Diagnostic:
    """SM004 for a further key in an item of a list of states, beside a state with its fields."""
    key = other.key
    help = f"begin another item with `- {key.value}:`, or indent it below `{name.text}:`"
    if is_field(other):
        column = fields.entries[0].key.span.column if fields.entries else 0
        more = max(column - key.span.column, 1)
        spaces = f"{more} space{'s' if more > 1 else ''}"
        help = f"indent it by {spaces} more: it is a field of `{name.text}`"
        if fields.span.text.startswith("{"):
            help = f"write it inside the braces of `{name.text}`: it is a field of the state"
    return wrong_shape(
        key.span,
        f"this item has two keys, `{name.text}` and `{key.value}`; a state has one",
        help,
        (Related(span=name.span, message="the first key"),),
        arguments=("item", name.text, str(key.value)),
    )


def another_state(iterator: str, first: str, other: Word) -> Diagnostic:
    """SM004 for a further state in an Iterator."""
    message = f"the Iterator `{iterator}` has the state `{first}`: `{other.text}` is another one"
    help = f"indent `{other.text}` like `{iterator}` if it comes after the loop; or put `{first}`"
    help += f" and `{other.text}` into a StateMachine inside `{iterator}`"
    return wrong_shape(
        other.span,
        message,
        help,
        arguments=("iterator", other.text),
        effect="an Iterator has exactly one state, which it runs for each item",
    )
