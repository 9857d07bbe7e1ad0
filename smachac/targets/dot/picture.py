"""The picture of a machine: containers as frames, states as boxes, outcomes as exits."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.ir import nodes
from smachac.ir.nodes import Concurrence, Container, Leaf, Machine, Node
from smachac.targets.dot.flow import Piece, Spot, edges, entry_mark, joins, merged
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
    attributes,
    font,
    html,
    identifier,
    lines,
    quoted,
    spaced,
    tone,
)

Path = tuple[str, ...]


def picture(machine: Machine, *, depth: int | None, rankdir: str) -> Iterator[str]:
    """The lines of a DOT file. Containers more than `depth` levels down are drawn closed."""
    root = machine.root
    yield f"digraph {quoted(root.name)} {{"
    for line in _settings(machine, rankdir):
        yield f"  {line}"
    todo: list[str | tuple[Path, Container]] = ["}", ((root.name,), root)]
    while todo:
        item = todo.pop()
        if isinstance(item, str):
            yield item
            continue
        path, container = item
        pad = "  " * len(path)
        opened = []
        todo += reversed([pad + line for line in _arrows(path, container, depth)])
        for line in _marks(path, container):
            yield pad + line
        for child in container.children:
            if _closed(child, len(path), depth):
                yield f"{pad}{_box(child, (*path, child.name))}"
            elif not isinstance(child, Leaf):
                opened.append(child)
        for child in reversed(opened):
            todo.append(f"{pad}}}")
            todo.append(((*path, child.name), child))
            todo += reversed([pad + line for line in _frame(child, (*path, child.name))])


def _closed(node: Node, level: int, depth: int | None) -> bool:
    return isinstance(node, Leaf) or (depth is not None and level >= depth)


def _settings(machine: Machine, rankdir: str) -> Iterator[str]:
    root = machine.root
    title = spaced([f"<B>{html(root.name)}</B>", font(html(machine.base), colour=FAINT, size=10)])
    look = {
        "rankdir": rankdir,
        "compound": "true",
        "newrank": "true",
        "fontname": FONT,
        "fontsize": "15",
    }
    space = {"nodesep": "0.35", "ranksep": "0.4", "pad": "0.2"}
    tip = {"tooltip": root.doc or root.name}
    top = {"label": title, "labelloc": "t", "fontcolor": INK}
    yield f"graph{attributes(look | space | top | tip)}"
    node = {"fontname": FONT, "fontsize": "11", "fontcolor": INK, "color": BORDER}
    box = {"shape": "box", "style": "rounded,filled", "fillcolor": STATE_FILL, "penwidth": "1.1"}
    yield f"node{attributes(node | box)}"
    edge = {"fontname": FONT, "fontsize": "9", "color": INK, "arrowsize": "0.7"}
    yield f"edge{attributes(edge)}"


def _frame(container: Container, path: Path) -> Iterator[str]:
    """The opening lines of a container's cluster."""
    kind = html(container.type)
    fill, border, style = FILLS[len(path) % 2], BORDER, "rounded,filled"
    match container:
        case Concurrence():
            fill, border, style = PARALLEL_FILL, PARALLEL_BORDER, "rounded,filled,dashed"
            kind = f"|| {kind}" + (", first to end" if container.join == "any" else "")
        case nodes.Iterator():
            fill, border = LOOP_FILL, LOOP_BORDER
    title = f"<B>{html(container.name)}</B>  {font(kind, colour=FAINT, size=9)}"
    look = {"label": f"<{title}>", "labeljust": "c", "labelloc": "t", "style": style}
    colours = {"fillcolor": fill, "color": border, "fontsize": "11"}
    yield f'subgraph "cluster_{identifier(path)}" {{'
    tip = {"tooltip": container.doc or "/".join(path)}
    yield f"  graph{attributes(look | colours | tip)}"


def _box(node: Node, path: Path) -> str:
    """A leaf, or a container that is drawn closed."""
    rows = [f"<B>{html(node.name)}</B>"]
    kind = html(node.type) if isinstance(node, Leaf) else f"{html(node.type)} <B>+</B>"
    if node.type:
        rows.append(font(kind, colour=FAINT, size=9))
    tip = {"tooltip": node.doc or "/".join(path)}
    return f'"{identifier(path)}"{attributes({"label": spaced(rows)} | tip)}'


def _exit(container: Container, outcome: nodes.Outcome, path: Path) -> str:
    """An outcome of a container: double lines if the whole machine ends with it."""
    line, fill = TONES[tone(outcome.name)]
    label = html(outcome.name)
    if isinstance(container, Concurrence) and outcome.name == container.default_outcome:
        label = lines([label, font("otherwise", colour=FAINT, size=8)])
    else:
        label = f"<{label}>"
    look = {"label": label, "shape": "ellipse"}
    look |= {"fillcolor": fill, "color": line, "fontcolor": line}
    if len(path) == 1:
        look |= {"peripheries": "2", "fontsize": "11"}
    else:
        look |= {"fontsize": "9", "margin": "0.04,0.02", "height": "0.25", "width": "0.5"}
    tip = {"tooltip": outcome.doc or outcome.name}
    return f'"{_exit_id(path, outcome.name)}"' + attributes(look | tip)


def _start_id(path: Path) -> str:
    return f"{identifier(path)}#start"


def _exit_id(path: Path, outcome: str) -> str:
    return f"{identifier(path)}={identifier([outcome])}"


def _piece(node: Node, path: Path, depth: int | None) -> Piece:
    if _closed(node, len(path) - 1, depth):
        return Piece(Spot(identifier(path)), {})
    ports = {outcome.name: _exit_id(path, outcome.name) for outcome in node.outcomes}
    return Piece(Spot(_start_id(path), identifier(path)), ports)


def _marks(path: Path, container: Container) -> Iterator[str]:
    """The start and the exits of a container, at its top and bottom."""
    start = _start_id(path)
    yield entry_mark(container, start)
    yield from joins(container, start)
    exits = {outcome.name: outcome for outcome in container.outcomes}
    if exits:
        drawn = "; ".join(_exit(container, outcome, path) for outcome in exits.values())
        yield f"{{ rank=same; {drawn} }}"


def _arrows(path: Path, container: Container, depth: int | None) -> Iterator[str]:
    exits = {outcome.name: _exit_id(path, outcome.name) for outcome in container.outcomes}
    drawn = {child.name: _piece(child, (*path, child.name), depth) for child in container.children}
    if isinstance(container, Concurrence) and drawn:
        level = "; ".join(f'"{piece.entry.id}"' for piece in drawn.values())
        yield f"{{ rank=same; {level} }}"
    yield from merged(edges(container, _start_id(path), exits, drawn))
