"""Hover texts, as Markdown: what a word of a script means."""

from __future__ import annotations

import os
from pathlib import Path

from smachac.analysis.context import Context
from smachac.frontend import schema
from smachac.frontend.schema import CONTAINER_DOCS, CONTAINERS
from smachac.ir.nodes import StateType, VariableType
from smachac.ir.types import ANY
from smachac.lsp.facts import Facts
from smachac.lsp.navigation import Named, named_at, script_path
from smachac.lsp.place import FIELD, KEY, Body, Place, place_at
from smachac.lsp.schema_words import schema_hover
from smachac.lsp.session import View
from smachac.report.explain_key import explain_key, key_text
from smachac.report.explain_state import explain_state, state_text
from smachac.report.outline import paragraphs
from smachac.report.state_types import Known, container_type, type_markdown


def hover_at(view: View, path: str, offset: int, facts: Facts) -> tuple[str, int, int] | None:
    """What the word at an offset of a text means, and its range; None if that is not known."""
    if view.python is not None:
        from smachac.lsp.python_view import hover as python_hover

        shown = python_hover(view.python, offset)
        folder = f"{Path(path).parent}{os.sep}"
        return shown and (shown[0].replace(folder, ""), *shown[1:])
    if view.kind != "script":
        found = schema_hover(view, offset)
        return (found[0], found[1].start, found[1].end) if found is not None else None
    place = place_at(view.tree, offset)
    text = hover(place, facts, view, path) if place is not None else ""
    return (text, place.word.start, place.word.end) if place is not None and text else None


def hover(place: Place, facts: Facts, view: View, path: str) -> str:
    """What the word at a place means; empty if that is not known."""
    word = str(place.word.value)
    if place.role == FIELD:
        return _field(place.body, word, facts)
    if place.field == "template":
        return _template(word, facts)
    if place.field == "script":
        found = facts.sub_script(word, facts.caller)
        return _sub_script(word, found[1], facts) if found is not None else ""
    named = named_at(place, facts)
    if named is not None:
        folder = f"{Path(path).parent}{os.sep}"
        return _named(named, facts, view, path).replace(folder, "")
    if place.field == "remapping" and place.role == KEY:
        return _interface_key(facts.called(place.body), word, facts)
    return ""


def _field(body: Body, word: str, facts: Facts) -> str:
    name = schema.LONG.get(word, word)
    type_ = facts.type_named(body.template)
    variable = type_.variables.get(word) if type_ is not None else None
    if variable is not None:
        return _variable(variable)
    doc = schema.FIELD_DOCS.get(name, "")
    default = schema.FIELD_DEFAULTS.get(name)
    end = f"\n\nDefault: `{default}`." if default else ""
    return f"**{name}**\n\n{doc}{end}" if doc else ""


def _variable(variable: VariableType) -> str:
    shown = "" if variable.type == ANY else f": {variable.type}"
    end = "Required." if variable.required else ""
    if variable.default is not None and variable.default.span.text:
        end = f"Default: `{' '.join(variable.default.span.text.split())}`."
    return "\n\n".join(filter(None, [f"`{variable.name}{shown}`", variable.doc, end]))


def _template(name: str, facts: Facts) -> str:
    kind = CONTAINERS.get(name)
    type_ = container_type(kind) if kind is not None else facts.type_named(name)
    if type_ is None:
        return ""
    place = "built-in" if type_.built_in or kind is not None else "of this project"
    if kind is not None:
        return f"**{name}**\n\n{CONTAINER_DOCS[kind]}"
    return type_markdown(Known(type_, place), level=3)


def _sub_script(name: str, body: Body, facts: Facts) -> str:
    rows = [("outcomes", facts.outcomes(body)), ("input keys", facts.inputs(body)),
            ("output keys", facts.outputs(body))]  # fmt: skip
    lines = [f"- {title}: {', '.join(f'`{name}`' for name in names)}" for title, names in rows
             if names]  # fmt: skip
    return "\n\n".join(filter(None, [f"**{name}**", body.text("doc"), "\n".join(lines)]))


def _interface_key(body: Body, word: str, facts: Facts) -> str:
    type_: StateType | None = facts.type_named(body.template)
    for key in (*type_.input_keys, *type_.output_keys) if type_ is not None else ():
        if key.name == word:
            shown = "" if key.type == ANY else f": {key.type}"
            return "\n\n".join(filter(None, [f"`{word}{shown}`", key.doc]))
    return ""


def _named(named: Named, facts: Facts, view: View, path: str) -> str:
    context = view.context
    if named.kind == "outcome":
        inner = facts.called(named.body)
        type_ = facts.type_named(inner.template)
        docs = (
            [outcome.doc for outcome in type_.outcomes if outcome.name == named.name]
            if type_
            else []
        )
        owner = named.body.name.value if named.body.name is not None else "the script"
        return "\n\n".join([f"outcome `{named.name}` of {owner}", *filter(None, docs)])
    plain = script_path(context.machine, named.body, path) if context is not None else None
    if context is None or plain is None:
        return f"{named.kind} `{named.name}`"
    full = full_path(context, plain)
    if named.kind == "state" and plain in context.written.states:
        return _text(paragraphs(*state_text(explain_state(context, plain, []))))
    return _text(paragraphs(*key_text(explain_key(context, full, named.name))))


def full_path(context: Context, plain: str) -> str:
    """The full path of a state: of one with sugar that of the state itself, not of the containers
    around it."""
    found = [path for path, shown in context.plain_paths.items() if shown == plain]
    return max(found, key=len) if found else plain


def _text(text: str) -> str:
    """A text for a terminal as a block of code."""
    return f"```text\n{text.rstrip()}\n```"
