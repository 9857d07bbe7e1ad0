"""The page of the viewer: styles, scripts and data in one text."""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Mapping
from hashlib import sha256
from html import escape
from importlib.resources import files
from typing import Any

from smachac.ir.nodes import Machine
from smachac.targets import made_by

_ESCAPES = {ord("<"): "\\u003c", ord(">"): "\\u003e", ord("&"): "\\u0026"}
"""Characters of JSON that would mean something to a reader of HTML. They are in strings only."""

_NONE, _SELF = "'none'", "'self'"

LAYOUT_ID, MODEL_ID, TRACE_ID = "smachac-layout", "smachac-model", "smachac-trace"
FILM_ID = "smachac-film"
"""The ids of the elements with the program that computes layouts, the model, a trace, and the data
of a film."""


def render_page(
    machine: Machine,
    model: Mapping[str, Any],
    data: Mapping[str, Any] | None = None,
    *,
    connect: bool = False,
) -> str:
    """The page that shows a model. It is ASCII, and equal input gives equal bytes.

    `data` is more data for the viewer, by element id. `connect`: the page may load data from the
    server that it comes from; otherwise it makes no connection at all.
    """
    style, script = _asset("viewer.css"), _asset("viewer.js")
    policy = "; ".join(
        [
            "default-src 'none'",
            f"script-src {_hash(script)}",
            f"style-src {_hash(style)}",
            "worker-src blob:",
            f"connect-src {_SELF if connect else _NONE}",
            *(["media-src blob:"] if connect else []),
            "base-uri 'none'",
            "form-action 'none'",
        ]
    )
    blocks = [_json_block(MODEL_ID, model)]
    blocks += [_json_block(name, content) for name, content in (data or {}).items()]
    return "\n".join(
        [
            "<!DOCTYPE html>",
            f"<!-- {_in_comment(made_by(machine))} -->",
            '<html lang="en">',
            "<head>",
            '<meta charset="utf-8">',
            f'<meta http-equiv="Content-Security-Policy" content="{policy}">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            f"<title>{_ascii(escape(machine.root.name))}</title>",
            f"<style>{style}</style>",
            "</head>",
            "<body>",
            "<noscript>This page needs JavaScript.</noscript>",
            *blocks,
            f'<script type="text/plain" id="{LAYOUT_ID}">{_asset("elk_worker.js")}</script>',
            f"<script>{script}</script>",
            "</body>",
            "</html>",
            "",
        ]
    )


def escaped_json(data: object) -> str:
    """JSON that can stand in an element `script`: ASCII, and without `<`, `>` and `&`."""
    return json.dumps(data, separators=(",", ":")).translate(_ESCAPES)


def _json_block(name: str, data: object) -> str:
    return f'<script type="application/json" id="{name}">{escaped_json(data)}</script>'


def _asset(name: str) -> str:
    """A file of the built viewer (viewer/ in the repository)."""
    return (files("smachac.targets.html") / name).read_text("utf-8")


def _hash(text: str) -> str:
    """The source expression of a content security policy that allows this text alone."""
    return f"'sha256-{b64encode(sha256(text.encode()).digest()).decode()}'"


def _in_comment(text: str) -> str:
    """A text in a comment of HTML: two hyphens in sequence and `>` would end it."""
    return _ascii(text.replace("--", "- -").replace(">", "&gt;"))


def _ascii(text: str) -> str:
    return text.encode("ascii", "xmlcharrefreplace").decode()
