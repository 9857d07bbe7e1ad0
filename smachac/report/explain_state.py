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
from smachac.ir.traversal import outcome_names, remapping
from smachac.ir.types import ANY, Type
from smachac.ir.written import Badge, Round, WrittenState
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
    """An outcome, the states or outcomes that it leads to, and the transitions on the way. After an
    outcome of one try or item, `again` is what begins next."""

    outcome: str
    arrivals: tuple[Arrival, ...] = ()
    steps: tuple[Transition, ...] = ()
    again: Round | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class StateExplanation:
    """The state as it was written.

    `entered` are the preceding states with their outcomes; an empty name is the start of the
    container. `way` is a shortest path to the state, empty if there is none.
    """

    written: WrittenState
    reads: tuple[StateKey, ...]
    writes: tuple[StateKey, ...]
    claims: tuple[str, ...]
    entered: tuple[tuple[str, str], ...]
    way: tuple[str, ...]
    reachable: bool
    exits: tuple[Exit, ...]
    report: Report = field(compare=False, repr=False)

    @property
    def node(self) -> Node:
        return self.written.node

    @property
    def path(self) -> str:
        return self.written.path


def explain_state(context: Context, path: str, report: Report) -> StateExplanation:
    """The explanation of the state at a path in the script, which must exist."""
    routes, types = context.routes, context.types
    state = context.written.states[path]
    node, outer, full, whole = state.node, state.outer, state.full, state.outer_full
    names = remapping(outer)
    given = {key.name for key in outer.inputs}

    def read(key: Key) -> StateKey:
        status = None
        if node is not routes.root:
            place = (whole, names[key.name]) if key.name in given else (full, key.name)
            status = key_status(context.flow, *place)
        known = types.inputs.get((full, key.name)) or types.keys.get((full, key.name), key.type)
        return StateKey(key=key, type=known, outer=names[key.name], status=status)

    def written(key: Key) -> StateKey:
        known = types.outputs.get((full, key.name)) or types.keys.get((full, key.name), key.type)
        return StateKey(key=key, type=known, outer=names[key.name])

    found = [*outcome_names(outer), *(step.outcome for step in outer.transitions)]
    exits = [
        Exit(
            outcome=name,
            arrivals=tuple(
                _in_script(context, path, name, arrival) for arrival in routes.arrivals(whole, name)
            ),
            steps=tuple(step for step in outer.transitions if step.outcome == name),
            again=state.next_round(name),
        )
        for name in dict.fromkeys(found)
    ]
    exits += [
        Exit(outcome=name, again=state.next_round(name))
        for name in state.repeated
        if name not in found
    ]
    return StateExplanation(
        written=state,
        reads=tuple(map(read, node.inputs)),
        writes=tuple(map(written, node.outputs)),
        claims=tuple(sorted(context.claims[full])),
        entered=tuple(_entries(context, state)),
        way=_way(context, state),
        reachable=(whole, "") in routes.before,
        exits=tuple(exits),
        report=[item for item in report if item.finding.node == path],
    )


def _way(context: Context, state: WrittenState) -> tuple[str, ...]:
    before, entry = context.routes.before, (state.outer_full, "")
    return path_to(before, entry, context.plain_paths) if entry in before else ()


def _entries(context: Context, state: WrittenState) -> dict[tuple[str, str], None]:
    """The states, with outcomes, after which a state is entered."""
    routes, view = context.routes, context.written
    entry = (state.outer_full, "")
    found: dict[tuple[str, str], None] = {}
    for full, outcome in routes.before:
        if not view.is_whole(full) or entry not in routes.after((full, outcome)):
            continue
        name = view.states[view.state(full)].name
        found[name if outcome else "", outcome] = None
    return found


def _in_script(context: Context, path: str, outcome: str, arrival: Arrival) -> Arrival:
    """Where an outcome of the state at a path leads, with paths of the script."""
    view = context.written
    through = [(path, outcome)]
    for inner, end in arrival.through:
        shown = (view.state(inner), end)
        if view.is_whole(inner) and shown != through[-1]:
            through.append(shown)
    return Arrival(tuple(through[1:]), view.state(arrival.target))


def state_text(state: StateExplanation) -> tuple[str, list[Paragraph]]:
    """A headline and its paragraphs."""
    node = state.node
    outer = state.written.outer
    lines = [f"{article(kind(node))}{place(node.span)}"]
    lines += [_badge_text(badge) for badge in state.written.badges]
    lines += [f"from the sub-script called at {call}" for call in node.via]
    if outer.doc:
        lines.append(" ".join(outer.doc.split()))
    return f"state {state.path}", [
        ("is", lines),
        ("holds", list(_held(node))),
        ("reads", [_read(read) for read in state.reads]),
        ("writes", [_written(node, write) for write in state.writes]),
        ("claims", list(state.claims)),
        ("entered", list(_entered(state))),
        (
            "left",
            [_left(state, exit_) for exit_ in state.exits] or ["never: it has no outcome"],
        ),
        ("found", [_found(item) for item in state.report] or ["nothing"]),
    ]


def _badge_text(badge: Badge) -> str:
    """What a field of the state does, in words."""
    if badge.field == "catches":
        return f"an exception ends it with {badge.outcome}"
    what = "item" if badge.field == "for_each" else "try"
    again = f", the next {what} after {' or '.join(badge.again)}" if badge.again else ""
    return f"with `{badge.field}`: {badge.text}{again}"


def kind(node: Node) -> str:
    """The state type, for a container its class."""
    if isinstance(node, Leaf):
        return node.type or "state that could not be read"
    return type(node).__name__


def _held(node: Node) -> Iterator[str]:
    if isinstance(node, Leaf):
        for variable in node.variables:
            yield f"{variable.name} = {print_data(variable.value.data)}"
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
    container = state.path.rpartition("/")[0].rpartition("/")[2]
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
    again = [f"the next {leaving.again}"] if leaving.again else []
    places = [step.span for step in leaving.steps if step.origin == "written"]
    where = place(places[0]) if places else ""
    if leaving.arrivals:
        arrivals = (_arrival(state.node, arrival) for arrival in leaving.arrivals)
        ways = " or ".join(dict.fromkeys([*again, *arrivals]))
        return f"on {leaving.outcome}: {ways}{where}"
    if again:
        return f"on {leaving.outcome}: {again[0]}"
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
        "doc": state.written.outer.doc,
        "at": at(node.span),
        "called": [at(call) for call in node.via],
        "reads": [_key_json(read) for read in state.reads],
        "writes": [_key_json(write) for write in state.writes],
        "claims": list(state.claims),
        "entered": [{"after": name, "outcome": outcome} for name, outcome in state.entered],
        "way": list(state.way),
        "reachable": state.reachable,
        "exits": [_exit_json(exit_) for exit_ in state.exits],
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
        **({"next": leaving.again} if leaving.again else {}),
        "leads": [
            {"through": [list(pair) for pair in arrival.through], "to": arrival.target}
            for arrival in arrivals
        ],
    }
