"""Explanation of a state: its interface, its entries and exits, and its findings."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from smachac.analysis.context import Context
from smachac.analysis.def_use import Status, key_status
from smachac.analysis.successors import Arrival, path_to
from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.wording import MOST_LISTED
from smachac.ir.nodes import Key, Leaf, Node, Transition
from smachac.ir.printer import print_data
from smachac.ir.script_paths import Sugared, in_words, role, sugared_containers
from smachac.ir.traversal import outcome_names, remapping
from smachac.ir.types import ANY, Type
from smachac.records import dataclass, field
from smachac.report.outline import STATUS, Paragraph, article, at, place, way


@dataclass(frozen=True, slots=True, kw_only=True)
class StateKey:
    """A key of a state: its inferred type, its name in the container, and for an input whether it
    is set."""

    key: Key
    type: Type
    outer: str
    status: Status | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Exit:
    """An outcome, the states or outcomes that it leads to, and the transitions on the way."""

    outcome: str
    arrivals: tuple[Arrival, ...]
    steps: tuple[Transition, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class StateExplanation:
    """The state of the state at a path.

    `plain` is the path without roles, `sugar` the containers made around it. `entered` are the
    preceding states with their outcomes; an empty name is the start of the container. `way` is a
    shortest path to the state, empty if there is none.
    """

    path: str
    plain: str
    node: Node
    sugar: tuple[Sugared, ...]
    reads: tuple[StateKey, ...]
    writes: tuple[StateKey, ...]
    claims: tuple[str, ...]
    entered: tuple[tuple[str, str], ...]
    way: tuple[str, ...]
    reachable: bool
    exits: tuple[Exit, ...]
    report: Report = field(compare=False, repr=False)


def explain_state(context: Context, path: str, report: Report) -> StateExplanation:
    """The explanation of the state at a path, which must exist."""
    routes, types = context.routes, context.types
    node, plain = routes.nodes[path], context.plain_paths.get(path, path)
    sugar = [each for each in sugared_containers(routes.root).values() if each.state == plain]
    names = remapping(node)

    def read(key: Key) -> StateKey:
        outer = names[key.name]
        status = key_status(context.flow, path, outer) if node is not routes.root else None
        known = types.inputs.get((path, key.name)) or types.keys.get((path, key.name), key.type)
        return StateKey(key=key, type=known, outer=outer, status=status)

    def written(key: Key) -> StateKey:
        known = types.outputs.get((path, key.name)) or types.keys.get((path, key.name), key.type)
        return StateKey(key=key, type=known, outer=names[key.name])

    found = [*outcome_names(node), *(step.outcome for step in node.transitions)]
    return StateExplanation(
        path=context.script_paths.get(path, path),
        plain=plain,
        node=node,
        sugar=tuple(sugar) if not role(node) else (),
        reads=tuple(map(read, node.inputs)),
        writes=tuple(map(written, node.outputs)),
        claims=tuple(sorted(context.claims[path])),
        entered=tuple(_entries(context, plain)),
        way=_way(context, path),
        reachable=(path, "") in routes.before,
        exits=tuple(
            Exit(
                outcome=name,
                arrivals=tuple(
                    _in_script(context, path, name, each) for each in routes.arrivals(path, name)
                ),
                steps=tuple(step for step in node.transitions if step.outcome == name),
            )
            for name in dict.fromkeys(found)
        ),
        report=[item for item in report if item.finding.node == plain],
    )


def _way(context: Context, path: str) -> tuple[str, ...]:
    before, entry = context.routes.before, (path, "")
    return path_to(before, entry, context.plain_paths) if entry in before else ()


def _entries(context: Context, plain: str) -> dict[tuple[str, str], None]:
    """The states, with outcomes, after which the state at a plain path is entered, or a container
    of its sugar from outside it."""
    routes, paths = context.routes, context.plain_paths
    mine = {path for path in routes.nodes if paths.get(path, path) == plain}
    found: dict[tuple[str, str], None] = {}
    for path, outcome in routes.before:
        here = paths.get(path, path)
        inside = here.startswith(f"{plain}/") or (path in mine and not outcome)
        if inside or not any(to in mine for to, end in routes.after((path, outcome)) if not end):
            continue
        found[here.rpartition("/")[2] if outcome else "", outcome] = None
    return found


def _in_script(context: Context, path: str, outcome: str, arrival: Arrival) -> Arrival:
    """Where an outcome of the state at a path leads, with plain paths. The containers of its sugar
    that end with the same outcome are left out."""
    paths = context.plain_paths
    through = [(paths.get(path, path), outcome)]
    for inner, end in arrival.through:
        shown = (paths.get(inner, inner), end)
        through += [shown] if shown != through[-1] else []
    return Arrival(tuple(through[1:]), paths.get(arrival.target, arrival.target))


def state_text(state: StateExplanation) -> tuple[str, list[Paragraph]]:
    """A headline and its paragraphs."""
    node = state.node
    lines = [f"{article(kind(node))}{place(node.span)}"]
    lines += [
        f"with `{each.role}`: {in_words(each.role, each.limit)}"
        for each in state.sugar
        if each.role != "try"
    ]
    lines += [f"from the sub-script called at {call}" for call in node.via]
    if node.doc:
        lines.append(" ".join(node.doc.split()))
    return f"state {state.path}", [
        ("is", lines),
        ("holds", list(_held(node))),
        ("reads", [_read(each) for each in state.reads]),
        ("writes", [_written(node, each) for each in state.writes]),
        ("claims", list(state.claims)),
        ("entered", list(_entered(state))),
        (
            "left",
            [_left(state, each) for each in state.exits] or ["never: it has no outcome"],
        ),
        ("found", [_found(item) for item in state.report] or ["nothing"]),
    ]


def kind(node: Node) -> str:
    """The state type; for a container its class and, if a field of a state created it, that
    field."""
    if isinstance(node, Leaf):
        return node.type or "state that could not be read"
    if node.sugar:
        return f"{type(node).__name__} made for `{node.sugar}`"
    return type(node).__name__


def _held(node: Node) -> Iterator[str]:
    if isinstance(node, Leaf):
        for each in node.variables:
            yield f"{each.name} = {print_data(each.value.data)}"
        return
    for preset in node.userdata:
        yield f"the key `{preset.key}` = {print_data(preset.value.data)}"
    names = [child.name for child in node.children]
    more = f" and {len(names) - MOST_LISTED} more" if len(names) > MOST_LISTED else ""
    yield f"the states {', '.join(names[:MOST_LISTED])}{more}" if names else "no state"


def _named(state_key: StateKey) -> str:
    type_ = "" if state_key.type == ANY else f" of type {state_key.type}"
    around = f", remapped to `{state_key.outer}`" if state_key.outer != state_key.key.name else ""
    return f"`{state_key.key.name}`{type_}{around}"


def _doc(key: Key) -> str:
    return f" ({' '.join(key.doc.split())})" if key.doc else ""


def _read(state_key: StateKey) -> str:
    status = f": {STATUS[state_key.status]}" if state_key.status else ""
    if state_key.key.type.name == "optional" and state_key.status in ("sometimes", "never"):
        status += ", which is allowed because it is optional"
    return f"{_named(state_key)}{status}{_doc(state_key.key)}"


def _written(node: Node, state_key: StateKey) -> str:
    writes = node.writes if isinstance(node, Leaf) else ()
    on = [outcome for outcome, keys in writes if state_key.key.name in keys]
    return f"{_named(state_key)}{', on ' + ' and '.join(on) if on else ''}{_doc(state_key.key)}"


def _entered(state: StateExplanation) -> Iterator[str]:
    container = state.plain.rpartition("/")[0].rpartition("/")[2]
    if not state.reachable:
        yield "never: no path from the start leads to this state"
        return
    if not container:
        yield "at the start: it is the whole machine"
        return
    for name, outcome in state.entered:
        if name == container and not outcome:
            continue
        yield f"after {name} on {outcome}" if name else f"when {container} starts"
    yield from way("shortest path: ", state.way)


def _left(state: StateExplanation, leaving: Exit) -> str:
    if "/" not in state.path:
        return f"on {leaving.outcome}: the machine has ended"
    places = [step.span for step in leaving.steps if step.origin == "written"]
    where = place(places[0]) if places else ""
    if leaving.arrivals:
        ways = " or ".join(dict.fromkeys(_arrival(state.node, each) for each in leaving.arrivals))
        return f"on {leaving.outcome}: {ways}{where}"
    if leaving.steps:
        return f"on {leaving.outcome}: to {leaving.steps[0].target}, which does not exist{where}"
    return f"on {leaving.outcome}: it has no transition"


def _arrival(node: Node, arrival: Arrival) -> str:
    parts = [f"{path.rpartition('/')[2]} ends with {end}" for path, end in arrival.through]
    if arrival.target:
        name = arrival.target.rpartition("/")[2]
        again = name == node.name and not arrival.through
        parts.append("again" if again else f"to {name}")
    return ", then ".join(parts)


def _found(item: Any) -> str:
    finding = item.finding
    return f"{item.severity.value}[{item.code}] {finding.message}{place(finding.span)}"


def state_json(state: StateExplanation) -> dict[str, Any]:
    """The state as data for JSON."""
    node = state.node
    return {
        "state": state.path,
        "type": kind(node),
        "doc": node.doc,
        "at": at(node.span),
        "called": [at(call) for call in node.via],
        "reads": [_key_json(each) for each in state.reads],
        "writes": [_key_json(each) for each in state.writes],
        "claims": list(state.claims),
        "entered": [{"after": name, "outcome": outcome} for name, outcome in state.entered],
        "way": list(state.way),
        "reachable": state.reachable,
        "exits": [_exit_json(each) for each in state.exits],
        "findings": [{"code": i.code, "message": i.finding.message} for i in state.report],
    }


def _key_json(state_key: StateKey) -> dict[str, Any]:
    status = {} if state_key.status is None else {"set": state_key.status}
    return {
        "key": state_key.key.name,
        "type": str(state_key.type),
        "outer": state_key.outer,
        **status,
    }


def _exit_json(leaving: Exit) -> dict[str, Any]:
    arrivals: Iterable[Arrival] = leaving.arrivals
    return {
        "outcome": leaving.outcome,
        "leads": [
            {"through": [list(each) for each in arrival.through], "to": arrival.target}
            for arrival in arrivals
        ],
    }
