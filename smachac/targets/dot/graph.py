"""The DOT text of a machine: containers are clusters, states boxes, their outcomes ellipses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from smachac.analysis.context import Context
from smachac.ir import nodes
from smachac.ir.nodes import Concurrence, Leaf, Machine
from smachac.ir.traversal import outcome_names
from smachac.ir.written import Written, WrittenState
from smachac.targets.dot.edges import Piece, Spot, edges, entry_mark, joins, merged
from smachac.targets.dot.style import (
    BADGE_INK,
    BORDER,
    FAINT,
    FILLS,
    FONT,
    INK,
    JOINS,
    LOOP_BORDER,
    LOOP_FILL,
    PARALLEL_BORDER,
    PARALLEL_FILL,
    STATE_FILL,
    TONES,
    UNKNOWN_LEGEND,
    UNKNOWN_STYLE,
    attributes,
    font,
    html,
    identifier,
    quoted,
    spaced,
    tone,
)


class Notes(NamedTuple):
    """Texts that are drawn beside a machine: below the names of states, by path, and beside
    outcomes, by path and outcome."""

    states: Mapping[str, str] = {}
    outcomes: Mapping[str, Mapping[str, str]] = {}


class Position(NamedTuple):
    """A state in the picture: its node name in DOT, and what is drawn of it. `tones` are those of
    the states in properties, `unknown` the reasons of the states that are not known exactly."""

    state: WrittenState
    id: str
    view: Written
    tones: Mapping[str, str]
    unknown: Mapping[str, str]
    notes: Notes = Notes()

    def inside(self) -> Iterator[Position]:
        """The states inside."""
        for path in self.state.children:
            state = self.view.states[path]
            yield self._replace(state=state, id=f"{self.id}/{identifier(state.name)}")

    @property
    def level(self) -> int:
        """The number of containers around the states inside."""
        return self.state.level + 1

    @property
    def start(self) -> str:
        return f"{self.id}#start"

    @property
    def exits(self) -> dict[str, str]:
        """The node names of the ends of a container: its outcomes, and those after which the next
        try or item begins."""
        names = dict.fromkeys([*outcome_names(self.state.outer), *self.state.repeated])
        return {name: f"{self.id}={identifier(name)}" for name in names}

    def is_open(self, depth: int | None) -> bool:
        return not isinstance(self.state.node, Leaf) and (depth is None or self.state.level < depth)


def picture(
    machine: Machine,
    view: Written,
    *,
    depth: int | None = None,
    rankdir: str = "TB",
    notes: Notes = Notes(),  # noqa: B008 (constant)
) -> Iterator[str]:
    """The lines of a DOT file of the states of a view. Containers below `depth` levels are drawn as
    closed boxes."""
    root = view.root
    unknown = {view.state(path): reason for path, reason in machine.unknown.items()}
    yield f"digraph {quoted(root.name)} {{"
    drawn = (path for path in unknown if depth is None or view.states[path].level <= depth)
    for line in _settings(machine, rankdir, draws_unknown=any(True for _ in drawn)):
        yield f"  {line}"
    tones = {view.state(path): tone for path, tone in property_tones(machine).items()}
    todo: list[str | Position] = ["}"]
    todo.append(Position(root, identifier(root.name), view, tones, unknown, notes))
    while todo:
        place = todo.pop()
        if isinstance(place, str):
            yield place
            continue
        pad = "  " * place.level
        opened = []
        todo += reversed([pad + line for line in _arrows(place, depth)])
        for line in _marks(place, sideways=rankdir in ("LR", "RL")):
            yield pad + line
        for inner in place.inside():
            if inner.is_open(depth):
                opened.append(inner)
            else:
                yield pad + _box(inner)
        for inner in reversed(opened):
            todo += [f"{pad}}}", inner]
            todo += reversed([pad + line for line in _frame(inner)])


def _settings(machine: Machine, rankdir: str, *, draws_unknown: bool) -> Iterator[str]:
    root = machine.root
    base = machine.base or machine.source
    rows = [f"<B>{html(root.name)}</B>", font(html(base), colour=FAINT, size=10)]
    if draws_unknown:
        rows.append(font(html(UNKNOWN_LEGEND), colour=FAINT, size=10))
    title = spaced(rows)
    look = {
        "rankdir": rankdir,
        "compound": "true",
        "newrank": "true",
        "fontname": FONT,
        "fontsize": "15",
    }
    space = {"nodesep": "0.35", "ranksep": "0.4", "pad": "0.2"}
    tip = {"tooltip": root.doc or root.name}
    top = {"labelloc": "t", "fontcolor": INK}
    yield f"graph{attributes(look | space | top | tip, title)}"
    node = {"fontname": FONT, "fontsize": "11", "fontcolor": INK, "color": BORDER}
    box = {"shape": "box", "style": "rounded,filled", "fillcolor": STATE_FILL, "penwidth": "1.1"}
    yield f"node{attributes(node | box)}"
    edge = {"fontname": FONT, "fontsize": "9", "color": INK, "arrowsize": "0.7"}
    yield f"edge{attributes(edge)}"


def _frame(place: Position) -> Iterator[str]:
    """The opening lines of a container's cluster."""
    state, path = place.state, place.state.path
    container = state.node
    kind = html(container.type)
    fill, border, style = FILLS[place.level % 2], BORDER, "rounded,filled"
    match container:
        case Concurrence():
            fill, border, style = PARALLEL_FILL, PARALLEL_BORDER, "rounded,filled,dashed"
            kind = f"|| {kind}{JOINS[container.join]}"
        case nodes.Iterator():
            fill, border = LOOP_FILL, LOOP_BORDER
    title = f"<B>{html(state.name)}</B>  {font(kind, colour=FAINT, size=9)}"
    if state.badges:
        title += f"  {_badges(state)}"
    if shade := place.tones.get(path):
        title += f"  {_property_mark(shade)}"
    if note := place.notes.states.get(path):
        title += f"<BR/>{font(html(note), colour=FAINT, size=9)}"
    if path in place.unknown:
        style = UNKNOWN_STYLE
    look = {"labeljust": "c", "labelloc": "t", "style": style}
    colours = {"fillcolor": fill, "color": border, "fontsize": "11"}
    yield f'subgraph "cluster_{place.id}" {{'
    tip = {"tooltip": _tip(place)}
    yield f"  graph{attributes(look | colours | tip, title)}"


def _badges(state: WrittenState) -> str:
    text = ", ".join(badge.text for badge in state.badges)
    return font(html(text), colour=BADGE_INK, size=9)


def _box(place: Position) -> str:
    """A leaf, or a container that is drawn closed."""
    state, path = place.state, place.state.path
    rows = [f"<B>{html(state.name)}</B>"]
    kind = html(state.node.type)
    kind = kind if isinstance(state.node, Leaf) else f"{kind} <B>+</B>"
    if state.node.type:
        rows.append(font(kind, colour=FAINT, size=9))
    if state.badges:
        rows.append(_badges(state))
    look = {"tooltip": _tip(place)}
    if path in place.unknown:
        look["style"] = UNKNOWN_STYLE
    if shade := place.tones.get(path):
        rows.append(_property_mark(shade))
        look |= {"color": TONES[shade][0], "penwidth": "2"} if shade == "failure" else {}
    if note := place.notes.states.get(path):
        rows.append(font(html(note), colour=INK, size=9))
    return f'"{place.id}"{attributes(look, spaced(rows))}'


def _tip(place: Position) -> str:
    path = place.state.path
    reason = place.unknown.get(path)
    return f"{path}: {reason}" if reason else place.state.outer.doc or path


def _property_mark(shade: str) -> str:
    return font("&#9670; property", colour=TONES[shade][0], size=8)


def property_tones(machine: Machine) -> dict[str, str]:
    """The tones of the states in properties, by full path: `failure` for those on the path of a
    counterexample, `neutral` for the others that a property names."""
    if not machine.properties:
        return {}
    found: dict[str, str] = {}
    judgements = Context(machine).judgements
    for judgement in judgements:
        found |= dict.fromkeys(judgement.states, "neutral")
    for judgement in judgements:
        if judgement.counterexample is not None:
            found |= dict.fromkeys(
                (visit.path for visit in judgement.counterexample.visits), "failure"
            )
    return found


def _exit(place: Position, outcome: str, id: str) -> str:
    """An end of a container: double lines if the whole machine ends with it."""
    state = place.state
    found = next((result for result in state.outer.outcomes if result.name == outcome), None)
    line, fill = TONES[tone(outcome, state.node if found is None else state.outer)]
    label = html(outcome)
    if isinstance(state.node, Concurrence) and outcome == state.node.default_outcome:
        label = spaced([label, font("otherwise", colour=FAINT, size=8)])
    if (again := state.next_round(outcome)) is not None:
        label = spaced([label, font(f"next {again}", colour=FAINT, size=8)])
    look = {"shape": "ellipse", "fillcolor": fill, "color": line, "fontcolor": line}
    if state.parent is None:
        look |= {"peripheries": "2", "fontsize": "11"}
    else:
        look |= {"fontsize": "9", "margin": "0.04,0.02", "height": "0.25", "width": "0.5"}
    tip = {"tooltip": (found.doc if found else "") or outcome}
    return f'"{id}"{attributes(look | tip, label)}'


def _marks(place: Position, *, sideways: bool) -> Iterator[str]:
    """The start and the exits of a container, at its top and bottom."""
    yield entry_mark(place.state, place.start, sideways=sideways)
    yield from joins(place.state.node, place.start, sideways=sideways)
    drawn = [_exit(place, outcome, id) for outcome, id in place.exits.items()]
    if drawn:
        yield f"{{ rank=same; {'; '.join(drawn)} }}"


def _arrows(place: Position, depth: int | None) -> Iterator[str]:
    container = place.state.node
    if isinstance(container, Leaf):
        return
    drawn = {position.state.name: _piece(position, depth) for position in place.inside()}
    if isinstance(container, Concurrence) and drawn:
        level = "; ".join(f'"{piece.entry.id}"' for piece in drawn.values())
        yield f"{{ rank=same; {level} }}"
    yield from merged(edges(container, place.start, place.exits, drawn, place.state.catches))


def _piece(place: Position, depth: int | None) -> Piece:
    notes = place.notes.outcomes.get(place.state.path, {})
    if place.is_open(depth):
        return Piece(Spot(place.start, place.id), place.exits, place.state.outer, notes)
    return Piece(Spot(place.id), {}, place.state.outer, notes)
