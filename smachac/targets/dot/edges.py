"""The edges in a container, with the nodes that only edges need: start marks and joins of rules."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from smachac.ir import graph, nodes
from smachac.ir.graph import START
from smachac.ir.nodes import Concurrence, Container, Node
from smachac.ir.traversal import leads_to_child, outcome_names
from smachac.ir.written import WrittenState, items_in_words
from smachac.targets.dot.style import (
    FAINT,
    INK,
    LOOP_BORDER,
    TONES,
    attributes,
    font,
    html,
    lines,
    spaced,
    tone,
)


class Spot(NamedTuple):
    """An end of edges: a DOT node; `cluster` is the cluster at whose border edges end."""

    id: str
    cluster: str = ""


class Piece(NamedTuple):
    """A drawn state: the end of its incoming edges and the nodes of its outgoing edges.

    `ports` maps outcomes to nodes; it is empty for a state that is one box. `node` has the outcomes
    with which it leaves, `notes` are texts beside them.
    """

    entry: Spot
    ports: dict[str, str]
    node: Node
    notes: Mapping[str, str] = {}


class Edge(NamedTuple):
    """The edge of an outcome; the outcome is empty for the edge from the start.

    `tacit`: it needs no label, because a node at its end has the name of the outcome. `main`: it
    belongs to the successful path and is drawn straight. `back`: it leads to an earlier state.
    `hidden`: it is not drawn and affects only the layout. `note` stands beside the outcome.
    """

    tail: str
    head: Spot
    outcome: str = ""
    tone: str = "neutral"
    tacit: bool = False
    dashed: bool = False
    main: bool = False
    back: bool = False
    hidden: bool = False
    note: str = ""


Drawn = dict[str, Piece]
"""The children of a container by name."""


def entry_mark(state: WrittenState, id: str, *, sideways: bool) -> str:
    """The start node of a container: a bar for a concurrence, a label for an iterator, else a dot.

    `sideways`: the graph runs horizontally, so that bars are vertical.
    """
    container = state.node
    if isinstance(container, Concurrence):
        return _bar(id, INK, "all at once", "1.2", sideways=sideways)
    if isinstance(container, nodes.Iterator):
        head = font(f"for each <B>{html(container.item_key)}</B>", colour=INK, size=11)
        label = spaced([head, font(html(items_in_words(container)), colour=FAINT, size=9)])
        return f'"{id}"{attributes({"color": LOOP_BORDER}, label)}'
    dot = {"label": "", "tooltip": "start", "shape": "circle"}
    size = {"width": "0.14", "height": "0.14", "fixedsize": "true"}
    return f'"{id}"{attributes(dot | {"fillcolor": INK, "color": INK} | size)}'


def _bar(id: str, colour: str, tooltip: str, length: str, *, sideways: bool) -> str:
    look = {"label": "", "tooltip": tooltip, "style": "filled"}
    width, height = ("0.06", length) if sideways else (length, "0.06")
    size = {"width": width, "height": height, "fixedsize": "true"}
    return f'"{id}"{attributes(look | {"fillcolor": colour, "color": colour} | size)}'


def edges(
    container: Container, start: str, exits: dict[str, str], drawn: Drawn, caught: str
) -> Iterator[Edge]:
    """The edges of a container: from its start, between its children and to its outcomes. `caught`
    is the outcome that exceptions in it become."""
    match container:
        case Concurrence():
            found = list(_rules(container, start, exits, drawn))
        case nodes.Iterator():
            found = list(_loop(container, start, exits, drawn))
        case _:
            found = list(_transitions(container, start, exits, drawn))
    yield from found
    if caught in exits:
        shade = tone(caught, container)
        yield Edge(start, Spot(exits[caught]), caught, shade, dashed=True)
    exit = next(iter(exits.values()), None)
    if exit is not None:
        yield from _hidden(found, Spot(exit), drawn)


def _hidden(found: list[Edge], exit: Spot, drawn: Drawn) -> Iterator[Edge]:
    """Hidden edges that keep outcomes below children whose edges all lead back."""
    onward = {edge.tail for edge in found if not edge.back}
    for piece in drawn.values():
        tails = [*piece.ports.values()] or [piece.entry.id]
        if onward.isdisjoint(tails):
            yield Edge(tails[0], exit, hidden=True)


def _leave(piece: Piece, outcome: str, head: Spot, exit: str = "") -> Edge:
    """The edge of an outcome of a child: from its port, or from its box.

    `exit` is the name of the head, if that is an outcome of the container.
    """
    port = piece.ports.get(outcome)
    tacit = port is not None or outcome == exit
    shade = tone(outcome, piece.node)
    main = shade in ("success", "neutral")
    note = piece.notes.get(outcome, "")
    return Edge(port or piece.entry.id, head, outcome, shade, tacit, main=main, note=note)


def _transitions(
    container: Container, start: str, exits: dict[str, str], drawn: Drawn
) -> Iterator[Edge]:
    for flow in graph.edges(container):
        if flow.source == START and isinstance(flow.target, str):
            yield Edge(start, drawn[flow.target].entry, main=True)
    order = {name: index for index, name in enumerate(drawn)}
    names = frozenset(order)
    for child in container.children:
        piece = drawn[child.name]
        for step in child.transitions:
            if leads_to_child(step, names):
                back = order[step.target] <= order[child.name]
                edge = _leave(piece, step.outcome, drawn[step.target].entry)
                yield edge._replace(back=back)
            elif step.target in exits:
                edge = _leave(piece, step.outcome, Spot(exits[step.target]), step.target)
                yield edge._replace(dashed=step.origin == "implicit")


def _rules(
    container: Concurrence, start: str, exits: dict[str, str], drawn: Drawn
) -> Iterator[Edge]:
    for piece in drawn.values():
        yield Edge(start, piece.entry)
    for number, rule in enumerate(container.rules):
        if rule.outcome not in exits:
            continue
        exit = Spot(exits[rule.outcome])
        bar = Spot(join_id(start, number))
        for condition in rule.when:
            if condition.child not in drawn:
                continue
            piece = drawn[condition.child]
            if len(rule.when) == 1:
                yield _leave(piece, condition.outcome, exit, rule.outcome)
            else:
                yield _leave(piece, condition.outcome, bar)
        if len(rule.when) != 1:
            shade = tone(rule.outcome, container)
            yield Edge(bar.id, exit, rule.outcome, shade, tacit=True, main=True)
    yield from _otherwise(container, exits, drawn)


def _otherwise(container: Concurrence, exits: dict[str, str], drawn: Drawn) -> Iterator[Edge]:
    """The edges from children without a rule to the default outcome."""
    if container.default_outcome not in exits:
        return
    exit = Spot(exits[container.default_outcome])
    judged = {condition.child for rule in container.rules for condition in rule.when}
    for name, piece in drawn.items():
        if name not in judged:
            for tail in [*piece.ports.values()] or [piece.entry.id]:
                yield Edge(tail, exit, dashed=True)


def join_id(start: str, number: int) -> str:
    """The node name of the bar that joins the conditions of a rule."""
    return f"{start}+{number}"


def joins(container: Node, start: str, *, sideways: bool) -> Iterator[str]:
    """The bars of a concurrence: one for each rule that does not have just one condition."""
    if not isinstance(container, Concurrence):
        return
    for number, rule in enumerate(container.rules):
        if len(rule.when) != 1:
            colour = TONES[tone(rule.outcome, container)][0]
            yield _bar(
                join_id(start, number), colour, f"all: {rule.outcome}", "0.8", sideways=sideways
            )


def _loop(
    container: nodes.Iterator, start: str, exits: dict[str, str], drawn: Drawn
) -> Iterator[Edge]:
    renamed = dict(container.final_map)
    exhausted = renamed.get(container.exhausted_outcome, container.exhausted_outcome)
    for child in container.children:
        piece = drawn[child.name]
        yield Edge(start, piece.entry, main=True)
        for outcome in outcome_names(child):
            target = renamed.get(outcome, outcome)
            if outcome in container.loop_outcomes:
                yield _leave(piece, outcome, Spot(start))._replace(back=True)
            elif target in exits:
                yield _leave(piece, outcome, Spot(exits[target]), target)
    if exhausted in exits:
        tacit = exhausted == container.exhausted_outcome
        shade = tone(exhausted, container)
        name = container.exhausted_outcome
        yield Edge(start, Spot(exits[exhausted]), name, shade, tacit, main=True)


def merged(edges: Iterable[Edge]) -> Iterator[str]:
    """The DOT statements of edges; all edges between the same two nodes are one."""
    bundles: dict[tuple[str, str], list[Edge]] = {}
    for edge in edges:
        bundles.setdefault((edge.tail, edge.head.id), []).append(edge)
    for bundle in bundles.values():
        yield _arrow(bundle)


def _arrow(bundle: list[Edge]) -> str:
    first = bundle[0]
    outcomes = [edge.outcome for edge in bundle if edge.outcome]
    look = {"color": TONES[_common([edge.tone for edge in bundle])][0]}
    label = ""
    noted = any(edge.note for edge in bundle)
    if outcomes and (noted or not all(edge.tacit for edge in bundle)):
        rows = [
            font(html(f"{edge.outcome} {edge.note}".rstrip()), colour=TONES[edge.tone][0])
            for edge in bundle
            if edge.outcome
        ]
        label = lines(f" {row} " for row in rows)
    if outcomes:
        look["tooltip"] = ", ".join(outcomes)
    if all(edge.hidden for edge in bundle):
        look = {"style": "invis"}
    elif all(edge.dashed for edge in bundle):
        look["style"] = "dashed"
    if any(edge.main and not edge.back for edge in bundle):
        look["weight"] = "20"
    frame = first.head.cluster
    if frame and not first.tail.startswith((f"{frame}/", f"{frame}=", f"{frame}#")):
        look["lhead"] = f"cluster_{frame}"
    return f'"{first.tail}" -> "{first.head.id}"{attributes(look, label)}'


def _common(tones: list[str]) -> str:
    """The tone of an edge for several outcomes."""
    if len(set(tones)) == 1:
        return tones[0]
    return "failure" if set(tones) == {"failure", "warning"} else "neutral"
