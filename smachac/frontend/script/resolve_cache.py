"""Results that one reading of a script leaves for the next one, after some texts have changed.

A state is a function of its fields, of the params and the calls around it, of the aliases of types,
of the texts of the sub-scripts inside, and of the state types there. If all of these are the same
as in the last reading, so is the state: that of a called sub-script, and one that is in no
container of the script. In an editor the spans of a state that did not change are the same
(pieces.py). A state type is a function of the answers of the library. Nothing is kept that has a
finding.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple, TypeAlias

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source, Span
from smachac.frontend.loader import Library
from smachac.frontend.resolved_script import State
from smachac.frontend.script.params import Scope
from smachac.frontend.script.unused import Uses
from smachac.frontend.text.type_names import Aliases
from smachac.frontend.text.yaml_tree import Entry
from smachac.frontend.types.state_types import find_state_type
from smachac.ir.nodes import FixedParam, Preset, StateType
from smachac.records import dataclass, field, replace

Answers: TypeAlias = "list[object]"
"""The answers of a library: texts, each equal to itself alone, and names of files."""


class CachedCall(NamedTuple):
    """The state of a call, or one in no container, and all else that its reading has found.

    `own`: the fields of the call. `around`: its surroundings, except `scope`. `texts`: those of the
    sub-scripts inside, by their names and the calling texts. `calls`: those inside. `states` and
    `keys`: the numbers of states and of userdata values; `most_keys`: the most values of one state.
    """

    own: Mapping[str, Entry]
    around: object
    scope: Scope
    state: State
    texts: Mapping[tuple[str, str], Source]
    sources: Mapping[Source, None]
    types: Mapping[str, StateType | None]
    calls: Mapping[Span, CachedCall]
    uses: Uses
    states: int
    keys: int
    most_keys: tuple[Preset, ...]
    fixed_params: tuple[FixedParam, ...]


def same_objects(one: Mapping[str, object], other: Mapping[str, object]) -> bool:
    """Whether two mappings have the same objects under the same names, with the same places."""
    return one.keys() == other.keys() and all(other[name] is value for name, value in one.items())


@dataclass(slots=True)
class ResolveCache:
    """The results of the last reading: the calls by the span of the state's name, the state types
    with the answers that they were made from, and the aliases of types."""

    calls: Mapping[Span, CachedCall] = field(default_factory=dict)
    types: dict[str, tuple[Answers, StateType]] = field(default_factory=dict)
    aliases: Aliases = field(default_factory=dict)

    def use_aliases(self, aliases: Aliases) -> None:
        """Forget the calls if the aliases are others."""
        if aliases != self.aliases:
            self.aliases, self.calls = aliases, {}

    def state_type(self, name: str, library: Library, report: Report) -> StateType | None:
        """As `find_state_type`; the same object as before if the answers are the same."""
        answers: Answers = [library.types]
        before = len(report)
        found = find_state_type(name, _noted(library, answers), report)
        known = self.types.pop(name, None)
        if found is None or len(report) > before:
            return found
        self.types[name] = known if known is not None and known[0] == answers else (answers, found)
        return self.types[name][1]


def _noted(library: Library, answers: Answers) -> Library:
    """A library whose answers to the questions of `find_state_type` are noted."""

    def text(ask: Callable[[str], Source | None], name: str) -> Source | None:
        answers.append(found := ask(name))
        return found

    def names(folder: str) -> tuple[str, ...]:
        answers.append(found := (*library.code_names(folder),))
        return found

    return replace(
        library,
        template=lambda name: text(library.template, name),
        own_template=lambda name: text(library.own_template, name),
        code=lambda name: text(library.code, name),
        code_names=names,
    )
