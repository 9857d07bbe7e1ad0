"""The nesting of a template, limited before Jinja compiles it.

Jinja 3.1 takes quadratic time and more for the depth of an expression, and recurses over tags.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from jinja2 import Environment

MOST_LEVELS = 50
"""The most tags one inside another, and the most brackets inside one tag or expression."""

MOST_OPERATIONS = 100
"""The most operators, attributes and filters in a row between two commas."""

_PLAIN = frozenset([",", ":", ";", "="])
_WORDS = frozenset(["not", "and", "or", "if", "is", "in"])
_OPENING = frozenset(["if", "for", "block", "macro", "call", "filter", "with"])


def refuse_deep(environment: Environment, text: str, name: str) -> None:
    """Raise TemplateSyntaxError at the first place of a template that is nested too deep."""
    from jinja2 import TemplateSyntaxError

    tags = brackets = operations = 0
    begins = False
    for line, kind, word in environment.lex(text, name, name):
        if kind in ("block_begin", "variable_begin"):
            brackets = operations = 0
            begins = kind == "block_begin"
            continue
        if kind == "name" and begins:
            tags += (word in _OPENING) - (word.removeprefix("end") in _OPENING - {word})
            begins = False
        elif kind == "operator" and word in "([{":
            brackets += 1
        elif kind == "operator" and word in ")]}":
            brackets -= 1
        elif kind == "operator" and word in _PLAIN:
            operations = 0
        elif kind == "operator" or (kind == "name" and word in _WORDS):
            operations += 1
        if tags > MOST_LEVELS or brackets > MOST_LEVELS:
            message = f"the template has more than {MOST_LEVELS} levels of nesting"
        elif operations > MOST_OPERATIONS:
            message = f"the template has more than {MOST_OPERATIONS} operations in one expression"
        else:
            continue
        raise TemplateSyntaxError(message, line, name, name)
