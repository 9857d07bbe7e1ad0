"""The differences of two analysed scripts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from pathlib import PurePath
from typing import Literal

from smachac.diagnostics.diagnostic import Diagnostic, Report
from smachac.diff.matching import corresponding, renamed_words
from smachac.diff.same_behaviour import paired_states
from smachac.diff.states import Fact, State, States, renamed, states_of, translated, value_text
from smachac.driver import Analysis
from smachac.records import dataclass, field

Kind = Literal["added", "removed", "changed", "renamed", "moved"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Change:
    """One difference: `what` is `state` or the kind of a fact, `name` that of the fact.

    `path` is the path of the state after the change, or of a removed one before it; `was` is its
    path before, where that is another. `before` and `after` are texts; empty where there is none.
    """

    kind: Kind
    what: str
    path: str
    name: str = ""
    was: str = ""
    before: str = ""
    after: str = ""
    place: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Comparison:
    """The differences of a script before and after: `name` and `was` are the names of its files.

    `changes` are in the order of the states after the change, removed states last. `states` are
    those before and after; `pairs` the paths after by the paths before. `same` counts the findings
    that both have. `alike` are the paths after, by those before, of the states that take each
    other's place in every run, if the machines are proved to behave alike; else None. `unread`: one
    of the machines could not be read, and so there are no changes.
    """

    name: str
    was: str
    changes: tuple[Change, ...] = ()
    added: Report = field(default_factory=list)
    removed: Report = field(default_factory=list)
    same: int = 0
    alike: Mapping[str, str] | None = None
    unread: bool = False
    before: States = field(default_factory=dict)
    after: States = field(default_factory=dict)
    pairs: Mapping[str, str] = field(default_factory=dict)

    @property
    def place(self) -> dict[str, str]:
        """The paths of the states before in a picture of both: of one that was removed, its path
        with a mark."""
        return {path: self.pairs.get(path, f"{path} (removed)") for path in self.before}

    @property
    def equal(self) -> bool:
        return not (self.unread or self.changes or self.added or self.removed)


def compare(before: Analysis | None, after: Analysis | None) -> Comparison:
    """Compare two analyses; None for a script that does not exist."""
    unread = any(analysis is not None and analysis.machine is None for analysis in (before, after))
    old, new = ({}, {}) if unread else (_states(before), _states(after))
    pairs = corresponding(old, new) if old and new else {}
    added, removed, same = _findings(before, after, pairs)
    return Comparison(
        name=after.script if after is not None else "",
        was=before.script if before is not None else "",
        changes=tuple(_changes(old, new, pairs)),
        added=added,
        removed=removed,
        same=same,
        alike=paired_states(before, after),
        unread=unread,
        before=old,
        after=new,
        pairs=pairs,
    )


def _states(analysis: Analysis | None) -> States:
    return {} if analysis is None or analysis.machine is None else states_of(analysis.machine)


def _changes(old: States, new: States, pairs: Mapping[str, str]) -> Iterator[Change]:
    sources = {other: one for one, other in pairs.items()}
    for path, state in new.items():
        if path not in sources:
            yield _whole(state, "added")
            continue
        known = old[sources[path]]
        yield from _place(known, state, pairs)
        yield from _fact_changes(known, state, pairs)
    for path, state in old.items():
        if path not in pairs:
            yield _whole(state, "removed")


def _whole(state: State, kind: Kind) -> Change:
    edges = [
        f"{name} -> {value_text(value)}"
        for (what, name), value in state.facts.items()
        if what == "transition"
    ]
    text = ": ".join(filter(None, [state.type, ", ".join(edges)]))
    before, after = ("", text) if kind == "added" else (text, "")
    return Change(
        kind=kind, what="state", path=state.path, before=before, after=after, place=str(state.span)
    )


def _place(known: State, state: State, pairs: Mapping[str, str]) -> Iterator[Change]:
    """The change of the name or of the container of a state."""
    if known.parent is None or state.parent is None:
        return
    moved = pairs.get(known.parent) != state.parent
    if moved or known.name != state.name:
        yield Change(
            kind="moved" if moved else "renamed",
            what="state",
            path=state.path,
            was=known.path,
            before=known.path,
            after=state.path,
            place=str(state.span),
        )


def _fact_changes(known: State, state: State, pairs: Mapping[str, str]) -> Iterator[Change]:
    def change(fact: Fact, kind: Kind, before: str, after: str) -> Change:
        what, name = fact
        return Change(
            kind=kind,
            what=what,
            path=state.path,
            name=name,
            was=known.path if known.path != state.path else "",
            before=before,
            after=after,
            place=str(state.span),
        )

    before = {renamed(fact, value, pairs): value for fact, value in known.facts.items()}
    for fact, value in state.facts.items():
        old = before.get(fact)
        if old is None:
            yield change(fact, "added", "", value_text(value))
        elif translated(old, pairs) != value:
            yield change(fact, "changed", value_text(old), value_text(value))
    for fact, old in before.items():
        if fact not in state.facts:
            yield change(fact, "removed", value_text(old), "")


def _findings(
    before: Analysis | None, after: Analysis | None, pairs: Mapping[str, str]
) -> tuple[Report, Report, int]:
    """The findings that are new, those that are gone, and the number of those in both."""
    words = renamed_words(pairs)
    old = (
        [(_mark(diagnostic, before, words), diagnostic) for diagnostic in before.report]
        if before
        else []
    )
    new = (
        [(_mark(diagnostic, after, {}), diagnostic) for diagnostic in after.report] if after else []
    )
    added, removed = _left(new, old), _left(old, new)
    return added, removed, len(new) - len(added)


def _left(
    these: Iterable[tuple[object, Diagnostic]], others: Iterable[tuple[object, Diagnostic]]
) -> Report:
    """The findings that the other report does not have, or has less often."""
    rest = Counter(mark for mark, _ in others)
    found = []
    for mark, diagnostic in these:
        if rest[mark]:
            rest[mark] -= 1
        else:
            found.append(diagnostic)
    return found


def _mark(item: Diagnostic, analysis: Analysis | None, words: Mapping[str, str]) -> object:
    """What stays of a finding when the lines around it move and states are renamed: its code and
    severity, its file, its state and its arguments."""
    file = item.span.source.name
    main = analysis is not None and file == analysis.script
    state = (item.finding.node or "").rpartition("/")[2]
    arguments = tuple(words.get(argument, argument) for argument in item.finding.arguments)
    name = "" if main else PurePath(file).name
    return item.code, item.severity, name, words.get(state, state), arguments
