"""Writes smachac/grammars/standalone: the parsers of the grammars, which need no package.

    python scripts/parsers.py [folder]

The module lalr is what lark writes for every grammar, its lexer and parser (MPL-2.0); the module
NAME has the tables of NAME.lark. With a `folder` they are written there. Run it after each change
of a grammar, and after an update of lark. The tables are numbered in the order of the names and of
the first visit, so that they are the same for every Python.
"""

from __future__ import annotations

import sys
from io import StringIO
from pathlib import Path
from typing import Any

from lark import Lark
from lark.grammar import Rule
from lark.lexer import TerminalDef
from lark.tools.standalone import gen_standalone

GRAMMARS = Path(__file__).parents[1] / "smachac" / "grammars"

LEXERS = {"expression": "basic", "ir": "contextual", "property": "contextual", "type": "contextual"}
"""The lexer of each grammar. The contextual one accepts only what can follow: a word can be a
keyword at one place and a name at another."""


def main(folder: Path = GRAMMARS / "standalone") -> None:
    folder.mkdir(exist_ok=True)
    for name, lexer in LEXERS.items():
        grammar = GRAMMARS / f"{name}.lark"
        parser = Lark(grammar.read_text("utf-8"), parser="lalr", lexer=lexer)
        data, memo = parser.memo_serialize([TerminalDef, Rule])
        data["parser"]["parser"] = in_order(data["parser"]["parser"])
        for item in memo.values():
            bound_width(item)
        states = data["parser"]["parser"].pop("states")
        text = f'"""The tables of {name}.lark, made by scripts/parsers.py."""\n\n'
        text += f"STATES = {rows(states)}\n\nMEMO = {rows(memo)}\n\nDATA = {data}\n"
        text += 'DATA["parser"]["parser"]["states"] = STATES\n'
        (folder / f"{name}.py").write_text(text, "utf-8")
    out = StringIO()
    gen_standalone(parser, out=out)
    library, _, _ = out.getvalue().partition("import pickle, zlib, base64\nDATA = (")
    text = "\n".join(line.rstrip() for line in library.split("\n")) + "Shift = 0\nReduce = 1\n"
    (folder / "lalr.py").write_text(text, "utf-8")


def rows(table: dict[int, Any]) -> str:
    """A table as Python, a line for each entry."""
    return "".join(["{\n", *(f"{key}: {value},\n" for key, value in table.items()), "}"])


WIDEST = 2**32 - 1
"""The width of a pattern without a limit; it is larger on newer Pythons."""


def bound_width(item: dict[str, Any]) -> None:
    """Limits the width of the pattern of a terminal; a rule has none."""
    pattern = item.get("pattern", {})
    if "_width" in pattern:
        pattern["_width"] = [min(width, WIDEST) for width in pattern["_width"]]


def in_order(table: dict[str, Any]) -> dict[str, Any]:
    """An LALR table whose tokens and states are numbered independently of the order of sets."""
    names: dict[int, str] = table["tokens"]
    numbers = {name: number for number, name in enumerate(sorted(names.values()))}
    rows: dict[int, dict[str, tuple[int, Any]]] = {
        state: dict(sorted((names[token], action) for token, action in row.items()))
        for state, row in table["states"].items()
    }
    found = dict.fromkeys(table["start_states"].values())
    order = list(found)
    for state in order:
        for kind, target in rows[state].values():
            if kind == 0 and target not in found:
                found[target] = None
                order.append(target)
    place = {state: number for number, state in enumerate(order)}
    return {
        "tokens": {number: name for name, number in numbers.items()},
        "states": {
            place[state]: {
                numbers[name]: (kind, place[target] if kind == 0 else target)
                for name, (kind, target) in rows[state].items()
            }
            for state in order
        },
        "start_states": {name: place[state] for name, state in table["start_states"].items()},
        "end_states": {name: place[state] for name, state in table["end_states"].items()},
    }


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
