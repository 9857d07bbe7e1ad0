"""The machine as it was written: one state of the script is one state of the view.

`timeout`, `retry` and `for_each` put containers around a state (frontend/script/desugar.py). In the
view a state and these containers are one `WrittenState` with badges. The view is made by the
structure of the graph: no name is compared, so that a state may be called `TIMER`.

Three kinds of paths lead to a state: its path in the script (`sm/DRIVE`), which is that of the
view; the full paths of the graph (`sm/DRIVE/TIMED/DRIVE`); and those in traces (`sm/DRIVE (retry)`,
see script_paths.py).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Literal, NamedTuple

from smachac.diagnostics.wording import quote
from smachac.ir import graph, nodes
from smachac.ir.graph import EdgeKind
from smachac.ir.nodes import Concurrence, Container, Data, Expression, Leaf, Machine, Node, Value
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.script_paths import role, script_paths, sugared_child
from smachac.ir.traversal import outcome_names
from smachac.records import dataclass

Role = Literal["state", "timeout", "retry", "try", "for_each", "timer", "pause"]
"""What a node of the graph is for its written state: the state itself, a container that was made of
one of its fields, or a state that such a field adds."""

Round = Literal["try", "item"]
_ROUNDS: Mapping[str, Round] = {"retry": "try", "for_each": "item"}

_WORDS: Mapping[Role, str] = {
    "timeout": "the time limit",
    "timer": "the timer",
    "retry": "the retry",
    "try": "a try",
    "pause": "the pause",
    "for_each": "the loop",
}

BadgeField = Literal["timeout", "retry", "for_each", "catches"]


FEW_BOXES = 40
"""The states of a picture that can be read on one page."""


class Badge(NamedTuple):
    """What one field of the script adds to a state.

    `limit` is its value in words: `5 min`, `3 tries`, `wp in waypoints`; `delay` the pause before
    each further try, `items` the items of a loop that the script lists. `outcome` is the outcome
    that the field adds, empty if it adds none. After the outcomes `again` of the state, the next
    one of `number` tries or items begins. `path` is the full path of the container that was made of
    the field.
    """

    field: BadgeField
    limit: str
    path: str
    outcome: str = ""
    again: tuple[str, ...] = ()
    number: int | None = None
    delay: str = ""
    items: Value | None = None

    @property
    def text(self) -> str:
        """The badge in words."""
        match self.field:
            case "timeout":
                return f"limit {self.limit}" if self.limit else "time limit"
            case "for_each":
                return f"for each {self.limit}"
            case "catches":
                return f"exception \N{RIGHTWARDS ARROW} {self.outcome}"
        return self.limit


class Part(NamedTuple):
    """A node of the graph as a part of a written state: the path of the state, the role of the
    node in it, the paths of the node in the graph and in traces, and what begins with each of its
    starts."""

    state: str
    role: Role
    full: str
    shown: str
    begins: Round | None = None


class WrittenEdge(NamedTuple):
    """An edge inside a container. `source` is the path of a state, None at the start; `target` is
    the path of a state, or an outcome of the container if `leaves`."""

    container: str
    source: str | None
    outcome: str
    target: str
    leaves: bool
    kind: EdgeKind


@dataclass(frozen=True, slots=True, kw_only=True)
class WrittenState:
    """A state of the script.

    `node` is the state without its badges, at the full path `full`; `outer` is the outermost
    container that was made of its fields, at `outer_full`, which has its transitions; both are the
    same for a state without such fields. `children` are the paths of the states inside. `parts` are
    the nodes of the graph that are this state, outermost first. `badges` are in the order in which
    they act on the state: innermost first.
    """

    path: str
    name: str
    node: Node
    full: str
    outer: Node
    outer_full: str
    parent: str | None
    level: int
    children: tuple[str, ...]
    badges: tuple[Badge, ...]
    parts: tuple[Part, ...]

    @property
    def catches(self) -> str:
        """The outcome that exceptions in the state become; empty if they are not caught."""
        return self.outer.catches or self.node.catches

    @property
    def repeated(self) -> tuple[str, ...]:
        """The outcomes of one try or item after which the next one begins."""
        return tuple(dict.fromkeys(name for badge in self.badges for name in badge.again))

    def edges(self) -> Iterator[WrittenEdge]:
        """The edges inside the state, in the order of the script."""
        if isinstance(self.node, Leaf):
            return
        for edge in graph.edges(self.node):
            source = f"{self.path}/{edge.source}" if isinstance(edge.source, str) else None
            leaves = not isinstance(edge.target, str)
            target = edge.target[1] if leaves else f"{self.path}/{edge.target}"
            yield WrittenEdge(self.path, source, edge.outcome, target, leaves, edge.kind)

    def next_round(self, outcome: str) -> Round | None:
        """What begins after an outcome of one try or item; None if the state ends."""
        found = next((badge for badge in self.badges if outcome in badge.again), None)
        return None if found is None else _ROUNDS.get(found.field)

    def field_of(self, outcome: str) -> BadgeField | None:
        """The field that adds an outcome; None for an outcome of the state itself."""
        if outcome == self.catches:
            return "catches"
        if outcome in outcome_names(self.node):
            return None
        found = next((badge for badge in self.badges if badge.outcome == outcome), None)
        if found is None and outcome == PREEMPTED:
            found = next((badge for badge in self.badges if badge.field != "catches"), None)
        return found.field if found else None

    def part_with(self, outcome: str) -> Part:
        """The part that ends with an outcome first: the state itself for an outcome of its own, the
        container of a time limit for `timeout`, that of the tries for `exhausted`."""
        field = self.field_of(outcome)
        mine = [part for part in reversed(self.parts) if part.role == field]
        return mine[0] if mine else Part(self.path, "state", self.full, self.path)


@dataclass(frozen=True, slots=True, kw_only=True)
class Written:
    """The states of a view by path, parents before children, in the order of the script; `parts`
    has the nodes of the graph by full path, `traced` by their paths in traces. Old traces have full
    paths, which `traced` has too where they are no other path."""

    states: Mapping[str, WrittenState]
    parts: Mapping[str, Part]
    traced: Mapping[str, Part]

    @property
    def root(self) -> WrittenState:
        return next(iter(self.states.values()))

    def state(self, full: str) -> str:
        """The path of the written state of a full path, which may be followed by an outcome (`:`).
        A path without a node is kept."""
        part = self.parts.get(full)
        if part is not None:
            return part.state
        head, colon, outcome = full.rpartition(":")
        inside = self.parts.get(head)
        return f"{inside.state}{colon}{outcome}" if inside is not None else full

    def traced_state(self, full: str) -> str:
        """The path in traces of the written state of a full path, which may be followed by an
        outcome (`:`). A path without a node is kept."""
        part = self.parts.get(full)
        if part is not None:
            return self.states[part.state].parts[-1].shown
        head, colon, outcome = full.rpartition(":")
        return f"{self.traced_state(head)}{colon}{outcome}" if head in self.parts else full

    def in_words(self, full: str) -> str:
        """A node of the graph for a message: its state, or what the node is for its state."""
        part = self.parts.get(full)
        state = quote(self.traced_state(full))
        return state if part is None or part.role == "state" else f"{_WORDS[part.role]} of {state}"

    def fitting_depth(self, most: int = FEW_BOXES) -> int:
        """The number of levels of containers, 1 or more, that a picture of at most `most` states
        has open; of all machines the first level is open."""
        counts: dict[int, int] = {}
        for state in self.states.values():
            counts[state.level] = counts.get(state.level, 0) + 1
        depth, shown = 1, counts.get(1, 0)
        while (more := counts.get(depth + 1, 0)) and shown + more <= most:
            depth, shown = depth + 1, shown + more
        return depth

    def is_whole(self, full: str) -> bool:
        """Whether the node at a full path is a written state with all its badges: its visits and
        outcomes are those of the written state."""
        part = self.parts.get(full)
        return part is not None and self.states[part.state].outer_full == full


def written(machine: Machine) -> Written:
    """The machine as it was written. Of two states with one path, which is an error of the script,
    the first counts."""
    return _view(machine.root, _folded)


def generated(machine: Machine) -> Written:
    """The same view of the graph itself: each node is a state, also those that were made of
    fields."""
    shown = script_paths(machine.root)

    def unfolded(node: Node, full: str, path: str) -> _Folded:
        badge = None if isinstance(node, Leaf) else _badge(node, full)
        badge = badge and badge._replace(again=())  # its edges are drawn
        part = Part(path, "state", full, shown.get(full, full))
        return _Folded(node, full, (part,), (badge,) if badge else ())

    return _view(machine.root, unfolded)


class _Folded(NamedTuple):
    """A written state at a node of the graph: its own node with its full path, and its parts and
    badges."""

    node: Node
    full: str
    parts: tuple[Part, ...]
    badges: tuple[Badge, ...]


def _view(root: Node, fold: Callable[[Node, str, str], _Folded]) -> Written:
    states: dict[str, WrittenState] = {}
    parts: dict[str, Part] = {}
    stack: list[tuple[Node, str, str, str | None, int]] = [(root, root.name, root.name, None, 0)]
    while stack:
        outer, full, path, parent, level = stack.pop()
        found = fold(outer, full, path)
        if path in states:
            continue
        node = found.node
        inside = () if isinstance(node, Leaf) else node.children
        children = tuple(dict.fromkeys(f"{path}/{child.name}" for child in inside))
        caught = outer.catches or node.catches
        catches = (Badge("catches", "", found.full, caught),) if caught else ()
        states[path] = WrittenState(
            path=path,
            name=outer.name,
            node=node,
            full=found.full,
            outer=outer,
            outer_full=full,
            parent=parent,
            level=level,
            children=children,
            badges=(*catches, *found.badges),
            parts=found.parts,
        )
        for part in found.parts:
            parts.setdefault(part.full, part)
        for child in reversed(inside):
            place = f"{found.full}/{child.name}", f"{path}/{child.name}"
            stack.append((child, *place, path, level + 1))
    traced = {part.shown: part for part in parts.values()}
    for full, part in parts.items():
        traced.setdefault(full, part)
    return Written(states=states, parts=parts, traced=traced)


def _folded(outer: Node, full: str, path: str) -> _Folded:
    """A node with the containers made of its fields as one state."""
    parts: list[Part] = []
    badges: list[Badge] = []
    node = outer
    begins: Round | None = None
    while not isinstance(node, Leaf) and (inside := sugared_child(node)) is not None:
        shown = f"{path} ({role(node)})"
        parts.append(Part(path, _container_role(node), full, shown, begins))
        begins = _ROUNDS.get(role(node))
        added: Role = "timer" if isinstance(node, Concurrence) else "pause"
        parts += [
            Part(path, added, f"{full}/{child.name}", f"{shown}/{child.name}")
            for child in node.children
            if child is not inside
        ]
        if (badge := _badge(node, full)) is not None:
            badges.append(badge)
        node, full = inside, f"{full}/{inside.name}"
    parts.append(Part(path, "state", full, path, begins))
    return _Folded(node, full, tuple(parts), tuple(reversed(badges)))


def _container_role(node: Container) -> Role:
    match role(node):
        case "timeout" | "retry" | "for_each" | "try" as known:
            return known
    raise AssertionError(f"{node.name} was made of no field")


def _badge(node: Container, full: str) -> Badge | None:
    """The badge of a container that was made of a field. One try has none: it belongs to the
    retry."""
    match node:
        case Concurrence(sugar="timeout"):
            return Badge("timeout", _seconds(node), full, node.default_outcome)
        case nodes.Iterator(sugar="retry"):
            tries, again = _count(node), node.loop_outcomes
            limit = f"{tries} {'try' if tries == 1 else 'tries'}"
            return Badge("retry", limit, full, node.exhausted_outcome, again, tries, _delay(node))
        case nodes.Iterator(sugar="for_each"):
            # A remapped key has another name in the state than in the script.
            word = node.item_span.text
            item = word if word.isidentifier() else node.item_key
            limit = f"{item} {items_in_words(node)}".strip()
            return Badge(
                "for_each", limit, full, "", node.loop_outcomes, _count(node), "", node.items
            )
    return None


def _seconds(limit: Concurrence) -> str:
    for child in limit.children:
        if isinstance(child, Leaf) and child is not limit.children[0]:
            for variable in child.variables:
                if isinstance(seconds := variable.value.data, int | float):
                    return duration(float(seconds))
    return ""


def _delay(retry: nodes.Iterator) -> str:
    data = None if retry.items is None else retry.items.data
    if isinstance(data, tuple) and data and data[0] == 0.0 and isinstance(data[-1], float):
        return duration(data[-1])
    return ""


def _count(node: nodes.Iterator) -> int | None:
    data = None if node.items is None else node.items.data
    return len(data) if isinstance(data, tuple) else None


def items_in_words(container: nodes.Iterator) -> str:
    """The items of an iterator as a short text."""
    if container.items is None:
        return f"in {container.items_key}"
    text = _short(container.items.data)
    return f"in {text if len(text) <= 24 else text[:23] + '…'}"


def _short(data: Data) -> str:
    match data:
        case Expression(text=text):
            return text
        case tuple() if len(data) > 4:
            return f"{len(data)} items"
        case tuple():
            return f"[{', '.join(map(_short, data))}]"
        case nodes.Struct():
            return "{…}"
        case _:
            return str(data)


_UNITS = ((3600.0, "h"), (60.0, "min"), (1.0, "s"))


def duration(seconds: float) -> str:
    """A time limit in words, as a script can have it: `2 h`, `1 min 30 s`, `50 ms`."""
    if 0 < seconds < 1:
        return f"{seconds * 1000:g} ms"
    parts, rest = [], seconds
    for size, unit in _UNITS[:-1]:
        if (whole := int(rest // size)) > 0:
            parts.append(f"{whole} {unit}")
            rest -= whole * size
    if rest or not parts:
        parts.append(f"{rest:g} s")
    return " ".join(parts)
