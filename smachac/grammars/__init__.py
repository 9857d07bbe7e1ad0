"""Grammars (lark) and JSON schemas of smachac's notations, and the construction of parsers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

if TYPE_CHECKING:
    from lark import Lark


def load(
    name: str, *, builder: Any = None, lexer: Literal["basic", "contextual"] = "basic"
) -> Lark:
    """A new LALR parser for `<name>.lark`; callers keep it, because its construction takes 12
    to 103 ms.

    With a `builder` the parser makes no tree: it calls the methods of the builder, named like the
    rules, with the results of the parts of each rule. Without one, trees have positions.
    """
    from lark import Lark

    return Lark.open_from_package(
        __name__,
        f"{name}.lark",
        ("",),
        parser="lalr",
        lexer=lexer,
        transformer=builder,
        propagate_positions=builder is None,
        cache=False,
    )
