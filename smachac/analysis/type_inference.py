"""The types of userdata, inferred over a whole machine, and where they clash.

Every key of every container, and every input, output and variable of a leaf, is a *place*. A value
comes to be in a place (a preset, a declared output, a result of code) and is carried along links,
which are the remaps, from place to place. What a place declares is asked of all that arrives
there, and stands for it from there on; literals are carried through, so that a list of six numbers
is told from one of seven wherever it ends up.

Places without a declaration that are linked are one type variable. Its type is what fits whatever
is written to it and can be read as whatever reads it; `any` where nothing is known.

The result is kept beside the machine and not in it: a node says what the script declares, so that
the text of a machine is read again as the same machine.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import reduce
from typing import Literal, TypeAlias

from smachac.analysis.expression_errors import always_fails
from smachac.analysis.expression_types import keys_read, type_of_call, type_of_data
from smachac.analysis.type_lattice import (
    NONE,
    Misfit,
    is_open,
    item_of,
    join,
    joined,
    meet,
    misfit,
    settled,
    widened,
)
from smachac.diagnostics.source import NOWHERE, Span
from smachac.ir import nodes
from smachac.ir.leaf import variable
from smachac.ir.nodes import Container, Data, Expression, Key, Leaf, Machine, Node, Struct, Variable
from smachac.ir.traversal import remapping
from smachac.ir.types import ANY, Type

MOST_FLOWS = 64
"""Values of one type that are told apart in one place."""

MOST_ROUNDS = 20
"""Times that one piece of code is typed anew as more becomes known of what it reads."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Types:
    """What is known of a machine's types.

    `keys` maps the path of a container and a key of its userdata to the key's type; `inputs` and
    `outputs` do so for leaves, under their own names. `constants` are the literals that reach a
    place with a declared type and fit it. `places` are the keys of containers and the inputs of
    leaves, with what arrives there.
    """

    keys: Mapping[tuple[str, str], Type]
    inputs: Mapping[tuple[str, str], Type]
    outputs: Mapping[tuple[str, str], Type]
    clashes: tuple[Clash, ...] = ()
    constants: tuple[Flow, ...] = ()
    places: Mapping[tuple[str, str], Place] = field(default_factory=dict, repr=False)

    def names(self, path: str, leaf: Leaf) -> dict[str, Type]:
        """The types of the keys that code of a leaf reads (see `type_of_call`)."""
        return {key.name: self.inputs[path, key.name] for key in leaf.inputs}


def infer(machine: Machine) -> Types:
    """The types of all userdata of a machine. Iterative; linear in the machine's size but for keys
    that many states write with values of different types."""
    run = _Inference()
    run.read(machine)
    run.propagate()
    run.open_up()
    return run.result()


class _Scope:
    """The userdata of one container: its keys as they are first met."""

    def __init__(self, run: _Inference, path: str, node: Container) -> None:
        self.run = run
        self.path = path
        self.node = node
        self.places: dict[str, Place] = {}

    def at(self, key: str, span: Span | None = None) -> Place:
        if key not in self.places:
            place = self.run.place(self.path, key, "scope", self.node, span or self.node.span)
            self.places[key] = place
        return self.places[key]


class _Inference:
    """The places of one machine, and what is still to be carried along."""

    def __init__(self) -> None:
        self.places: list[Place] = []
        self.rounds: dict[int, int] = {}
        self.todo: deque[Flow] = deque()
        self.codes: list[Code] = []
        self.open: list[_Scope] = []
        self.clashes: dict[tuple[object, ...], Clash] = {}
        self.constants: list[Flow] = []

    def read(self, machine: Machine) -> None:
        for held in machine.variables:
            self.variable(held, machine.root.name, None)
        stack: list[tuple[str, Node, _Scope | None]] = [(machine.root.name, machine.root, None)]
        while stack:
            path, node, around = stack.pop()
            if not isinstance(node, Leaf):
                scope = self.container(path, node, around)
                stack.extend((f"{path}/{each.name}", each, scope) for each in node.children[::-1])
            elif around is not None:
                self.leaf(path, node, around)

    def place(self, path: str, key: str, role: Role, node: Node | None, span: Span) -> Place:
        made = Place(path=path, key=key, role=role, node=node, span=span)
        self.places.append(made)
        return made

    def declare(self, place: Place, type_: Type, span: Span) -> None:
        """Say what a place holds. A second declaration is asked to fit the first."""
        if is_open(type_):
            return
        if place.declared == ANY:
            place.declared, place.span = type_, span
        self.arrive(Flow(type=type_, how="declared", span=span, place=place))

    def literal(self, place: Place, data: Data, span: Span) -> None:
        type_ = type_of_data(data)
        self.arrive(Flow(type=type_, how="value", span=span, place=place, value=data))

    def variable(self, held: Variable, path: str, node: Node | None) -> None:
        if not is_open(held.type):
            place = self.place(path, held.name, "variable", node, held.span)
            place.declared = held.type
            self.literal(place, held.value.data, held.value.span)

    def leaf(self, path: str, leaf: Leaf, around: _Scope) -> None:
        names = remapping(leaf)
        inputs: dict[str, Place] = {}
        if leaf.open:
            self.open.append(around)
        for key in leaf.inputs:
            place = self.place(path, key.name, "input", leaf, place_of(leaf, key))
            self.declare(place, key.type, place.span)
            around.at(names.get(key.name, key.name)).links.append(place)
            inputs[key.name] = place
        written = _written(leaf)
        if isinstance(around.node, nodes.Iterator):
            # Its child writes every key as it is (smach-semantics I7).
            for name in sorted(written.keys() - {key.name for key in leaf.outputs}):
                self.unknown(around.at(name))
        for key in leaf.outputs:
            place = self.place(path, key.name, "output", leaf, place_of(leaf, key))
            place.links.append(around.at(names.get(key.name, key.name)))
            self.declare(place, key.type, place.span)
            if key.name in written:
                for span, data in written[key.name]:
                    if isinstance(data, Expression) and leaf.type in _BY_CODE:
                        reads = {k: inputs[k] for k in keys_read(data) if k in inputs}
                        self.code(Code(place=place, span=span, reads=reads, expression=data))
                    else:
                        self.literal(place, data, span)
            elif is_open(key.type):
                self.arrive(Flow(type=ANY, how="declared", span=place.span, place=place))
        for held in leaf.variables:
            self.variable(held, path, leaf)

    def container(self, path: str, node: Container, around: _Scope | None) -> _Scope:
        scope = _Scope(self, path, node)
        names = remapping(node)
        for key in node.inputs:
            inner = scope.at(key.name, place_of(node, key))
            self.declare(inner, key.type, inner.span)
            if around is not None:
                around.at(names.get(key.name, key.name)).links.append(inner)
            else:
                self.unknown(inner)
        for preset in node.userdata:
            place = scope.at(preset.key, preset.span)
            self.declare(place, preset.type, preset.span)
            self.literal(place, preset.value.data, preset.value.span)
        for key in node.outputs:
            inner = scope.at(key.name, place_of(node, key))
            self.declare(inner, key.type, place_of(node, key))
            if around is not None:
                inner.links.append(around.at(names.get(key.name, key.name)))
        if isinstance(node, nodes.Iterator):
            self.iterator(node, scope)
        return scope

    def iterator(self, node: nodes.Iterator, scope: _Scope) -> None:
        """The key that holds each item gets what the items are."""
        item = scope.at(node.item_key)
        if node.items_key:
            source = scope.at(node.items_key)
            self.code(Code(place=item, span=node.span, reads={node.items_key: source}, items=True))
        elif node.items is not None:
            items, span = node.items.data, node.items.span
            if isinstance(items, Expression):
                reads = {key: scope.at(key) for key in keys_read(items)}
                code = Code(place=item, span=span, reads=reads, expression=items, items=True)
                self.code(code)
            elif isinstance(items, tuple):
                for each in items:
                    self.literal(item, each, span)
            else:
                self.unknown(item)

    def code(self, code: Code) -> None:
        self.codes.append(code)
        for place in code.reads.values():
            place.readers.append(code)
        if not code.reads:
            self.compute(code)

    def unknown(self, place: Place) -> None:
        """Say that a place may get what nothing is known of."""
        if place.declared == ANY:
            self.arrive(Flow(type=ANY, how="declared", span=place.span, place=place))

    # Carrying along

    def open_up(self) -> None:
        """What may come where nothing is known: from code that reads a key which nothing known
        sets, and from states without an interface, which may write every key around them."""
        for code in self.codes:
            if any(place.holds is None for place in code.reads.values()):
                self.unknown(code.place)
        for scope in self.open:
            for place in scope.places.values():
                self.unknown(place)
        self.propagate()

    def propagate(self) -> None:
        while self.todo:
            flow = self.todo.popleft()
            for link in flow.place.links:
                self.arrive(replace(flow, place=link, before=flow))
            if not flow.judged:
                for code in flow.place.readers:
                    self.compute(code)

    def arrive(self, flow: Flow) -> None:
        """A value comes to a place: it is judged, kept, and will be carried on if it is new."""
        place = flow.place
        own = flow.how == "declared" and flow.before is None and flow.type == place.declared
        if place.declared != ANY and not own:
            found = misfit(flow.type, place.declared)
            if found is not None and (found.kind == "length" or not flow.judged):
                self.clash(Clash(flow=flow, place=place, misfit=found))
            if found is not None or flow.how != "value":
                return
            self.constants.append(flow)
            flow = replace(flow, judged=True)
        mark = flow.mark
        if mark in place.flows:
            place.flows[mark].append(flow)
            return
        kind = widened(flow.type) if flow.how == "value" else flow.type
        if len(place.flows) >= MOST_FLOWS and kind in place.kinds:
            return
        place.flows[mark] = [flow]
        place.kinds.add(kind)
        if not flow.judged:
            # Nothing, written before the run, stands where something is to come.
            if place.holds is None or place.holds == NONE:
                place.holds = flow.type
            elif flow.type != NONE:
                place.holds = join(place.holds, flow.type)
        self.todo.append(flow)

    def clash(self, clash: Clash) -> None:
        """Keep a clash, but not its like on the way back of a key that goes in and out."""
        origin, place = clash.flow.origin, clash.place
        ends = frozenset([(origin.place.path, origin.place.key), (place.path, place.key)])
        which = (origin.span, id(origin.value)) if origin.how == "value" else None
        self.clashes.setdefault((ends, which), clash)

    def compute(self, code: Code) -> None:
        """Type a piece of code again, once all that it reads is known of."""
        held = {key: place.holds for key, place in code.reads.items()}
        known = {key: type_ for key, type_ in held.items() if type_ is not None}
        rounds = self.rounds[id(code)] = self.rounds.get(id(code), 0) + 1
        if len(known) < len(held) or rounds > MOST_ROUNDS:
            return
        if code.expression is not None:
            type_ = type_of_call(code.expression, known)
            if type_ == ANY and always_fails(code.expression, known):
                return
        else:
            (type_,) = known.values()
        if code.items:
            type_ = item_of(type_)
        self.arrive(Flow(type=type_, how="computed", span=code.span, place=code.place))

    # What is known in the end

    def result(self) -> Types:
        found: dict[Role, dict[tuple[str, str], Type]] = {
            role: {} for role in ("scope", "input", "output", "variable")
        }
        types = key_types(self.places)
        for place in self.places:
            found[place.role].setdefault((place.path, place.key), types[id(place)])
        return Types(
            keys=found["scope"],
            inputs=found["input"],
            outputs=found["output"],
            clashes=tuple(self.clashes.values()),
            constants=tuple(self.constants),
            places={
                (place.path, place.key): place
                for place in self.places
                if place.role in ("scope", "input")
            },
        )


_BY_CODE = ("CallbacksState", "DeleteFileState", "RandomOutcomeState")
"""State types that write nothing but what functions of the script give, and `outcome`."""


def _written(leaf: Leaf) -> dict[str, list[tuple[Span, Data]]]:
    """What the script itself says that leaves of some built-in types write, by key."""
    found: dict[str, list[tuple[Span, Data]]] = {}
    if leaf.type in _BY_CODE:
        callbacks = variable(leaf, "callbacks")
        for key, data in callbacks.entries if isinstance(callbacks, Struct) else ():
            own = key == "outcome" and leaf.type == "RandomOutcomeState"
            if isinstance(data, Expression) and not own:
                found.setdefault(key, []).append((data.span, data))
    elif leaf.type == "ScriptedState":
        for held in leaf.variables:
            steps = held.value.data if held.name == "steps" else ()
            for step in steps if isinstance(steps, tuple) else ():
                told = dict(step.entries).get("set") if isinstance(step, Struct) else None
                for key, data in told.entries if isinstance(told, Struct) else ():
                    found.setdefault(key, []).append((held.value.span, data))
    return found


def key_types(places: list[Place]) -> dict[int, Type]:
    """The type of each place by `id`. Linked places without a declaration have one type."""
    groups = Groups()
    for place in places:
        for link in place.links:
            if place.declared == ANY and link.declared == ANY:
                groups.unite(id(place), id(link))
    read = _read(places, groups)
    written: dict[int, set[Type]] = {}
    for place in places:
        fresh = (alike[0].type for alike in place.flows.values() if not alike[0].judged)
        written.setdefault(groups.of(id(place)), set()).update(fresh)
    types = {
        group: settled(joined(found), _common(read.get(group, ())))
        for group, found in written.items()
    }
    return {
        id(place): types[groups.of(id(place))] if place.declared == ANY else place.declared
        for place in places
    }


def _read(places: list[Place], groups: Groups) -> dict[int, set[Type]]:
    """What the readers of each group ask for; those of an item ask for a list of such."""
    read: dict[int, set[Type]] = {}
    for place in places:
        wanted = (link.declared for link in place.links if link.declared != ANY)
        read.setdefault(groups.of(id(place)), set()).update(wanted)
    for place in places:
        for code in place.readers:
            if code.items and code.expression is None:
                item = code.place.declared
                if item == ANY:
                    item = _common(read.get(groups.of(id(code.place)), ()))
                if item != ANY:
                    read[groups.of(id(place))].add(Type("list", (item,)))
    return read


def _common(types: Iterable[Type]) -> Type:
    """The type that can be read as all of these; `any` where there is none."""
    return reduce(meet, sorted(types, key=repr), ANY)


class Groups:
    """Sets that are united step by step; each has one member that stands for it."""

    def __init__(self) -> None:
        self.parent: dict[int, int] = {}

    def of(self, member: int) -> int:
        root = member
        while (above := self.parent.get(root, root)) != root:
            root = above
        while member != root:
            self.parent[member], member = root, self.parent[member]
        return root

    def unite(self, one: int, other: int) -> None:
        self.parent[self.of(one)] = self.of(other)


Role: TypeAlias = Literal["scope", "input", "output", "variable"]


@dataclass(slots=True, eq=False, kw_only=True)
class Place:
    """Where a value can be: a key of a container (`scope`), or one of a leaf, or a variable.

    `path` and `node` are those of the state; a variable of the base has no node. `span` is the
    place in the text that speaks of it. `declared` is `any` where nothing is.
    """

    path: str
    key: str
    role: Role
    node: Node | None
    span: Span
    declared: Type = ANY
    links: list[Place] = field(default_factory=list, repr=False)
    flows: dict[tuple[object, ...], list[Flow]] = field(default_factory=dict, repr=False)
    kinds: set[Type] = field(default_factory=set, repr=False)
    readers: list[Code] = field(default_factory=list, repr=False)
    holds: Type | None = None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Flow:
    """A value that is in a place: its type, and how it came there.

    `how`: the script gives a literal (`value`), the place declares it, or code computes it.
    `before` is the same value one link earlier. `judged`: a declaration on the way accepted it.
    """

    type: Type
    how: Literal["value", "declared", "computed"]
    span: Span
    place: Place
    value: Data = None
    before: Flow | None = None
    judged: bool = False

    @property
    def mark(self) -> tuple[object, ...]:
        """What tells a flow from others in its place; of those alike one is carried along."""
        which = (self.span, id(self.value)) if self.how == "value" else None
        return self.type, self.judged, which

    @property
    def origin(self) -> Flow:
        """The flow where the value came to be."""
        flow = self
        while flow.before is not None:
            flow = flow.before
        return flow


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Clash:
    """A value that arrives where it does not fit; `misfit` are the innermost types."""

    flow: Flow
    place: Place
    misfit: Misfit


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Code:
    """An expression whose type a place gets; `reads` are the places of the keys it names.

    `items`: the place gets the items of what the expression, or the one place, holds.
    """

    place: Place
    span: Span
    reads: Mapping[str, Place]
    expression: Expression | None = None
    items: bool = False


def place_of(node: Node, key: Key) -> Span:
    """Where the script speaks of a key of a state: its declaration, its remap, else the state."""
    if key.span.source is node.span.source and key.span.source is not NOWHERE.source:
        return key.span
    return next((remap.span for remap in node.remaps if remap.key == key.name), node.span)
