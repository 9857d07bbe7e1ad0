"""The DOT text of a machine: containers are clusters, states boxes, their outcomes ellipses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from smachac.analysis.context import Context
from smachac.ir import nodes
from smachac.ir.nodes import Concurrence, Container, Leaf, Machine, Node
from smachac.ir.script_paths import name_in_script, role_in_words, script_paths
from smachac.ir.traversal import outcome_names
from smachac.targets.dot.edges import Piece, Spot, edges, entry_mark, joins, merged
from smachac.targets.dot.style import (
    BORDER,
    FAINT,
    FILLS,
    FONT,
    INK,
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
    """Texts that are drawn beside a machine: below the names of states, by full path, and beside
    outcomes, by path and outcome."""

    states: Mapping[str, str] = {}
    outcomes: Mapping[str, Mapping[str, str]] = {}


class Position(NamedTuple):
    """The position of a state: its full path, its node name in DOT and its depth; `paths` are those
    of the script by full path, where they differ; `tones` those of the states in properties;
    `unknown` the reasons of the states that are not known exactly."""

    path: str
    id: str
    level: int
    paths: Mapping[str, str]
    tones: Mapping[str, str]
    unknown: Mapping[str, str]
    notes: Notes = Notes()

    def below(self, name: str) -> Position:
        path, id = f"{self.path}/{name}", f"{self.id}/{identifier(name)}"
        return self._replace(path=path, id=id, level=self.level + 1)

    @property
    def shown(self) -> str:
        """The path in the script."""
        return self.paths.get(self.path, self.path)

    @property
    def start(self) -> str:
        return f"{self.id}#start"

    def exits(self, node: Node) -> dict[str, str]:
        """The node names of the outcomes of a container at this position."""
        return {name: f"{self.id}={identifier(name)}" for name in outcome_names(node)}


def picture(
    machine: Machine,
    *,
    depth: int | None = None,
    rankdir: str = "TB",
    notes: Notes = Notes(),  # noqa: B008 (constant)
) -> Iterator[str]:
    """The lines of a DOT file. Containers below `depth` levels are drawn as closed boxes."""
    root = machine.root
    yield f"digraph {quoted(root.name)} {{"
    for line in _settings(machine, rankdir, draws_unknown=_draws_unknown(machine, depth)):
        yield f"  {line}"
    todo: list[str | tuple[Position, Container]] = ["}"]
    tones = property_tones(machine)
    paths = script_paths(root)
    start = Position(root.name, identifier(root.name), 1, paths, tones, machine.unknown, notes)
    todo.append((start, root))
    while todo:
        item = todo.pop()
        if isinstance(item, str):
            yield item
            continue
        place, container = item
        pad = "  " * place.level
        opened = []
        todo += reversed([pad + line for line in _arrows(place, container, depth)])
        for line in _marks(place, container, sideways=rankdir in ("LR", "RL")):
            yield pad + line
        for child in container.children:
            if isinstance(child, Leaf) or place.level == depth:
                yield pad + _box(child, place.below(child.name))
            else:
                opened.append(child)
        for child in reversed(opened):
            inner = place.below(child.name)
            todo += [f"{pad}}}", (inner, child)]
            todo += reversed([pad + line for line in _frame(child, inner)])


def _draws_unknown(machine: Machine, depth: int | None) -> bool:
    """Whether a state that is not known exactly is drawn, not only the closed box around it."""
    todo: list[tuple[str, Container, int]] = [(machine.root.name, machine.root, 1)]
    while todo and machine.unknown:
        path, container, level = todo.pop()
        for child in container.children:
            inside = f"{path}/{child.name}"
            if inside in machine.unknown:
                return True
            if not isinstance(child, Leaf) and level != depth:
                todo.append((inside, child, level + 1))
    return False


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


def _frame(container: Container, place: Position) -> Iterator[str]:
    """The opening lines of a container's cluster."""
    kind = html(container.type)
    fill, border, style = FILLS[place.level % 2], BORDER, "rounded,filled"
    match container:
        case Concurrence():
            fill, border, style = PARALLEL_FILL, PARALLEL_BORDER, "rounded,filled,dashed"
            kind = f"|| {kind}" + (", first to end" if container.join == "any" else "")
        case nodes.Iterator():
            fill, border = LOOP_FILL, LOOP_BORDER
    kind = html(role_in_words(container)) if container.sugar else kind
    name = name_in_script(container)
    title = f"<B>{html(name)}</B>  {font(kind, colour=FAINT, size=9)}"
    if shade := place.tones.get(place.path):
        title += f"  {_property_mark(shade)}"
    if note := place.notes.states.get(place.path):
        title += f"<BR/>{font(html(note), colour=FAINT, size=9)}"
    if place.path in place.unknown:
        style = UNKNOWN_STYLE
    look = {"labeljust": "c", "labelloc": "t", "style": style}
    colours = {"fillcolor": fill, "color": border, "fontsize": "11"}
    yield f'subgraph "cluster_{place.id}" {{'
    tip = {"tooltip": _tip(container, place)}
    yield f"  graph{attributes(look | colours | tip, title)}"


def _box(node: Node, place: Position) -> str:
    """A leaf, or a container that is drawn closed."""
    rows = [f"<B>{html(name_in_script(node))}</B>"]
    kind = html(role_in_words(node) or node.type)
    kind = kind if isinstance(node, Leaf) else f"{kind} <B>+</B>"
    if node.type:
        rows.append(font(kind, colour=FAINT, size=9))
    look = {"tooltip": _tip(node, place)}
    if place.path in place.unknown:
        look["style"] = UNKNOWN_STYLE
    if shade := place.tones.get(place.path):
        rows.append(_property_mark(shade))
        look |= {"color": TONES[shade][0], "penwidth": "2"} if shade == "failure" else {}
    if note := place.notes.states.get(place.path):
        rows.append(font(html(note), colour=INK, size=9))
    return f'"{place.id}"{attributes(look, spaced(rows))}'


def _tip(node: Node, place: Position) -> str:
    reason = place.unknown.get(place.path)
    return f"{place.shown}: {reason}" if reason else node.doc or place.shown


def _property_mark(shade: str) -> str:
    return font("&#9670; property", colour=TONES[shade][0], size=8)


def property_tones(machine: Machine) -> dict[str, str]:
    """The tones of the states in properties, by full path: `failure` for those on the path of a
    counterexample, `neutral` for the others that a property names."""
    if not machine.properties:
        return {}
    found: dict[str, str] = {}
    judgements = Context(machine).judgements
    for each in judgements:
        found |= dict.fromkeys(each.states, "neutral")
    for each in judgements:
        if each.counterexample is not None:
            found |= dict.fromkeys((visit.path for visit in each.counterexample.visits), "failure")
    return found


def _exit(container: Container, outcome: nodes.Outcome, id: str, *, final: bool) -> str:
    """An outcome of a container: double lines if the whole machine ends with it."""
    line, fill = TONES[tone(outcome.name)]
    label = html(outcome.name)
    if isinstance(container, Concurrence) and outcome.name == container.default_outcome:
        label = spaced([label, font("otherwise", colour=FAINT, size=8)])
    look = {"shape": "ellipse", "fillcolor": fill, "color": line, "fontcolor": line}
    if final:
        look |= {"peripheries": "2", "fontsize": "11"}
    else:
        look |= {"fontsize": "9", "margin": "0.04,0.02", "height": "0.25", "width": "0.5"}
    tip = {"tooltip": outcome.doc or outcome.name}
    return f'"{id}"{attributes(look | tip, label)}'


def _marks(place: Position, container: Container, *, sideways: bool) -> Iterator[str]:
    """The start and the exits of a container, at its top and bottom."""
    yield entry_mark(container, place.start, sideways=sideways)
    yield from joins(container, place.start, sideways=sideways)
    ids = place.exits(container)
    by_id = {ids[outcome.name]: outcome for outcome in container.outcomes}
    final = place.level == 1
    drawn = [_exit(container, outcome, id, final=final) for id, outcome in by_id.items()]
    if drawn:
        yield f"{{ rank=same; {'; '.join(drawn)} }}"


def _arrows(place: Position, container: Container, depth: int | None) -> Iterator[str]:
    closed = place.level == depth
    drawn = {c.name: _piece(c, place.below(c.name), closed=closed) for c in container.children}
    if isinstance(container, Concurrence) and drawn:
        level = "; ".join(f'"{piece.entry.id}"' for piece in drawn.values())
        yield f"{{ rank=same; {level} }}"
    yield from merged(edges(container, place.start, place.exits(container), drawn))


def _piece(node: Node, place: Position, *, closed: bool) -> Piece:
    notes = place.notes.outcomes.get(place.path, {})
    if closed or isinstance(node, Leaf):
        return Piece(Spot(place.id), {}, notes)
    return Piece(Spot(place.start, place.id), place.exits(node), notes)
