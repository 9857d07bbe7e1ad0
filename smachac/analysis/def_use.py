"""One userdata key along the paths of a machine: where it is set, and a path on which it is not."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

from smachac.analysis.definite_assignment import Flow, Scope, child_writes
from smachac.analysis.fixpoint import Step
from smachac.diagnostics.source import Span
from smachac.ir import nodes
from smachac.ir.graph import START, Place
from smachac.ir.nodes import Concurrence, Key, Leaf, Node
from smachac.ir.traversal import outcome_names, remapping

State = Literal["unset", "told", "set"]
"""Whether the key is set on a path. `told`: unset, and a container needed it already."""

Status = Literal["always", "sometimes", "never", "unreachable"]
"""Whether a key is set when a state is entered: on every path that leads there, on some, on none;
or no path leads there."""


class Reached(NamedTuple):
    """A place of a container as a path reaches it."""

    place: Place
    state: State


Search = Mapping[Reached, "tuple[Reached, str] | None"]
"""For what paths reach, nearest first: what it comes from and on which outcome, None at a start."""


def search(
    flow: Flow, scope: Scope, key: str, states: Iterable[State], *, stops: bool = False
) -> Search:
    """Where the paths of a container lead on which its key begins in those states.

    Writes count that are sure; or those that are trusted, where `stops` says that a leaf that
    reads the key without finding it ends the path. A container that can be entered again has what
    was set before (smach-semantics V3).
    """
    found: dict[Reached, tuple[Reached, str] | None] = {
        Reached(START, state): None for state in states
    }
    beside = _found_beside(flow, scope, key)
    todo = list(found)
    for here in todo:
        for step, state in _following(scope, key, here, stops):
            both: tuple[State, ...] = (state,)
            if step.target in beside and state != "set":
                both = ("set", state)
            for reached in (Reached(step.target, each) for each in both):
                if reached not in found:
                    found[reached] = (here, step.outcome)
                    todo.append(reached)
        ends = is_exit(here.place) and scope.path in flow.repeated
        if ends and here.state == "set" and Reached(START, "set") not in found:
            found[Reached(START, "set")] = None
            todo.append(Reached(START, "set"))
    return found


def _following(scope: Scope, key: str, here: Reached, stops: bool) -> Iterator[tuple[Step, State]]:
    """The steps from a place, and what becomes of the key on them."""
    state = here.state
    if stops and state == "unset" and key in scope.reads.get(here.place, ()):
        if here.place not in scope.inner:
            return
        state = "told"
    for step in scope.steps.get(here.place, ()):
        writes = step.writes
        if state == "set" or writes.anything or key in writes.perhaps:
            yield step, "set"
        written = key in writes.trusted or writes.anything if stops else key in writes.sure
        if state != "set" and not written:
            yield step, state


def is_exit(place: Place) -> bool:
    return isinstance(place, tuple) and place != START


def _found_beside(flow: Flow, scope: Scope, key: str) -> frozenset[Place]:
    """The children of a concurrence that may find the key because a sibling has written it."""
    if not isinstance(scope.container, Concurrence):
        return frozenset()
    names = [child.name for child in scope.container.children]
    writers = {
        child.name for child in scope.container.children if may_write(flow, scope, child, key)
    }
    return frozenset(name for name in names if writers - {name})


def may_write(flow: Flow, scope: Scope, child: Node, key: str) -> bool:
    """Whether a child of a container may set the container's key."""
    inner = flow.scopes.get(f"{scope.path}/{child.name}")
    raw = isinstance(scope.container, nodes.Iterator)
    if isinstance(child, Leaf) and child.open:
        return True
    for outcome in outcome_names(child):
        writes = child_writes(child, inner, outcome, raw=raw)
        if writes is not None and key in writes.perhaps:
            return True
    return False


def around(flow: Flow, path: str) -> str | None:
    """The path of the container around a state; None for the machine itself."""
    cut = len(path) if path != flow.machine.root.name else -1
    while cut >= 0:
        # A name may hold a slash, which makes it a fault, not a container.
        cut = path.rfind("/", 0, cut)
        if cut >= 0 and path[:cut] in flow.scopes:
            return path[:cut]
    return None


def place_in(container: str, path: str) -> str:
    """The name of a state in the container around it."""
    return path[len(container) + 1 :]


def source_of(flow: Flow, path: str, key: str) -> list[tuple[str, str]]:
    """A container and its key, and before them where the key is handed in from, outermost first."""
    found = [(path, key)]
    while True:
        scope = flow.scopes[path]
        outer = around(flow, path)
        if key in scope.held or key not in scope.inputs or outer is None:
            return found[::-1]
        path, key = outer, scope.inputs[key]
        found.append((path, key))


def key_status(flow: Flow, path: str, key: str) -> Status:
    """Whether the state at a path finds a key of its container when it is entered."""
    return _status(_states(_searches(flow, path, key), path))


def _searches(flow: Flow, path: str, key: str) -> list[tuple[str, Search]]:
    """For each container that the key comes through, outermost first, where its paths lead."""
    outer = around(flow, path)
    if outer is None or path not in flow.entered:
        return []
    found: list[tuple[str, Search]] = []
    states: set[State] = {"unset"}
    for where, name in source_of(flow, outer, key):
        scope = flow.scopes[where]
        if found:
            states = _states(found, where)
        if name in scope.held:
            states = {"set"}
        found.append((where, search(flow, scope, name, sorted(states))))
    return found


def _states(searches: list[tuple[str, Search]], path: str) -> set[State]:
    if not searches:
        return set()
    where, found = searches[-1]
    return {here.state for here in found if here.place == place_in(where, path)}


def _status(states: set[State]) -> Status:
    if not states:
        return "unreachable"
    if "set" not in states:
        return "never"
    return "always" if states == {"set"} else "sometimes"


def path_without(flow: Flow, path: str, key: str) -> tuple[str, ...]:
    """A shortest path to a state on which a key of its container is unset; empty if there is none.

    Names of states as they are entered, in brackets the outcomes between them.
    """
    searches = _searches(flow, path, key)
    whole: list[str] = []
    targets = [*(where for where, _ in searches[1:]), path]
    for (where, found), target in zip(searches, targets, strict=True) if searches else ():
        end = Reached(place_in(where, target), "unset")
        if end not in found:
            return ()
        whole += way_to(found, end)
    return tuple(whole)


def way_to(found: Search, end: Reached) -> list[str]:
    """The path by which a search came to a place."""
    names: list[str] = []
    here: Reached | None = end
    while here is not None:
        before = found[here]
        if isinstance(here.place, str):
            names.append(here.place)
        if before is not None and before[1]:
            names.append(f"({before[1]})")
        here = before[0] if before is not None else None
    return names[::-1]


Kind = Literal["presets", "items", "reads", "writes", "takes in", "hands out"]
"""How a key is used: the container holds it before it starts; an iterator puts its items there; a
leaf; a container, from and to the userdata around it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Use:
    """One use of a key of a container, at its place in a script.

    `path` is the state that uses it, `key` what it calls it there. `outcomes` are those of a
    writer that come with the key; `always` says that they are all it has.
    """

    path: str
    kind: Kind
    key: str
    outcomes: tuple[str, ...] = ()
    always: bool = True
    span: Span = field(compare=False, repr=False)


def uses(flow: Flow, path: str, key: str) -> list[Use]:
    """The uses of one key of the container at a path, in the order of the script."""
    return uses_by_key(flow, path).get(key, [])


def uses_by_key(flow: Flow, path: str) -> dict[str, list[Use]]:
    """The uses of the keys of the container at a path, by key, in the order of the script."""
    scope = flow.scopes[path]
    container = scope.container
    found: dict[str, list[Use]] = {}
    for preset in container.userdata:
        use = Use(path=path, kind="presets", key=preset.key, span=preset.span)
        found.setdefault(preset.key, []).append(use)
    if isinstance(container, nodes.Iterator):
        use = Use(path=path, kind="items", key=container.item_key, span=container.span)
        found.setdefault(use.key, []).append(use)
    for key in scope.reads.get(START, ()):
        use = Use(path=path, kind="reads", key=key, span=container.span)
        found.setdefault(key, []).append(use)
    for child in container.children:
        for key, use in _uses_of(flow, scope, child):
            found.setdefault(key, []).append(use)
    return found


def _uses_of(flow: Flow, scope: Scope, child: Node) -> Iterator[tuple[str, Use]]:
    """The uses that a child makes of the keys of its container."""
    raw = isinstance(scope.container, nodes.Iterator) and isinstance(child, Leaf)
    names = remapping(child)
    path = f"{scope.path}/{child.name}"
    is_leaf = isinstance(child, Leaf)
    kind: Kind = "reads" if is_leaf else "takes in"
    for each in child.inputs:
        span = place_of(child, each)
        yield (
            names.get(each.name, each.name),
            Use(path=path, kind=kind, key=each.name, span=span),
        )
    kind = "writes" if is_leaf else "hands out"
    inner = flow.scopes.get(path)
    known = outcome_names(child) if child.outputs else ()
    endings = [(name, child_writes(child, inner, name, raw=raw)) for name in known]
    for each in child.outputs:
        key = names.get(each.name, each.name)
        written = tuple(
            name for name, writes in endings if writes is not None and key in writes.trusted
        )
        always = written == known
        span = place_of(child, each)
        yield (
            key,
            Use(path=path, kind=kind, key=each.name, outcomes=written, always=always, span=span),
        )


def place_of(node: Node, key: Key) -> Span:
    """Where a script says that a state has a key: its list of keys, its remapping, or its name."""
    remap = next((remap for remap in node.remaps if remap.key == key.name), None)
    if key.span.source is node.span.source:
        return key.span
    return remap.span if remap is not None else node.span


def same_key(flow: Flow, path: str, key: str) -> tuple[tuple[str, str], ...]:
    """The keys of other containers that a key of one comes from or goes to, itself among them.

    In the order of the script.
    """
    found = {(path, key)}
    todo = [(path, key)]
    while todo:
        where, name = todo.pop()
        for pair in _next_to(flow, where, name):
            if pair not in found:
                found.add(pair)
                todo.append(pair)
    order = {path: number for number, path in enumerate(flow.scopes)}
    return tuple(sorted(found, key=lambda pair: (order[pair[0]], pair[1])))


def _next_to(flow: Flow, path: str, key: str) -> Iterator[tuple[str, str]]:
    """The keys one copy away, inwards and outwards."""
    scope = flow.scopes[path]
    outer = around(flow, path)
    for names in (scope.inputs, scope.outputs):
        if outer is not None and key in names:
            yield outer, names[key]
    for name in scope.inner:
        inner = flow.scopes[f"{path}/{name}"]
        for names in (inner.inputs, inner.outputs):
            yield from ((inner.path, own) for own, to in names.items() if to == key)
