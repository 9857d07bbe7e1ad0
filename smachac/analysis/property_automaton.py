"""Automata of properties: a table over the events that a property names.

An event is a state's entry or its end with an outcome. Its bits are the parts of the property that
name it: a row of the table has one entry for each combination of bits.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from smachac.diagnostics.source import assert_never
from smachac.ir.properties import After, AlwaysEnds, AtMost, Atoms, Before, Form, Never

BAD = -1
"""The state of an automaton after a violation."""

PREMISE, RELEASE, OTHER, LEAF = 1, 2, 4, 8
"""Bits of an event: it is what the property is about; it fulfils or ends the obligation; it is the
other event of the property; a leaf is entered."""


class Automaton(NamedTuple):
    """`table[state][bits]` is the next state; the first state is 0. `open_ends` are the states in
    which a run must not end."""

    table: Sequence[Sequence[int]]
    open_ends: frozenset[int] = frozenset()


class Part(NamedTuple):
    """Atoms of a property with their bits."""

    atoms: Atoms
    bits: int


def parts(form: Form) -> tuple[Part, ...]:
    """The atoms of a form by the bits that their events have."""
    match form:
        case Never(after=after, until=until, enter=enter):
            return Part(after, PREMISE), Part(until, RELEASE), Part(enter, OTHER)
        case Before(later=later, earlier=earlier):
            return Part(later, PREMISE), Part(earlier, RELEASE)
        case After(first=first, answer=answer, before_claim=claims):
            return Part(first, PREMISE), Part(answer, RELEASE), Part(claims, OTHER)
        case AtMost(event=event):
            return (Part(event, PREMISE),)
        case AlwaysEnds():
            return ()
    return assert_never(form)


def automaton(form: Form) -> Automaton:
    """The automaton of a form."""
    bits = range(16)
    match form:
        case Never(after=after):
            if not after:
                return Automaton([[_too_early(_swapped(bit)) for bit in bits], [1] * 16])
            idle = [int(bool(bit & PREMISE)) for bit in bits]
            return Automaton([idle, [_forbidden(bit) for bit in bits]])
        case Before():
            return Automaton([[_too_early(bit) for bit in bits], [1] * 16])
        case AtMost(times=times):
            rows = [[n + 1 if b & PREMISE else n for b in bits] for n in range(times)]
            return Automaton([*rows, [BAD if b & PREMISE else times for b in bits]])
        case After(within=within):
            waits = range(1, max(within, 1) + 1)
            first = len(waits)
            idle = [first if b & PREMISE and not b & RELEASE else 0 for b in bits]
            rows = [[_awaited(b, n, first, counts=within > 0) for b in bits] for n in waits]
            return Automaton([idle, *rows], frozenset(waits))
        case AlwaysEnds():
            return Automaton([[0] * 16])
    return assert_never(form)


def _forbidden(bits: int) -> int:
    """The next state while an event of `enter` is forbidden."""
    if bits & RELEASE:
        return int(bool(bits & PREMISE))
    return BAD if bits & OTHER else 1


def _swapped(bits: int) -> int:
    """The bits of `never` without `after` as those of `before`."""
    return (bits & RELEASE) | (PREMISE if bits & OTHER else 0)


def _too_early(bits: int) -> int:
    if bits & RELEASE:
        return 1
    return BAD if bits & PREMISE else 0


def _awaited(bits: int, left: int, first: int, *, counts: bool) -> int:
    """The next state while an answer is awaited. `left`: the states in which it may still come."""
    if bits & RELEASE:
        return 0
    if bits & OTHER:
        return BAD
    if counts and bits & LEAF:
        return left - 1 or BAD
    return left
