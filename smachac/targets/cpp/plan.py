"""The plan of a header: the containers, the types of their keys, and what C++ cannot express."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from collections.abc import Set as AbstractSet

from smachac.analysis.type_inference import infer
from smachac.analysis.type_lattice import inside
from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import NOWHERE, Span
from smachac.ir.nodes import Concurrence, Container, Iterator, Leaf, Machine, Node, StateType
from smachac.ir.script_paths import script_paths
from smachac.ir.secret_keys import secret_keys
from smachac.ir.traversal import OuterNames, containers, outcome_names, remapping, walk
from smachac.ir.types import ANY, Bounds, Type
from smachac.records import dataclass, field, replace
from smachac.targets import comment
from smachac.targets.cpp.bounded import bounded, loose
from smachac.targets.cpp.dialect import BLOCKING, FAULT, STEPPED, Dialect
from smachac.targets.cpp.expressions import Spelling
from smachac.targets.cpp.identifiers import clashes, identifier, outermost
from smachac.targets.cpp.records import RecordNames
from smachac.targets.cpp.types import UnportableError, cpp_literal, cpp_type, plain
from smachac.targets.errors import unsupported_by_target

OTHERWISE = "change this part of the script, or write a class in C++ for the state"
"""The help for a refusal without a help of its own."""

OWN = "own_"
"""The field of a `UserdataView` with the userdata of the container itself; no key has this name."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ContainerScope:
    """A container and its userdata.

    `keys` are the types of its keys by name. `sure` are the keys that hold a value whenever one of
    its states starts. `shared` are the keys that have no object of their own: they are those of the
    container around. `secret` are the keys whose values traces hide. `bounds` are those of a
    stepped machine, in which the types of keys are those of their storage (bounded.py).
    """

    path: str
    node: Container
    keys: Mapping[str, Type]
    sure: frozenset[str]
    shared: frozenset[str] = frozenset()
    secret: AbstractSet[str] = frozenset()
    bounds: Bounds | None = None

    @property
    def dialect(self) -> Dialect:
        return BLOCKING if self.bounds is None else STEPPED

    def key(self, name: str) -> Type:
        """The type of a key. Raises UnportableError where the container cannot have it."""
        if name not in self.keys:
            raise UnportableError(f"`{self.path}` declares no userdata key `{name}`")
        return self.keys[name]

    def read(self, name: str, called: str) -> Spelling:
        """How C++ reads a key that an expression calls `called`; the text may have marks of the
        dialect."""
        spelt, type_ = self.object(name), self.key(name)
        view = ".view()" if type_.name == "text" else ""
        if name in self.sure:
            return Spelling(text=f"{spelt}.unchecked(){view}", type=loose(type_))
        if self.dialect.stepped:
            need = f"smachac::step::need({FAULT}{spelt}, {cpp_literal(called)})"
            return Spelling(text=f"{need}{view}", type=loose(type_))
        return Spelling(text=f"smachac::need({spelt}, {cpp_literal(called)})", type=type_)

    def object(self, name: str) -> str:
        """The object of a key, in the functions of the container and of its states."""
        return f"ud.{'' if name in self.shared else self._own}{identifier(name)}"

    @property
    def view(self) -> tuple[str, ...]:
        """The shared keys, in the order of the view's fields."""
        return tuple(key for key in self.keys if key in self.shared)

    def userdata_of(self, child: Node) -> str:
        """The userdata of a container in this one."""
        return f"ud.{self._own}{member(child)}"

    @property
    def _own(self) -> str:
        return f"{OWN}." if self.shared else ""

    @property
    def userdata_type(self) -> str:
        """The type of `ud` in the functions of the container and of its states."""
        return "const UserdataView &" if self.shared else "Userdata &"

    def names(self, child: Node) -> OuterNames:
        """The keys of the container by those of a child. The child of an iterator has no
        remapping."""
        return OuterNames() if isinstance(self.node, Iterator) else remapping(child)


@dataclass(slots=True, kw_only=True)
class Plan:
    """A machine with its scopes by path, parents before children; `report` holds the refusals.
    `paths` are the paths of the script by full path, where they differ: events have them. `bounds`
    are those of a stepped machine; a blocking one has none. `names` are those of the records."""

    machine: Machine
    names: RecordNames
    scopes: Mapping[str, ContainerScope]
    paths: Mapping[str, str]
    report: Report = field(default_factory=list)
    bounds: Bounds | None = None

    @property
    def dialect(self) -> Dialect:
        return BLOCKING if self.bounds is None else STEPPED

    def refuse(self, span: Span, error: UnportableError, *names: str) -> None:
        """Add a refusal to the report; `names` are the state or the keys that it is about."""
        names = (*names, *error.names)
        help = error.help or OTHERWISE
        self.report.append(unsupported_by_target(span, "C++", str(error), help, names))


def plan(machine: Machine, bounds: Bounds | None = None, names: RecordNames | None = None) -> Plan:
    """The plan of a machine; names and types that C++ cannot express are refused. `bounds` make it
    a stepped one; `names` are those of records."""
    scopes: dict[str, ContainerScope] = {}
    paths = script_paths(machine.root)
    names = names or RecordNames(stepped=bounds is not None)
    found = Plan(machine=machine, names=names, scopes=scopes, paths=paths, bounds=bounds)
    keys = _types(found)
    machine = found.machine = replace(machine, state_types=_state_types(found))
    secret = secret_keys(machine)
    catching: set[str] = set()
    for path, node in containers(machine.root):
        around = scopes.get(path.rpartition("/")[0])
        if node.catches or path.rpartition("/")[0] in catching:
            catching.add(path)
        scope = ContainerScope(
            path=path,
            node=node,
            keys=keys.get(path, {}),
            sure=_sure(node, around),
            secret=secret.get(path, frozenset()),
            bounds=bounds,
        )
        written = _written(node, machine.state_types)
        scope = replace(scope, shared=_shared(scope, around, written, path in catching))
        scopes[path] = scope
        _check(found, scope, around)
        if isinstance(node, Concurrence) and node.join == "rule":
            text = "a concurrence that ends with its first rule (`join: rule`)"
            help = "write `join: any` or `join: all`"
            found.refuse(node.span, UnportableError(text, help=help), node.name)
    return found


def _types(found: Plan) -> Mapping[str, Mapping[str, Type]]:
    """The types of all keys by container and key. A type that a stepped machine cannot store is
    refused."""
    nodes = dict(containers(found.machine.root))
    keys: dict[str, dict[str, Type]] = {}
    for (path, key), type_ in sorted(infer(found.machine).keys.items(), key=lambda item: item[0]):
        stored = ANY
        try:
            named = found.names.with_structs(type_)
            stored = plain(named) if found.bounds is None else bounded(named, found.bounds)
        except UnportableError as error:
            refused = UnportableError(f"the key `{key}`: {error}", help=error.help)
            found.refuse(_place_of(nodes[path], key), refused, key)
        keys.setdefault(path, {})[key] = stored
    return keys


def _state_types(found: Plan) -> dict[str, StateType]:
    """The state types with structs in place of records. A record without a name is refused at the
    first state whose class needs one."""
    types = dict(found.machine.state_types)
    for name, type_ in types.items():
        try:
            types[name] = found.names.state_type(type_)
        except UnportableError as error:
            if "cpp" in type_.classes:
                leaf = next(node for _, node in walk(found.machine.root) if node.type == name)
                found.refuse(
                    leaf.span, UnportableError(f"`{name}`: {error}", help=error.help), name
                )
    return types


def _sure(node: Container, around: ContainerScope | None) -> frozenset[str]:
    held = {preset.key for preset in node.userdata}
    if isinstance(node, Iterator):
        held.add(node.item_key)
    if around is not None:
        names = around.names(node)
        held |= {key.name for key in node.inputs if names[key.name] in around.sure}
    return frozenset(held)


def _shared(
    scope: ContainerScope, around: ContainerScope | None, written: AbstractSet[str], caught: bool
) -> frozenset[str]:
    """The keys of a container for which it can use the objects of the container around, with the
    same result as copies. `written` are the keys that something in it may write. `caught`: the
    script goes on after an exception of the container.

    A key that is only an input must not be written inside. One that is an output too has the same
    value outside whenever the container starts or ends, and nobody outside uses it meanwhile; but
    after an exception the value outside would be another one. No other key of the container may be
    the same key outside.
    """
    node = scope.node
    if around is None:
        return frozenset()
    names = around.names(node)
    inputs, outputs = ({key.name for key in keys} for keys in (node.inputs, node.outputs))
    outer = Counter(names[key] for key in inputs | outputs)
    kept = {preset.key for preset in node.userdata}

    def is_shared(key: str) -> bool:
        bound = names[key]
        if outer[bound] > 1 or key in kept:
            return False
        if (key not in scope.keys) or scope.keys[key] != around.keys.get(bound):
            return False
        return key not in written or (key in outputs and not caught)

    return frozenset(filter(is_shared, inputs))


def _written(node: Container, types: Mapping[str, StateType]) -> frozenset[str]:
    """The keys of a container that something in it may write."""
    if isinstance(node, Iterator) and any(isinstance(child, Leaf) for child in node.children):
        # The state of an iterator may write all keys.
        return frozenset(key.name for key in (*node.inputs, *node.outputs)) | {node.item_key}
    found = {node.item_key} if isinstance(node, Iterator) else set()
    for child in node.children:
        names = OuterNames() if isinstance(node, Iterator) else remapping(child)
        outputs = child.outputs
        if isinstance(child, Leaf) and child.type in types:
            outputs += types[child.type].output_keys
        found |= {names[key.name] for key in outputs}
    return frozenset(found)


def _check(plan: Plan, scope: ContainerScope, around: ContainerScope | None) -> None:
    node = scope.node
    for key, type_ in scope.keys.items():
        try:
            cpp_type(type_)
        except UnportableError as error:
            refused = UnportableError(f"the key `{key}`: {error}", help=error.help)
            plan.refuse(_place_of(node, key), refused, key)
    names = [
        *(("state", child.name) for child in node.children),
        *(("key", key) for key in scope.keys),
    ]
    members = [member(child) for child in node.children if not isinstance(child, Leaf)]
    for key in scope.keys:
        if identifier(key) in members:
            text = f"the key `{key}` and a container would both be named `{identifier(key)}`"
            plan.refuse(_place_of(node, key), UnportableError(text), key)
    for kind in ("state", "key"):
        for name, other in clashes(name for what, name in names if what == kind):
            text = f"the {kind}s `{other}` and `{name}` would both be named `{identifier(name)}`"
            plan.refuse(_named(node, name), UnportableError(text), kind, other, name)
    for child in (node, *(child for child in node.children if isinstance(child, Leaf))):
        for name, other in clashes(outcome_names(child)):
            text = f"the outcomes `{other}` and `{name}` would both be named `{identifier(name)}`"
            plan.refuse(child.span, UnportableError(text), "outcome", other, name)
    if around is not None:
        _check_borders(plan, scope, around)
    if isinstance(node, Concurrence):
        _check_races(plan, scope, node)


def _check_races(plan: Plan, scope: ContainerScope, node: Concurrence) -> None:
    """Refuses a key that a branch writes while another reads or writes it, which is undefined in
    C++. An `allow` of the rule for data races does not change this."""
    writers: dict[str, list[Node]] = {}
    readers: dict[str, list[Node]] = {}
    for child in node.children:
        names = scope.names(child)
        for keys, found in ((child.outputs, writers), (child.inputs, readers)):
            for outer in {names[key.name]: None for key in keys}:
                found.setdefault(outer, []).append(child)
    for key, writing in writers.items():
        branches = {child.name: child for child in (*writing, *readers.get(key, ()))}
        if len(branches) > 1:
            one, other = list(branches.values())[:2]
            text = f"the branches `{one.name}` and `{other.name}` use the key `{key}` at the same"
            text += f" time, and `{one.name}` writes it"
            help_ = "remap the key so that each branch has its own"
            plan.refuse(one.span, UnportableError(text, help=help_), key, one.name, other.name)


def _check_borders(plan: Plan, scope: ContainerScope, around: ContainerScope) -> None:
    """Refuses keys that are copied into or out of a container but cannot be converted."""
    names = around.names(scope.node)
    pairs = [(key, around, scope) for key in scope.node.inputs]
    pairs += [(key, scope, around) for key in scope.node.outputs]
    for key, source, target in pairs:
        outer = names[key.name]
        ends = {id(around): outer, id(scope): key.name}
        try:
            given, wanted = source.key(ends[id(source)]), target.key(ends[id(target)])
            if not converts(loose(given), loose(wanted)):
                text = f"the key `{key.name}` is `{given}`, which does not convert to `{wanted}`"
                raise UnportableError(text)
        except UnportableError as error:
            plan.refuse(_place_of(scope.node, key.name), error, key.name)


def converts(given: Type, wanted: Type) -> bool:
    """Whether `smachac::convert` converts one plain type to the other."""
    if given == wanted or wanted == ANY:
        return True
    inner, outer = inside(given), inside(wanted)
    match given.name, wanted.name:
        case "optional", "optional":
            return converts(inner, outer)
        case "optional", _:
            return converts(inner, wanted)
        case "none", "optional":
            return True
        case _, "optional":
            return converts(given, outer)
        case "int", "float":
            return True
        case (("list" | "array"), ("list" | "array")):
            return converts(inner, outer)
        case (("list" | "array"), ("Point" | "Quaternion")):
            return converts(inner, Type("float"))
        case "dict", "dict":
            return converts(inner, outer)
    return False


def _place_of(node: Node, name: str) -> Span:
    presets = node.userdata if not isinstance(node, Leaf) else ()
    for preset in presets:
        if preset.key == name and preset.span.source is node.span.source is not NOWHERE.source:
            return preset.span
    for key in (*node.inputs, *node.outputs):
        if key.name == name and key.span.source is node.span.source is not NOWHERE.source:
            return key.span
    return node.span


def _named(node: Container, name: str) -> Span:
    return next((child.span for child in node.children if child.name == name), node.span)


def place(node: Node) -> str:
    """The place of a state in the script, file name and line; empty if it has none."""
    if node.span.source is NOWHERE.source:
        return ""
    return comment(f"{node.span.source.file_name}:{node.span.line}")


def scope_name(path: str) -> str:
    """The namespace of a container: `pick::LIFT`."""
    first, *others = path.split("/")
    return "::".join([outermost(first), *map(identifier, others)])


def member(child: Node) -> str:
    """The name of a child as a member of the States and the Userdata of its container."""
    name = identifier(child.name)
    return name if isinstance(child, Leaf) else f"{name.rstrip('_')}_"
