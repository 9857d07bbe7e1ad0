"""State types whose code was read: their states, the names that these declare, related places."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from smachac.analysis.context import Context
from smachac.checks.findings import notation
from smachac.checks.findings.help_text import other_place
from smachac.diagnostics.diagnostic import Related
from smachac.diagnostics.source import NOWHERE, Word
from smachac.ir import nodes
from smachac.ir.nodes import Key, Leaf, Outcome, StateType
from smachac.ir.traversal import outcome_names

TYPE_CHECKING = False  # annotations only: most machines have no classes
if TYPE_CHECKING:
    from smachac.ir.class_facts import ClassFacts


def leaves_by_type(context: Context, *, declared: bool) -> Iterator[tuple[str, Leaf, ClassFacts]]:
    """A leaf of each type whose code was read, with its path. `declared`: one that can use only
    the keys it declares, unlike the child of an iterator. The iterator of `retry` and `for_each`
    has the keys that the state declares."""
    seen: set[str] = set()
    for path, leaf, facts, container in context.leaves_with_class:
        if declared and isinstance(container, nodes.Iterator) and not container.sugar:
            continue
        if leaf.type not in seen:
            seen.add(leaf.type)
            yield path, leaf, facts


def own_types(
    context: Context, *, declared: bool
) -> Iterator[tuple[str, Leaf, StateType, ClassFacts]]:
    """As `leaves_by_type`, for the types of the user."""
    for path, leaf, facts in leaves_by_type(context, declared=declared):
        type_ = context.machine.state_types.get(leaf.type)
        if type_ is not None and not type_.built_in and not type_.open:
            yield path, leaf, type_, facts


class TypeNames(NamedTuple):
    """The names of outcomes, input keys and output keys that some state of a type declares, or a
    default value of its constructor."""

    outcomes: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]


def names_by_type(context: Context) -> Mapping[str, TypeNames]:
    """The names of the types whose constructors get lists from the script. States of one type can
    declare different names, so a name is wrong only if none of them declares it."""
    found: dict[str, TypeNames] = {}
    for _, leaf, facts, _ in context.leaves_with_class:
        if facts.passed:
            given = dict(facts.passed)
            known = found.get(leaf.type) or TypeNames(
                given.get("outcomes", ()), given.get("input_keys", ()), given.get("output_keys", ())
            )
            pairs = zip(own_names(leaf), known, strict=True)
            joined = (tuple(dict.fromkeys((*own, *others))) for own, others in pairs)
            found[leaf.type] = TypeNames(*joined)
    return found


def own_names(leaf: Leaf) -> TypeNames:
    """The names that one state declares."""
    return TypeNames(
        outcome_names(leaf),
        tuple(key.name for key in leaf.inputs),
        tuple(key.name for key in leaf.outputs),
    )


def used_here(leaf: Leaf) -> tuple[Related, ...]:
    """The first state of a type, as a related place."""
    what = "is an object of" if notation.is_python(leaf) else "is of the type"
    if notation.is_function(leaf):
        what = "runs the function"
    return other_place(leaf.span, f"`{leaf.name}` {what} `{leaf.type}`")


def declared_here(leaf: Leaf, names: Sequence[Outcome | Key]) -> tuple[Related, ...]:
    """The place of the first of some names of a state in its interface, or of its outcomes; none
    for a class of a program in Python."""
    if notation.is_python(leaf):
        return ()
    spans = [name.span for name in (*names, *leaf.outcomes)]
    span = next((span for span in spans if span.source is not leaf.span.source), NOWHERE)
    return other_place(span, f"the interface of `{leaf.type}`")


def first_of_each(words: Iterable[Word], known: Iterable[str]) -> list[Word]:
    """The first occurrence of each unknown word."""
    found: dict[str, Word] = {}
    for word in words:
        found.setdefault(word.text, word)
    left = found.keys() - set(known)
    return [word for word in found.values() if word.text in left]
