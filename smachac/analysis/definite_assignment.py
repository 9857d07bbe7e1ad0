"""Definite assignment: the userdata keys that are surely set at each state of the hierarchy.

Keys are only ever added to a container's userdata (docs/semantics.md, Userdata). So a key is
surely set at a vertex if and only if every path from the container's start writes it. Each
container is analysed once, inner ones first, as if nothing were passed in: an input that is set at
its entry is set everywhere in it. The summary of a container is the keys that it needs and the keys
that it writes. Linear in the number of states; sets of keys are bits of integers.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from collections.abc import Set as AbstractSet
from dataclasses import dataclass

from smachac.analysis.accesses import (
    ANYTHING,
    NONE,
    NOTHING,
    Writes,
    leaf_reads,
    leaf_writes,
    userdata_fields,
)
from smachac.analysis.fixpoint import (
    KeyStep,
    KeySteps,
    Order,
    flow_order,
    looping,
    may_be_set,
    may_be_unset,
)
from smachac.ir import nodes
from smachac.ir.graph import START, Vertex, edges, exit_vertex, stopped_endings
from smachac.ir.nodes import Concurrence, Container, Expression, Leaf, Machine, Node, OutcomeRule
from smachac.ir.traversal import PREEMPTED, containers, ends_preempted, outcome_names, remapping


@dataclass(frozen=True, slots=True, kw_only=True)
class UserdataScope:
    """A container with its own userdata.

    `held` are the keys that are set before it starts; `inputs` and `outputs` map its own names to
    those of the container around it; `optional` inputs may be absent. `vertices` are the reachable
    ones, `steps` lead on from each, `reads` are the keys that each needs, and `unset` are those of
    them that can be unset if nothing is passed in. `needed` inputs are read inside before they are
    written; `endings` are the keys around it that each outcome sets. `inner` are the containers
    inside, `again` those of them that a path can enter again.
    """

    path: str
    container: Container
    children: Mapping[str, Node]
    held: frozenset[str]
    inputs: Mapping[str, str]
    optional: frozenset[str]
    outputs: Mapping[str, str]
    reads: Mapping[Vertex, tuple[str, ...]]
    steps: KeySteps
    vertices: AbstractSet[Vertex]
    unset: Mapping[Vertex, tuple[str, ...]]
    needed: frozenset[str]
    endings: Mapping[str, Writes]
    inner: frozenset[str]
    again: frozenset[Vertex]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class DataFlow:
    """The userdata scopes of a machine by path, parents before children.

    `entered` are the paths of states and containers that can be entered, `repeated` the containers
    that can be entered more than once.
    """

    machine: Machine
    scopes: Mapping[str, UserdataScope]
    entered: frozenset[str]
    repeated: frozenset[str]


def data_flow(machine: Machine) -> DataFlow:
    """The data flow of userdata in a machine."""
    found: dict[str, UserdataScope] = {}
    for path, container in reversed(list(containers(machine.root))):
        found[path] = _scope(path, container, found, machine.root)
    entered = {machine.root.name}
    repeated: set[str] = set()
    scopes = {path: found[path] for path, _ in containers(machine.root)}
    for path, scope in scopes.items():
        if path not in entered:
            continue
        entered.update(f"{path}/{vertex}" for vertex in scope.vertices if isinstance(vertex, str))
        repeated.update(
            f"{path}/{name}"
            for name in scope.inner
            if name in scope.vertices and (name in scope.again or path in repeated)
        )
    return DataFlow(
        machine=machine,
        scopes=scopes,
        entered=frozenset(entered),
        repeated=frozenset(repeated),
    )


def _scope(
    path: str, container: Container, inner: Mapping[str, UserdataScope], root: Container
) -> UserdataScope:
    names = remapping(container)
    inputs = {key.name: names.get(key.name, key.name) for key in container.inputs}
    held = {preset.key for preset in container.userdata}
    if container is root:
        held |= inputs.keys()
    optional = frozenset(k.name for k in container.inputs if k.type.name == "optional")
    outputs = {key.name: names.get(key.name, key.name) for key in container.outputs}
    reads: dict[Vertex, tuple[str, ...]] = {START: _items_read(container)}
    raw = isinstance(container, nodes.Iterator)
    # Of two states of one name (SM106) the first counts, everywhere.
    children = {child.name: child for child in reversed(container.children)}
    containing = frozenset(name for name, c in children.items() if not isinstance(c, Leaf))
    for child in reversed(children.values()):
        reads[child.name] = _reads(child, inner.get(f"{path}/{child.name}"), raw)
    steps = _steps(path, container, inner)
    order = flow_order(steps)
    asked = {
        vertex: [key for key in keys if key not in held] for vertex, keys in reads.items() if keys
    }
    unset = may_be_unset(asked, steps, order)
    needed = {
        key for keys in unset.values() for key in keys if key in inputs and key not in optional
    }
    return UserdataScope(
        path=path,
        container=container,
        children={child.name: child for child in reversed(container.children)},
        held=frozenset(held),
        inputs=inputs,
        optional=optional,
        outputs=outputs,
        reads={vertex: keys for vertex, keys in reads.items() if keys},
        steps=steps,
        vertices=order.keys(),
        unset=unset,
        needed=frozenset(needed),
        endings=_with_caught(container, _endings(outputs, held, steps, order)),
        inner=containing,
        again=looping(steps, order) & containing if containing else frozenset(),
    )


def _endings(
    outputs: Mapping[str, str], held: AbstractSet[str], steps: KeySteps, order: Order
) -> Mapping[str, Writes]:
    """The keys around a container that each possible outcome sets (docs/semantics.md, Userdata)."""
    exits = [vertex for vertex in order if isinstance(vertex, tuple) and vertex != START]
    if not outputs:
        return {vertex[1]: NOTHING for vertex in exits}
    open_keys = [key for key in outputs if key not in held]
    asked: dict[Vertex, list[str]] = dict.fromkeys(exits, open_keys)
    unsure = may_be_unset(asked, steps, order, sure=True)
    untrusted = may_be_unset(asked, steps, order)
    possible = may_be_set(asked, steps, order)

    def outer(missing: Iterable[str]) -> frozenset[str]:
        """What the outputs that are not missing are called outside."""
        return frozenset(outputs[key] for key in outputs.keys() - set(missing))

    return {
        vertex[1]: Writes(
            outer(unsure.get(vertex, ())),
            outer(untrusted.get(vertex, ())),
            outer(set(open_keys).difference(possible.get(vertex, ()))),
        )
        for vertex in exits
    }


def _with_caught(container: Container, found: Mapping[str, Writes]) -> Mapping[str, Writes]:
    """The endings of a container with that of an exception, which copies no output."""
    if not container.catches:
        return found
    known = found.get(container.catches, NOTHING)
    return {**found, container.catches: Writes(perhaps=known.perhaps)}


def _items_read(container: Container) -> tuple[str, ...]:
    """The keys that an iterator reads to get its items."""
    if not isinstance(container, nodes.Iterator):
        return ()
    if container.items_key:
        return (container.items_key,)
    if container.items is not None and isinstance(container.items.data, Expression):
        fields = userdata_fields(container.items.data.text)
        return tuple(key for key in fields.read if key not in fields.tested) if fields else ()
    return ()


def _reads(child: Node, scope: UserdataScope | None, raw: bool) -> tuple[str, ...]:
    """The keys of its container that a child needs at its entry."""
    names = remapping(child)
    own: tuple[str, ...]
    if isinstance(child, Leaf):
        own = leaf_reads(child, raw=raw)
    else:
        own = tuple(key for key in scope.inputs if key in scope.needed) if scope else ()
    return tuple(dict.fromkeys(names.get(key, key) for key in own))


def child_writes(
    child: Node, scope: UserdataScope | None, outcome: str, *, raw: bool
) -> Writes | None:
    """The keys of its container that a child has set when it ends so; None where it never does."""
    if not isinstance(child, Leaf):
        return scope.endings.get(outcome) if scope else NOTHING
    writes = leaf_writes(child, outcome, raw=raw)
    names = remapping(child)
    if not names:
        return writes
    sure, trusted, perhaps = (frozenset(names.get(key, key) for key in keys) for keys in writes[:3])
    return Writes(sure, trusted, perhaps, writes.anything)


def _steps(path: str, container: Container, inner: Mapping[str, UserdataScope]) -> KeySteps:
    """The steps of a container, those of a concurrence being its start, its children and ends."""
    children = {child.name: child for child in reversed(container.children)}
    raw = isinstance(container, nodes.Iterator)
    known: dict[tuple[str, str], Writes | None] = {}

    def writes(name: str, outcome: str) -> Writes | None:
        key = (name, outcome)
        if key not in known:
            scope = inner.get(f"{path}/{name}")
            known[key] = child_writes(children[name], scope, outcome, raw=raw)
        return known[key]

    found: dict[Vertex, list[KeyStep]] = {}
    if isinstance(container, Concurrence):
        for target, together in joined(container, writes):
            found.setdefault(START, []).append(KeyStep(target, "", together))
        return {vertex: tuple(steps) for vertex, steps in found.items()}
    if isinstance(container, nodes.Iterator):
        for child in container.children[:1]:
            for outcome, result in stopped_endings(container).items():
                stopped = writes(child.name, outcome)
                if stopped is not None and result in outcome_names(container):
                    step = KeyStep(exit_vertex(result), outcome, stopped)
                    found.setdefault(child.name, []).append(step)
    for edge in edges(container):
        given: Writes | None = NOTHING
        if isinstance(edge.source, str):
            given = writes(edge.source, edge.outcome)
        if given is None:
            continue
        if isinstance(container, nodes.Iterator) and isinstance(edge.target, str):
            item = frozenset([container.item_key])
            given = Writes(given[0] | item, given[1] | item, given[2] | item, given[3])
        found.setdefault(edge.source, []).append(KeyStep(edge.target, edge.outcome, given))
    return {vertex: tuple(steps) for vertex, steps in found.items()}


ChildEndings = Mapping[str, Writes]
"""The outcomes that a child can have, with its writes on each; `*` is any outcome."""

ANY_OUTCOME = "*"

MOST_ROUNDS = 10
"""The most passes over the rules to exclude outcomes of children."""

MOST_WORK = 5_000_000
"""The most rules times keys: beyond it the writes of all rules are joined, which is sound."""


def joined(
    container: Concurrence, writes: Callable[[str, str], Writes | None]
) -> Iterator[tuple[Vertex, Writes]]:
    """Where a concurrence goes from its start: into each child, and to each outcome.

    With an outcome comes what all children together have written. They all run to their end, also
    where the first to end preempts the others: `join` makes no difference.
    """
    every = {child.name: _child_endings(child, writes) for child in container.children}
    yield from ((name, NOTHING) for name in every)
    if not all(every.values()):
        return
    exits = frozenset(outcome_names(container))
    base = _Base(every)
    exact = len(container.rules) * len(base.perhaps) <= MOST_WORK
    ways = [(rule.outcome, _given(every, rule)) for rule in container.rules]
    ways.append((container.default_outcome, _otherwise(every, container.rules)))
    if ends_preempted(container):
        ways.append((PREEMPTED, {}))
    for outcome, left in ways:
        if outcome in exits and left is not None:
            yield exit_vertex(outcome), base.writes(left if exact else {})


def _child_endings(child: Node, writes: Callable[[str, str], Writes | None]) -> ChildEndings:
    is_open = isinstance(child, Leaf) and child.open
    found = (
        (name, writes(child.name, name))
        for name in outcome_names(child) or (ANY_OUTCOME,) * is_open
    )
    endings = {name: written for name, written in found if written is not None}
    return {ANY_OUTCOME: next(iter(endings.values()), ANYTHING)} if is_open else endings


def _either(several: Iterable[Writes]) -> Writes:
    """The join of several writes: one of them happens."""
    ways = list(several)
    return Writes(
        frozenset.intersection(*(each.sure for each in ways)),
        frozenset.intersection(*(each.trusted for each in ways)),
        frozenset.union(*(each.perhaps for each in ways)),
        all(each.anything for each in ways),
    )


class _Base:
    """What the children write whichever outcome they have, and with fewer outcomes left."""

    def __init__(self, every: Mapping[str, ChildEndings]) -> None:
        self._every = every
        self._of = {name: _either(endings.values()) for name, endings in every.items()}
        self._sure = NONE.union(*(each.sure for each in self._of.values()))
        self._trusted = NONE.union(*(each.trusted for each in self._of.values()))
        self.perhaps = Counter(key for each in self._of.values() for key in each.perhaps)
        self._anything = any(each.anything for each in self._of.values())

    def writes(self, left: Mapping[str, ChildEndings]) -> Writes:
        """What is written when the children in `left` have one of those outcomes.

        Fewer outcomes write more for sure, and less perhaps.
        """
        fewer = {name: _either(endings.values()) for name, endings in left.items()}
        lost = Counter(
            key for name, writes in fewer.items() for key in self._of[name].perhaps - writes.perhaps
        )
        never = frozenset(key for key, times in lost.items() if times == self.perhaps[key])
        return Writes(
            self._sure.union(*(each.sure for each in fewer.values())),
            self._trusted.union(*(each.trusted for each in fewer.values())),
            frozenset(self.perhaps).difference(never),
            self._anything,
        )


def _given(every: Mapping[str, ChildEndings], rule: OutcomeRule) -> dict[str, ChildEndings] | None:
    """The outcomes left to children when a rule matches; None where it never does."""
    left: dict[str, ChildEndings] = {}
    for condition in rule.when:
        known = left.get(condition.child) or every.get(condition.child, {})
        writes = known.get(condition.outcome) or known.get(ANY_OUTCOME)
        if writes is None:
            return None
        left[condition.child] = {condition.outcome: writes}
    return left


def _otherwise(
    every: Mapping[str, ChildEndings], rules: tuple[OutcomeRule, ...]
) -> dict[str, ChildEndings] | None:
    """The outcomes left to children when no rule matches; None where one always does.

    A rule with one condition that is not certain, beside others that are, shows an outcome that
    the child did not have. Rules say more together than that; what is left out here is safe.
    """
    left: dict[str, ChildEndings] = {}
    conditions = [{(each.child, each.outcome) for each in rule.when} for rule in rules if rule.when]
    for _ in range(MOST_ROUNDS):
        before = sum(map(len, left.values())), len(left)
        for pairs in conditions:
            unsure = [
                (child, outcome)
                for child, outcome in pairs
                if (left.get(child) or every.get(child, {})).keys() != {outcome}
            ]
            if not unsure:
                return None
            child, outcome = unsure[0]
            known = left.get(child) or every.get(child, {})
            if len(unsure) == 1 and outcome in known:
                left[child] = {name: each for name, each in known.items() if name != outcome}
        if before == (sum(map(len, left.values())), len(left)):
            break
    return left
