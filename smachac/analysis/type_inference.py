"""Type inference: the types of all userdata of a machine, and the type clashes.

Every key of every container, and every input, output and variable of a leaf, is a *cell*. A value
originates in a cell (a preset, a declared output, a result of code) and flows along links, which
are the remaps, from cell to cell. A value that arrives at a cell with a declared type must fit it,
and has the declared type from there on; literals keep their own type, so that a list of six numbers
differs from one of seven at every cell.

Linked cells without a declaration are one type variable. Its type fits everything that is written
to it and can be read as every type that reads it; it is `any` where nothing is known.

The result is not stored in the machine: a node holds what the script declares, so that the text of
a machine is parsed to the same machine.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Mapping, Sequence
from functools import cached_property, reduce
from typing import Literal, TypeAlias

from smachac.analysis.data_types import type_of_data
from smachac.analysis.received_types import received_types
from smachac.analysis.type_lattice import (
    NONE,
    Misfit,
    is_unknown,
    item_of,
    join,
    joined,
    meet,
    misfit,
    settled,
    widened,
)
from smachac.analysis.uses import place_of
from smachac.diagnostics.source import NOWHERE, Span
from smachac.ir import nodes
from smachac.ir.leaf import functions, key_names, variable_of
from smachac.ir.nodes import Container, Data, Expression, Key, Leaf, Machine, Node, Struct, Variable
from smachac.ir.traversal import outer_inputs, outer_outputs
from smachac.ir.types import ANY, Type
from smachac.records import dataclass, field

TYPE_CHECKING = False  # annotations only: most machines have no messages
if TYPE_CHECKING:
    from smachac.ir.message_types import Definitions

MOST_FLOWS = 64
"""The most values of one type that are distinguished in one cell."""

MOST_ROUNDS = 20
"""The most times that one computation is typed again because its inputs have changed."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Types:
    """The types of a machine.

    `keys` maps the path of a container and a key of its userdata to the key's type; `inputs` and
    `outputs` do so for leaves, under their own names. `constants` are the literals that reach a
    cell with a declared type and fit it. `cells` are the keys of containers and the inputs of
    leaves, with the flows that arrive there. `every` are all cells, `readers` the computations that
    read them.
    """

    clashes: tuple[Clash, ...]
    constants: tuple[TypeFlow, ...]
    every: Sequence[Cell] = field(repr=False)
    readers: Readers = field(repr=False)

    @property
    def keys(self) -> Mapping[tuple[str, str], Type]:
        return self._by_role["scope"]

    @property
    def inputs(self) -> Mapping[tuple[str, str], Type]:
        return self._by_role["input"]

    @property
    def outputs(self) -> Mapping[tuple[str, str], Type]:
        return self._by_role["output"]

    @cached_property
    def cells(self) -> Mapping[tuple[str, str], Cell]:
        roles = ("scope", "input")
        return {(cell.path, cell.key): cell for cell in self.every if cell.role in roles}

    @cached_property
    def _by_role(self) -> Mapping[Role, Mapping[tuple[str, str], Type]]:
        """The types of the cells by role, path and key: of a correct machine few are needed."""
        found: dict[Role, dict[tuple[str, str], Type]] = {
            role: {} for role in ("scope", "input", "output", "variable")
        }
        types = key_types(self.every, self.readers)
        for cell in self.every:
            found[cell.role].setdefault((cell.path, cell.key), types.get(cell) or cell.declared)
        return found

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


class _ContainerCells:
    """The cells of one container's userdata, each made at the first use of its key."""

    def __init__(self, run: _Inference, path: str, node: Container) -> None:
        self.run = run
        self.path = path
        self.node = node
        self.cells: dict[str, Cell] = {}

    def at(self, key: str, span: Span | None = None) -> Cell:
        cell = self.cells.get(key)
        if cell is None:
            cell = self.run.cell(self.path, key, "scope", self.node, span or self.node.span)
            self.cells[key] = cell
        return cell


class _Inference:
    """The cells of one machine, and the worklist of flows."""

    def __init__(self) -> None:
        self.cells: list[Cell] = []
        self.rounds: dict[Computation, int] = {}
        self.todo: deque[TypeFlow] = deque()
        self.computations: list[Computation] = []
        self.readers: dict[Cell, list[Computation]] = {}
        self.open: list[_ContainerCells] = []
        self.clashes: dict[tuple[object, ...], Clash] = {}
        self.constants: list[TypeFlow] = []
        self.literals: set[tuple[Cell, Span, Type, Data]] = set()
        self.definitions: Definitions = {}
        self.preset_lists: set[str] = set()

    def read(self, machine: Machine) -> None:
        self.definitions = machine.definitions
        for held in machine.variables:
            self.variable(held, machine.root.name, None)
        stack: list[tuple[str, Node, _ContainerCells | None]] = [
            (machine.root.name, machine.root, None)
        ]
        while stack:
            path, node, around = stack.pop()
            if not isinstance(node, Leaf):
                scope = self.container(path, node, around)
                stack.extend(
                    [
                        (f"{path}/{child.name}", child, scope)
                        for child in node.children[::-1]
                        if not isinstance(child, Leaf) or _has_types(child)
                    ]
                )
            elif around is not None:
                self.leaf(path, node, around)

    def cell(self, path: str, key: str, role: Role, node: Node | None, span: Span) -> Cell:
        made = Cell(path, key, role, node, span)
        self.cells.append(made)
        return made

    def declare(self, cell: Cell, type_: Type, span: Span) -> None:
        """Declare the type of a cell. A second declaration must fit the first."""
        if is_unknown(type_):
            return
        if cell.declared == ANY:
            cell.declared, cell.span = type_, span
        flow = TypeFlow(type_, "declared", span, cell)
        if cell.flows:
            self.arrive(flow)
        else:
            self.keep(flow)

    def literal(self, cell: Cell, data: Data, span: Span) -> None:
        type_ = type_of_data(data)
        which = cell, span, type_, data
        if which in self.literals:
            return
        self.literals.add(which)
        self.arrive(TypeFlow(type=type_, how="value", span=span, cell=cell, value=data))

    def variable(self, held: Variable, path: str, node: Node | None) -> None:
        if not is_unknown(held.type) and not _is_quoted_function(held):
            cell = self.cell(path, held.name, "variable", node, held.span)
            cell.declared = held.type
            self.literal(cell, held.value.data, held.value.span)

    def leaf(self, path: str, leaf: Leaf, around: _ContainerCells) -> None:
        inputs: dict[str, Cell] = {}
        if leaf.open:
            self.open.append(around)
        for key, outer in zip(leaf.inputs, outer_inputs(leaf), strict=True):
            cell = self.cell(path, key.name, "input", leaf, place_of(leaf, key))
            self.declare(cell, key.type, cell.span)
            around.at(outer).links.append(cell)
            inputs[key.name] = cell
        written = _written(leaf)
        received = received_types(leaf, self.definitions) if self.definitions else {}
        if isinstance(around.node, nodes.Iterator):
            # Its child writes every key as it is (docs/semantics.md, Iterator).
            for name in sorted(written.keys() - {key.name for key in leaf.outputs}):
                self.unknown(around.at(name))
        for key, outer in zip(leaf.outputs, outer_outputs(leaf), strict=True):
            cell = self.cell(path, key.name, "output", leaf, place_of(leaf, key))
            cell.links.append(around.at(outer))
            self.declare(cell, key.type, cell.span)
            if key.name in written:
                for span, data in written[key.name]:
                    if isinstance(data, Expression) and not leaf.stand_in:
                        from smachac.analysis.expression_types import keys_read

                        reads = {k: inputs[k] for k in keys_read(data) if k in inputs}
                        self.computation(
                            Computation(cell=cell, span=span, reads=reads, expression=data)
                        )
                    else:
                        self.literal(cell, data, span)
            elif key.name in received:
                type_ = received[key.name]
                self.arrive(TypeFlow(type=type_, how="computed", span=cell.span, cell=cell))
            elif is_unknown(key.type):
                self.arrive(TypeFlow(type=ANY, how="declared", span=cell.span, cell=cell))
        for held in leaf.variables:
            self.variable(held, path, leaf)

    def container(
        self, path: str, node: Container, around: _ContainerCells | None
    ) -> _ContainerCells:
        scope = _ContainerCells(self, path, node)
        for key, outer in zip(node.inputs, outer_inputs(node), strict=True):
            inner = scope.at(key.name, place_of(node, key))
            self.declare(inner, key.type, declaration_of(node, key))
            if around is not None:
                around.at(outer).links.append(inner)
            else:
                self.unknown(inner)
        for preset in node.userdata:
            cell = scope.at(preset.key, preset.span)
            self.declare(cell, preset.type, preset.span)
            if isinstance(preset.value.data, tuple):
                self.preset_lists.add(preset.key)
            self.literal(cell, preset.value.data, preset.value.span)
        for key, outer in zip(node.outputs, outer_outputs(node), strict=True):
            inner = scope.at(key.name, place_of(node, key))
            self.declare(inner, key.type, declaration_of(node, key))
            if around is not None:
                inner.links.append(around.at(outer))
        if isinstance(node, nodes.Iterator):
            self.iterator(node, scope)
        return scope

    def iterator(self, node: nodes.Iterator, scope: _ContainerCells) -> None:
        """The items flow into the cell of the item key."""
        item = scope.at(node.item_key)
        if node.items_key:
            source = scope.at(node.items_key)
            self.computation(
                Computation(cell=item, span=node.span, reads={node.items_key: source}, items=True)
            )
        elif node.items is not None:
            items, span = node.items.data, node.items.span
            if isinstance(items, Expression):
                from smachac.analysis.expression_types import keys_read

                reads = {key: scope.at(key) for key in keys_read(items)}
                computation = Computation(
                    cell=item, span=span, reads=reads, expression=items, items=True
                )
                self.computation(computation)
            elif isinstance(items, tuple):
                is_key = len(items) == 1 and isinstance(items[0], str)
                is_key = is_key and items[0] in self.preset_lists
                for value in () if is_key else items:  # SM305 or SM306: the key is meant
                    self.literal(item, value, span)
            else:
                self.unknown(item)

    def computation(self, computation: Computation) -> None:
        self.computations.append(computation)
        for cell in computation.reads.values():
            self.readers.setdefault(cell, []).append(computation)
        if not computation.reads:
            self.compute(computation)

    def unknown(self, cell: Cell) -> None:
        """A value of unknown type can flow into a cell."""
        if cell.declared == ANY:
            self.arrive(TypeFlow(type=ANY, how="declared", span=cell.span, cell=cell))

    # Propagation

    def open_up(self) -> None:
        """What may come where nothing is known: from code that reads a key which nothing known
        sets, and from states without an interface, which may write every key around them."""
        for computation in self.computations:
            if any(cell.holds is None for cell in computation.reads.values()):
                self.unknown(computation.cell)
        for scope in self.open:
            for cell in scope.cells.values():
                self.unknown(cell)
        self.propagate()

    def propagate(self) -> None:
        while self.todo:
            flow = self.todo.popleft()
            for link in flow.cell.links:
                self.arrive(flow.moved_to(link))
            if not flow.judged:
                for computation in self.readers.get(flow.cell, ()):
                    self.compute(computation)

    def arrive(self, flow: TypeFlow) -> None:
        """A value arrives at a cell: it is checked, stored, and queued if it is new."""
        cell = flow.cell
        own = flow.how == "declared" and flow.before is None and flow.type == cell.declared
        if not own and cell.declared != ANY:
            found = misfit(flow.type, cell.declared)
            if found is not None and (found.kind == "length" or not flow.judged):
                self.clash(Clash(flow=flow, cell=cell, misfit=found))
            if found is not None or flow.how != "value":
                return
            self.constants.append(flow)
            flow = flow.accepted()
        self.keep(flow)

    def keep(self, flow: TypeFlow) -> None:
        """A value that fits its cell is stored, and queued if it is new."""
        cell, mark = flow.cell, flow.mark
        if mark in cell.flows:
            cell.flows[mark].append(flow)
            return
        if len(cell.flows) >= MOST_FLOWS:
            cell.kinds = cell.kinds or {_kind(flow[0]) for flow in cell.flows.values()}
            if _kind(flow) in cell.kinds:
                return
            cell.kinds.add(_kind(flow))
        cell.flows[mark] = [flow]
        if not flow.judged:
            # Nothing, written before the run, stands where something is to come.
            if cell.holds is None or cell.holds == NONE:
                cell.holds = flow.type
            elif flow.type != NONE:
                cell.holds = join(cell.holds, flow.type)
        self.todo.append(flow)

    def clash(self, clash: Clash) -> None:
        """Keep a clash, but not its like on the way back of a key that goes in and out."""
        origin, cell = clash.flow.origin, clash.cell
        ends = frozenset([(origin.cell.path, origin.cell.key), (cell.path, cell.key)])
        which = origin if origin.how == "value" else None
        self.clashes.setdefault((ends, which), clash)

    def compute(self, computation: Computation) -> None:
        """Type a piece of code again, once all that it reads is known of."""
        held = {key: cell.holds for key, cell in computation.reads.items()}
        known = {key: type_ for key, type_ in held.items() if type_ is not None}
        rounds = self.rounds[computation] = self.rounds.get(computation, 0) + 1
        if len(known) < len(held) or rounds > MOST_ROUNDS:
            return
        if computation.expression is not None:
            from smachac.analysis.expression_errors import always_fails
            from smachac.analysis.expression_types import type_of_call

            type_ = type_of_call(computation.expression, known)
            if type_ == ANY and always_fails(computation.expression, known):
                return
        else:
            (type_,) = known.values()
        if computation.items:
            type_ = item_of(type_)
        self.arrive(
            TypeFlow(type=type_, how="computed", span=computation.span, cell=computation.cell)
        )

    # Results

    def result(self) -> Types:
        return Types(
            clashes=tuple(self.clashes.values()),
            constants=tuple(self.constants),
            every=self.cells,
            readers=self.readers,
        )


def _is_quoted_function(held: Variable) -> bool:
    """Whether a function in a variable is written as text (SM316)."""
    data = held.value.data
    is_function = held.role in ("function", "duration")
    return is_function and isinstance(data, str) and data.lstrip().startswith("lambda")


def _kind(flow: TypeFlow) -> Type:
    """The type of a flow, for literals as a script would write it."""
    return widened(flow.type) if flow.how == "value" else flow.type


def _has_types(leaf: Leaf) -> bool:
    """Whether the values that a leaf reads and writes may have types."""
    return bool(leaf.variables or leaf.inputs or leaf.outputs or leaf.open)


def _written(leaf: Leaf) -> dict[str, list[tuple[Span, Data]]]:
    """The values that the script gives to the outputs of a leaf, by key: results of callbacks, for
    keys that nothing else writes, and data of steps."""
    found: dict[str, list[tuple[Span, Data]]] = {}
    if not leaf.variables:
        return found
    callbacks = functions(leaf, "callbacks")
    if callbacks:
        others = {key.name for key in leaf.outputs} - key_names(leaf.outputs, "result")
        for key, code in callbacks.items():
            if key not in others:
                found.setdefault(key, []).append((code.span, code))
    held = variable_of(leaf, "steps")
    if held is None or not isinstance(held.value.data, tuple):
        return found
    for step in held.value.data:
        values = dict(step.entries).get("set") if isinstance(step, Struct) else None
        for key, data in values.entries if isinstance(values, Struct) else ():
            found.setdefault(key, []).append((held.value.span, data))
    return found


Readers: TypeAlias = "Mapping[Cell, Sequence[Computation]]"
"""The computations that read a cell."""


def key_types(cells: Sequence[Cell], readers: Readers) -> dict[Cell, Type]:
    """The types of the cells without a declaration. Linked ones have one type."""
    groups = Groups()
    free = [cell for cell in cells if cell.declared == ANY]
    for cell in free:
        for link in cell.links:
            if link.declared == ANY:
                groups.unite(cell, link)
    of = {cell: groups.of(cell) for cell in free}
    read = _read(of, readers)
    written: dict[Cell, set[Type]] = {group: set() for group in of.values()}
    for cell, group in of.items():
        written[group].update(
            [alike[0].type for alike in cell.flows.values() if not alike[0].judged]
        )
    types = {
        group: settled(joined(found), _common(read.get(group, ())))
        for group, found in written.items()
    }
    return {cell: types[group] for cell, group in of.items()}


def _read(groups: Mapping[Cell, Cell], readers: Readers) -> dict[Cell, set[Type]]:
    """The types that the readers of each group require; the readers of an item require a list.
    `groups` are the groups of the cells without a declaration."""
    read: dict[Cell, set[Type]] = {}
    for cell, group in groups.items():
        wanted = [link.declared for link in cell.links if link.declared != ANY]
        if wanted:
            read.setdefault(group, set()).update(wanted)
    for cell, group in groups.items() if readers else ():
        for computation in readers.get(cell, ()):
            if computation.items and computation.expression is None:
                item = computation.cell.declared
                if item == ANY:
                    item = _common(read.get(groups[computation.cell], ()))
                if item != ANY:
                    read.setdefault(group, set()).add(Type("list", (item,)))
    return read


def _common(types: Collection[Type]) -> Type:
    """The type that can be read as all of these; `any` where there is none."""
    return reduce(meet, sorted(types, key=repr) if len(types) > 1 else types, ANY)


class Groups:
    """Union-find over cells: each set has one representative."""

    def __init__(self) -> None:
        self.parent: dict[Cell, Cell] = {}

    def of(self, member: Cell) -> Cell:
        root = member
        while (above := self.parent.get(root, root)) is not root:
            root = above
        while member is not root:
            self.parent[member], member = root, self.parent[member]
        return root

    def unite(self, one: Cell, other: Cell) -> None:
        self.parent[self.of(one)] = self.of(other)


Role: TypeAlias = Literal["scope", "input", "output", "variable"]


@dataclass(slots=True, eq=False)
class Cell:
    """A cell that holds values: a key of a container (`scope`) or of a leaf, or a variable.

    `path` and `node` are those of the state; a variable of the base has no node. `span` is where
    the script names it. `declared` is the declared type, or `any`. `kinds` are the types of its
    flows, from the time that there are MOST_FLOWS.
    """

    path: str
    key: str
    role: Role
    node: Node | None
    span: Span
    declared: Type = ANY
    links: list[Cell] = field(default_factory=list, repr=False)
    flows: dict[tuple[object, ...], list[TypeFlow]] = field(default_factory=dict, repr=False)
    kinds: set[Type] | None = field(default=None, repr=False)
    holds: Type | None = None


@dataclass(slots=True, eq=False)
class TypeFlow:
    """A typed value that has arrived at a cell. Nobody changes it; it is not frozen, because a
    frozen one takes four times as long to make.

    `how`: the script gives a literal (`value`), the cell declares it, or code computes it.
    `before` is the same value one link earlier, `first` where the value came to be (none: here).
    `judged`: a declaration on the way accepted it.
    """

    type: Type
    how: Literal["value", "declared", "computed"]
    span: Span
    cell: Cell
    value: Data = None
    before: TypeFlow | None = None
    first: TypeFlow | None = None
    judged: bool = False

    @property
    def mark(self) -> tuple[object, ...]:
        """The identity of a flow within its cell; of flows with one mark, one is propagated."""
        return self.type, self.judged, (self.first or self) if self.how == "value" else None

    @property
    def origin(self) -> TypeFlow:
        """The flow where the value originates."""
        return self.first or self

    def accepted(self) -> TypeFlow:
        """The same value after a declaration has accepted it."""
        return TypeFlow(
            type=self.type,
            how=self.how,
            span=self.span,
            cell=self.cell,
            value=self.value,
            before=self.before,
            first=self.first,
            judged=True,
        )

    def moved_to(self, cell: Cell) -> TypeFlow:
        """The same value one link later."""
        return TypeFlow(
            self.type, self.how, self.span, cell, self.value, self, self.first or self, self.judged
        )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Clash:
    """A value that does not fit the cell where it arrives; `misfit` are the innermost types."""

    flow: TypeFlow
    cell: Cell
    misfit: Misfit


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Computation:
    """An expression whose value flows into a cell; `reads` are the cells of the keys it reads.

    `items`: the items of the value of the expression, or of the one cell read, flow into the cell.
    """

    cell: Cell
    span: Span
    reads: Mapping[str, Cell]
    expression: Expression | None = None
    items: bool = False


def declaration_of(node: Container, key: Key) -> Span:
    """The span of the declaration of a key, also in a sub-script."""
    return key.span if key.span.source is not NOWHERE.source else place_of(node, key)
