"""Properties: what must never or always happen in the runs of a machine (docs/properties.md)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal, TypeAlias

from smachac.diagnostics.source import Span
from smachac.records import dataclass, field

Subject = Literal["path", "tag", "type", "claim"]
"""How an atom selects states: by path or its end, by tag, by state type, by claimed resource."""

Exceptions = Literal["caught", "all", "none"]
"""The exceptions that a property considers: those that the script catches, also those that end the
run, or none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Atom:
    """An event: the selected states are entered or, with an outcome, end with it."""

    subject: Subject
    name: str
    outcome: str | None = None
    span: Span = field(compare=False, repr=False)

    def __str__(self) -> str:
        """The atom as a script has it, without quotes."""
        subject = "" if self.subject == "path" else f"{self.subject} "
        return f"{subject}{self.name}" + ("" if self.outcome is None else f":{self.outcome}")


Atoms: TypeAlias = tuple[Atom, ...]
"""Alternatives: one of the events."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Never:
    """No event of `enter` from an event of `after` (if empty: from the start) to the next one of
    `until` (if empty: to the end)."""

    after: Atoms = ()
    until: Atoms = ()
    enter: Atoms


@dataclass(frozen=True, slots=True, kw_only=True)
class Before:
    """An event of `earlier` comes before the first event of `later`."""

    later: Atoms
    earlier: Atoms


@dataclass(frozen=True, slots=True, kw_only=True)
class After:
    """An event of `answer` follows each event of `first` before the run ends.

    `within`: it is the entry of one of the next states, at most so many; 0: there is no limit.
    `before_claim`: no state with one of these events is entered between the two.
    """

    first: Atoms
    answer: Atoms
    within: int = 0
    before_claim: Atoms = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class AtMost:
    """The event happens at most so many times in a run."""

    event: Atoms
    times: int


@dataclass(frozen=True, slots=True, kw_only=True)
class AlwaysEnds:
    """The property that every run ends."""


Form: TypeAlias = Never | Before | After | AtMost | AlwaysEnds


@dataclass(frozen=True, slots=True, kw_only=True)
class Property:
    """A property of a script; `name` is the given one, or the property in words.

    `exceptions` and `stops`: the paths that it is checked on.
    """

    name: str
    form: Form
    exceptions: Exceptions = "caught"
    stops: bool = True
    span: Span = field(compare=False, repr=False)


def atoms(form: Form) -> Atoms:
    """The atoms of a property, in the order of the script."""
    match form:
        case Never(after=after, until=until, enter=enter):
            return (*after, *until, *enter)
        case Before(later=later, earlier=earlier):
            return (*later, *earlier)
        case After(first=first, answer=answer, before_claim=claims):
            return (*first, *answer, *claims)
        case AtMost(event=event):
            return event
    return ()


def in_words(form: Form) -> str:
    """A property as a sentence."""
    return "".join(part if isinstance(part, str) else f"`{part}`" for part in words(form))


def words(form: Form) -> list[str | Atom]:
    """The parts of the sentence for a property: its events, and the words around them."""
    match form:
        case Never(after=after, until=until, enter=enter):
            start = [" after ", *_either(after)] if after else []
            end = [" until ", *_either(until)] if until else []
            return ["never ", *_either(enter), *start, *end]
        case Before(later=later, earlier=earlier):
            return [*_either(earlier), " before ", *_either(later)]
        case After(first=first, answer=answer, within=within, before_claim=claims):
            limit = [f" within {within} state{'s' * (within != 1)}"] if within else []
            claimed = [" before ", *_either(claims)] if claims else []
            return [*_either(answer), " after ", *_either(first), *limit, *claimed]
        case AtMost(event=event, times=times):
            return [*_either(event), f" at most {times} time{'s' * (times != 1)}"]
    return ["always ends"]


def _either(events: Atoms) -> Iterator[str | Atom]:
    """Alternatives, with the words between them."""
    for number, event in enumerate(events):
        if number:
            yield " or "
        yield event


def either(events: Atoms) -> str:
    """Alternatives in words."""
    return " or ".join(f"`{event}`" for event in events)
