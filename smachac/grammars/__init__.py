"""The grammars of smachac's notations, one file each, and how a parser is made from one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

if TYPE_CHECKING:
    from lark import Lark


def load(
    name: str, *, builder: Any = None, lexer: Literal["basic", "contextual"] = "basic"
) -> Lark:
    """A new LALR parser for `<name>.lark`; keep it, for making one takes some milliseconds.

    With a `builder` no tree is made: its methods, named like the rules, are called with what the
    parts of the rule gave. Without one, trees carry their positions.
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
