"""Completion: the words that fit at a place, the most likely one first."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

from smachac.lsp import (
    complete_fields,
    complete_flow,
    complete_keys,
    complete_templates,
    complete_values,
)
from smachac.lsp.facts import Facts
from smachac.lsp.place import FIELD, STATE, place_at
from smachac.lsp.repair import MARK, with_mark
from smachac.lsp.schema_words import TOML_WORD, schema_words
from smachac.lsp.session import View
from smachac.lsp.word import Completion, Request

WORD = re.compile(r"[\w.<>/-]*")


def word_range(text: str, offset: int, word: re.Pattern[str] = WORD) -> tuple[int, int]:
    """The range of the word at an offset; empty if there is none."""
    start = offset
    while start > 0 and word.fullmatch(text[start - 1]):
        start -= 1
    found = word.match(text, offset)
    return start, found.end() if found is not None else offset


def complete(text: str, offset: int, path: str, view: View | None) -> list[Completion]:
    """The words that fit at an offset of a text, in the order of their likelihood."""
    if view is not None and view.python is not None:
        return []
    is_project = view is not None and view.kind == "project"
    start, end = word_range(text, offset, TOML_WORD if is_project else WORD)
    if view is not None and view.kind != "script":
        return schema_words(text, start, end, view)
    marked = with_mark(text, start, end, path)
    if marked is None or view is None:
        return []
    _, tree, at = marked
    place = place_at(tree, at)
    if place is None or MARK not in str(place.word.value):
        return []
    machine = view.machine
    facts = Facts(view.library, path, machine.state_types if machine is not None else {})
    found = _words(Request(facts=facts, place=place, view=view))
    unique = {
        completion.word: completion
        for completion in reversed([*found])
        if completion.word and completion.word != MARK
    }
    return list(reversed(unique.values()))


def _words(here: Request) -> Iterable[Completion]:
    """The words for one place; they may repeat."""
    place = here.place
    if place.role == FIELD:
        return complete_fields.fields(here)
    if place.role == STATE:
        return [Completion(word=name, kind="state") for name in complete_flow.missing_states(here)]
    if place.siblings[:1] == ("params",) or _is_look_up(here):
        return [Completion(word=param, kind="param") for param in here.facts.params(place.bodies)]
    return BY_FIELD.get(place.field, complete_values.variable)(here)


def _is_look_up(here: Request) -> bool:
    """Whether the word is alone in two brackets: `[[word]]`."""
    word = here.place.word
    source, start, end = word.source, word.start, word.end
    return source.text[max(start - 2, 0) : start] == "[[" and source.text[end : end + 2] == "]]"


BY_FIELD: dict[str, Callable[[Request], Iterable[Completion]]] = {
    "template": complete_templates.templates,
    "script": complete_templates.scripts,
    "transitions": complete_flow.transitions,
    "autonomy": complete_values.autonomy,
    "remapping": complete_keys.remapping,
    "input_keys": complete_keys.declared_keys,
    "output_keys": complete_keys.declared_keys,
    "userdata": complete_keys.userdata,
    "outcomes": complete_flow.outcomes,
    "outcome_map": complete_flow.outcome_map,
    "initial": complete_flow.children,
    "on_error": complete_flow.on_error,
    "default_outcome": complete_flow.default_outcome,
    "connector_outcome": complete_flow.connector,
    "exhausted_outcome": complete_flow.endings,
    "final_outcome_map": complete_flow.final_map,
    "loop_outcomes": complete_flow.loop_outcomes,
    "break_outcomes": complete_flow.loop_outcomes,
    "it": complete_keys.item_keys,
    "it_label": complete_keys.label_keys,
    "for_each": complete_keys.for_each,
    "retry": complete_flow.retry,
    "callbacks": complete_keys.callbacks,
    "join": complete_values.choices,
    "robot": complete_values.robots,
    "params": complete_values.params,
}
"""The words in the value of a field; in those of other fields, `variable`."""
