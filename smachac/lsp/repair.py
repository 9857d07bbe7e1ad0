"""Repair of half-typed texts: a YAML text of the same length, so that all offsets stay valid."""

from __future__ import annotations

from smachac.diagnostics.source import Source
from smachac.frontend.text.yaml_tree import Tree, parse, syntax_error_line

MOST_REPAIRS = 8
"""The most lines that are blanked before the whole text is given up."""


def repaired(text: str) -> str | None:
    """The text with lines blanked until it is YAML; None if that does not succeed.

    The line at which the parser stops is blanked if it has a word, else the one before it.
    """
    for _ in range(MOST_REPAIRS):
        line = syntax_error_line(text)
        if line is None:
            return text
        shorter = _blanked(text, line)
        if shorter is None:
            return None
        text = shorter
    return text if syntax_error_line(text) is None else None


def _blanked(text: str, line: int) -> str | None:
    """The text without the words of a line, or of the last line above it that has some."""
    lines = text.split("\n")
    while line >= 0 and not lines[line].strip():
        line -= 1
    if line < 0:
        return None
    lines[line] = " " * len(lines[line])
    return "\n".join(lines)


MARK = "smachacMARK"
"""The word that stands for the one at the cursor: no script has it."""

ENDING = "smachacEND"
"""The value that completes a field without one."""

_ENDINGS = tuple(
    name.replace("x", ENDING) for name in ("", ": x", "}", "]", ": x}", "}]", "]}", "}}", ": x}}")
)
"""What may complete the text after the cursor, in the order in which it is tried."""


def with_mark(text: str, start: int, end: int, name: str) -> tuple[Source, Tree, int] | None:
    """A YAML text in which MARK replaces the word from `start` to `end`, with its tree and the
    offset of MARK; None if no ending makes it YAML, also when other lines are blanked."""
    head, tail = text[:start], text[end:]
    line_end = tail.find("\n")
    rest, below = (tail[:line_end], tail[line_end:]) if line_end >= 0 else (tail, "")
    space = " " if head[-1:] in (":", "-", ",") else ""
    at = start + len(space)
    for base_head, base_below in _bases(head, below):
        for ending in _ENDINGS:
            for after in dict.fromkeys((rest, "")):
                made = f"{base_head}{space}{MARK}{ending}{after}{base_below}"
                if syntax_error_line(made) is None:
                    source = Source(name, made)
                    tree = parse(source, [])
                    if tree is not None:
                        return source, tree, at
    return None


def _bases(head: str, below: str) -> list[tuple[str, str]]:
    """The texts before the cursor and below its line: as they are, and repaired."""
    line_start = head.rfind("\n") + 1
    found = [(head, below)]
    blank = f"{head[:line_start]}{' ' * (len(head) - line_start)}{below}"
    fixed = repaired(blank)
    if fixed is not None and fixed != blank:
        found.append((fixed[:line_start] + head[line_start:], fixed[len(head) :]))
    return found
