"""Classes of the user held against the interfaces of their state types.

A target reads what a class in its language declares, without running anything (`Declared`); what
cannot be read is not judged. `code_faults` says where that is not what the interface says.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Protocol

from smachac.diagnostics.diagnostic import Diagnostic, Severity
from smachac.diagnostics.source import Span, Word
from smachac.frontend.loader import Library
from smachac.frontend.state_types import StateType, find_state_type
from smachac.ir.nodes import Leaf, Machine
from smachac.ir.traversal import walk
from smachac.targets.errors import interfaces_differ, stale_code

Words = tuple[Word, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Declared:
    """What a class says its interface is, in the words of the interface where those fit.

    A part that could not be read is None. `others` are more faults, each with its place; `stale`
    is the number of the interface that the class was written for, where there is another now:
    its place, and the new number.
    """

    name: str
    span: Span
    outcomes: Words | None = None
    inputs: Words | None = None
    outputs: Words | None = None
    others: Words = ()
    stale: Word | None = None


class Language(Protocol):
    """The part of a Target that reads the user's classes: its name and its class reader."""

    @property
    def name(self) -> str: ...
    @property
    def declared(self) -> Callable[[StateType, Library], Declared | None]: ...


Load = Callable[[str], Language | None]


def code_faults(machine: Machine, library: Library, load: Load) -> Iterator[Diagnostic]:
    """Where code of the user is not what its interface says, at the first state of each type.

    These are warnings: only what is built for the language of the code fails.
    """
    targets: dict[str, Language | None] = {}
    for leaf, type_ in own_types(machine, library):
        for language in languages(type_):
            if language not in targets:
                targets[language] = load(language)
            target = targets[language]
            for item in type_faults(leaf, type_, target, library) if target is not None else ():
                yield replace(item, severity=Severity.WARNING)


def target_faults(machine: Machine, library: Library, target: Language) -> Iterator[Diagnostic]:
    """What `code_faults` says of one language, as errors."""
    for leaf, type_ in own_types(machine, library):
        if target.name in languages(type_):
            yield from type_faults(leaf, type_, target, library)


def languages(type_: StateType) -> tuple[str, ...]:
    """The languages that an interface names code in."""
    return tuple(dict.fromkeys((*type_.code, *type_.classes)))


def own_types(machine: Machine, library: Library) -> Iterator[tuple[Leaf, StateType]]:
    """The state types with an interface of the user's, each with the first state of it."""
    seen: set[str] = set()
    for _, node in walk(machine.root):
        if isinstance(node, Leaf) and node.type not in seen:
            seen.add(node.type)
            if library.own_template(f"{node.type}.yml") is not None:
                type_ = find_state_type(node.type, library, [])
                if type_ is not None and not type_.open:
                    yield node, type_


def type_faults(
    leaf: Leaf, type_: StateType, target: Language, library: Library
) -> Iterator[Diagnostic]:
    """The faults of the code of one state type in one language."""
    found = target.declared(type_, library)
    if found is None:
        return
    differences = [*_differences(type_, found)]
    if found.stale is not None:
        yield stale_code(leaf.span, type_.name, found.name, found.stale, differences)
    elif differences:
        yield interfaces_differ(leaf.span, type_.name, found.name, differences)


def _differences(type_: StateType, found: Declared) -> Iterator[Word]:
    parts = (
        ("outcome", found.outcomes, type_.outcomes),
        ("input key", found.inputs, type_.input_keys),
        ("output key", found.outputs, type_.output_keys),
    )
    for what, words, wanted in parts:
        left_to_the_script = f"{what.replace(' ', '_')}s" in type_.given
        if words is None or left_to_the_script or (what == "outcome" and type_.optional):
            continue
        yield from _unlike(what, words, [each.name for each in wanted], found.span)
    yield from found.others


def _unlike(what: str, words: Words, wanted: Iterable[str], span: Span) -> Iterator[Word]:
    names = [word.text for word in words]
    for name in wanted:
        if name not in names:
            yield Word(f"it has no {what} `{name}`", words[0].span if words else span)
    known = set(wanted)
    for word in words:
        if word.text not in known:
            yield Word(f"its {what} `{word.text}` is not in the interface", word.span)
