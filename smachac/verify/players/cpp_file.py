"""Player of a C++ header on disk, such as one that was edited by hand.

The program contains the header as it is, with a call at the beginning of the `execute` of each
built-in state. The user's classes are replaced by stand-ins of the same interface, in headers of
the same names. Both perform the steps of the test case for the state that runs.
"""

from __future__ import annotations

import json
import re
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from importlib import resources
from pathlib import Path, PurePosixPath

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.frontend.loader import Library
from smachac.ir.nodes import Leaf, Machine, Node
from smachac.ir.traversal import outcome_names, own_outcomes, walk
from smachac.ir.types import Type
from smachac.records import dataclass
from smachac.runtime.tracing.writer import with_shown_paths
from smachac.targets.cpp.builtin_states import built_in, enumeration
from smachac.targets.cpp.identifiers import identifier
from smachac.targets.cpp.plan import ContainerScope, Plan, member, place, plan, scope_name
from smachac.targets.cpp.records import key_types, record_names
from smachac.targets.cpp.types import UnportableError, cpp_literal, cpp_value, plain, script_data
from smachac.targets.cpp.user_classes import (
    ClassCode,
    argument,
    class_code,
    field_type,
    interface_hash,
    stops,
)
from smachac.verify.file_faults import FileFault, unplayable
from smachac.verify.players.cpp import CompilationError, first_compiler, traces
from smachac.verify.players.cpp_program import CppLeaf, Program, given_inputs
from smachac.verify.players.header_text import TYPES, Execute, Scope, scopes
from smachac.verify.test_case import OPAQUE, Event, Player, TestCase

AGAIN = "generate the file again with `smachac build --target cpp`"
EDIT = f"edit the script too, or {AGAIN}"

_PLAIN_NAME = re.compile(r"(?:(?P<space>[A-Za-z_][\w:]*)::)?(?P<name>[A-Za-z_]\w*)")


def file_player(
    source: Source, machine: Machine, library: Library, report: Report, *, folders: Sequence[Path]
) -> Player:
    """A player of a C++ header on disk, which may include headers from `folders`.

    Adds to `report` what C++ cannot express of the machine. Raises UnplayableError, with the place
    in the file, if the header has other states or outcomes than the script, or does not compile.
    """
    planned = plan(machine, names=record_names(machine, library))
    report.extend(Program(planned, ()).refused())

    def play(cases: Sequence[TestCase]) -> Iterator[list[Event]]:
        header = _Header(source, planned, cases)
        if header.faults:
            raise unplayable(source, header.faults)
        compiler = first_compiler()
        lines = {path: f"{Path(source.name).name}:{n}" for path, n in header.lines.items()}
        full = {shown: path for path, shown in planned.paths.items()}
        with tempfile.TemporaryDirectory() as folder:
            header.write_stand_ins(Path(folder))
            found = [path for home in folders for path in (home, home / "include")]
            flags = [
                f"-I{fromkey}" for fromkey in (folder, *dict.fromkeys(map(Path.resolve, found)))
            ]
            try:
                for events in traces(header.program(), header.script(), compiler, *flags):
                    yield [_with_line(with_shown_paths(event, full), lines) for event in events]
            except CompilationError as error:
                raise unplayable(source, [_does_not_compile(source, error)]) from error

    return play


def _with_line(event: Event, lines: Mapping[str, str]) -> Event:
    """The event of a state with its place in the header."""
    line = lines.get(event["path"])
    return event if line is None else {**event, "src": line}


def _does_not_compile(source: Source, error: CompilationError) -> FileFault:
    """The first error in the header, else the first one."""
    start = f"{source.name}:"
    first = next((line for line in error.lines if line.startswith(start)), "")
    number = first.removeprefix(start).partition(":")[0]
    text = first or next(iter(error.lines), "the compiler failed without a message")
    message = text.partition("error: ")[2] or text
    return FileFault(
        message=f"the header does not compile: {message}",
        line=int(number) if number.isdecimal() else 0,
        help=f"it is compiled with the headers of this version of smachac; correct it, or {AGAIN}",
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _StandIn:
    """A leaf that performs test cases in the program of a header. `code` is its class; None for
    states whose code is in the header. `keys` are the expressions for the keys of its container, by
    name. `uses_stop`: its code has a parameter for requests to stop."""

    leaf: CppLeaf
    code: ClassCode | None
    keys: Mapping[str, str]
    uses_stop: bool

    @property
    def space(self) -> str:
        """The namespace of the container."""
        return scope_name(self.leaf.scope.path)

    @property
    def struct(self) -> str:
        """The struct of a state whose code is in the header."""
        return f"{self.space}::{TYPES}::{identifier(self.leaf.leaf.name)}"


class _Header:
    """A header on disk as a program for some test cases."""

    def __init__(self, source: Source, planned: Plan, cases: Sequence[TestCase]) -> None:
        self._source = source
        self._machine = planned.machine
        self._scopes = planned.scopes
        self._names = planned.names
        self._cases = cases
        self._found = scopes(source)
        self._stand_ins: dict[str, _StandIn] = {}
        for number, (path, node) in enumerate(walk(self._machine.root)):
            if isinstance(node, Leaf):
                scope = planned.scopes[path.rpartition("/")[0]]
                leaf = CppLeaf(number=number, path=path, leaf=node, scope=scope)
                type_ = self._machine.state_types.get(node.type)
                code = class_code(type_) if type_ is not None else None
                keys = {key: self._key(scope, key) for key in scope.keys}
                uses_stop = code is None and _uses_stop(node, scope)
                self._stand_ins[path] = _StandIn(
                    leaf=leaf, code=code, keys=keys, uses_stop=uses_stop
                )
        for case in cases:
            for path, row in case.rows.items():
                for step in row:
                    self._stand_ins[path].leaf.case_of(step)
        self.lines = dict(self._lines())
        self.faults = list(self._faults())

    def _key(self, scope: ContainerScope, key: str) -> str:
        """The expression for a key of a container, which may be that of a container around it. In
        headers without views, as older versions printed them, each container has its own keys."""
        while key in scope.shared and f"{scope_name(scope.path)}::UserdataView" in self._found:
            around = self._scopes[scope.path.rpartition("/")[0]]
            key = around.names(scope.node)[key]
            scope = around
        return f"{_userdata(scope.path, self._scopes)}.{identifier(key)}"

    def _lines(self) -> Iterator[tuple[str, int]]:
        """The line of every state in the header, by path; those that are missing are left out."""
        for path, node in walk(self._machine.root):
            own = self._found.get(scope_name(path))
            around = self._found.get(scope_name(path.rpartition("/")[0])) if "/" in path else None
            line = around.states.get(identifier(node.name)) if around is not None else None
            if line is not None:
                yield path, line
            elif own is not None:
                yield path, own.line

    # Comparison with the script

    def _faults(self) -> Iterator[FileFault]:
        """What the header has more or less than the script: states and outcomes."""
        root = self._machine.root
        space = scope_name(root.name)
        if space not in self._found or "State" not in self._found[space].enums:
            message = f"the header has no machine `{root.name}`: no namespace `{space}` with states"
            yield FileFault(message=message, help=AGAIN)
            return
        for path, scope in self._scopes.items():
            found = self._found.get(scope_name(path))
            if found is not None:
                yield from _different_states(path, scope, found)
        yield from self._different_outcomes(root, self._found[space], root.name)
        for path, stand_in in self._stand_ins.items():
            if stand_in.space in self._found and path in self.lines and stand_in.code is None:
                yield from self._different_struct(path, stand_in)

    def _different_outcomes(self, node: Node, found: Scope, path: str) -> Iterator[FileFault]:
        ours = sorted({identifier(name) for name in outcome_names(node)})
        theirs = sorted(found.enums.get("Outcome", ()))
        if ours != theirs:
            message = f"`{path}` has the outcomes {_listed(theirs)}, in the script {_listed(ours)}"
            yield FileFault(message=message, line=found.line, help=EDIT)

    def _different_struct(self, path: str, stand_in: _StandIn) -> Iterator[FileFault]:
        """The faults of the struct of a state whose code is in the header."""
        found, leaf = self._found.get(stand_in.struct), stand_in.leaf.leaf
        if found is None or found.execute is None:
            message = f"the state `{path}` has no struct `{stand_in.struct}` with an `execute`"
            help_ = f"its type is the built-in `{leaf.type}` in the script: {EDIT}"
            yield FileFault(message=message, line=self.lines[path], help=help_)
            return
        missing = [
            name
            for name in own_outcomes(leaf)
            if identifier(name) not in found.enums.get("Outcome", ())
        ]
        if missing:
            message = f"the state `{path}` has no outcome {_listed(missing)}, as in the script"
            yield FileFault(message=message, line=found.line, help=EDIT)

    # The program

    def script(self) -> str:
        """The input of the program."""
        lines = []
        for case in self._cases:
            live = [str(self._stand_ins[path].leaf.number) for path in sorted(case.live)]
            rows = {path: row for path, row in case.rows.items() if row}
            lines.append(" ".join([str(len(live)), *live]))
            lines.append(f"{case.most} {int(case.stopped)} {len(rows)}")
            for path, row in rows.items():
                leaf = self._stand_ins[path].leaf
                steps = " ".join(str(leaf.case_of(step)) for step in row)
                lines.append(f"{leaf.number} {len(row)} {steps}")
        return "\n".join(lines) + "\n"

    def program(self) -> str:
        """The source of the program."""
        play = [
            resources.files("smachac.verify").joinpath(name).read_text("utf-8")
            for name in ("play.hpp", "play_header.hpp")
        ]
        declared = [
            "template <class Outcome, class In, class Out, class Stop>"
            f" Outcome leaf_{in_.leaf.number}(In &in, Out &out, Stop &stop);"
            for in_ in self._stand_ins.values()
        ]
        name = scope_name(self._machine.root.name)
        reads = {path: keys for case in self._cases for path, keys in case.reads.items()}
        leaves = [line for in_ in self._stand_ins.values() for line in _leaf(in_, reads)]
        return "\n".join([
            *play,
            "namespace verify {", *declared, "}",
            f"#line 1 {cpp_literal(self._source.name)}",
            self._text(),
            '#line 1 "verify.cpp"',
            *self._assertions(),
            "namespace verify {",
            f"static {name}::Userdata *given = nullptr;",
            *leaves,
            *self._here(),
            "}",
            *self._main(name),
        ])  # fmt: skip

    def _text(self) -> str:
        """The header with a call at the beginning of each `execute` of a state."""
        own = {in_.struct: in_ for in_ in self._stand_ins.values() if in_.code is None}
        calls: dict[int, str] = {}
        for name, scope in self._found.items():
            calls |= {at: f" ::verify::starts({run});" for at, run in scope.starts}
            if scope.execute is not None and name.rpartition("::")[0].endswith(f"::{TYPES}"):
                calls[scope.execute.start] = _call(own.get(name), scope.execute)
        parts, last = [], 0
        for at, call in sorted(calls.items()):
            parts += [self._source.text[last:at], call]
            last = at
        return "".join([*parts, self._source.text[last:]])

    def _assertions(self) -> Iterator[str]:
        """The assertions that each state is of the type that is replaced."""
        for path, in_ in self._stand_ins.items():
            name = identifier(in_.leaf.leaf.name)
            type_ = f"::{in_.struct}" if in_.code is None else in_.code.name
            message = f"the state {path} is not of the type {type_.removeprefix('::')}"
            yield f"#line {self.lines.get(path, 1)} {cpp_literal(self._source.name)}"
            yield (
                f"static_assert(std::is_same_v<decltype(::{in_.space}::States::{name}), {type_}>,"
                f" {cpp_literal(message)});"
            )
        yield '#line 1 "verify.cpp"'

    def _here(self) -> Iterator[str]:
        yield "std::size_t here() {"
        yield "  static const std::map<std::string_view, std::size_t> numbers{"
        for path, in_ in self._stand_ins.items():
            yield f"    {{{cpp_literal(path)}, {in_.leaf.number}}},"
        yield "  };"
        yield "  const auto found = numbers.find(current.full());"
        yield "  return found == numbers.end() ? 0 : found->second;"
        yield "}"

    def _main(self, name: str) -> Iterator[str]:
        scope = self._scopes[self._machine.root.name]
        yield "int main() {"
        yield "  for (verify::read_live(); std::cin; verify::read_live()) {"
        yield f"    verify::play<verify::Watcher, {name}::Userdata>([](auto &ud) {{"
        yield "        verify::given = &ud;"
        yield from given_inputs(self._cases, scope)
        yield "      }, [](auto &ud, auto *observer, auto &stop) {"
        yield f"        const auto states = verify::made<{name}::States>();"
        yield f"        {name}::run(*states, ud, observer, stop);"
        yield "      });"
        yield "  }"
        yield "}"

    # Stand-ins for classes

    def write_stand_ins(self, folder: Path) -> None:
        """Write the headers with stand-ins for the classes of the user."""
        headers: dict[str, dict[str, list[_StandIn]]] = {}
        for in_ in self._stand_ins.values():
            if in_.code is not None:
                classes = headers.setdefault(in_.code.header, {})
                classes.setdefault(in_.code.name, []).append(in_)
        for header, classes in headers.items():
            name = PurePosixPath(header)
            if name.is_absolute() or ".." in name.parts:
                message = f"the header `{header}` of a class has no place below a folder"
                help_ = "name it in the interface as it is found with -I"
                raise unplayable(self._source, [FileFault(message=message, help=help_)])
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            text = [line for stand_ins in classes.values() for line in _class(stand_ins)]
            types = (code.type for ins in classes.values() if (code := ins[0].code) is not None)
            own = self._names.headers(
                text_type for type_ in types for text_type in key_types(type_)
            )
            included = (f'#include "{file}"' for file in ("smachac/smachac.hpp", *own))
            lines = ["#pragma once", *included, *text]
            path.write_text("\n".join(lines) + "\n", "utf-8")


def _call(stand_in: _StandIn | None, execute: Execute) -> str:
    """The call at the beginning of the `execute` of a state whose code is in the header."""
    if stand_in is None:
        return ' throw std::runtime_error("is not in the script");'
    none = "::verify::nothing" if stand_in.uses_stop else "*::verify::current_stop"
    number = stand_in.leaf.number
    given = f"::verify::nothing, ::verify::nothing, {execute.stop or none}"
    leaf = f"::verify::leaf_{number}<Outcome>({given})"
    return f" if (::verify::scripted({number})) {{ return {leaf}; }}"


def _uses_stop(leaf: Leaf, scope: ContainerScope) -> bool:
    """Whether the generated code of a built-in state has a parameter for requests to stop."""
    try:
        code = built_in(leaf, scope, lambda span, error, *names: None)
    except UnportableError:
        return False
    return code is not None and code.uses_stop


def _different_states(path: str, scope: ContainerScope, found: Scope) -> Iterator[FileFault]:
    """The states that only the script or only the header has in a container."""
    ours = {identifier(child.name): child for child in scope.node.children}
    theirs = found.enums.get("State", ())
    for name, child in ours.items():
        if name not in theirs:
            src = f" ({place(child)})" if place(child) else ""
            message = f"the state `{path}/{child.name}` of the script{src} is not in the header"
            yield FileFault(message=message, line=found.line, help=EDIT)
    for name in theirs:
        if name not in ours:
            message = f"the state `{path}/{name}` of the header is not in the script"
            yield FileFault(message=message, line=found.states.get(name, found.line), help=EDIT)


def _listed(names: Sequence[str]) -> str:
    return ", ".join(f"`{name}`" for name in names) or "(none)"


def _class(stand_ins: Sequence[_StandIn]) -> Iterator[str]:
    """The stand-in for a class, and declarations of the types that its constructor takes."""
    code = stand_ins[0].code
    assert code is not None
    type_ = code.type
    for parameter in code.parameters:
        yield from _declared(parameter)
    ins, outs = (
        [f"{field_type(part, key.type)} {identifier(key.name)};" for key in keys]
        for part, keys in (("In", type_.input_keys), ("Out", type_.output_keys))
    )
    space, _, name = code.name.removeprefix("::").rpartition("::")
    parameters = [
        *(["In in"] if ins else []),
        *(["Out out"] if outs else []),
        *(["smachac::Stop &stop"] if stops(type_) else []),
    ]
    given = ", ".join([
        "in" if ins else "verify::nothing",
        "out" if outs else "verify::nothing",
        "stop" if stops(type_) else "*verify::current_stop",
    ])  # fmt: skip
    yield from [f"namespace {space} {{"] if space else []
    yield f"class {name} {{"
    yield "public:"
    yield from enumeration(tuple(outcome.name for outcome in type_.outcomes))
    yield f"  struct In {{ {' '.join(ins)} }};"
    yield f"  struct Out {{ {' '.join(outs)} }};"
    yield f"  static constexpr std::uint32_t smachac_interface = {interface_hash(type_)};"
    yield f"  {name}() = default;"
    yield f"  template <class One, class... More> explicit {name}(One &&, More &&...) {{}}"
    yield f"  Outcome execute({', '.join(parameters)}) {{"
    yield "    switch (verify::here()) {"
    for in_ in stand_ins:
        number = in_.leaf.number
        yield f"    case {number}: return verify::leaf_{number}<Outcome>({given});"
    yield '    default: throw std::runtime_error("is not in the script");'
    yield "    }"
    yield "  }"
    yield "};"
    yield from ["}"] if space else []


def _declared(parameter: str) -> Iterator[str]:
    """The declaration of the class that a parameter of a constructor names."""
    text = parameter.removesuffix(argument(parameter)).replace("const ", "").strip("&* ")
    found = _PLAIN_NAME.fullmatch(text.removeprefix("::"))
    if found is None or (found["space"] or "").partition("::")[0] == "std":
        return
    if found["space"]:
        yield f"namespace {found['space']} {{ class {found['name']}; }}"
    elif found["name"] not in BASIC:
        yield f"class {found['name']};"


BASIC = ("bool", "char", "double", "float", "int", "long", "short", "unsigned")
"""Types of C++ that need no declaration."""


def _leaf(each: _StandIn, reads: Mapping[str, Sequence[str]]) -> Iterator[str]:
    """The function that performs the steps of a leaf."""
    leaf = each.leaf
    yield "template <class Outcome, class In, class Out, class Stop>"
    yield f"Outcome leaf_{leaf.number}(In &in, Out &out, Stop &stop) {{"
    yield f"  const std::size_t step = next({leaf.number});"
    yield "  const smachac::Place place = current;"
    yield "  static_cast<void>(in), static_cast<void>(out), static_cast<void>(place);"
    types = _types(each)
    for key in reads.get(leaf.path, ()):
        type_ = types.get(key)
        if type_ is None or plain(Type("optional", (type_,))).name != "optional":
            yield f"  read(place, {cpp_literal(key)}, {cpp_literal(json.dumps(OPAQUE))});"
        elif each.code is not None:
            yield f"  read_value(place, {cpp_literal(key)}, in.{identifier(key)});"
        else:
            yield f"  read_key(place, {cpp_literal(key)}, {_outer_key(each, key)});"
    yield from leaf.switch(lambda key, value: _write(each, types, key, value))
    yield "}"


def _types(each: _StandIn) -> dict[str, Type]:
    """The types of the keys of a leaf that exist in C++."""
    if each.code is not None:
        keys = (*each.code.type.input_keys, *each.code.type.output_keys)
        return {key.name: plain(key.type) for key in keys}
    scope, leaf = each.leaf.scope, each.leaf.leaf
    names = scope.names(leaf)
    outer = {key.name: names[key.name] for key in (*leaf.inputs, *leaf.outputs)}
    return {name: scope.keys[key] for name, key in outer.items() if key in scope.keys}


def _write(each: _StandIn, types: Mapping[str, Type], key: str, value: object) -> str:
    """The statement that writes an output; empty for one that does not exist in C++."""
    if key not in types:
        return ""
    try:
        text = cpp_value(script_data(value), types[key])
    except UnportableError:
        return ""
    if each.code is not None:
        return f"out.{identifier(key)} = {text};"
    return f"write_key(place, {cpp_literal(key)}, {_outer_key(each, key)}, {text});"


def _outer_key(each: _StandIn, key: str) -> str:
    """The key of the container that a key of a leaf is remapped to."""
    leaf = each.leaf
    return each.keys[leaf.scope.names(leaf.leaf)[key]]


def _userdata(path: str, scopes: Mapping[str, ContainerScope]) -> str:
    """The userdata of a container, inside the userdata of the machine."""
    names = path.split("/")
    inner = ["/".join(names[: depth + 1]) for depth in range(1, len(names))]
    return ".".join(["(*given)", *(member(scopes[text].node) for text in inner)])
