"""The picture of a comparison for Graphviz: both machines in one graph. What was added is green,
what was removed red, what was changed yellow."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from smachac.diff.comparison import Comparison
from smachac.diff.states import State, StateName, States, outcome_of
from smachac.targets.dot.style import FAINT, FONT, INK, attributes, font, html, identifier, spaced

ADDED, REMOVED, CHANGED, SAME = "added", "removed", "changed", "same"
COLOURS = {
    ADDED: ("#1a7f37", "#dafbe1"),
    REMOVED: ("#cf222e", "#ffebe9"),
    CHANGED: ("#9a6700", "#fff8c5"),
    SAME: ("#8c959f", "#ffffff"),
}
"""The line and fill colours of states."""


class Union:
    """Both machines as one: states by their path after the change; removed ones have a mark behind
    their path before."""

    def __init__(self, comparison: Comparison) -> None:
        self.shown: dict[str, State] = dict(comparison.after)
        self.look = dict.fromkeys(comparison.after, ADDED)
        self.children = {path: list(state.children) for path, state in comparison.after.items()}
        self.place = comparison.place
        self.before = {self.place[path]: state for path, state in comparison.before.items()}
        changed = {change.path for change in comparison.changes if change.what != "transition"}
        for other in comparison.pairs.values():
            self.look[other] = CHANGED if other in changed else SAME
        for path, state in comparison.before.items():
            if path not in comparison.pairs:
                here = self.place[path]
                self.shown[here] = state
                self.look[here] = REMOVED
                self.children[here] = []
                if state.parent is not None:
                    self.children[self.place[state.parent]].append(here)

    def parent(self, path: str) -> str | None:
        """The container around a state; None for a machine."""
        around = self.shown[path].parent
        return self.place[around] if around and self.look[path] == REMOVED else around

    def outcomes(self, path: str) -> list[str]:
        """The outcomes of a state, those of both machines."""
        facts = dict(self.shown[path].facts)
        if path in self.before:
            facts |= self.before[path].facts
        return [name for kind, name in facts if kind == "outcome"]


class _Edge(NamedTuple):
    """An edge between two nodes of the graph; the outcome is empty for the edge from a start, and
    where the node that it leaves has the name of the outcome."""

    source: str
    target: str
    outcome: str


def render_picture(comparison: Comparison) -> str:
    """A comparison as a DOT file."""
    union = Union(comparison)
    lines = ["digraph diff {", f"  graph{attributes(_GRAPH)}", f"  node{attributes(_NODE)}"]
    lines.append(f"  edge{attributes(_EDGE)}")
    roots = [path for path in union.shown if union.shown[path].parent is None]
    todo: list[tuple[int, str] | str] = [(1, path) for path in reversed(roots)]
    while todo:
        item = todo.pop()
        if isinstance(item, str):
            lines.append(item)
            continue
        level, path = item
        pad = "  " * level
        state, inside = union.shown[path], union.children[path]
        if not inside and state.parent is not None:
            lines.append(f"{pad}{_box(union, path)}")
            continue
        lines.append(f'{pad}subgraph "cluster_{node_id(path)}" {{')
        lines += [f"{pad}  {line}" for line in _frame(union, path)]
        todo += [f"{pad}}}", *((level + 1, text) for text in reversed(inside))]
    return "\n".join([*lines, *_edges(comparison, union), "}", ""])


CLUSTER_FILL = "#f6f8fa"
_START = {"shape": "circle", "label": "", "style": "filled", "fillcolor": INK, "width": "0.14",
          "height": "0.14", "fixedsize": "true"}  # fmt: skip
_EXIT = {"shape": "ellipse", "color": INK, "fillcolor": "#ffffff", "fontsize": "9"}
_GRAPH = {"compound": "true", "newrank": "true", "fontname": FONT, "fontsize": "12"}
_NODE = {"fontname": FONT, "fontsize": "11", "shape": "box", "style": "rounded,filled"}
_EDGE = {"fontname": FONT, "fontsize": "9", "arrowsize": "0.7"}


def _title(union: Union, path: str) -> str:
    state = union.shown[path]
    rows = [f"<B>{html(state.name)}</B>"]
    if state.type:
        rows.append(font(html(state.type), colour=FAINT, size=9))
    return spaced(rows)


def _box(union: Union, path: str) -> str:
    line, fill = COLOURS[union.look[path]]
    look = {"color": line, "fillcolor": fill, "tooltip": union.look[path]}
    return f'"{node_id(path)}"{attributes(look, _title(union, path))}'


def _frame(union: Union, path: str) -> Iterator[str]:
    """The look of a cluster, its start mark and its outcomes."""
    line, fill = COLOURS[union.look[path]]
    back = CLUSTER_FILL if union.look[path] == SAME else fill
    look = {"style": "rounded,filled", "color": line, "fillcolor": back, "tooltip": path}
    yield f"graph{attributes(look, _title(union, path))}"
    yield f'"{node_id(path)}"{attributes(_START)}'
    for name in union.outcomes(path):
        yield f'"{_exit(path, name)}"{attributes(_EXIT, html(name))}'


def node_id(path: str) -> str:
    """The node of a state, as in pictures of the target dot."""
    return "/".join(map(identifier, path.split("/")))


def _exit(path: str, outcome: str) -> str:
    return f"{node_id(path)}={identifier(outcome)}"


def _edges(comparison: Comparison, union: Union) -> Iterator[str]:
    """The edges of both machines; those between two places with one look are one."""
    old = dict.fromkeys(_arrows(comparison.before, comparison.place, union))
    new = dict.fromkeys(_arrows(comparison.after, {}, union))
    bundles: dict[tuple[str, str, str], list[str]] = {}
    for edge in dict.fromkeys([*new, *old]):
        look = SAME if edge in old and edge in new else ADDED if edge in new else REMOVED
        bundles.setdefault((edge.source, edge.target, look), []).append(edge.outcome)
    for (source, target, look), outcomes in bundles.items():
        colour = INK if look == SAME else COLOURS[look][0]
        style = {"color": colour, "fontcolor": colour}
        style |= {REMOVED: {"style": "dashed"}, ADDED: {"penwidth": "2"}}.get(look, {})
        text = "<BR/>".join(f" {html(outcome)} " for outcome in outcomes if outcome)
        yield f'  "{source}" -> "{target}"{attributes(style, text)}'


def _arrows(states: States, place: Mapping[str, str], union: Union) -> Iterator[_Edge]:
    """The edges of a machine. A container is entered at its start mark and left at its outcomes."""
    for path, state in states.items():
        here = place.get(path, path)
        for target in started(state):
            if target in states:
                yield _Edge(node_id(here), node_id(place.get(target, target)), "")
        for (kind, name), value in state.facts.items():
            if kind != "transition" or state.parent is None:
                continue
            left = union.children[here] and ("outcome", name) in union.shown[here].facts
            source = _exit(here, name) if left else node_id(here)
            first = value[0]
            if isinstance(first, StateName):
                if first.path in states:
                    target = node_id(place.get(first.path, first.path))
                    yield _Edge(source, target, "" if left else name)
            else:
                around = place.get(state.parent, state.parent)
                yield _Edge(source, _exit(around, outcome_of(first)), "" if left else name)


def started(state: State) -> Sequence[str]:
    """The paths of the states that a container starts with."""
    initial = state.facts.get(("field", "initial"))
    if initial is None:
        return state.children
    return [part.path for part in initial if isinstance(part, StateName)]
