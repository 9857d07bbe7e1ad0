"""Reaching definitions of one userdata key, and a witness path on which it is unset."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Literal, NamedTuple

from smachac.analysis.definite_assignment import DataFlow, UserdataScope, child_writes
from smachac.analysis.fixpoint import KeyStep
from smachac.analysis.uses import Use
from smachac.diagnostics.diagnostic import PathStep, ended, entered
from smachac.ir import nodes
from smachac.ir.graph import START, Vertex
from smachac.ir.nodes import Concurrence, Leaf, Node
from smachac.ir.script_paths import NO_SUGAR, PlainPaths, steps_in_script
from smachac.ir.traversal import outcome_names

KeyState = Literal["unset", "reported", "set"]
"""Whether the key is set on a path. `reported`: unset and already reported, because a container on
the path needs it."""

Status = Literal["always", "given", "sometimes", "never", "unreachable"]
"""Whether a key is set when a state is entered: on every path to it; on every path if the caller of
the machine sets its input key; on some, on none; or there is no path to it."""


class Reached(NamedTuple):
    """A vertex of a container, and the state of the key on a path that reaches it."""

    vertex: Vertex
    state: KeyState


Search = Mapping[Reached, "tuple[Reached, str] | None"]
"""For each reached vertex, nearest first, its predecessor and the outcome; None at a start."""


def search(
    flow: DataFlow,
    scope: UserdataScope,
    key: str,
    states: Iterable[KeyState],
    *,
    stops: bool = False,
) -> Search:
    """Breadth-first search over the vertices of a container, with the state of one key.

    `states` are the states of the key at the start. Sure writes count; with `stops`, trusted writes
    count, and a leaf that reads the unset key ends the path. A container that can be entered again
    keeps what was set before (docs/semantics.md, Userdata).
    """
    # By hand: networkx needs the product graph of vertices and key states, and takes 16 ms instead
    # of 2 ms for 1,000 states and 177 ms instead of 24 ms for 10,000, that is 11 % of a check with
    # one fault, 78 % with ten (python bench/searches.py).
    found: dict[Reached, tuple[Reached, str] | None] = {
        Reached(START, state): None for state in states
    }
    beside = _found_beside(flow, scope, key)
    todo = list(found)
    for here in todo:
        for step, state in _following(scope, key, here, stops):
            both: tuple[KeyState, ...] = (state,)
            if step.target in beside and state != "set":
                both = ("set", state)
            for reached in (Reached(step.target, text) for text in both):
                if reached not in found:
                    found[reached] = (here, step.outcome)
                    todo.append(reached)
        ends = is_exit(here.vertex) and scope.path in flow.repeated
        if ends and here.state == "set" and Reached(START, "set") not in found:
            found[Reached(START, "set")] = None
            todo.append(Reached(START, "set"))
    return found


def _following(
    scope: UserdataScope, key: str, here: Reached, stops: bool
) -> Iterator[tuple[KeyStep, KeyState]]:
    """The steps from a vertex, with the state of the key after each."""
    state = here.state
    if stops and state == "unset" and key in scope.reads.get(here.vertex, ()):
        if here.vertex not in scope.inner:
            return
        state = "reported"
    for step in scope.steps.get(here.vertex, ()):
        writes = step.writes
        if state == "set" or writes.anything or key in writes.perhaps:
            yield step, "set"
        written = key in writes.trusted or writes.anything if stops else key in writes.sure
        if state != "set" and not written:
            yield step, state


def is_exit(vertex: Vertex) -> bool:
    return isinstance(vertex, tuple) and vertex != START


def _found_beside(flow: DataFlow, scope: UserdataScope, key: str) -> frozenset[Vertex]:
    """The children of a concurrence that can find the key set because a sibling wrote it."""
    if not isinstance(scope.container, Concurrence):
        return frozenset()
    names = [child.name for child in scope.container.children]
    writers = {
        child.name for child in scope.container.children if may_write(flow, scope, child, key)
    }
    return frozenset(name for name in names if writers - {name})


def may_write(flow: DataFlow, scope: UserdataScope, child: Node, key: str) -> bool:
    """Whether a child of a container can set a key of the container."""
    inner = flow.scopes.get(f"{scope.path}/{child.name}")
    raw = isinstance(scope.container, nodes.Iterator)
    if isinstance(child, Leaf) and child.open:
        return True
    for outcome in outcome_names(child):
        writes = child_writes(child, inner, outcome, raw=raw)
        if writes is not None and key in writes.perhaps:
            return True
    return False


def around(flow: DataFlow, path: str) -> str | None:
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


def source_of(flow: DataFlow, path: str, key: str) -> list[tuple[str, str]]:
    """The containers that a key is passed in through, outermost first, with its name in each."""
    found = [(path, key)]
    while True:
        scope = flow.scopes[path]
        outer = around(flow, path)
        if key in scope.held or key not in scope.inputs or outer is None:
            return found[::-1]
        path, key = outer, scope.inputs[key]
        found.append((path, key))


def key_status(flow: DataFlow, path: str, key: str) -> Status:
    """Whether a key of its container is set when the state at a path is entered."""
    return key_statuses(flow, around(flow, path), key, [path])[path]


def key_statuses(
    flow: DataFlow, container: str | None, key: str, paths: Iterable[str]
) -> dict[str, Status]:
    """`key_status` of states of one container, by path. One search serves all of them."""
    found = _searches(flow, container, key)
    without_caller = _searches(flow, container, key, caller=False)
    statuses: dict[str, Status] = {}
    for path in paths:
        status = _status(_states(found, path)) if path in flow.entered else "unreachable"
        given = status == "always" and _status(_states(without_caller, path)) != "always"
        statuses[path] = "given" if given else status
    return statuses


def _searches(
    flow: DataFlow, container: str | None, key: str, *, caller: bool = True
) -> list[tuple[str, Search]]:
    """The search in each container that a key is passed in through, outermost first, down to its
    container. `caller`: the caller of the machine sets its input keys."""
    found: list[tuple[str, Search]] = []
    states: set[KeyState] = {"unset"}
    for where, name in source_of(flow, container, key) if container is not None else ():
        scope = flow.scopes[where]
        if found:
            states = _states(found, where)
        presets = {preset.key for preset in scope.container.userdata}
        if name in (scope.held if caller else presets):
            states = {"set"}
        found.append((where, search(flow, scope, name, sorted(states))))
    return found


def _states(searches: list[tuple[str, Search]], path: str) -> set[KeyState]:
    if not searches:
        return set()
    where, found = searches[-1]
    vertex = place_in(where, path)
    states: tuple[KeyState, ...] = ("unset", "reported", "set")
    return {state for state in states if Reached(vertex, state) in found}


def _status(states: set[KeyState]) -> Status:
    if not states:
        return "unreachable"
    if "set" not in states:
        return "never"
    return "always" if states == {"set"} else "sometimes"


def path_without(
    flow: DataFlow, path: str, key: str, plain: PlainPaths = NO_SUGAR
) -> tuple[str, ...]:
    """A shortest path to a state on which a key of its container is unset; empty if there is none.

    Names of states in the script as they are entered, in brackets the outcomes between them.
    `plain` are the plain paths.
    """
    searches = _searches(flow, around(flow, path), key) if path in flow.entered else []
    whole: list[PathStep] = []
    targets = [*(where for where, _ in searches[1:]), path]
    for (where, found), target in zip(searches, targets, strict=True) if searches else ():
        end = Reached(place_in(where, target), "unset")
        if end not in found:
            return ()
        whole += way_to(where, found, end)
    return tuple(label for _, label in steps_in_script(plain, whole))


def way_to(path: str, found: Search, end: Reached) -> list[PathStep]:
    """The path that a search in the container at `path` found to a vertex."""
    steps: list[PathStep] = []
    here: Reached | None = end
    while here is not None:
        before = found[here]
        if isinstance(here.vertex, str):
            steps.append(entered(here.vertex, f"{path}/{here.vertex}"))
        if before is not None and before[1]:
            steps.append(ended(before[1]))
        here = before[0] if before is not None else None
    return steps[::-1]


def written_on(flow: DataFlow, scope: UserdataScope, use: Use) -> tuple[str, ...]:
    """The outcomes of the state of a use with which it has set the key."""
    raw = isinstance(scope.container, nodes.Iterator) and isinstance(use.node, Leaf)
    inner = flow.scopes.get(use.path)
    endings = (
        (name, child_writes(use.node, inner, name, raw=raw)) for name in outcome_names(use.node)
    )
    return tuple(
        name for name, writes in endings if writes is not None and use.outer in writes.trusted
    )


def same_key(flow: DataFlow, path: str, key: str) -> tuple[tuple[str, str], ...]:
    """The keys of containers that are copied to or from a key, with the key itself.

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


def _next_to(flow: DataFlow, path: str, key: str) -> Iterator[tuple[str, str]]:
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
