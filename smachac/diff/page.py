"""A comparison as a page of the viewer: both machines in one graph, the changes in the panel."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import PurePath
from typing import Any

from smachac.diff.comparison import Comparison
from smachac.diff.picture import ADDED, REMOVED, SAME, Union, started
from smachac.diff.report import change_text, summary
from smachac.diff.states import State, StateName, States, outcome_of
from smachac.ir.nodes import Concurrence, Leaf, Machine
from smachac.ir.outcome_names import fails, successes
from smachac.targets.html.model import VERSION, place_in_script, snippet
from smachac.targets.html.page import render_page


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
    for each in comparison.changes:
        gone = each.kind == REMOVED and each.what == "state"
        path = comparison.place[each.path] if gone else each.path
        yield {"path": path, "kind": each.kind, "text": change_text(each)}


def _findings(comparison: Comparison, root: str) -> Iterator[dict[str, str]]:
    """The findings that are new, or gone, at their states."""
    places: tuple[tuple[Mapping[str, str], States], ...] = (
        ({}, comparison.after),
        (comparison.place, comparison.before),
    )
    reports = (ADDED, "+", comparison.added), (REMOVED, "-", comparison.removed)
    for (kind, sign, report), (place, states) in zip(reports, places, strict=True):
        for each in report:
            node = each.finding.node or ""
            path = place.get(node, node) if node in states else root
            text = f"{sign} {each.severity.value}[{each.code}] {each.message}"
            yield {"path": path, "kind": kind, "text": text}


def _node(union: Union, path: str) -> dict[str, Any]:
    """A state for the viewer; its outcomes are those before and after."""
    state = union.shown[path]
    inner, outer = state.chain[-1], state.chain[0]
    file, line = place_in_script(state.span)
    before, good = union.known.get(path, {}), successes(outer)
    names = [name for kind, name in {**state.facts, **before} if kind == "outcome"]
    children = union.children[path]
    first = [each for each in started(state) if each in children]
    return {
        "path": path,
        "name": state.name,
        "kind": _kind(union, state, path),
        "parent": union.parent(path),
        "children": children,
        "initial": first[0] if len(first) == 1 else None,
        "type": state.type or None,
        "role": None,
        "doc": inner.doc,
        "file": file,
        "line": line,
        "snippet": snippet(state.span),
        "outcomes": [
            {"name": name, "failure": fails(outer, name), "success": name in good, "doc": ""}
            for name in names
        ],
        "inputs": [],
        "outputs": [],
        "findings": [],
        "tags": list(inner.tags),
        "change": union.look[path],
    }


def _kind(union: Union, state: State, path: str) -> str:
    inner = state.chain[-1]
    if not isinstance(inner, Leaf):
        return inner.keyword
    return "machine" if union.children[path] else "leaf"


def _edges(comparison: Comparison) -> Iterator[dict[str, Any]]:
    """The edges of both machines, each with its change."""
    before = {_key(each): each for each in _of_machine(comparison.before, comparison.place)}
    after = {_key(each): each for each in _of_machine(comparison.after, {})}
    for key, edge in {**after, **before}.items():
        change = SAME if key in before and key in after else ADDED if key in after else REMOVED
        yield {**edge, "kind": "transition", "implicit": False, "change": change}


def _key(edge: Mapping[str, Any]) -> object:
    return edge["container"], edge["source"], edge["outcome"], str(edge["target"])


def _of_machine(states: States, place: Mapping[str, str]) -> Iterator[dict[str, Any]]:
    """The edges inside the containers of a machine; `place` has other paths for its states."""
    for path, state in states.items():
        here = place.get(path, path)
        for target in started(state):
            if target in states:
                yield _edge(here, None, "", place.get(target, target))
        node = state.chain[-1]
        if isinstance(node, Concurrence):
            for rule in node.rules:
                for each in rule.when:
                    child = f"{path}/{each.child}"
                    source = place.get(child, child)
                    yield _edge(here, source, each.outcome, {"outcome": rule.outcome})
        if state.parent is None:
            continue
        around = place.get(state.parent, state.parent)
        for (kind, name), value in state.facts.items():
            if kind != "transition":
                continue
            first = value[0]
            failure = fails(state.chain[0], name)
            if not isinstance(first, StateName):
                yield _edge(around, here, name, {"outcome": outcome_of(first)}, failure=failure)
            elif first.path in states:
                target = place.get(first.path, first.path)
                yield _edge(around, here, name, target, failure=failure)


def _edge(
    container: str,
    source: str | None,
    outcome: str,
    target: str | dict[str, str],
    *,
    failure: bool = False,
) -> dict[str, Any]:
    return {
        "container": container,
        "source": source,
        "outcome": outcome,
        "target": target,
        "failure": failure,
    }
