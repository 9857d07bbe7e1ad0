"""Unused declarations of a script: params that no look-up names, aliases that no type has."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import TypeAlias

from smachac.diagnostics.diagnostic import Report, has_errors
from smachac.diagnostics.source import Source, Span, Word
from smachac.frontend.script.params import look_ups
from smachac.frontend.text.yaml_tree import Entry, Map, Scalar, Tree
from smachac.frontend.types.type_annotations import TYPED, type_words, words_of
from smachac.ir.nodes import StateType, Unused
from smachac.records import dataclass, field

Mark: TypeAlias = tuple[int, int, int]
"""A position in the reading of a script: look-ups, unknown uses and diagnostics so far."""


@dataclass(slots=True)
class Uses:
    """The uses of params and aliases in the part of a script read so far.

    `looked_up` are the names in look-ups, in order. `unknown` counts the states that may use any
    param, such as those of SMACHA's templates. `found` are the unused declarations. `defaults` are
    the places of params that fields of a sub-script use where no call replaces them; `anchored` are
    the places of the values of unused params, `trees` those of the script and its sub-scripts.
    """

    looked_up: list[str] = field(default_factory=list)
    types: set[str] = field(default_factory=set)
    unknown: int = 0
    found: list[Unused] = field(default_factory=list)
    defaults: set[Span] = field(default_factory=set)
    anchored: dict[Span, list[Span]] = field(default_factory=dict)
    trees: dict[Source, Tree] = field(default_factory=dict)

    def value(self, key: str, tree: Tree, *, flat: bool) -> None:
        """Collect the uses in a field of a state. `flat`: see `is_flat`."""
        if not flat:
            self.looked_up += (word.text for word in look_ups(tree))
        if key in TYPED:
            self.types.update(type_words(key, tree))

    def add(self, inner: Uses) -> None:
        """Add the uses in a part of the script that was read on its own."""
        self.looked_up += inner.looked_up
        self.types |= inner.types
        self.unknown += inner.unknown
        self.found += inner.found
        self.defaults |= inner.defaults
        self.anchored |= inner.anchored
        self.trees |= inner.trees

    def type(self, type_: StateType) -> None:
        """Count a state whose type may use any param. The template of one without an interface sees
        them as `params`."""
        self.unknown += type_.any_variable and (type_.used is None or "params" in type_.used)

    def mark(self, report: Report) -> Mark:
        """The current position: a state begins."""
        return len(self.looked_up), self.unknown, len(report)

    def params(self, own: Entry | None, begin: Mark, report: Report, via: tuple[Span, ...]) -> None:
        """Find the unused params of a state whose reading ends here. With errors or unknown uses in
        the state no param counts as unused."""
        if own is None or not isinstance(own.value, Map):
            return
        looked_up, unknown, before = begin
        if self.unknown > unknown or has_errors(report[before:]):
            return
        used = set(self.looked_up[looked_up:])
        given: dict[object, set[str]] = {}
        for entry in own.value.entries:
            given.setdefault(entry.key.span.source, set()).add(str(entry.key.value))
        for entry in own.value.entries:
            name = str(entry.key.value)
            if name in used:
                self.defaults.add(entry.key.span)
                continue
            # Those of a called sub-script are in another text: the call can give them.
            known = tuple(sorted(used - given[entry.key.span.source]))
            kept = {str(entry.key.value): entry.value.span for entry in own.value.entries
                    if entry.key.value in known} if known else {}  # fmt: skip
            self.found.append(Unused("param", Word(name, entry.key.span), via, known, kept))
            self.anchored[entry.key.span] = [node.span for node in _inside(entry.value)]

    def replaced(self, inner: Mapping[str, Entry], call: Mapping[str, Entry]) -> None:
        """Count the params of a sub-script that its own fields use, of which the call replaces
        some, and those that the params of the call use."""
        params = inner.get("params")
        if params is None or not isinstance(params.value, Map):
            return
        fields = [entry.value for key, entry in inner.items() if key in call]
        given = call.get("params")
        fields += [given.value] if given is not None else []
        names = {word.text for value in fields for word in look_ups(value)}
        keys = (entry.key for entry in params.value.entries if entry.key.value in names)
        self.defaults.update(key.span for key in keys)

    def aliases(self, tree: Tree, report: Report) -> None:
        """Find the unused aliases of a script, after it was read."""
        if has_errors(report) or not isinstance(tree, Map):
            return
        inside = {word for entry in tree.entries for word in words_of(entry.value)}
        for entry in tree.entries:
            name = str(entry.key.value)
            if name not in self.types | inside:
                self.found.append(Unused("type", Word(name, entry.key.span)))

    def unused(self, report: Report) -> tuple[Unused, ...]:
        """The unused declarations, without those of use elsewhere.

        A param is of use if another reading of its sub-script uses it, if an alias repeats its
        value, or if a look-up out of scope names it (SM015).
        """
        if not self.found:
            return ()
        places = Counter(node.span for tree in self.trees.values() for node in _inside(tree))
        repeated = {
            span
            for span, inside in self.anchored.items()
            if any(places[span] > 1 for span in inside)
        }
        names = set(self.looked_up) if has_errors(report) else set()
        of_use = self.defaults | repeated
        return tuple(
            unused
            for unused in self.found
            if unused.word.text not in names and unused.word.span not in of_use
        )


def _inside(tree: Tree) -> Iterator[Tree]:
    """A value and the values in it, as often as they stand there."""
    todo: list[Tree] = [tree]
    while todo:
        each = todo.pop()
        yield each
        if isinstance(each, Map):
            todo.extend(entry.value for entry in each.entries)
        elif not isinstance(each, Scalar):
            todo.extend(each.items)
