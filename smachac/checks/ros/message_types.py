"""Types of messages, services and actions in a script that do not exist, or of another kind."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping, Sequence

from smachac.analysis.message_code import MOST_CODE
from smachac.checks.findings.help_text import calls, did_you_mean
from smachac.diagnostics.diagnostic import Finding
from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import either, listed
from smachac.ir.leaf import type_text, variable_of
from smachac.ir.message_types import PARTS, DefinitionKind, Missing, MissingDefinitions
from smachac.ir.nodes import DEFINITION_KINDS, Expression, Leaf
from smachac.ir.python_code import parse_code

USUAL_NAMES: Mapping[str, str] = {"double": "Float64", "integer": "Int32", "text": "String"}
"""The messages of std_msgs that are meant by words of other languages."""

KIND_WORDS: Mapping[DefinitionKind, str] = {
    "msg": "a message",
    "srv": "a service",
    "action": "an action",
}


def kind_word(kind: DefinitionKind) -> str:
    """The word for a kind, without its article."""
    return KIND_WORDS[kind].partition(" ")[2]


def _other_kind(parts: Sequence[str], kind: DefinitionKind) -> DefinitionKind | None:
    """The kind of a type whose name has another folder: `std_msgs/msg/Bool`. In ROS 1 an action
    can be named by its message; ROS 2 has messages such as `Drive_FeedbackMessage`."""
    if len(parts) != 3 or (kind == "action" and parts[1] == "msg") or "_" in parts[2]:
        return None
    return next((word for word in KIND_WORDS if word == parts[1] and word != kind), None)


def names_type(leaf: Leaf) -> bool:
    """Whether a state names the type of a message, a service or an action."""
    return not DEFINITION_KINDS.keys().isdisjoint([held.role for held in leaf.variables])


def missing_types(path: str, leaf: Leaf, missing: MissingDefinitions) -> Iterator[Finding]:
    """Types that a state names and that their packages do not have."""
    for role, kind in DEFINITION_KINDS.items():
        named = variable_of(leaf, role)
        if named is None:
            continue
        parts = re.split(r"[/.]", type_text(named).strip())
        absent = missing.get((kind, type_text(named)))
        other = absent.other if absent is not None else _other_kind(parts, kind)
        if other is not None:
            message = f"`{type_text(named)}` is {KIND_WORDS[other]}, not {KIND_WORDS[kind]}"
        elif absent is not None:
            message = no_type(parts[0], parts[-1], kind)
        else:
            continue
        known = suggested_type(parts[-1], kind, absent or Missing(()))
        word = parts[-1]
        if absent is None and other is not None and "/" in type_text(named):
            word = "/".join(parts[1:])
            known = f"write `{parts[0]}/{kind}/{parts[-1]}` if the package has this"
            known += f" {kind_word(kind)}, or the name of another one"
        yield Finding(
            span=word_in(word, named.value.span).span,
            message=message,
            arguments=(parts[0], parts[-1]),
            help=known,
            effect="the program stops when it imports the type",
            related=calls(leaf, named.value.span),
            node=path,
        )


def no_type(package: str, name: str, kind: DefinitionKind) -> str:
    """The statement about a type that its package does not have."""
    return f"the package `{package}` has no {kind_word(kind)} `{name}`"


def suggested_type(name: str, kind: DefinitionKind, absent: Missing) -> str:
    """The help for a type that does not exist: names of the same form with a size, the type of this
    name in another package, the nearest name, or all names."""
    word = name.casefold()
    sizes = [
        name
        for name in absent.names
        if name.casefold().startswith(word) and name[len(word) :].isdigit()
    ]
    if len(sizes) > 1:
        sizes.sort(key=lambda size: int(size[len(word) :]))
        return f"write {either(sizes)}"
    if len(absent.packages) == 1:
        return f"write `{absent.packages[0]}/{name}`, which is in another package"
    usual = USUAL_NAMES.get(word)
    guess = usual if usual in absent.names else guesser(absent.names)(name)
    if guess is None:
        inside = [name for name in absent.names if word in name.casefold()]
        guess = inside[0] if len(inside) == 1 else None
    known = f"write one of {listed(absent.names)}" if absent.names else ""
    return did_you_mean(guess) or known or f"write the name of {KIND_WORDS[kind]}"


def type_in_place_of_part(path: str, leaf: Leaf) -> Iterator[Finding]:
    """Calls of the class of a service or an action where its request or its goal is needed:
    `SetBool(data=True)`. In Python this class of a service takes no arguments."""
    for role, kind in DEFINITION_KINDS.items():
        named = variable_of(leaf, role)
        parts = re.split(r"[/.]", type_text(named).strip()) if named is not None else []
        if kind == "msg" or len(parts) < 2:
            continue
        part = PARTS[kind][0]
        name = parts[-1].removesuffix("Action") if kind == "action" else parts[-1]
        for held in leaf.variables:
            code = held.value.data
            if held.role != part or not isinstance(code, Expression):
                continue
            call = call_of(code.text)
            if call is None or not isinstance(call.func, ast.Name | ast.Attribute):
                continue
            called = ast.unparse(call.func).rpartition(".")[2]
            if called not in (name, parts[-1]):
                continue
            new = f"{name}.{part.capitalize()}" if len(parts) > 2 else f"{name}{part.capitalize()}"
            given = ", ".join(ast.unparse(argument) for argument in (*call.args, *call.keywords))
            what = kind_word(kind)
            yield Finding(
                span=word_in(called, held.value.span).span,
                message=f"`{called}` is the class of the {what}, not of its {part}",
                arguments=(held.name, called),
                help=f"write `{new}({given})`",
                effect=f"it has no fields of the {part}: the program stops when it makes the state",
                related=calls(leaf, held.value.span),
                node=path,
            )


def call_of(text: str) -> ast.Call | None:
    """The call that code is; None for other code."""
    if len(text) > MOST_CODE:
        return None
    try:
        tree = parse_code(text.strip())
    except SyntaxError:
        return None
    return tree if isinstance(tree, ast.Call) else None


def word_in(name: str, span: Span, after: str = "") -> Word:
    """A name inside a span, before some text; the whole span if it is not written there."""
    found = re.search(rf"(?<!\w){re.escape(name)}(?=\s*{re.escape(after)})(?!\w)", span.text)
    if found is None:
        return Word(name, span)
    return Word(name, Span(span.source, span.start + found.start(), span.start + found.end()))
