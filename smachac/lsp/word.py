"""A word that completion offers, and the request that it answers."""

from __future__ import annotations

from smachac.lsp.facts import Facts
from smachac.lsp.place import Body, Place
from smachac.lsp.session import View
from smachac.records import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Completion:
    """A word that fits. `kind` is one of KINDS; `detail` is its type, `doc` its description.
    `text` replaces what is typed; empty if it is the word itself."""

    word: str
    kind: str
    detail: str = ""
    doc: str = ""
    text: str = ""


KINDS = ("field", "state", "outcome", "key", "type", "template", "script", "param", "value")
"""The kinds of words."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Request:
    """A place where a word is wanted, with what is known around it."""

    facts: Facts
    place: Place
    view: View

    @property
    def body(self) -> Body:
        """The state, container or script in which the word stands."""
        return self.place.body

    @property
    def around(self) -> Body | None:
        """The container of that state."""
        return self.place.around
