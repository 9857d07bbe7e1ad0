"""Explanation of a userdata key: its writers, readers and copies, and where it is set."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from smachac.analysis.context import Context
from smachac.analysis.def_use import (
    Status,
    around,
    key_statuses,
    path_without,
    same_key,
    written_on,
)
from smachac.analysis.definite_assignment import DataFlow, UserdataScope
from smachac.analysis.uses import Use, UseKind
from smachac.diagnostics.source import Span
from smachac.ir import nodes
from smachac.ir.nodes import Preset
from smachac.ir.printer import print_data
from smachac.ir.traversal import outcome_names
from smachac.ir.types import ANY, Type
from smachac.records import dataclass, field, replace
from smachac.report.outline import STATUS, Paragraph, at, place, way
from smachac.runtime.tracing.writer import SECRET

MOST_READERS = 100
"""Limit on the readers of a key whose paths are computed; the others are only named."""


@dataclass(frozen=True, slots=True, kw_only=True)
class UseStatus:
    """A use of a key by the state at a path of the script; `kind` is that of the state without its
    badges; `own`: it is the container of the key itself. For a read: whether the key is set
    there, and a path on which it is not; for a write: the outcomes with which the key is set, and
    whether these are all."""

    use: Use
    path: str
    kind: UseKind
    own: bool
    outcomes: tuple[str, ...] = ()
    always: bool = True
    status: Status | None = None
    without: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class KeyPart:
    """A key in one container.

    `inside` is the container around it that shares the key, with its name there. `given`: the
    caller of the machine sets the key.
    """

    container: str
    key: str
    type: Type
    value: str
    given: bool
    inside: tuple[str, str] | None
    uses: tuple[UseStatus, ...]
    span: Span = field(compare=False, repr=False)


KeyExplanation = tuple[KeyPart, ...]
"""One key in all the containers that share it, outer ones first."""


def key_names(flow: DataFlow) -> dict[str, list[tuple[str, str]]]:
    """The keys of containers, as path and key, by each name that they have in the container or with
    one of its states; in the order of the script."""
    found: dict[str, dict[tuple[str, str], None]] = {}
    for path, scope in flow.scopes.items():
        for name, key in _names_in(scope):
            found.setdefault(name, {})[path, key] = None
    return {name: list(pairs) for name, pairs in found.items()}


def _names_in(scope: UserdataScope) -> Iterator[tuple[str, str]]:
    """The names of keys in a container, with the name that the container uses."""
    container = scope.container
    own = [*scope.held, *scope.inputs, *scope.outputs]
    if isinstance(container, nodes.Iterator):
        own += [container.item_key, *filter(None, [container.items_key])]
    yield from ((key, key) for key in sorted(own))
    for use in scope.uses.all:
        yield use.outer, use.outer
        yield use.key, use.outer


def explain_keys(context: Context, pairs: Iterable[tuple[str, str]]) -> Iterator[KeyExplanation]:
    """The explanations of some keys; keys that are copies of each other share one."""
    done: set[tuple[str, str]] = set()
    for pair in pairs:
        if pair not in done:
            same = same_key(context.flow, *pair)
            done.update(same)
            yield _in_script(context, {path: explain_key(context, path, key) for path, key in same})


def _in_script(context: Context, parts: Mapping[str, KeyPart]) -> KeyExplanation:
    """A key in the containers of the script, without those that were made of a field of a state,
    unless it is in such a container alone, as the item of a loop."""
    view = context.written
    own = {path: part for path, part in parts.items() if view.parts[path].role == "state"}
    if not own:
        return tuple(parts.values())
    found = []
    for path, part in own.items():
        inside, outer = part.inside, around(context.flow, path)
        while inside and outer is not None and outer in parts and outer not in own:
            inside, outer = parts[outer].inside, around(context.flow, outer)
        found.append(replace(part, inside=inside))
    return tuple(found)


def explain_key(context: Context, path: str, key: str) -> KeyPart:
    """The explanation of a key in one container, without its copies in others."""
    flow = context.flow
    scope = flow.scopes[path]
    container = scope.container
    outer = around(flow, path)
    beyond = (scope.inputs.get(key), scope.outputs.get(key))
    view = context.written
    shown = None if outer is None else view.state(outer)
    inside = next(((shown, name) for name in beyond if shown and name), None)
    preset = next((preset for preset in container.userdata if preset.key == key), None)
    found = scope.uses.of(key)
    read = [use for use in found if use.reads and use.path != path]
    followed = key_statuses(flow, path, key, [use.path for use in read[:MOST_READERS]])
    return KeyPart(
        container=view.state(path),
        key=key,
        type=context.types.keys.get((path, key), ANY),
        value=_value(context, path, preset) if preset else "",
        given=outer is None and key in scope.inputs,
        inside=inside,
        uses=tuple(_use_status(context, scope, use, followed.get(use.path)) for use in found),
        span=container.span,
    )


def _value(context: Context, path: str, preset: Preset) -> str:
    """The initial value of a key of the container at a path, as the report shows it."""
    secret = preset.key in context.secret_keys.get(path, ())
    return SECRET if secret else print_data(preset.value.data)


_OF_LEAVES: Mapping[UseKind, UseKind] = {"copies in": "reads", "copies out": "writes"}
"""The uses of a key by a leaf, whose container of a field copies the key."""


def _use_status(
    context: Context, scope: UserdataScope, use: Use, status: Status | None
) -> UseStatus:
    """A use of a key, with the path of its state in the script. `status`: that of a reader."""
    flow, shown = context.flow, context.written.state(use.path)
    state = context.written.states.get(shown)
    is_leaf = state is not None and isinstance(state.node, nodes.Leaf)
    kind = _OF_LEAVES.get(use.kind, use.kind) if is_leaf else use.kind
    own = use.path == scope.path
    if use.writes:
        outcomes = written_on(flow, scope, use)
        always = outcomes == outcome_names(use.node)
        return UseStatus(use=use, path=shown, kind=kind, own=own, outcomes=outcomes, always=always)
    if status is None or not use.reads:
        return UseStatus(use=use, path=shown, kind=kind, own=own)
    without: tuple[str, ...] = ()
    if status in ("sometimes", "never"):
        without = path_without(flow, use.path, use.outer, context.plain_paths)
    return UseStatus(use=use, path=shown, kind=kind, own=own, status=status, without=without)


def key_text(part: KeyPart) -> tuple[str, list[Paragraph]]:
    """A headline and its paragraphs."""
    words: dict[str, list[str]] = {"is": [], "set": [], "written": [], "read": [], "copied": []}
    if part.inside is not None:
        path, name = part.inside
        words["is"].append(f"a copy of `{name}` of {path}")
    if part.given:
        words["set"].append("by the caller of the machine")
    for use in part.uses:
        word, lines = _use_text(part, use)
        words[word] += lines
    if not (words["set"] or words["written"] or words["copied"] or words["is"]):
        words["set"].append("nowhere")
    if not (words["read"] or words["copied"] or words["is"]):
        words["read"].append("nowhere")
    type_ = "" if part.type == ANY else f": {part.type}"
    return f"key `{part.key}` of {part.container}{type_}", list(words.items())


def _use_text(part: KeyPart, use_status: UseStatus) -> tuple[str, list[str]]:
    """The paragraph of a use, and its lines."""
    use = use_status.use
    name = use_status.path.rpartition("/")[2]
    called = f" as `{use.key}`" if use.key != part.key else ""
    where = place(use.span)
    status = f": {STATUS[use_status.status]}" if use_status.status else ""
    unset = list(way("  unset on the path ", use_status.without))
    match use_status.kind:
        case "presets":
            return "set", [f"before {name} starts, to {part.value}{where}"]
        case "items":
            return "set", [f"by {name}, to each item in turn{where}"]
        case "reads" if use_status.own:
            return "read", [f"by {name} itself, which iterates over it{where}"]
        case "reads":
            return "read", [f"by {name}{called}{status}{where}", *unset]
        case "copies in":
            return "copied", [f"into {name}{called}{status}{where}", *unset]
        case "writes":
            return "written", [f"by {name}{called}{_on(use_status)}{where}"]
    return "copied", [f"out of {name}{called}{_on(use_status)}{where}"]


def _on(use: UseStatus) -> str:
    if use.always:
        return ""
    if not use.outcomes:
        return ", not guaranteed on any outcome"
    return f", only on {' and '.join(use.outcomes)}"


def key_json(explanation: KeyExplanation) -> list[dict[str, Any]]:
    """The explanation as data for JSON."""
    return [
        {
            "key": part.key,
            "container": part.container,
            "type": str(part.type),
            "copy_of": list(part.inside) if part.inside else None,
            "given": part.given,
            "uses": [_use_json(use) for use in part.uses],
        }
        for part in explanation
    ]


def _use_json(use_status: UseStatus) -> dict[str, Any]:
    use = use_status.use
    found: dict[str, Any] = {
        "state": use_status.path,
        "use": use_status.kind,
        "as": use.key,
        "at": at(use.span),
    }
    if use.writes:
        found |= {"on": list(use_status.outcomes), "always": use_status.always}
    if use_status.status is not None:
        found |= {"set": use_status.status, "unset_path": list(use_status.without)}
    return found
