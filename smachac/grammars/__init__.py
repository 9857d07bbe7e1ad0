"""Grammars (lark) and JSON schemas of smachac's notations, and the construction of parsers.

The parsers are made ready by scripts/parsers.py, so that nothing is installed for them and a start
takes less time.
"""

from __future__ import annotations

from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from smachac.grammars.standalone.lalr import Lark


@cache
def parser_of(name: str, builder: type[Any] | None = None) -> Lark:
    """The LALR parser of `<name>.lark`, made at its first use, as a module is imported once.

    With a `builder` the parser makes no tree: it calls the methods of an object of this class,
    named like the rules, with the results of the parts of each rule. Without one, trees have
    positions.
    """
    from smachac.grammars.standalone.lalr import Lark

    tables = import_module(f"{__name__}.standalone.{name}")
    transformer = builder() if builder is not None else None
    options = {"transformer": transformer, "propagate_positions": builder is None}
    parser: Lark = Lark._load_from_dict(tables.DATA, tables.MEMO, **options)  # type: ignore[no-untyped-call]
    return parser
