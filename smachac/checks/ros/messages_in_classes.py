"""Messages of ROS in the classes of state types: types that do not exist, fields of messages."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.analysis.context import Context
from smachac.analysis.message_code import Content, MessageCode
from smachac.checks.findings.types_with_code import leaves_by_type, used_here
from smachac.checks.ros.message_reads import (
    unknown_field_finding,
    wrong_comparisons,
    wrong_operands,
    wrong_reads,
)
from smachac.checks.ros.message_types import KIND_WORDS, no_type, suggested_type
from smachac.diagnostics.diagnostic import Finding
from smachac.diagnostics.source import Span
from smachac.ir.class_facts import ClassMessages, MessageRef
from smachac.ir.message_types import Definitions, Message, MissingDefinitions
from smachac.ir.nodes import Leaf


def faults_in_classes(
    context: Context, found: Definitions, missing: MissingDefinitions
) -> Iterator[Finding]:
    """Faults of types and fields in the classes of the state types, each once."""
    seen: set[Span] = set()
    for path, leaf, facts in leaves_by_type(context, declared=False):
        if facts.messages is not None:
            for finding in _faults(path, leaf, facts.messages, found, missing):
                if finding.span not in seen:
                    seen.add(finding.span)
                    yield finding


def _faults(
    path: str,
    leaf: Leaf,
    messages: ClassMessages,
    found: Definitions,
    missing: MissingDefinitions,
) -> Iterator[Finding]:
    for ref, word in messages.named:
        kind, text, _ = ref.readings()[0]
        absent = missing.get((kind, text))
        if absent is not None:
            other = absent.other
            yield Finding(
                span=word.span,
                message=no_type(ref.package, ref.name, kind)
                if other is None
                else f"`{text}` is {KIND_WORDS[other]}, not {KIND_WORDS[kind]}",
                arguments=(ref.package, ref.name),
                help=suggested_type(ref.name, kind, absent)
                if other is None
                else f"import it from `{ref.package}.{other}`",
                effect="the program stops when it imports the type",
                related=used_here(leaf),
                node=path,
            )
    here = used_here(leaf)
    for ref, words in messages.calls:
        owners = _content(ref, found)
        for word in words:
            if owners and not any(owner.field(word.text) for owner in owners):
                yield unknown_field_finding(path, leaf, word, owners, here=here)
    for variables, uses in messages.uses:
        contents: dict[str, Content] = {
            name: tuple(_content(ref, found)) for name, ref in variables
        }
        code = MessageCode(contents=contents, uses=uses, results=(), function=None)
        yield from wrong_reads(path, leaf, code, found, here)
        yield from wrong_comparisons(path, leaf, code, found, here)
        yield from wrong_operands(path, leaf, uses.operands, code, found, here)


def _content(ref: MessageRef, found: Definitions) -> list[Message]:
    """The messages that a name means; none if it is the name of a service or an action."""
    for kind, text, part in ref.readings():
        if part and (kind, text) in found:
            return [definition.part(part) for definition in found[kind, text]]
    return []
