"""Inlay hints: what the script leaves out, shown where it could stand."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.frontend.text.yaml_tree import Map, Scalar, Seq
from smachac.ir.types import ANY
from smachac.ir.written import written
from smachac.lsp.hover import full_path
from smachac.lsp.navigation import script_path
from smachac.lsp.place import Body, top_bodies
from smachac.lsp.session import View
from smachac.records import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Hint:
    """A text that an editor shows behind an offset."""

    offset: int
    text: str
    is_type: bool


def hints(view: View, path: str) -> list[Hint]:
    """The types of keys that have none in the text, and the transitions that are not written."""
    found: list[Hint] = []
    todo = top_bodies(view.tree)
    while todo:
        body = todo.pop()
        todo += body.states
        found += _key_hints(body, view, path)
    found += _transition_hints(view, path)
    return sorted(found, key=lambda hint: hint.offset)


def _key_hints(body: Body, view: View, path: str) -> Iterator[Hint]:
    context = view.context
    if context is None or not body.states:
        return
    plain = script_path(context.machine, body, path)
    if plain is None:
        return
    container = full_path(context, plain)
    for field in ("userdata", "input_keys", "output_keys"):
        entry = body.fields.get(field)
        value = entry.value if entry is not None else None
        words = [item for item in value.items if isinstance(item, Scalar)] if isinstance(
            value, Seq) else []  # fmt: skip
        if isinstance(value, Map) and field == "userdata":
            words = [entry.key for entry in value.entries
                     if not (isinstance(entry.value, Map) and entry.value.get("type"))]  # fmt: skip
        for word in words:
            type_ = context.types.keys.get((container, str(word.value)), ANY)
            if type_ != ANY:
                yield Hint(offset=word.end, text=f": {type_}", is_type=True)


def _transition_hints(view: View, path: str) -> Iterator[Hint]:
    """`aborted -> aborted` behind the name of each state with implicit transitions."""
    if view.machine is None:
        return
    seen: set[int] = set()
    for state in written(view.machine).states.values():
        node = state.node
        if node.span.source is not view.source or node.span.start in seen:
            continue
        steps = [transition for transition in node.transitions if transition.origin == "implicit"]
        if steps and node is state.outer:
            seen.add(node.span.start)
            words = ", ".join(f"{step.outcome} \u2192 {step.target}" for step in steps)
            yield Hint(offset=node.span.end + 1, text=f" {words}", is_type=False)
