"""All answers of a session of the language server about a place, without the protocol."""

from __future__ import annotations

from smachac.diagnostics.diagnostic import Diagnostic, in_order
from smachac.ir.recursion import deep_recursion
from smachac.lsp import symbols
from smachac.lsp.completion import complete
from smachac.lsp.facts import Facts
from smachac.lsp.hints import hints
from smachac.lsp.hover import hover
from smachac.lsp.navigation import definitions, named_at, references
from smachac.lsp.picture import picture
from smachac.lsp.place import place_at
from smachac.lsp.session import Session


def answers(session: Session, path: str, text: str, offset: int) -> list[Diagnostic]:
    """Change a text and compute every answer about a place of it; the findings of its check."""
    session.change(path, text)
    with deep_recursion():
        view = session.view(path)
        assert view is not None
        complete(text, offset, path, view)
        hints(view, path)
        picture(view)
        for part in (symbols.symbols, symbols.folds, symbols.tokens):
            part(view.tree)
        place = place_at(view.tree, offset)
        if place is not None:
            known = view.machine.state_types if view.machine is not None else {}
            facts = Facts(view.library, path, known)
            hover(place, facts, view, path)
            definitions(place, facts)
            named = named_at(place, facts)
            if named is not None:
                references(named, session.machines(path))
    return in_order(item for one in session.check(path).values() for item in one)
