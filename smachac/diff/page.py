"""A comparison as a page of the viewer: both machines in one graph, the changes in the panel."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import PurePath
from typing import Any, get_args

from smachac.diff.comparison import Comparison
from smachac.diff.picture import ADDED, REMOVED, SAME, Union, started
from smachac.diff.report import change_text, summary
from smachac.diff.states import State, States
from smachac.ir.nodes import Leaf, Machine, Origin
from smachac.ir.outcome_names import fails, successes
from smachac.targets.html.model import (
    VERSION,
    badge_data,
    edges_of,
    form_of,
    place_in_script,
    snippet,
)
from smachac.targets.html.page import render_page

ORIGINS = frozenset(get_args(Origin))
"""The kinds of edges that are transitions."""


def render_difference_page(comparison: Comparison, machine: Machine) -> str:
    """The page of a comparison: one file, without a network. `machine` is the later one of both
    that exists; the comparison has at least one."""
    union = Union(comparison)
    root = next(path for path, state in union.shown.items() if state.parent is None)
    model = {
        "version": VERSION,
        "name": union.shown[root].name,
        "source": PurePath(comparison.name or comparison.was).name,
        "digest": machine.digest,
        "root": root,
        "live": False,
        "nodes": [_node(union, path) for path in union.shown],
        "edges": list(_edges(comparison)),
        "findings": [],
        "properties": [],
        "differences": {
            "summary": summary(comparison),
            "changes": [*_changes(comparison), *_findings(comparison, root)],
        },
    }
    return render_page(machine, model)


def _changes(comparison: Comparison) -> Iterator[dict[str, str]]:
    """Each change in words, with the state of the picture that it is about."""
    for change in comparison.changes:
        gone = change.kind == REMOVED and change.what == "state"
        path = comparison.place[change.path] if gone else change.path
        yield {"path": path, "kind": change.kind, "text": change_text(change)}


def _findings(comparison: Comparison, root: str) -> Iterator[dict[str, str]]:
    """The findings that are new, or gone, at their states."""
    places: tuple[tuple[Mapping[str, str], States], ...] = (
        ({}, comparison.after),
        (comparison.place, comparison.before),
    )
    reports = (ADDED, "+", comparison.added), (REMOVED, "-", comparison.removed)
    for (kind, sign, report), (place, states) in zip(reports, places, strict=True):
        for diagnostic in report:
            node = diagnostic.finding.node or ""
            path = place.get(node, node) if node in states else root
            text = f"{sign} {diagnostic.severity.value}[{diagnostic.code}] {diagnostic.message}"
            yield {"path": path, "kind": kind, "text": text}


def _node(union: Union, path: str) -> dict[str, Any]:
    """A state for the viewer; its outcomes are those before and after."""
    state = union.shown[path]
    node, outer = state.node, state.written.outer
    file, line = place_in_script(state.span)
    good = successes(outer)
    children = union.children[path]
    first = [text for text in started(state) if text in children]
    return {
        "path": path,
        "name": state.name,
        "kind": _kind(union, state, path),
        "parent": union.parent(path),
        "children": children,
        "initial": first[0] if len(first) == 1 else None,
        "type": state.type or None,
        "badges": [badge_data(badge) for badge in state.written.badges],
        "doc": outer.doc,
        "file": file,
        "line": line,
        "snippet": snippet(state.span),
        "outcomes": [
            {"name": name, "failure": fails(outer, name), "success": name in good, "doc": ""}
            for name in union.outcomes(path)
        ],
        "inputs": [],
        "outputs": [],
        "findings": [],
        "tags": list(node.tags),
        "change": union.look[path],
    } | _form(union, path)


def _kind(union: Union, state: State, path: str) -> str:
    if not isinstance(state.node, Leaf):
        return state.node.keyword
    return "machine" if union.children[path] else "leaf"


def _form(union: Union, path: str) -> dict[str, Any]:
    """The fields of a container of its kind; each rule of a concurrence has its change."""
    now = {} if union.look[path] == REMOVED else _form_in(union.shown[path], {})
    was = _form_in(union.before[path], union.place) if path in union.before else {}
    form = now or was
    if "rules" not in form:
        return form
    new, old = now.get("rules", []), was.get("rules", [])
    rules = [{**item, "change": SAME if item in old else ADDED} for item in new]
    rules += [{**item, "change": REMOVED} for item in old if item not in new]
    return {**form, "rules": rules}


def _form_in(state: State, place: Mapping[str, str]) -> dict[str, Any]:
    """The fields of a container; `place` has other paths for its states."""
    form = {} if isinstance(state.node, Leaf) else form_of(state.path, state.node)
    for rule in form.get("rules", ()):
        rule["when"] = [[place.get(path, path), outcome] for path, outcome in rule["when"]]
    return form


def _edges(comparison: Comparison) -> Iterator[dict[str, Any]]:
    """The edges of both machines, each with its change."""
    before = {_key(entry): entry for entry in _of_machine(comparison.before, comparison.place)}
    after = {_key(entry): entry for entry in _of_machine(comparison.after, {})}
    for key, edge in {**after, **before}.items():
        change = SAME if key in before and key in after else ADDED if key in after else REMOVED
        yield {**edge, "change": change}


def _key(edge: Mapping[str, Any]) -> object:
    return *(edge[name] for name in ("container", "source", "outcome", "kind")), str(edge["target"])


def _of_machine(states: States, place: Mapping[str, str]) -> Iterator[dict[str, Any]]:
    """The edges inside the containers of a machine; `place` has other paths for its states. A
    transition that the script does not write is the same as one that it writes."""
    written = {path: state.written for path, state in states.items()}
    for path, state in written.items():
        for edge in edges_of(state, written):
            source, target = edge["source"], edge["target"]
            yield {
                **edge,
                "container": place.get(path, path),
                "source": source and place.get(source, source),
                "target": place.get(target, target) if isinstance(target, str) else target,
                "kind": "transition" if edge["kind"] in ORIGINS else edge["kind"],
                "implicit": edge["kind"] == "default",
            }
