"""The style of graphs: colours and fonts, and names and labels in the DOT language."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from html import escape

from smachac.ir.nodes import Node
from smachac.ir.outcome_names import fails

FONT = "Helvetica,Arial,sans-serif"

INK = "#24292f"
LINE = "#57606a"
FAINT = "#6e7781"
BORDER = "#8c959f"
STATE_FILL = "#ffffff"
FILLS = ("#f6f8fa", "#eaeef2")
"""The fill colours of containers, alternating with the depth."""

PARALLEL_FILL, PARALLEL_BORDER = "#f0f6ff", "#54aeff"
LOOP_FILL, LOOP_BORDER = "#fff8e5", "#d4a72c"
BADGE_INK = "#7d4e00"

TONES = {
    "success": ("#1a7f37", "#dafbe1"),
    "failure": ("#cf222e", "#ffebe9"),
    "warning": ("#bc4c00", "#fff1e5"),
    "neutral": (LINE, "#ffffff"),
}
"""The line and fill colours by tone of an outcome."""

JOINS = {"all": "", "any": ", first to end", "rule": ", first rule that holds"}
"""What ends a concurrence, by its `join`, after its kind."""

UNKNOWN_LEGEND = "dashed: not known exactly"
UNKNOWN_STYLE = "rounded,filled,dashed"
"""What the dashed boxes of pictures mean, and their style: states that are not known exactly."""

_WORDS = {
    "success": "succeeded success successful done ok finished completed complete reached true yes",
    "failure": "aborted failed failure fail error errored invalid rejected lost crashed collision"
    " unreachable fatal",
    "warning": "preempted timeout timed_out exhausted cancelled canceled interrupted recalled"
    " stopped invalid_input",
}
_TONE = {word: tone for tone, words in _WORDS.items() for word in words.split()}

_ODD = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")
"""Characters that XML 1.0 cannot represent."""


def tone(outcome: str, node: Node) -> str:
    """The tone of an outcome of a state, a key of `TONES`: failure if it is one, by its interface
    too, else what its name suggests."""
    found = _tone_of_name(outcome)
    declared = next((result.failure for result in node.outcomes if result.name == outcome), None)
    if declared is None:
        return "failure" if found != "warning" and fails(node, outcome) else found
    return "failure" if declared else "neutral" if found == "failure" else found


def _tone_of_name(outcome: str) -> str:
    word = outcome.casefold()
    before, _, last = word.rpartition("_")
    found = _TONE.get(word) or _TONE.get(last) or "neutral"
    if "not" in before.split("_") or "no" in before.split("_"):
        return {"success": "failure", "failure": "success"}.get(found, found)
    return found


def identifier(name: str) -> str:
    """A name with the special characters of DOT escaped; different names stay different."""
    return re.sub(r"[^\w.-]", lambda odd: f"~{ord(odd[0]):X}.", name)


def quoted(text: str) -> str:
    """A DOT string that shows a text.

    A backslash is replaced by U+2216: Graphviz resolves escapes in tooltips twice.
    """
    text = _ODD.sub("\ufffd", text).replace("\\", "\u2216")
    return '"' + text.replace('"', '\\"').replace("\n", "\\n") + '"'


def html(text: str) -> str:
    """Text for an HTML label, on one line and never empty: Graphviz rejects empty labels."""
    return escape(_ODD.sub("\ufffd", " ".join(text.split()))) or "&#160;"


def font(text: str, *, colour: str, size: int | None = None) -> str:
    """Markup in a colour and, if given, a size in points."""
    points = f' POINT-SIZE="{size}"' if size else ""
    return f'<FONT COLOR="{colour}"{points}>{text}</FONT>'


def attributes(values: Mapping[str, str], markup: str = "") -> str:
    """An attribute list. `markup` is the label, as HTML."""
    parts = [f"label=<{markup}>"] if markup else []
    parts += (f"{name}={quoted(value)}" for name, value in values.items())
    return f" [{', '.join(parts)}]"


def lines(texts: Iterable[str]) -> str:
    """Markup of these lines."""
    return "<BR/>".join(texts)


def spaced(texts: Iterable[str]) -> str:
    """As `lines`, with room for underscores between them."""
    rows = "".join(f"<TR><TD>{text}</TD></TR>" for text in texts)
    return f'<TABLE BORDER="0" CELLBORDER="0" CELLPADDING="0" CELLSPACING="1">{rows}</TABLE>'
