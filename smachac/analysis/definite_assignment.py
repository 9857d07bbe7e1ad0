"""Definite assignment: the userdata keys that are surely set at each state of the hierarchy.

Keys are only ever added to a container's userdata (docs/semantics.md, Userdata). So a key is
surely set at a vertex if and only if every path from the container's start writes it. Each
container is analysed once, inner ones first, as if none of its inputs were set: an input that is
set at its entry is set everywhere in it. The summary of a container is the keys that it needs and
the keys that it writes. The time is linear in the number of states; a set of keys is an integer
with one bit for each key (fixpoint.py).
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from collections.abc import Set as AbstractSet
from typing import NamedTuple, Protocol, TypeVar, cast

from smachac.analysis.accesses import (
    ANYTHING,
    NONE,
    NOTHING,
    Writes,
    leaf_reads,
    leaf_writes,
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
from smachac.analysis.uses import KeyUses, items_read
from smachac.diagnostics.source import new_tuple
from smachac.ir import nodes
from smachac.ir.graph import START, Vertex, edges, exit_vertex, stopped_endings, transitions
from smachac.ir.nodes import (
    Concurrence,
    Container,
    Leaf,
    Machine,
    Node,
    OutcomeRule,
)
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import containers, ends_preempted, outcome_names, remapping
from smachac.records import dataclass

T = TypeVar("T")


@dataclass(frozen=True, slots=True, kw_only=True)
class UserdataScope:
    """A container with its own userdata.

    `held`: the keys that are set before it starts. `inputs`, `outputs`: its own names of keys, to
    those of the container around it. `optional`: the inputs that may be unset. `vertices`: the
    reachable vertices. `steps`: the steps from each vertex. `reads`: the keys that each vertex
    needs. `unset`: those of them that can be unset if no input is set. `needed`: the inputs that
    are read inside before they are written. `endings`: for each outcome, the keys of the container
    around it that are set then. `inner`: the names of the containers inside. `again`: those of
    them that a path can enter more than once. `uses`: the uses of its keys. `filled`: it is an
    iterator that surely has items.
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
    uses: KeyUses
    filled: bool = False


class FactOf(Protocol):
    """Computes a fact about the userdata of a container, by its path, or takes a known one."""

    def __call__(
        self, fact: Callable[[UserdataScope], T], path: str, container: UserdataScope
    ) -> T:
        """The fact."""
        ...


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


def data_flow(
    machine: Machine,
    known: Mapping[str, UserdataScope] = {},
    filled: AbstractSet[str] = frozenset(),
) -> DataFlow:
    """The data flow of userdata in a machine. `known` are the scopes of the machine before a
    change: those of containers that have not changed, nor any inside, hold for this machine.
    `filled` are the paths of the iterators that surely have items (filled_lists.py)."""
    found: dict[str, UserdataScope] = {}
    shared: dict[object, object] = {}
    every = list(containers(machine.root))
    for path, container in reversed(every):
        scope = known.get(path)
        same = scope is not None and scope.filled is (path in filled)
        if scope is None or not same or not _is_unchanged(scope, container, found, known):
            filled_here = path in filled
            scope = _scope(path, container, found, machine.root, shared, scope, filled=filled_here)
        found[path] = scope
    entered = {machine.root.name}
    repeated: set[str] = set()
    scopes = {path: found[path] for path, _ in every}
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


def _is_unchanged(
    scope: UserdataScope,
    container: Container,
    found: Mapping[str, UserdataScope],
    known: Mapping[str, UserdataScope],
) -> bool:
    inner = (f"{scope.path}/{name}" for name in scope.inner)
    return scope.container is container and all(found[text] is known[text] for text in inner)


def _scope(
    path: str,
    container: Container,
    inner: Mapping[str, UserdataScope],
    root: Container,
    shared: dict[object, object],
    before: UserdataScope | None,
    *,
    filled: bool,
) -> UserdataScope:
    """The scope of a container; `inner` are those of the containers inside. `filled`: it is an
    iterator that surely has items. `shared` are the sets of keys in other scopes: a machine has few
    different ones. `before` is the scope of the container before a change."""

    def share(value: T) -> T:
        return cast(T, shared.setdefault(value, value))

    names = remapping(container)
    inputs = {key.name: names[key.name] for key in container.inputs}
    held = {preset.key for preset in container.userdata}
    if container is root:
        held |= inputs.keys()
    optional = frozenset(k.name for k in container.inputs if k.type.name == "optional")
    outputs = {key.name: names[key.name] for key in container.outputs}
    reads: dict[Vertex, tuple[str, ...]] = {START: items_read(container)}
    # The state of an iterator uses the userdata of the iterator itself, without a remapping.
    raw = isinstance(container, nodes.Iterator)
    # Of two states of one name (SM106) the first counts, everywhere.
    children = {child.name: child for child in reversed(container.children)}
    scopes = {
        name: inner.get(f"{path}/{name}")
        for name, child in children.items()
        if not isinstance(child, Leaf)
    }
    known = _unchanged_leaves(container, children, before) if before is not None else {}
    reads |= _reads_of(children, scopes, known, raw=raw)
    steps = _steps(container, children, scopes, known, share, filled=filled)
    order = flow_order(steps)
    reads = {vertex: keys for vertex, keys in reads.items() if keys}
    queried: dict[Vertex, list[str]] = {
        vertex: [key for key in keys if key not in held] for vertex, keys in reads.items()
    }
    ends = map(exit_vertex, outcome_names(container))
    exits = [vertex for vertex in ends if vertex in order]
    unheld = [key for key in outputs if key not in held]
    at_end: dict[Vertex, list[str]] = dict.fromkeys(exits, unheld)
    found = may_be_unset(queried | at_end, steps, order)
    unset = {vertex: keys for vertex, keys in found.items() if vertex in queried}
    needed = {
        key for keys in unset.values() for key in keys if key in inputs and key not in optional
    }
    return UserdataScope(
        path=path,
        container=container,
        children=children,
        held=share(frozenset(held)),
        inputs=inputs,
        optional=share(optional),
        outputs=outputs,
        reads=reads,
        steps=steps,
        vertices=order.keys(),
        unset=unset,
        needed=share(frozenset(needed)),
        endings=_with_caught(container, _endings(outputs, at_end, found, steps, order)),
        inner=share(frozenset(scopes)),
        again=looping(steps, order).intersection(scopes) if scopes else NONE,
        uses=KeyUses(path=path, container=container),
        filled=filled,
    )


def _reads_of(
    children: Mapping[str, Node],
    scopes: Mapping[str, UserdataScope | None],
    known: Mapping[str, _LeafFlow],
    *,
    raw: bool,
) -> dict[Vertex, tuple[str, ...]]:
    """The keys of its container that each child needs at its entry, by name, the last child
    first."""
    return {
        name: known[name].reads if name in known else _reads(child, scopes.get(name), raw)
        for name, child in reversed([*children.items()])
        if name in known or child.inputs or raw
    }


class _LeafFlow(NamedTuple):
    """The keys that a leaf needs, and the steps from it."""

    reads: tuple[str, ...]
    steps: tuple[KeyStep, ...]


def _unchanged_leaves(
    container: Container, children: Mapping[str, Node], before: UserdataScope
) -> Mapping[str, _LeafFlow]:
    """The leaves of a container that are the same objects as before a change, by name. Their flow
    is the same if the container leads to the same names."""
    if (
        not isinstance(container, nodes.StateMachine | nodes.Sequence)
        or children.keys() != before.children.keys()
        or len(container.children) > len(children)
        or outcome_names(container) != outcome_names(before.container)
    ):
        return {}
    return {
        name: _LeafFlow(before.reads.get(name, ()), before.steps.get(name, ()))
        for name, child in children.items()
        if child is before.children[name] and isinstance(child, Leaf)
    }


def _endings(
    outputs: Mapping[str, str],
    unheld: Mapping[Vertex, list[str]],
    without_trusted: Mapping[Vertex, tuple[str, ...]],
    steps: KeySteps,
    order: Order,
) -> Mapping[str, Writes]:
    """The keys around a container that each possible outcome sets (docs/semantics.md, Userdata).

    `unheld`: at each exit the outputs that are not set before the container starts;
    `without_trusted`: those of them that can be unset if trusted writes count.
    """
    if not outputs:
        return {vertex[1]: NOTHING for vertex in unheld}
    without_sure = without_trusted
    written = [step.writes for leading in steps.values() for step in leading]
    if any(_is_trusted(writes) for writes in written if writes is not NOTHING):
        without_sure = may_be_unset(unheld, steps, order, sure=True)
    perhaps = may_be_set(unheld, steps, order)

    def outer(missing: Iterable[str]) -> frozenset[str]:
        """The outputs that are not missing, by their names in the container around."""
        return frozenset(outputs[key] for key in outputs.keys() - set(missing))

    return {
        vertex[1]: Writes(
            outer(without_sure.get(vertex, ())),
            outer(without_trusted.get(vertex, ())),
            outer(set(keys).difference(perhaps.get(vertex, ()))),
        )
        for vertex, keys in unheld.items()
    }


def _is_trusted(writes: Writes) -> bool:
    """Whether some of these writes are trusted, but not sure."""
    return writes.anything or writes.sure != writes.trusted


def _with_caught(container: Container, found: Mapping[str, Writes]) -> Mapping[str, Writes]:
    """The endings of a container, and its ending by an exception, which copies no output."""
    if not container.catches:
        return found
    known = found.get(container.catches, NOTHING)
    return {**found, container.catches: Writes(perhaps=known.perhaps)}


def _reads(child: Node, scope: UserdataScope | None, raw: bool) -> tuple[str, ...]:
    """The keys of its container that a child needs at its entry."""
    names = remapping(child)
    own: tuple[str, ...]
    if isinstance(child, Leaf):
        own = leaf_reads(child, raw=raw)
    else:
        own = tuple(key for key in scope.inputs if key in scope.needed) if scope else ()
    return tuple(dict.fromkeys([names[key] for key in own] if names else own))


def child_writes(
    child: Node, scope: UserdataScope | None, outcome: str, *, raw: bool
) -> Writes | None:
    """The keys of its container that a child has set when it ends with `outcome`; None if it never
    ends with it."""
    if not isinstance(child, Leaf):
        return scope.endings.get(outcome) if scope else NOTHING
    writes = leaf_writes(child, outcome, raw=raw)
    if writes is NOTHING or not child.remaps:
        return writes
    names = remapping(child)
    sure, trusted, perhaps = (frozenset([names[key] for key in keys]) for keys in writes[:3])
    return Writes(sure, trusted, perhaps, writes.anything)


def _steps(
    container: Container,
    children: Mapping[str, Node],
    scopes: Mapping[str, UserdataScope | None],
    known: Mapping[str, _LeafFlow],
    share: Callable[[Writes], Writes],
    *,
    filled: bool,
) -> KeySteps:
    """The steps of a container; those of a concurrence lead from its start to each child and to
    each of its outcomes. `scopes`: those of the containers inside, `known`: see
    `_unchanged_leaves`. One that is `filled` has no step from its start past its child."""
    raw = isinstance(container, nodes.Iterator)

    def writes(name: str, outcome: str) -> Writes | None:
        given = child_writes(children[name], scopes.get(name), outcome, raw=raw)
        return given if given is None or given is NOTHING else share(given)

    found: defaultdict[Vertex, list[KeyStep]] = defaultdict(list)
    match container:
        case Concurrence():
            for target, written in _concurrence_steps(container, writes):
                found[START].append(KeyStep(target, "", written))
        case nodes.Iterator():
            for vertex, made in _iterator_steps(container, writes, filled=filled):
                found[vertex].append(made)
        case _:
            # The others write nothing, whatever their outcome is.
            writers = {
                child.name
                for child in container.children
                if child.outputs or not isinstance(child, Leaf) or child.open
            }
            if container.initial in children:
                found[START].append(KeyStep(container.initial, "", NOTHING))
            for child, leads in transitions(container, known):
                name = child.name
                if name in known and known[name].steps:
                    found[name] += known[name].steps
                for target, step in leads:
                    given = writes(name, step.outcome) if name in writers else NOTHING
                    if given is not None:
                        found[name].append(new_tuple(KeyStep, (target, step.outcome, given)))
    return {vertex: tuple(steps) for vertex, steps in found.items()}


def _iterator_steps(
    container: nodes.Iterator, writes: Callable[[str, str], Writes | None], *, filled: bool
) -> Iterator[tuple[Vertex, KeyStep]]:
    """The steps of an iterator, each with the vertex that it leads from: first those after a
    request to stop. The step to its child sets the item."""
    for child in container.children[:1]:
        for outcome, result in stopped_endings(container).items():
            stopped = writes(child.name, outcome)
            if stopped is not None and result in outcome_names(container):
                yield child.name, KeyStep(exit_vertex(result), outcome, stopped)
    item = frozenset([container.item_key])
    for source, target, outcome, _, _ in edges(container):
        if filled and source == START and not isinstance(target, str):
            continue
        given = writes(source, outcome) if isinstance(source, str) else NOTHING
        if given is None:
            continue
        if isinstance(target, str):
            given = Writes(
                given.sure | item,
                given.trusted | item,
                given.perhaps | item,
                given.anything or not container.item_key,
            )
        yield source, KeyStep(target, outcome, given)


ChildEndings = Mapping[str, Writes]
"""The outcomes that a child can have, with its writes on each; `*` is any outcome."""

ANY_OUTCOME = "*"

MOST_ROUNDS = 10
"""The most passes over the rules to exclude outcomes of children."""

MOST_WORK = 5_000_000
"""The most rules times keys. Beyond it every rule gets the writes for any outcomes of the children,
which is sound."""


def _concurrence_steps(
    container: Concurrence, writes: Callable[[str, str], Writes | None]
) -> Iterator[tuple[Vertex, Writes]]:
    """The steps from the start of a concurrence: to each child, and to each outcome.

    The step to an outcome writes what all children together have written. All children run to their
    ends, also if the first to end preempts the others, so `join` makes no difference.
    """
    every = {child.name: _child_endings(child, writes) for child in container.children}
    yield from ((name, NOTHING) for name in every)
    if not all(every.values()):
        return
    exits = frozenset(outcome_names(container))
    together = _ChildrenTogether(every)
    exact = len(container.rules) * len(together.perhaps) <= MOST_WORK
    ways = [(rule.outcome, _left_by_rule(every, rule)) for rule in container.rules]
    ways.append((container.default_outcome, _left_by_no_rule(every, container.rules)))
    if ends_preempted(container):
        ways.append((PREEMPTED, {}))
    for outcome, left in ways:
        if outcome in exits and left is not None:
            yield exit_vertex(outcome), together.writes(left if exact else {})


def _child_endings(child: Node, writes: Callable[[str, str], Writes | None]) -> ChildEndings:
    """The endings of one child of a concurrence. Those of a child with unknown outcomes are one."""
    has_no_interface = isinstance(child, Leaf) and child.open
    found = (
        (name, writes(child.name, name))
        for name in outcome_names(child) or (ANY_OUTCOME,) * has_no_interface
    )
    endings = {name: written for name, written in found if written is not None}
    return {ANY_OUTCOME: next(iter(endings.values()), ANYTHING)} if has_no_interface else endings


def _either(several: Iterable[Writes]) -> Writes:
    """The writes of one of several steps, when it is not known which of them is taken."""
    ways = list(several)
    return Writes(
        frozenset.intersection(*(way.sure for way in ways)),
        frozenset.intersection(*(way.trusted for way in ways)),
        frozenset.union(*(way.perhaps for way in ways)),
        all(way.anything for way in ways),
    )


class _ChildrenTogether:
    """The writes of all children of a concurrence together, when all or fewer of their outcomes are
    possible.

    Kept for all outcomes, so that a rule costs only the children that it names.
    """

    def __init__(self, every: Mapping[str, ChildEndings]) -> None:
        self._all = {name: _either(endings.values()) for name, endings in every.items()}
        self._sure = NONE.union(*(writes.sure for writes in self._all.values()))
        self._trusted = NONE.union(*(writes.trusted for writes in self._all.values()))
        self.perhaps = Counter(key for writes in self._all.values() for key in writes.perhaps)
        self._anything = any(writes.anything for writes in self._all.values())

    def writes(self, left: Mapping[str, ChildEndings]) -> Writes:
        """The writes when each child in `left` has one of the outcomes there.

        With fewer possible outcomes more keys are surely written, and fewer are possibly written.
        """
        fewer = {name: _either(endings.values()) for name, endings in left.items()}
        lost = Counter(
            key
            for name, writes in fewer.items()
            for key in self._all[name].perhaps - writes.perhaps
        )
        never = frozenset(key for key, times in lost.items() if times == self.perhaps[key])
        return Writes(
            self._sure.union(*(writes.sure for writes in fewer.values())),
            self._trusted.union(*(writes.trusted for writes in fewer.values())),
            frozenset(self.perhaps).difference(never),
            self._anything,
        )


def _left_by_rule(
    every: Mapping[str, ChildEndings], rule: OutcomeRule
) -> dict[str, ChildEndings] | None:
    """The outcomes that the children of a rule can have when it matches; None if it never does."""
    left: dict[str, ChildEndings] = {}
    for condition in rule.when:
        known = left.get(condition.child) or every.get(condition.child, {})
        writes = known.get(condition.outcome) or known.get(ANY_OUTCOME)
        if writes is None:
            return None
        left[condition.child] = {condition.outcome: writes}
    return left


def _left_by_no_rule(
    every: Mapping[str, ChildEndings], rules: tuple[OutcomeRule, ...]
) -> dict[str, ChildEndings] | None:
    """The outcomes that children can have when no rule matches; None if a rule always matches.

    If all conditions of a rule but one surely hold and the rule does not match, the child of that
    condition has not ended with its outcome. Several rules together can exclude more outcomes; to
    exclude fewer is sound.
    """
    left: dict[str, ChildEndings] = {}
    conditions = [
        {(condition.child, condition.outcome) for condition in rule.when}
        for rule in rules
        if rule.when
    ]
    for _ in range(MOST_ROUNDS):
        before = sum(map(len, left.values())), len(left)
        for pairs in conditions:
            open_ = [
                (child, outcome)
                for child, outcome in pairs
                if (left.get(child) or every.get(child, {})).keys() != {outcome}
            ]
            if not open_:
                return None
            child, outcome = open_[0]
            known = left.get(child) or every.get(child, {})
            if len(open_) == 1 and outcome in known:
                left[child] = {name: writes for name, writes in known.items() if name != outcome}
        if before == (sum(map(len, left.values())), len(left)):
            break
    return left
