"""Keys of one container that nothing sets before they are read, where it has no `userdata`: one
finding (SM301) with the initial values that are missing."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import groupby

from smachac.analysis.context import Context
from smachac.analysis.type_inference import Types
from smachac.analysis.unset_reads import Missing, Reader, container_name, reader_at
from smachac.checks.findings import notation
from smachac.checks.findings.help_text import calls, other_place
from smachac.checks.findings.type_words import placeholder
from smachac.diagnostics.diagnostic import Finding
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import listed
from smachac.ir import nodes
from smachac.ir.types import ANY

MOST_RELATED = 5
"""Limit on the other readers in a finding."""


def missing_together(found: Iterable[Missing]) -> Iterator[tuple[Missing, ...]]:
    """The keys of each container that has no initial values and lacks two or more. A key that is
    set later counts only if the state that reads it first also sets it, as a counter."""
    for _, group in groupby(found, lambda missing: missing.scope.path):
        every = [missing for missing in group if not missing.scope.container.userdata]
        scope = every[0].scope if every else None
        if (
            scope is None
            or scope.inputs
            or not any(missing.cause == "nowhere" for missing in every)
        ):
            continue
        known = {key for steps in scope.steps.values() for step in steps
                 for key in step.writes.perhaps}  # fmt: skip
        guess = guesser(sorted(known | scope.held))
        lacking = tuple(
            missing
            for missing in every
            if (missing.cause == "nowhere" and guess.unique_match(missing.key) is None)
            or (missing.cause == "unset" and counts(missing))
        )
        if len(lacking) > 1:
            yield lacking


def _first(missing: Missing) -> Reader:
    return reader_at(missing.scope, missing.vertices[0], missing.key)


def counts(missing: Missing) -> bool:
    """Whether only states that read a key set it, as that of a counter."""
    uses = missing.scope.uses
    writers = {use.path for use in uses.writers(missing.key)}
    return bool(writers) and writers <= {use.path for use in uses.readers(missing.key)}


def together_finding(context: Context, lacking: tuple[Missing, ...]) -> Finding:
    """The finding on such keys, at the first state that reads one."""
    scope = lacking[0].scope
    readers = [_first(missing) for missing in lacking]
    keys = [missing.key for missing in lacking]
    first = readers[0]
    where = container_name(scope, first.span)
    pairs = [(missing.key, initial_value(context.types, reader, missing))
             for missing, reader in zip(lacking, readers, strict=True)]  # fmt: skip
    others = [reader for reader in readers[1:] if reader.span != first.span][:MOST_RELATED]
    return Finding(
        span=first.span,
        message=f"nothing in {where} sets {listed(keys)} before its states read them",
        arguments=tuple(keys),
        help=f"give them initial values in {where}:"
        f" `{notation.initial_values(scope.container, pairs)}`",
        related=(
            *(
                place
                for other in others
                for place in other_place(other.span, f"{other.words} here")
            ),
            *calls(first.node, first.span),
        ),
        node=first.path,
    )


def initial_value(types: Types, reader: Reader, missing: Missing) -> str:
    """An initial value of the type that is expected."""
    node = reader.node
    if isinstance(node, nodes.Iterator) and node.items_key == reader.key:
        return "[...]"
    wanted = types.inputs.get((reader.path, reader.key), ANY)
    if placeholder(wanted) == "...":
        wanted = types.keys.get((missing.scope.path, missing.key), ANY)
    zeros = {"int": "0", "float": "0.0"} if missing.cause == "unset" else {}
    return zeros.get(wanted.name) or placeholder(wanted)
