"""Values that the Python class of a state type writes, and parts of values that it reads, against
the types in its interface."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from collections.abc import Set as AbstractSet
from functools import reduce

from smachac.analysis.context import Context
from smachac.analysis.data_types import type_of_data
from smachac.analysis.expression_errors import FaultKind, expression_faults
from smachac.analysis.fixed_lists import lacks_entry
from smachac.analysis.type_lattice import (
    BOOL,
    FLOAT,
    STR,
    fields,
    inside,
    is_unknown,
    length_of,
    mapping,
    misfit,
    present,
    widened,
)
from smachac.checks.findings.help_text import did_you_mean, other_place
from smachac.checks.findings.type_words import HELP, example, in_words
from smachac.checks.findings.types_with_code import own_types, used_here
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.diagnostics.meanings import by_words
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import listed
from smachac.ir.class_facts import Part, Step, TableLookUp
from smachac.ir.expressions import Binary, Call, Compare
from smachac.ir.nodes import Data, Key, Leaf, Struct
from smachac.ir.python_code import parse_code
from smachac.ir.script_code import script_code
from smachac.ir.types import ANY, Type

MOST_ITEMS = 20
"""The most items of a list or dictionary whose parts are typed one by one."""

MADE = {"str": STR, "repr": STR, "float": FLOAT, "bool": BOOL, "len": Type("int")}
"""The types that functions of Python return."""


def wrong_writes(context: Context) -> Iterator[Finding]:
    """The literals that a class writes to an output key whose type they do not fit (SM304)."""
    for path, leaf, type_, facts in own_types(context, declared=True):
        keys = {key.name: key for key in type_.output_keys}
        for name, written in facts.values:
            key = keys.get(name)
            given = type_of_code(written.text) if key is not None else None
            if given is None and key is not None and written.span in facts.numbers:
                given = FLOAT if misfit(Type("int"), key.type) is not None else None
            made = dict(facts.collections).get(written.span) if key is not None else None
            words = ""
            if given is None and made is not None and key is not None:
                single = present(key.type).name in SINGLE[made]
                given, words = (Type(made, (ANY,)), COLLECTIONS[made]) if single else (None, "")
            if key is None or given is None or misfit(given, key.type) is None:
                continue
            if misfit(given, Type("optional", (key.type,))) is None and given.name == "none":
                continue  # a key that is cleared
            found = example(key.type)
            such = f", such as `{found}`" if found else ""
            yield Finding(
                span=written.span,
                message=f"`{leaf.type}` writes {words or in_words(given)} to `{name}`, but its"
                f" interface declares `{name}` as `{key.type}`",
                arguments=(name, str(widened(given)), str(key.type), "class"),
                help=(_list_help(name, key.type) if words == COLLECTIONS["list"] else None)
                or _field_help(given, key.type)
                or _plain_help(written.text, key.type)
                or HELP.get(present(key.type).name)
                or f"write a value of the type `{key.type}`{such}, or correct the interface",
                related=(
                    *other_place(key.span, f"the interface declares `{name}`"),
                    *used_here(leaf),
                ),
                node=path,
            )


COLLECTIONS = {"list": "a list", "dict": "a dictionary"}

SINGLE = {
    "list": frozenset(["int", "float", "bool", "str", "one_of", "record"]),
    "dict": frozenset(["int", "float", "bool", "str", "one_of", "list", "array"]),
}
"""The types whose values are certainly no lists, or no dictionaries."""


def _list_help(name: str, type_: Type) -> str:
    """The help for a list in place of one value."""
    return f'write `{name}: "list[{type_}]"` in the interface, or write one item of the list'


def _field_help(given: Type, type_: Type) -> str | None:
    """The help for a dictionary whose keys are not the fields of a record."""
    wanted = present(type_)
    if given.name != "mapping" or wanted.name != "record":
        return None
    missing = [name for name in fields(wanted) if name not in fields(given)]
    more = [name for name in fields(given) if name not in fields(wanted)]
    if len(missing) == len(more) == 1:
        return f'write `"{missing[0]}"` in place of `"{more[0]}"`'
    if len(missing) == 1:
        return f'add `"{missing[0]}": ...` to the dictionary'
    return None


def _plain_help(text: str, type_: Type) -> str | None:
    """The help for a choice that is one slip away, and for a value in a needless `str()`."""
    wanted = present(type_)
    node = parse_code(f"({text})")
    match node:
        case ast.Constant(value=str(word)) if wanted.name == "one_of":
            return did_you_mean(guesser([str(argument) for argument in wanted.args])(word))
        case ast.Call(func=ast.Name(id="str" | "repr"), args=[ast.Name(id=name)], keywords=[]):
            return f"write `{name}` without `str()`" if wanted.name in ("int", "float") else None
    return None


def none_writes(context: Context) -> Iterator[Finding]:
    """The results of methods such as `append`, which are None, that a class writes to a key
    (SM318)."""
    for path, leaf, type_, facts in own_types(context, declared=True):
        types = {key.name: present(key.type) for key in (*type_.input_keys, *type_.output_keys)}
        for name, written in facts.values:
            found = _changed_key(written.text)
            if found is None or found[1] not in types or name not in types:
                continue
            owner, key, method, argument = found
            kind = "list" if types[key].name == "list" else "mapping"
            known = types[key].name in ("list", "map", "record") and method in CHANGES[kind]
            if not known:
                continue
            help = f"write `{written.text}` without an assignment"
            if kind == "list" and method == "append" and argument:
                help = f"write `{owner}.{key} + [{argument}]`"
            yield Finding(
                span=written.span,
                message=f"`{leaf.type}` writes the result of `{method}` to `{name}`, which is None",
                arguments=(leaf.type, name, method),
                help=help,
                effect=f"`{name}` gets the value None",
                related=used_here(leaf),
                node=path,
            )


CHANGES = {
    "list": frozenset(["append", "extend", "insert", "remove", "sort", "reverse", "clear"]),
    "mapping": frozenset(["update", "clear"]),
}
"""The methods that change a value and return None, by the kind of the value."""


def _changed_key(text: str) -> tuple[str, str, str, str] | None:
    """The userdata, the key, the method and the only argument in `userdata.key.append(value)`."""
    if not text.endswith(")"):
        return None
    try:
        node = parse_code(f"({text})")
    except SyntaxError:
        return None
    match node:
        case ast.Call(
            func=ast.Attribute(
                value=ast.Attribute(value=ast.Name(id=owner), attr=key), attr=method
            ),
            args=arguments,
        ):
            plain = len(arguments) == 1 and not isinstance(arguments[0], ast.Starred)
            argument = ast.get_source_segment(f"({text})", arguments[0]) if plain else ""
            return owner, key, method, argument or ""
    return None


def wrong_loops(context: Context) -> Iterator[Finding]:
    """The loops of a class over a variable that is a number (SM304), by the interface or, if that
    has no type for it, in the script."""
    seen: set[tuple[str, str]] = set()
    for path, leaf, facts, _ in context.leaves_with_class:
        type_ = context.machine.state_types.get(leaf.type)
        if type_ is None or type_.built_in or not facts.loops:
            continue
        set_ = {variable.name: variable.value for variable in leaf.variables}
        for name, loop in facts.loops:
            if name not in type_.variables or (leaf.type, name) in seen:
                continue
            declared = type_.variables[name].type
            value = set_[name].data if name in set_ else None
            number = type(value) in (int, float, bool)
            if declared.name in ("int", "float", "bool"):
                seen.add((leaf.type, name))
                yield Finding(
                    span=loop.span,
                    message=f"`{leaf.type}` loops over `{loop.text}`, but its interface declares"
                    f" `{name}` as `{declared}`",
                    arguments=(leaf.type, name, "loop"),
                    help=f"write `range({loop.text})`"
                    if declared.name == "int"
                    else "loop over a list, or correct the type in the interface",
                    effect="Python cannot loop over a number: the machine stops with an error",
                    related=used_here(leaf),
                    node=path,
                )
            elif is_unknown(declared) and number:
                yield Finding(
                    span=set_[name].span,
                    message=f"`{name}` of `{leaf.name}` is {value}, but `{leaf.type}` loops over"
                    " it",
                    arguments=(leaf.name, name, "loop"),
                    help=f"write `range({value})`, or a list",
                    effect="Python cannot loop over a number: the machine stops with an error",
                    related=other_place(loop.span, f"`{leaf.type}` loops over `{name}` here"),
                    node=path,
                )


def wrong_operations(context: Context, kind: FaultKind) -> Iterator[Finding]:
    """The comparisons and calculations of a class that the types of its input keys do not support
    (SM311), or that seem to be in another unit (SM522)."""
    for path, leaf, type_, facts in own_types(context, declared=True):
        types = {key.name: key.type for key in type_.input_keys}
        lists = {name for name, type_ in types.items() if present(type_).name in ("list", "array")}
        for word in facts.operations:
            tree = script_code(word.text).portable
            found = (
                expression_faults(tree, mapping(types.items()), (facts.userdata,)) if tree else ()
            )
            for fault in found:
                known = {*fault.keys} <= types.keys() and fault.kind == kind
                array = isinstance(fault.expr, Binary) and not lists.isdisjoint(fault.keys)
                if not known or array or not isinstance(fault.expr, Binary | Compare | Call):
                    continue
                places = [key.span for key in type_.input_keys if key.name in fault.keys]
                yield Finding(
                    span=word.span,
                    message=f"{fault.what}, by the types in the interface of `{leaf.type}`",
                    arguments=(leaf.type, word.text, "class"),
                    help=_length_help(word.text, facts.userdata, lists & {*fault.keys})
                    or fault.help
                    or "correct the operation, or the types in the interface",
                    effect=fault.effect,
                    related=(
                        *(
                            place
                            for span in places
                            for place in other_place(span, "the type of the key is declared here")
                        ),
                        *used_here(leaf),
                    ),
                    severity=Severity.WARNING,
                    node=path,
                )
                break


def _words_of(type_: Type) -> list[str]:
    """The words of a type that is one of some words; empty for all others."""
    words = [choice for choice in type_.args if isinstance(choice, str)]
    return words if type_.name == "one_of" and len(words) == len(type_.args) else []


def wrong_comparisons(context: Context) -> Iterator[Finding]:
    """The comparisons of a class with words that a variable or an input key cannot have by its
    interface (SM312)."""
    for path, leaf, type_, facts in own_types(context, declared=True):
        keys = {key.name: key for key in type_.input_keys}
        done = set[str]()
        for compared in facts.compared:
            key = keys.get(compared.name) if compared.kind == "key" else None
            variable = type_.variables.get(compared.name) if compared.kind == "variable" else None
            declared = key or variable
            kind = present(declared.type) if declared is not None else ANY
            choices = _words_of(kind)
            if not choices or compared.word.text in done.union(choices):
                continue
            done.add(compared.word.text)
            used = {one.word.text for one in facts.compared if one.name == compared.name}
            left = [choice for choice in choices if choice not in used]
            near = guesser(choices)(compared.word.text) or (left[0] if len(left) == 1 else None)
            quote = compared.word.span.text[:1]
            written = [f"`{quote}{choice}{quote}`" for choice in ([near] if near else choices)]
            yield Finding(
                span=compared.word.span,
                message=f"`{leaf.type}` compares `{compared.owner}` with `{compared.word.text}`,"
                f" but its interface declares `{compared.name}` as `{kind}`",
                arguments=(leaf.type, compared.name, compared.word.text),
                help=f"write {' or '.join(written)}, or correct the interface",
                related=(
                    *(other_place(key.span, f"the interface declares `{key.name}`") if key else ()),
                    *used_here(leaf),
                ),
                node=path,
            )


def _used_values(context: Context, type_: str, look_up: TableLookUp) -> set[object]:
    """The values that the states of a type give to the variable of a look-up."""
    if look_up.kind == "key":
        return set()
    return {
        variable.value.data
        for _, leaf, _, _ in context.leaves_with_class
        if leaf.type == type_
        for variable in leaf.variables
        if variable.name == look_up.name and isinstance(variable.value.data, str)
    }


def missing_choices(context: Context) -> Iterator[Finding]:
    """The dictionaries of a class that lack a word of the variable or input key that it looks up in
    them (SM311)."""
    for path, leaf, type_, facts in own_types(context, declared=True):
        keys = {key.name: key.type for key in type_.input_keys}
        variables = {name: variable.type for name, variable in type_.variables.items()}
        done = set[tuple[str, str]]()
        for table in facts.tables:
            choices = _words_of((keys if table.kind == "key" else variables).get(table.name, ANY))
            known = {word.text for word in table.keys}
            known |= {one.word.text for one in facts.compared if one.name == table.name}
            missing = [choice for choice in choices if choice not in known]
            if not missing or (table.table, table.name) in done:
                continue
            done.add((table.table, table.name))
            more = [word for word in table.keys if word.text not in choices]
            if len(more) != 1:
                used = _used_values(context, leaf.type, table)
                missing = [choice for choice in missing if choice in used]
            if not missing:
                continue
            help = f'add `"{missing[0]}": ...` to `{table.table}`'
            if len(missing) == len(more) == 1:
                help = (
                    f'write `"{missing[0]}"` in place of `{more[0].span.text}` in `{table.table}`'
                )
            yield Finding(
                span=more[0].span if len(more) == 1 else table.word.span,
                message=f"`{leaf.type}` reads `{table.word.text}`, but `{table.table}` has no entry"
                f" {listed(missing)}, which the interface allows for `{table.name}`",
                arguments=(leaf.type, table.table, table.name),
                help=help,
                effect="the code raises KeyError for this value: the machine stops",
                related=used_here(leaf),
                severity=Severity.WARNING,
                node=path,
            )


def _length_help(text: str, userdata: str, lists: AbstractSet[str]) -> str | None:
    """The help for an order of a number and a list: the length of the list is meant."""
    try:
        node = parse_code(text)
    except SyntaxError:
        return None
    match node:
        case ast.Compare(ops=[ast.Lt() | ast.LtE() | ast.Gt() | ast.GtE()]):
            names = [f"{userdata}.{key}" for key in lists]
        case _:
            return None
    for side in (node.left, node.comparators[0]):
        name = ast.unparse(side)
        if len(names) == 1 and name in names and text.count(name) == 1:
            return f"write `{text.replace(name, f'len({name})')}`"
    return None


COORDINATES = {"x": 0, "y": 1, "z": 2, "w": 3}
"""The index in a list for the fields of a message with coordinates."""

FIELDS = frozenset([*COORDINATES, "position", "orientation", "pose", "data"])
"""Fields of messages that neither lists nor numbers have, whatever library they are from."""


def wrong_parts(context: Context) -> Iterator[Finding]:
    """The attributes and indexes of an input key that its type does not have (SM311)."""
    for path, leaf, type_, facts in own_types(context, declared=True):
        keys = {key.name: key for key in type_.input_keys}
        for part in facts.parts:
            key = keys.get(part.key)
            if key is not None and is_unknown(key.type):
                yield from _missing_entry(context, path, leaf, key, part)
                continue
            fault = _wrong_part(key.type, part) if key is not None else None
            if key is None or fault is None:
                continue
            what, help = fault
            verb, where = "reads", ""
            if part.steps[-1][0] == "names":
                verb, where = "unpacks", f" to {part.steps[-1][1]} names"
            yield Finding(
                span=part.span,
                message=f"`{leaf.type}` {verb} `{part.text}`{where}, but its interface declares"
                f" `{key.name}` as `{key.type}`, {what}",
                arguments=(
                    key.name,
                    *(str(step) for _, step in part.steps),
                    str(key.type),
                    "class",
                ),
                help=help,
                related=(
                    *other_place(key.span, f"the interface declares `{key.name}`"),
                    *used_here(leaf),
                ),
                severity=Severity.WARNING,
                node=path,
            )


def _missing_entry(
    context: Context, path: str, leaf: Leaf, key: Key, part: Part
) -> Iterator[Finding]:
    """The finding on an entry that the mapping of the script in a key without a type lacks."""
    cell = context.types.cells.get((path, key.name))
    match part.steps:
        case (("item", str(entry)),) if cell is not None and entry:
            pass
        case _:
            return
    if not lacks_entry(cell, entry, context.machine.state_types):
        return
    origins = [flow.origin for alike in cell.flows.values() for flow in alike]
    value = origins[0].value
    names = [name for name, _ in value.entries] if isinstance(value, Struct) else []
    yield Finding(
        span=part.span,
        message=f"`{leaf.type}` reads `{part.text}`, but the mapping of `{key.name}` in the script"
        f" has no entry `{entry}`",
        arguments=(key.name, entry, "class"),
        help=did_you_mean(guesser(names)(entry)) or f"use one of its entries: {listed(names)}",
        related=(
            *other_place(origins[0].span, f"the value of `{key.name}`"),
            *used_here(leaf),
        ),
        severity=Severity.WARNING,
        node=path,
    )


def _wrong_part(type_: Type, part: Part) -> tuple[str, str] | None:
    """What is wrong with a part of a value of a type, and what to write."""
    *first, (kind, last) = part.steps
    owner = reduce(_at, first, type_)
    which = "which" if not first else f"in which `{_owner_text(part)}`"
    match kind, last:
        case "attribute", str():
            return _wrong_attribute(owner, last, _owner_text(part), which)
        case "item", str() if owner.name == "record" and last not in fields(owner):
            names = list(fields(owner))
            meant = did_you_mean(_suggested_field(owner, last))
            return f"{which} has no field `{last}`", meant or _one_of(names)
        case "names", int():
            size = length_of(owner)
            if size is None or size == last:
                return None
            each = first and first[-1][0] == "each"
            what = (
                f"in which `{part.text}` has {size} items" if first else f"which has {size} items"
            )
            what = f"in which each item has {size} items" if each else what
            return what, f"write {size} names, or correct the type in the interface"
        case "item", int():
            size = length_of(owner)
            if size is None or -size <= last < size:
                return None
            whose = "whose" if not first else f"{which} has `{owner}`: its"
            return (
                f"{whose} last index is {size - 1}",
                f"use an index from 0 to {size - 1}, or correct the type in the interface",
            )
    return None


def _wrong_attribute(type_: Type, name: str, owner: str, which: str) -> tuple[str, str] | None:
    """What is wrong with an attribute of a value with the text `owner`, and what to write."""
    if type_.name == "record":
        return _attribute_of_record(type_, name, owner, which)
    if type_.name not in ("list", "array", "int", "float", "bool", "str") or name not in FIELDS:
        return None
    help = f"correct the type of the key in the interface, or write `{owner}`"
    if type_.name in ("list", "array") and name in COORDINATES:
        help = f"write `{owner}[{COORDINATES[name]}]`, or correct the type in the interface"
    return f"{which} has no attribute `{name}`", help


def _one_of(names: Sequence[str]) -> str:
    return f"use one of its fields: {listed(names)}"


def _attribute_of_record(type_: Type, name: str, owner: str, which: str) -> tuple[str, str] | None:
    """What is wrong with an attribute of a record, which is a dictionary in Python."""
    if hasattr(dict, name):
        return None
    names = list(fields(type_))
    meant = name if name in names else _suggested_field(type_, name)
    what = f"{which} is a dictionary: it has no attribute `{name}`"
    if meant is None:
        return what, _one_of(names)
    return what, f'write `{owner}["{meant}"]`'


def _suggested_field(record: Type, name: str) -> str | None:
    """The field of a record that is meant by an unknown one: the nearest, or the only one whose
    type has the name, as the field `at` of type `Pose` for `pose`."""
    names = list(fields(record))
    of_type = [text for text, type_ in fields(record).items()
               if present(type_).name.casefold() == name.casefold()]  # fmt: skip
    near = guesser(names)(name) or by_words(name, names)
    return near or (of_type[0] if len(of_type) == 1 else None)


def _owner_text(part: Part) -> str:
    """The text of the value whose part is read."""
    kind, _ = part.steps[-1]
    end = part.text.rfind(".") if kind == "attribute" else part.text.rfind("[")
    return part.text[:end].rstrip()


def _at(type_: Type, step: Step) -> Type:
    """The type of a part of a value; `any` if it is not known."""
    match step:
        case "item", int() if type_.name in ("list", "array"):
            return inside(type_)
        case "item", str(name):
            known = fields(type_) if type_.name == "record" else {}
            return known.get(name, inside(type_) if type_.name == "dict" else ANY)
        case "each", _ if type_.name in ("list", "array"):
            return inside(type_)
    return ANY


def type_of_code(text: str) -> Type | None:
    """The type of an expression of Python that is a literal, or obvious without its names; None
    for any other."""
    try:
        node = parse_code(f"({text})")
    except SyntaxError:
        return None
    match node:
        case (
            ast.JoinedStr()
            | ast.BinOp(left=ast.Constant(value=str()) | ast.JoinedStr(), op=ast.Mod())
        ):
            return STR
        case ast.Call(func=ast.Attribute(value=ast.Constant(value=str()), attr="format" | "join")):
            return STR
        case ast.UnaryOp(op=ast.Not()):
            return BOOL
        case ast.Call(func=ast.Name(id=name)) if name in MADE:
            return MADE[name]
    try:
        type_ = _type_of_node(node)
    except (ValueError, TypeError, RecursionError, MemoryError):
        return None
    return None if is_unknown(type_) else type_


def _type_of_node(node: ast.expr) -> Type:
    """The type of an expression with the parts that are literals, `any` for the others."""
    try:
        return type_of_data(_data(ast.literal_eval(node)))
    except (ValueError, TypeError):
        pass
    match node:
        case ast.List(elts=items) | ast.Tuple(elts=items):
            if len(items) <= MOST_ITEMS and not any(
                isinstance(item, ast.Starred) for item in items
            ):
                return Type("tuple", tuple(map(_type_of_node, items)))
        case ast.Dict(keys=keys, values=values) if len(keys) <= MOST_ITEMS:
            names = [key.value for key in keys
                     if isinstance(key, ast.Constant) and isinstance(key.value, str)]  # fmt: skip
            if len(names) == len(keys):
                return mapping(zip(names, map(_type_of_node, values), strict=True))
    return ANY


def _data(value: object) -> Data:
    """A literal of Python as data of a script. Raises ValueError if a script cannot have it."""
    match value:
        case None | bool() | int() | float() | str():
            return value
        case list() | tuple():
            return tuple([_data(item) for item in value])
        case dict() if all(isinstance(key, str) for key in value):
            return Struct(entries=tuple([(key, _data(item)) for key, item in value.items()]))
    raise ValueError(value)
