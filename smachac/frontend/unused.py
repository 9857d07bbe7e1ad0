"""What a script declares and never uses: params that no look-up asks for, aliases of types."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import TypeAlias

from smachac.diagnostics.diagnostic import Report, has_errors
from smachac.diagnostics.source import Span, Word
from smachac.frontend.params import is_flat, look_up_word
from smachac.frontend.state_types import StateType
from smachac.frontend.type_annotations import type_words, words_of
from smachac.frontend.yaml_tree import Entry, Map, Scalar, Tree
from smachac.ir.nodes import Unused

Mark: TypeAlias = tuple[int, int, int]
"""A moment while a script is read: how much was met by then, and told."""


@dataclass(slots=True)
class Uses:
    """What was met of a script so far, in order; `found` is what was declared in vain.

    `asked` are the names that look-ups ask for. `unknown`: how often something was met that may
    use any param, such as a template of SMACHA's.
    """

    asked: list[str] = field(default_factory=list)
    types: set[str] = field(default_factory=set)
    unknown: int = 0
    found: list[Unused] = field(default_factory=list)

    def value(self, key: str, tree: Tree) -> None:
        """A variable of a state."""
        if not is_flat(tree):
            self.asked += _names(tree)
        self.types.update(type_words(key, tree))

    def type(self, type_: StateType) -> None:
        """The type of a state."""
        self.unknown += type_.open or "variables" in type_.given

    def mark(self, report: Report) -> Mark:
        """Where a state with params begins."""
        return len(self.asked), self.unknown, len(report)

    def params(self, own: Entry | None, begin: Mark, report: Report, via: tuple[Span, ...]) -> None:
        """Judge the params of a state that has been read. Where anything is unknown, or wrong,
        nothing is said of them."""
        if own is None or not isinstance(own.value, Map):
            return
        asked, unknown, told = begin
        if self.unknown > unknown or has_errors(report[told:]):
            return
        used = set(self.asked[asked:])
        for entry in own.value.entries:
            name = str(entry.key.value)
            if name not in used:
                self.found.append(Unused("param", Word(name, entry.key.span), via))

    def aliases(self, tree: Tree, report: Report) -> None:
        """Judge the types of a script that has been read."""
        if has_errors(report) or not isinstance(tree, Map):
            return
        inside = {word for entry in tree.entries for word in words_of(entry.value)}
        for entry in tree.entries:
            name = str(entry.key.value)
            if name not in self.types | inside:
                self.found.append(Unused("type", Word(name, entry.key.span)))

    def judged(self, report: Report) -> tuple[Unused, ...]:
        """What was declared in vain; not what a look-up asks for in the wrong place (SM015)."""
        if not has_errors(report):
            return tuple(self.found)
        asked = set(self.asked)
        return tuple(each for each in self.found if each.word.text not in asked)


def _names(tree: Tree) -> Iterator[str]:
    """The params that a value asks for, at any depth."""
    todo: list[Tree] = [tree]
    while todo:
        each = todo.pop()
        if isinstance(each, Scalar):
            continue
        word = look_up_word(each)
        if word is not None:
            yield word.text
            continue
        inner: Iterable[Tree]
        inner = (entry.value for entry in each.entries) if isinstance(each, Map) else each.items
        todo.extend(inner)
