"""Findings on code that uses messages (SM512): fields that a message does not have, and values of
other types in comparisons and operations.

The code is that of functions of the script (message_fields.py) or of the user's classes
(messages_in_classes.py); the fields that it uses are those of analysis/message_code.py.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Sequence
from difflib import SequenceMatcher

from smachac.analysis.code_slots import CodeSlot, is_condition
from smachac.analysis.message_code import (
    FieldRead,
    MessageCode,
    content_of,
    field_reads,
    nested_messages,
    owners,
)
from smachac.checks.findings.help_text import calls, did_you_mean, other_place
from smachac.checks.ros.message_values import an_example, constants_for, named_constants
from smachac.diagnostics.diagnostic import Finding, Related
from smachac.diagnostics.meanings import by_words
from smachac.diagnostics.repair import Certainty, Edit, Repair
from smachac.diagnostics.source import Word
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import listed
from smachac.ir.function_facts import Comparison, Operand, Part
from smachac.ir.message_types import FLOATS, INTEGERS, TEXTS, Definitions, FieldType, Message
from smachac.ir.nodes import Leaf, Node
from smachac.ir.python_code import parse_code
from smachac.records import replace

METHODS = frozenset(
    ["serialize", "deserialize", "serialize_numpy", "deserialize_numpy"]  # ROS 1
) | {"SLOT_TYPES", "get_fields_and_field_types"}
"""The names of a message in Python that are no fields."""

NUMBERS = frozenset([*INTEGERS, *FLOATS, "bool"])
"""The types of fields that are numbers in Python."""

NEAR = 0.75
"""How similar a name must be to a field that is meant although the words of another fit better."""

SHORTEST_PART = 3
"""A shorter name is the beginning of too many others."""


ORDERS = ("<", "<=", ">", ">=")


def wrong_comparisons(
    path: str, leaf: Leaf, code: MessageCode, found: Definitions, here: tuple[Related, ...]
) -> Iterator[Finding]:
    """Comparisons of a number in a message with a text, or the reverse, and of the order of a list
    and a number."""
    for compared in code.uses.comparisons:
        part, operator, value, span = compared
        content = content_of(part, code, found)
        lists = [type_ for type_ in content if isinstance(type_, FieldType) and type_.array]
        if lists and len(lists) == len(content) and operator in ORDERS:
            yield _ordered_list(path, leaf, compared, lists[0], here)
            continue
        fields = [type_ for type_ in content if isinstance(type_, FieldType) and not type_.array]
        wrong = NUMBERS if isinstance(value, str) else TEXTS
        if not fields or len(fields) != len(content) or {field.name for field in fields} - {*wrong}:
            continue
        constants = constants_for(part.name.text, fields[0], owners(part, code, found)[:1])
        meant = [constant for constant in constants if constant.name == value]
        help = f"compare it with a value of the type `{fields[0]}`{an_example(fields[0])}"
        if meant and operator in ("==", "!="):
            help = f"write `{part.text} {operator} {meant[0].value}`: `{value}` is a constant of"
            help += f" the message with the value {meant[0].value}"
        elif constants:
            help = f"compare it with a constant of the message: {named_constants(constants)}"
        yield Finding(
            span=span,
            message=f"`{part.text}` is `{fields[0]}`: it never equals `{value!r}`",
            arguments=(part.text, repr(value)),
            help=help,
            effect="the condition always has the same result, or the function fails",
            related=(*here, *calls(leaf, span)),
            node=path,
        )


def _ordered_list(
    path: str, leaf: Leaf, compared: Comparison, type_: FieldType, here: tuple[Related, ...]
) -> Finding:
    """The finding on a list that is compared with one value, by their order."""
    part, operator, value, span = compared
    text = span.text.replace(part.text, f"len({part.text})", 1)
    edits = (Edit(span=span, text=text),) if not here and span.text != text else ()
    length = Repair(edits=edits, certainty=Certainty.LIKELY, operator="compare its length")
    return Finding(
        span=span,
        message=f"`{part.text}` is a list (`{type_}`), but `{operator}` compares it with one value",
        arguments=(part.text, operator, repr(value)),
        help=f"write `{text}` for the number of its items, or compare one item",
        effect="the function fails with a TypeError or ValueError",
        repairs=(length,) if edits else (),
        related=(*here, *calls(leaf, span)),
        node=path,
    )


def code_places(leaf: Leaf, slot: CodeSlot, code: MessageCode) -> tuple[Related, ...]:
    """Where the script names the function in a module with a fault."""
    named = code.function is not None
    return other_place(slot.code.span, f"`{leaf.name}` calls it here") if named else ()


def operands_of(slot: CodeSlot, code: MessageCode) -> tuple[Operand, ...]:
    """The parts of arguments that have to be values, with the results of a condition."""
    results = code.results if is_condition(slot) else ()
    whole = [
        Operand(result.part, result.span, result.text)
        for result in results
        if result.part is not None
    ]
    return (*code.uses.operands, *whole)


def wrong_reads(
    path: str, leaf: Leaf, code: MessageCode, found: Definitions, here: tuple[Related, ...]
) -> Iterator[Finding]:
    """Fields that a function uses and that its messages do not have."""
    for read in field_reads(code, found):
        messages, word = read.messages, read.part.name
        name = word.text
        known = {field.name for message in messages for field in message.fields}
        constants = {constant.name for message in messages for constant in message.constants}
        if (
            name.startswith("_")
            or name in METHODS
            or {name, name.rstrip("_")} & (known | constants)
        ):
            continue
        finding = unknown_field_finding(path, leaf, word, messages, here=here)
        level = _level_help(read, code, found)
        if level is not None:
            finding = replace(finding, help=level)
        yield finding


def near_field(word: str, names: Sequence[str]) -> str | None:
    """The name nearest to that of a field: `temperature` for `temp`, `percentage` for `level`."""
    guess = guesser(names)(word)
    if guess is None or SequenceMatcher(None, word, guess).ratio() < NEAR:
        guess = by_words(word, names) or guess
    if guess is not None or len(word) < SHORTEST_PART:
        return guess
    longer = [name for name in names if name.casefold().startswith(word.casefold())]
    return longer[0] if len(longer) == 1 else None


def _level_help(read: FieldRead, code: MessageCode, found: Definitions) -> str | None:
    """The help for a name that is a field of a message in the message, or whose own field is one of
    the message: `message.force` of a WrenchStamped is `message.wrench.force`."""
    name, text = read.part.name, read.part.text
    owner = text[: -len(name.text)]
    whole = _whole(read.part, code.uses.parts)
    rest = whole.text[len(text) :]
    guess = near_field(name.text, [field.name for field in read.messages[0].fields])
    if guess is not None and name.text in guess:
        return None
    inner = whole.steps[len(read.part.steps) :][:1]
    if inner and all(message.field(inner[0] or "") for message in read.messages):
        return f"write `{owner}{rest[1:]}`"
    deeper = _deeper(name.text, read.messages, found)
    return f"write `{owner}{deeper}{rest}`" if deeper is not None else None


def _whole(part: Part, parts: Sequence[Part]) -> Part:
    """The longest part of an argument that begins with another one, at its place."""
    longer = [other for other in parts if other.text.startswith(f"{part.text}.")]
    for other in sorted(longer, key=lambda part: len(part.steps)):
        name = other.name.span
        if name.source is part.name.span.source and name.start == part.name.span.end + 1:
            part = other
    return part


def _deeper(name: str, messages: Sequence[Message], found: Definitions) -> str | None:
    """The only path to a field of a name in the messages of one or two levels of fields."""
    level = [("", tuple(messages))]
    for _ in range(2):
        inner = [
            (f"{path}{field.name}.", tuple(nested_messages([field.type], found)))
            for path, owners in level
            for field in owners[0].fields
            if all(owner.field(field.name) for owner in owners)
        ]
        level = [pair for pair in inner if pair[1]]
        paths = [path for path, row in level if all(one.field(name) for one in row)]
        if paths:
            return f"{paths[0]}{name}" if len(paths) == 1 else None
    return None


def wrong_operands(
    path: str,
    leaf: Leaf,
    operands: Iterable[Operand],
    code: MessageCode,
    found: Definitions,
    here: tuple[Related, ...],
) -> Iterator[Finding]:
    """Messages with which a function calculates as if they were numbers or texts, whose fields it
    reads as items, or that are the result of a condition."""
    for operand in operands:
        content = content_of(operand.part, code, found)
        messages = nested_messages(content, found) if content else []
        if messages:
            yield Finding(
                span=operand.span,
                message=f"`{operand.part.text}` is a message (`{described(messages[0])[1:-1]}`),"
                " not a value",
                arguments=(operand.part.text, messages[0].name),
                help=_operand_help(operand, messages[0]),
                effect="the function fails, or the condition always has the same result",
                related=(*here, *calls(leaf, operand.span)),
                node=path,
            )


def _operand_help(operand: Operand, message: Message) -> str:
    """The help for a message in place of one of its fields."""
    names = [field.name for field in message.fields if field.name != "header"]
    item = _item(operand.text)
    if item is not None and item in names:
        return f"write `{operand.part.text}.{item}`"
    if len(names) == 1:
        return f"write `{operand.part.text}.{names[0]}`"
    return f"write `{operand.part.text}.` and one of its fields: {listed(names)}"


def _item(text: str) -> str | None:
    """The text between the brackets of code such as `message["data"]`."""
    match parse_code(text):
        case ast.Subscript(slice=ast.Constant(value=str(name))):
            return name
    return None


def unknown_field_finding(
    path: str,
    node: Node,
    word: Word,
    messages: Sequence[Message],
    *,
    also: str = "",
    other: str = "",
    here: tuple[Related, ...] = (),
) -> Finding:
    """The finding for a word that is no field of any of the messages. `also`: the other place of
    the script that has the name; `other`: the end of the help, about another type; `here`: the
    place that uses the code."""
    names = sorted({field.name for message in messages for field in message.fields})
    known = f"use one of its fields: {listed(names)}" if names else "remove it: it has no fields"
    if len(names) == 1 and not other:
        known = f"write `{names[0]}`, its only field, in place of `{word.text}`"
    guess = near_field(word.text, names)
    help = did_you_mean(guess) or f"{known}{other}"
    if guess and also:
        help += f" Write it here{also}, and remap it: `remapping: {{{guess}: {word.text}}}`"
    message = f"{described(messages[0])} has no field `{word.text}`"
    finding = field_finding(path, node, word, message, help, messages)
    return replace(finding, related=(*here, *finding.related)) if here else finding


def described(message: Message) -> str:
    """The name of a message in a sentence."""
    definition, _, part = message.name.partition(".")
    return f"the {part} of `{definition}`" if part else f"`{definition}`"


def field_finding(
    path: str,
    node: Node,
    word: Word,
    message: str,
    help: str | None,
    messages: Sequence[Message],
    effect: str | None = None,
) -> Finding:
    label = "its fields are defined here"
    places = [message.fields[0].span for message in messages if message.fields][:1]
    field = messages[0].field(word.text)
    if field is not None:
        label, places = f"`{word.text}` is defined here", [field.span]
    return Finding(
        span=word.span,
        message=message,
        arguments=(messages[0].name, word.text),
        help=help,
        related=(
            *(related for span in places for related in other_place(span, label)),
            *calls(node, word.span),
        ),
        node=path,
        effect=effect,
    )
