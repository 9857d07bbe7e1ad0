"""Grammars (lark) and JSON schemas of smachac's notations, and the construction of parsers.

The parsers are made ready by scripts/parsers.py, so that nothing is installed for them and a start
takes less time.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from smachac.grammars.standalone.lalr import Lark


def load(name: str, *, builder: Any = None) -> Lark:
    """A new LALR parser for `<name>.lark`; callers keep it.

    With a `builder` the parser makes no tree: it calls the methods of the builder, named like the
    rules, with the results of the parts of each rule. Without one, trees have positions.
    """
    from smachac.grammars.standalone.lalr import Lark

    tables = import_module(f"{__name__}.standalone.{name}")
    options = {"transformer": builder, "propagate_positions": builder is None}
    parser: Lark = Lark._load_from_dict(tables.DATA, tables.MEMO, **options)  # type: ignore[no-untyped-call]
    return parser
