"""The header of a machine: a namespace for each container, inner containers first.

A namespace has the outcomes, the userdata, the types and objects of the states, their places and
the function that runs the container.
"""

from __future__ import annotations

from collections.abc import Mapping
from collections.abc import Set as AbstractSet
from typing import NamedTuple

from smachac.ir.nodes import Iterator, Leaf, Machine, Node
from smachac.ir.traversal import walk
from smachac.records import dataclass, field, replace
from smachac.targets import COMMENT_WIDTH, comment_lines, made_by, stem
from smachac.targets.cpp.bounded import most_bytes
from smachac.targets.cpp.builtin_states import LeafCode, built_in, enumeration
from smachac.targets.cpp.containers import ContainerPlan, Lines, execute, parts, results
from smachac.targets.cpp.identifiers import identifier
from smachac.targets.cpp.plan import OWN, ContainerScope, Plan, member, place, scope_name
from smachac.targets.cpp.records import key_types, script_structs
from smachac.targets.cpp.step_containers import RESERVED, StepPlan, requests, states_members, step
from smachac.targets.cpp.step_machine import machine_class, node_table
from smachac.targets.cpp.types import UnportableError, cpp_literal, cpp_type, cpp_value
from smachac.targets.cpp.user_classes import (
    ClassCode,
    argument,
    assertions,
    class_code,
    class_leaf,
    named_apart,
    named_classes,
)
from smachac.targets.errors import no_code_for_target

STRICT = """// A class with more outcomes than its interface is an error at every warning level.
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic error "-Wswitch"
#endif"""
LENIENT = """#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif"""
"""The pragmas before and after containers with classes of the user."""


class Header(NamedTuple):
    """The text of a header, the constructor parameters of the machine's States, and the headers of
    the user's classes that it includes."""

    text: str
    parameters: tuple[str, ...]
    classes: tuple[str, ...]


def header_of(plan: Plan, *, with_records: bool = True) -> Header:
    """The header of a machine. Everything that C++ cannot express is added to the plan's report;
    the header is empty then. `with_records`: with the structs for the types of the script."""
    numbers = {path: number for number, (path, _) in enumerate(walk(plan.machine.root))}
    printing = _Printing(plan=plan, classes=_classes(plan.machine), numbers=numbers)
    if plan.report and plan.bounds is not None:
        return Header("", (), ())  # without storage for all keys, nothing else can be judged
    blocks = [
        "\n".join(_container(printing, scope)) for scope in reversed(list(plan.scopes.values()))
    ]
    _refuse_missing(plan, printing.missing)
    _refuse_names(plan, printing.classes)
    if plan.report:
        # A class whose types are refused has no assertions.
        return Header("", (), ())
    codes = list(printing.classes.values())
    runtime = "smachac/step.hpp" if plan.dialect.stepped else "smachac/smachac.hpp"
    types = [type_ for scope in plan.scopes.values() for type_ in scope.keys.values()]
    types += [type_ for code in codes for type_ in key_types(code.type)]
    records = script_structs(plan.names, plan.bounds, types) if with_records else []
    included = [runtime, *(code.header for code in codes), *plan.names.headers(types)]
    included += [plan.names.header] if plan.names.project else []
    headers = sorted(set(included))
    classes = tuple(header for header in headers if not header.startswith("smachac/"))
    made = f"// {made_by(plan.machine)}\n#pragma once"
    includes = "\n".join(f'#include "{header}"' for header in headers)
    checks = ["\n".join(assertions(code, plan.bounds)) for code in codes]
    catching = next((node for _, node in walk(plan.machine.root) if node.catches), None)
    if catching is not None and not plan.dialect.stepped:
        includes += f"\n\n{_needs_exceptions(catching)}"
    blocks = [*records, *blocks]
    if codes:
        blocks = [STRICT, *checks, *blocks, LENIENT]
    text = "\n\n".join([made, includes, *blocks]) + "\n"
    return Header(text, printing.parameters.get(plan.machine.root.name, ()), classes)


def _needs_exceptions(node: Node) -> str:
    """The code that refuses compilers without exceptions, for a state whose exceptions become an
    outcome."""
    message = f"the script catches the exceptions of {identifier(node.name)}"
    message += f"{f' ({place(node)})' if place(node) else ''}: compile with -fexceptions"
    return f"static_assert(smachac::has_exceptions,\n              {cpp_literal(message)});"


@dataclass(slots=True, kw_only=True)
class _Printing:
    """The state that the containers of one header share.

    `classes` are the classes of state types by name. `parameters` are those of the constructor of
    `States`, by path of each container printed so far. `stopping` are the containers in which a
    state receives requests to stop. `missing` are the state types without code. `numbers` are those
    of the nodes of a stepped machine, by path; `sizes` the upper limits on the sizes of its
    containers in bytes, without the objects of the user.
    """

    plan: Plan
    classes: Mapping[str, ClassCode]
    numbers: Mapping[str, int]
    sizes: dict[str, int] = field(default_factory=dict)
    parameters: dict[str, tuple[str, ...]] = field(default_factory=dict)
    stopping: set[str] = field(default_factory=set)
    missing: set[str] = field(default_factory=set)

    def code_of(self, leaf: Leaf, scope: ContainerScope) -> LeafCode | None:
        """The code of a leaf; None if its type has no code for C++. Raises UnportableError."""
        code, number = self.classes.get(leaf.type), self.numbers[f"{scope.path}/{leaf.name}"]
        if code is not None:
            return class_leaf(code, leaf, scope, number)
        return built_in(leaf, scope, self.plan.refuse, number)


def _classes(machine: Machine) -> Mapping[str, ClassCode]:
    """The classes of the state types of a machine, by name. Their constructors have parameters of
    one name only where these have one type."""
    found: dict[str, ClassCode] = {}
    objects: list[str] = []
    for _, node in walk(machine.root):
        type_ = machine.state_types.get(node.type) if isinstance(node, Leaf) else None
        code = class_code(type_) if type_ is not None and node.type not in found else None
        if code is not None:
            parameters = named_apart(code.parameters, objects)
            found[node.type] = replace(code, parameters=parameters)
            objects += parameters
    return found


def _refuse_missing(plan: Plan, types: AbstractSet[str]) -> None:
    """Reports each state type without code, at the first of its states."""
    leaves: dict[str, list[Leaf]] = {}
    for _, node in walk(plan.machine.root):
        if isinstance(node, Leaf) and node.type in types:
            leaves.setdefault(node.type, []).append(node)
    for name, states in leaves.items():
        place = states[0].span
        plan.report.append(no_code_for_target(place, "C++", "cpp", name, len(states)))


def _refuse_names(plan: Plan, classes: Mapping[str, ClassCode]) -> None:
    """Refuses classes, their parameters and their headers that have a name of the header itself, at
    the first state of each type."""
    own = {scope_name(path): scope.node.name for path, scope in plan.scopes.items()}
    header = f"{stem(plan.machine)}.hpp"
    first: dict[str, Leaf] = {}
    for _, node in walk(plan.machine.root):
        if isinstance(node, Leaf) and node.type in classes:
            first.setdefault(node.type, node)
    for name, leaf in first.items():
        code = classes[name]
        if code.header.casefold() == header.casefold():  # equal names in some file systems
            text = f"the header of `{name}` and the generated header would both be `{header}`"
            help_ = "rename the header of the class, or the machine"
            plan.refuse(leaf.span, UnportableError(text, help=help_), leaf.name, header)
        for used in named_classes(code):
            if used in own:
                text = f"the class `{used}` of `{name}` has the name of the namespace that is"
                text += f" generated for `{own[used]}`"
                help_ = f"move the class into a namespace of its own, or rename `{own[used]}`"
                plan.refuse(leaf.span, UnportableError(text, help=help_), leaf.name, used)


def _container(printing: _Printing, scope: ContainerScope) -> Lines:
    plan, node, name = printing.plan, scope.node, scope_name(scope.path)
    leaves = _leaves(printing, scope)
    if leaves is None:
        return []
    names = frozenset(child.name for child in node.children)
    container = ContainerPlan(
        scope=scope,
        leaves=leaves,
        names=names,
        scopes=plan.scopes,
        stopping=printing.stopping,
    )
    if isinstance(node, Iterator) or any(map(container.receives_stop, node.children)):
        printing.stopping.add(scope.path)
    blocks = [
        enumeration(results(node)),
        _names(results(node)),
        _userdata(plan, scope),
        _view(scope),
        _types(leaves),
    ]
    try:
        blocks += _stepped(printing, container) if plan.bounds else _blocking(printing, container)
    except UnportableError as error:
        plan.refuse(node.span, error, node.name)
    inner = "\n\n".join("\n".join(block) for block in blocks if block)
    where = f" // {place(node)}" if place(node) else ""
    return [*_doc(node), f"namespace {name} {{{where}", "", inner, "", f"}} // namespace {name}"]


def _blocking(printing: _Printing, container: ContainerPlan) -> list[Lines]:
    """The blocks of a container that runs from its entry to its outcome."""
    plan, scope = printing.plan, container.scope
    blocks = [
        _states(printing, scope, container.leaves),
        _places(plan, scope),
        parts(container),
        execute(container),
    ]
    return [*blocks, _root(plan.machine)] if scope.node is plan.machine.root else blocks


def _stepped(printing: _Printing, container: ContainerPlan) -> list[Lines]:
    """The blocks of a container that is stepped."""
    plan, scope = printing.plan, container.scope
    assert plan.bounds is not None
    step_plan = StepPlan(container=container, numbers=printing.numbers, bounds=plan.bounds)
    members = states_members(step_plan)
    taken = [member(child) for child in scope.node.children]
    for name in RESERVED:
        if name in taken:
            raise UnportableError(f"`{name}` is a name of the generated code: rename the state")
    types = [type_ for key, type_ in scope.keys.items() if key not in scope.shared]
    printing.sizes[scope.path] = sum(8 + most_bytes(type_) for type_ in types) + sum(
        size for _, size in members
    )
    size = 8 if len(taken) < 2**8 else 16
    names = [f"enum class State : std::uint{size}_t {{", "  none_,"]
    names += [f"  {identifier(child.name)}," for child in scope.node.children]
    blocks = [
        [*names, "};"],
        _states(printing, scope, container.leaves, tuple(text for text, _ in members)),
        requests(step_plan),
        step(step_plan),
    ]
    if scope.node is not plan.machine.root:
        return blocks
    machine = plan.machine
    return [
        *blocks,
        node_table(machine, plan.paths),
        machine_class(
            machine,
            printing.classes,
            printing.parameters[scope.path],
            sum(printing.sizes.values()),
            asks=scope.path in printing.stopping,
        ),
    ]


def _doc(node: Node, indent: str = "") -> Lines:
    """The documentation of a state as comments."""
    lines = comment_lines(node.doc, COMMENT_WIDTH - len(indent) - 3)
    return [f"{indent}// {line}".rstrip() for line in lines]


def _leaves(printing: _Printing, scope: ContainerScope) -> Mapping[str, LeafCode] | None:
    """The code of the leaves by name; None if one of them has no code."""
    plan = printing.plan
    found: dict[str, LeafCode] = {}
    leaves = [child for child in scope.node.children if isinstance(child, Leaf)]
    for leaf in leaves:
        try:
            code = printing.code_of(leaf, scope)
        except UnportableError as error:
            plan.refuse(leaf.span, error, leaf.name)
            continue
        if code is None:
            printing.missing.add(leaf.type)
        else:
            found[leaf.name] = code
    if not scope.node.children:
        empty = UnportableError("the container has no states")
        plan.refuse(scope.node.span, empty, scope.node.name)
        return None
    return found if len(found) == len(leaves) else None


def _names(outcomes: tuple[str, ...]) -> Lines:
    texts = ", ".join(map(cpp_literal, outcomes))
    return [
        "constexpr const char *name(Outcome outcome) {",
        f"  constexpr const char *names[] = {{{texts}}};",
        "  return names[static_cast<std::size_t>(outcome)];",
        "}",
    ]


def _userdata(plan: Plan, scope: ContainerScope) -> Lines:
    presets = {preset.key: preset for preset in scope.node.userdata}
    lines = []
    for key, type_ in scope.keys.items():
        if key in scope.shared:
            continue
        value = ""
        if key in presets:
            try:
                value = f"{{{cpp_value(presets[key].value.data, type_)}}}"
            except UnportableError as error:
                plan.refuse(presets[key].value.span, error, key)
        try:
            key_type = f"{plan.dialect.namespace}Key<{cpp_type(type_)}>"
            lines.append(f"  {key_type} {identifier(key)}{value};")
        except UnportableError:
            continue  # reported by plan
    for child in scope.node.children:
        if not isinstance(child, Leaf):
            lines.append(f"  {identifier(child.name)}::Userdata {member(child)};")
    return ["struct Userdata {", *lines, "};"] if lines else ["struct Userdata {};"]


def _view(scope: ContainerScope) -> Lines:
    """The struct of the container's own userdata and of the keys that it shares."""
    if not scope.shared:
        return []
    outputs = {key.name for key in scope.node.outputs}
    fields = []
    for key in scope.view:
        access = "" if key in outputs else "const "
        try:
            type_ = cpp_type(scope.keys[key])
        except UnportableError:
            continue  # reported by plan
        fields.append(f"  {access}{scope.dialect.namespace}Key<{type_}> &{identifier(key)};")
    return ["struct UserdataView {", f"  Userdata &{OWN};", *fields, "};"]


def _types(leaves: Mapping[str, LeafCode]) -> Lines:
    found = ["\n".join(code.definition) for code in leaves.values() if code.definition]
    if not found:
        return []
    return ["namespace types {", "", "\n\n".join(found), "", "} // namespace types"]


def _states(
    printing: _Printing,
    scope: ContainerScope,
    leaves: Mapping[str, LeafCode],
    own: tuple[str, ...] = (),
) -> Lines:
    """The struct of the states, with a constructor if the classes of some states need arguments.
    `own` are members that are no states."""
    members: list[tuple[Lines, str, bool]] = []
    made: Lines = []
    parameters: dict[str, None] = {}
    for child in scope.node.children:
        if isinstance(child, Leaf):
            code = leaves[child.name]
            type_, given = code.type, code.made_with
            wanted = code.parameters
        else:
            type_ = f"{identifier(child.name)}::States"
            wanted = printing.parameters.get(f"{scope.path}/{child.name}", ())
            given = ", ".join(map(argument, wanted))
        parameters |= dict.fromkeys(wanted)
        doc = _doc(child, "  ") if isinstance(child, Leaf) else []
        members.append((doc, f"  {type_} {member(child)}", bool(given)))
        if given:
            made.append(f"{member(child)}({given})")
    printing.parameters[scope.path] = tuple(parameters)
    lines: Lines = []
    for doc, text, listed in members:
        lines += [*doc, f"{text}{{}};" if made and not listed else f"{text};"]
    lines += [f"  {text}" for text in own]
    if not made:
        return ["struct States {", *lines, "};"]
    explicit = "explicit " if len(parameters) == 1 else ""
    head = f"  {explicit}States({', '.join(parameters)})"
    initial = ",\n        ".join(made)
    return ["struct States {", head, f"      : {initial} {{}}", "", *lines, "};"]


def _places(plan: Plan, scope: ContainerScope) -> Lines:
    children = scope.node.children
    return [
        "enum class State : std::size_t {",
        *(f"  {identifier(child.name)}," for child in children),
        "};",
        "",
        "inline constexpr smachac::Place places[] = {",
        *(f"    {_place(plan, scope.path, child)}," for child in children),
        "};",
    ]


def _place(plan: Plan, around: str, child: Node) -> str:
    """The place of a child of the container at a path: its path in the script, file and line; also
    its full path and the container's path in the script, where one of them differs."""
    path = f"{around}/{child.name}"
    texts = [plan.paths.get(path, path), place(child)]
    if path in plan.paths or around in plan.paths:
        texts += [path, plan.paths.get(around, around)]
    return f"{{{', '.join(map(cpp_literal, texts))}}}"


def _root(machine: Machine) -> Lines:
    root = machine.root
    here = f"{{{cpp_literal(root.name)}, {cpp_literal(place(root))}}}"
    return [
        "/// Runs the machine once. The observer receives all events of the run; it may be null.",
        "inline Outcome run(States &states, Userdata &ud, smachac::Observer *observer,",
        "                   smachac::Stop &stop) {",
        "  if (observer == nullptr) {",
        "    smachac::Run alone{stop};",
        "    return execute(states, ud, alone);",
        "  }",
        "  smachac::WatchedRun watched(*observer, stop);",
        f"  watched.start({here});",
        "  return watched.finish(execute(states, ud, watched));",
        "}",
        "",
        "/// As above, for an observer of any class with `on(const smachac::Event &)`. It receives",
        "/// all events but those of writes and requests to stop, at less cost.",
        "template <class Watch>",
        "smachac::IfClass<Watch, Outcome> run(States &states, Userdata &ud, Watch &watch,",
        "                                     smachac::Stop &stop) {",
        f"  constexpr smachac::Place machine{here};",
        "  smachac::DirectRun<Watch> watched(watch, stop);",
        "  watched.start(machine);",
        "  return watched.finish(machine, execute(states, ud, watched));",
        "}",
    ]
