"""Recorded SMACH machines as C++ programs, whose leaves receive their actions through a pipe.

Each leaf is a class of its own, with the interface of the recording. The machine is placed inside
another one, which stands for its parent.
"""

from __future__ import annotations

import json
import re
import subprocess
from collections.abc import Iterable, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import NOWHERE
from smachac.driver import build
from smachac.frontend.files import disk_library
from smachac.frontend.loader import memory_library
from smachac.interpreter.userdata import UserdataError
from smachac.ir import nodes
from smachac.ir.nodes import Checked, Key, Leaf, Machine, Node, Outcome, Preset, StateMachine
from smachac.ir.traversal import outcome_names, remapping
from smachac.ir.types import ANY, Bounds, Type
from smachac.targets.cpp import TARGET
from smachac.targets.cpp.bounded import bounded, loose
from smachac.targets.cpp.containers import results
from smachac.targets.cpp.identifiers import identifier
from smachac.targets.cpp.plan import member, plan
from smachac.targets.cpp.types import cpp_literal, cpp_type
from smachac.targets.cpp.user_classes import interface_hash, step_field_type
from tests.conformance_ir.ir_vectors import Replay, data_of, leaves_of, machine_of
from tests.cpp.compilers import Compiler
from tests.support.typed_machines import with_state_types

Json = Any

HOST = Path(__file__).with_name("vector_host.hpp")
STEP_HOST = Path(__file__).with_name("step_host.hpp")
TYPES = {"i": Type("int"), "l": Type("list", (Type("int"),)), "s": Type("str")}
BUILT_IN = disk_library(Path("main.yml"), [])


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """A case as C++: the classes of its leaves, its header, and what runs it. `shared` are the keys
    that containers share with those around them, by the path of the recording."""

    case: Json
    shared: Mapping[str, AbstractSet[str]]
    name: str
    classes: str
    header: str
    call: str


BOUNDS = Bounds(text=64, list=32)
"""The bounds of the values in stepped machines."""


def part(case: Json, name: str, *, stepped: bool = False) -> Part | list[str]:
    """A case as C++, or why C++ cannot say it. The keys of random machines are typed by their
    names, where that holds; others as their container has them."""
    typed = not case["id"].startswith("h")
    found = _part(case, name, typed, BOUNDS if stepped else None)
    again = isinstance(found, list) and typed
    return _part(case, name, False, BOUNDS if stepped else None) if again else found


def _part(case: Json, name: str, typed: bool, bounds: Bounds | None) -> Part | list[str]:
    leaves: dict[str, Leaf] = {}
    machine = _machine(case, name, typed, leaves)
    scopes = plan(machine, bounds).scopes
    if not typed:
        leaves = {
            path: _inferred(leaf, scopes[f"{name}/root{path}".rpartition("/")[0]])
            for path, leaf in leaves.items()
        }
    files: dict[str, str] = {}
    for path, leaf in leaves.items():
        within = scopes[f"{name}/root{path}".rpartition("/")[0]]
        open_ = isinstance(within.node, nodes.Iterator)
        keys = {key: loose(type_) for key, type_ in within.keys.items()} if open_ else {}
        files[f"templates/{leaf.type}.yml"] = _interface(case, path, leaf, keys, bounds)
    library = memory_library(files, BUILT_IN)
    typed_machine = with_state_types(machine, library)
    report: Report = []
    options = {"mode": "step", "text": str(BOUNDS.text), "list": str(BOUNDS.list)}
    texts = build(Checked(typed_machine), TARGET, library, report, options if bounds else None)
    if report:
        return [item.finding.message for item in report]
    classes = []
    for path, leaf in leaves.items():
        type_ = typed_machine.state_types[leaf.type]
        make = _class if bounds is None else _step_class
        classes.append(make(type_, f"{name}/root{path}"))
    asked = str(bool(case.get("preempt_before"))).lower()
    planned = plan(typed_machine, bounds).scopes
    told = "\n".join(_told(machine, planned))
    call = (
        f'  vectors::play<{name}::Machine<vectors::Host>>("{name}", {case.get("runs", 1)}, '
        f"{asked}, [](auto &host, const auto &ud) {{\n{told}\n  }});"
        if bounds
        else f'  vectors::play<{name}::States, {name}::Userdata>("{name}", {case.get("runs", 1)}, '
        f"{asked}, [](auto &&...given) {{ return {name}::run("
        "std::forward<decltype(given)>(given)...); }, "
        f"[](auto &host, const auto &ud) {{\n{told}\n  }});"
    )
    (text,) = texts.values()
    header = "\n".join(line for line in text.splitlines() if not line.startswith("#"))
    # Somebody always listens here: to compile the other case as well takes a third longer.
    header = re.sub(r"  if \(observer == nullptr\) \{\n.*?\n  \}\n", "", header, flags=re.DOTALL)
    shared = {
        path.removeprefix(f"{name}/root"): scope.shared
        for path, scope in planned.items()
        if path != name
    }
    return Part(
        case=case,
        shared=shared,
        name=name,
        classes="\n".join(classes),
        header=header,
        call=call,
    )


def _machine(case: Json, name: str, typed: bool, leaves: dict[str, Leaf]) -> Machine:
    inner = _renamed(declared(case), "", name, typed, leaves)
    return Machine(root=_around(case, name, inner), source="vectors")


def typed_machine(case: Json, name: str) -> Machine:
    """The machine of a case whose keys have the types of their names."""
    return _machine(case, name, True, {})


def declared(case: Json) -> Any:
    """The graph of a case, with the outcomes that its leaves end with, declared or not: a class
    has to. So has the state of an iterator the keys that it writes (I7)."""
    return _declaring(machine_of(case).root, "", leaves_of(case), loose=False)


def _declaring(node: Any, path: str, leaves: Mapping[str, Json], *, loose: bool) -> Any:
    if isinstance(node, Leaf):
        steps = leaves[path].get("steps", [])
        more = tuple(
            Outcome(name=outcome, span=NOWHERE) for outcome in undeclared_outcomes(node, steps)
        )
        keys = undeclared_keys(node, steps) if loose else ()
        written = tuple(Key(name=key, span=NOWHERE) for key in keys)
        return replace(node, outcomes=node.outcomes + more, outputs=node.outputs + written)
    loose = isinstance(node, nodes.Iterator)
    children = tuple(
        _declaring(child, f"{path}/{child.name}", leaves, loose=loose) for child in node.children
    )
    return replace(node, children=children)


def undeclared_outcomes(leaf: Leaf, steps: Json) -> list[str]:
    """What a leaf ends with beside its outcomes."""
    ends: list[Json] = []
    for step in steps:
        told = step.get("ret")
        ends += [told["then"], told["else"]] if isinstance(told, dict) else [told]
        ends.append(step.get("pre"))
    return list(dict.fromkeys(x for x in ends if x and x not in outcome_names(leaf)))


def undeclared_keys(leaf: Leaf, steps: Json) -> list[str]:
    """What a leaf writes beside its outputs."""
    outputs = {key.name for key in leaf.outputs}
    done = [operation for step in steps for operation in step.get("do", [])]
    keys = [operation[1] for operation in done if operation[0] == "set"]
    return list(dict.fromkeys(key for key in keys if key not in outputs))


def _key(key: Key, typed: bool, optional: bool) -> Key:
    type_ = TYPES.get(key.name[0], ANY) if typed else ANY
    return replace(key, type=Type("optional", (type_,)) if optional and type_ != ANY else type_)


def _renamed(node: Node, path: str, case: str, typed: bool, leaves: dict[str, Leaf]) -> Any:
    """The graph with types for its keys and a state type for each leaf, which `leaves` gathers."""
    both = {key.name for key in node.outputs}
    keys: dict[str, Any] = {
        "outputs": tuple(_key(key, typed, False) for key in node.outputs),
        "inputs": tuple(_key(key, typed, key.name not in both) for key in node.inputs),
    }
    if isinstance(node, Leaf):
        leaf = replace(node, type=f"L{case}_{len(leaves)}", **keys)
        leaves[path] = leaf
        return leaf
    keys["inputs"] = tuple(_key(key, typed, False) for key in node.inputs)
    children = tuple(
        _renamed(child, f"{path}/{child.name}", case, typed, leaves) for child in node.children
    )
    return replace(node, children=children, **keys)


def _around(case: Json, name: str, inner: Any) -> StateMachine:
    """The machine around: its userdata is the `parent` of the case."""
    held = tuple(
        Preset(key=key, value=nodes.Value(data=data_of(value), span=NOWHERE), span=NOWHERE)
        for key, value in case.get("userdata", {}).items()
    )
    presets = tuple(p for p in inner.userdata if p.key not in case.get("userdata", {})) + held
    parent = case.get("parent")
    inner = replace(
        inner,
        name="root",
        userdata=presets,
        inputs=() if parent is None else inner.inputs,
        outputs=() if parent is None else inner.outputs,
        transitions=tuple(
            nodes.Transition(outcome=result, target=result, span=NOWHERE)
            for result in results(inner)
        ),
    )
    return StateMachine(
        name=name,
        type="StateMachine",
        outcomes=tuple(Outcome(name=result, span=NOWHERE) for result in results(inner)),
        children=(inner,),
        initial="root",
        userdata=tuple(
            Preset(key=key, value=nodes.Value(data=data_of(value), span=NOWHERE), span=NOWHERE)
            for key, value in (parent or {}).items()
        ),
        span=NOWHERE,
    )


def _inferred(leaf: Leaf, scope: Any) -> Leaf:
    """A leaf whose keys have the types that they have around it."""

    def known(key: Key) -> Key:
        outer = scope.names(leaf).get(key.name, key.name)
        return replace(key, type=scope.keys.get(outer, ANY))

    return replace(
        leaf, inputs=tuple(map(known, leaf.inputs)), outputs=tuple(map(known, leaf.outputs))
    )


def _interface(
    case: Json, path: str, leaf: Leaf, loose: Mapping[str, Type], bounds: Bounds | None
) -> str:
    outputs = {key.name: str(key.type) for key in leaf.outputs}
    inputs = {key.name: key.type for key in leaf.inputs if key.name not in outputs}
    # A class that looks for a key has to see it hold nothing: as a T?, or as what it may write.
    outputs |= {name: str(type_) for name, type_ in loose.items()}
    optional = {name for name, type_ in inputs.items() if type_.name == "optional"}
    outputs |= {name: str(type_) for name, type_ in inputs.items() if name not in optional}
    inputs = {name: type_ for name, type_ in inputs.items() if name not in outputs}
    return json.dumps(
        {
            "name": leaf.type,
            "blocking": True,
            "input_keys": {name: str(type_) for name, type_ in inputs.items()},
            "output_keys": outputs,
            "outcomes": {name: {} for name in outcome_names(leaf)},
            "code": {
                "cpp": {
                    "header": "step_host.hpp" if bounds else "vector_host.hpp",
                    "class": f"vectors::{leaf.type}",
                    "with": "vectors::Host& host",
                }
            },
        }
    )


def _class(type_: Any, path: str) -> str:
    """The class of a leaf."""
    ends = [outcome.name for outcome in type_.outcomes]
    ins = [f"    const {cpp_type(k.type)} &{identifier(k.name)};" for k in type_.input_keys]
    outs = [
        f"    smachac::Key<{cpp_type(k.type)}> &{identifier(k.name)};" for k in type_.output_keys
    ]
    views = [
        *(f"view({cpp_literal(k.name)}, in.{identifier(k.name)})" for k in type_.input_keys),
        *(f"view({cpp_literal(k.name)}, out.{identifier(k.name)})" for k in type_.output_keys),
    ]
    parameters = [
        *(["In in"] if ins else []),
        *(["Out out"] if outs else []),
        "smachac::Stop &stop",
    ]
    call = f"host.act({cpp_literal(path)}, stop, {{{', '.join(views)}}})"
    return "\n".join(
        [
            f"class {type_.name} {{",
            "public:",
            f"  enum class Outcome {{ {', '.join(map(identifier, ends))} }};",
            *(["  struct In {", *ins, "  };"] if ins else []),
            *(["  struct Out {", *outs, "  };"] if outs else []),
            f"  static constexpr std::uint32_t smachac_interface = {interface_hash(type_)};",
            f"  explicit {type_.name}(Host &given) : host(given) {{}}",
            f"  Outcome execute({', '.join(parameters)}) {{",
            f"    return static_cast<Outcome>({call});",
            "  }",
            "  Host &host;",
            "};",
        ]
    )


def _step_class(type_: Any, path: str) -> str:
    """The class of a leaf of a stepped machine."""
    ends = [identifier(outcome.name) for outcome in type_.outcomes]

    def fields(part: str, keys: Iterable[Key]) -> list[str]:
        stored = {key.name: bounded(key.type, BOUNDS) for key in keys}
        return [
            f"    {step_field_type(part, stored_)} {identifier(name)};"
            for name, stored_ in stored.items()
        ]

    ins, outs = fields("In", type_.input_keys), fields("Out", type_.output_keys)
    views = [
        *(f"view({cpp_literal(k.name)}, in.{identifier(k.name)})" for k in type_.input_keys),
        *(f"view({cpp_literal(k.name)}, out.{identifier(k.name)})" for k in type_.output_keys),
    ]
    parameters = [
        "smachac::step::Context &context",
        *(["In in"] if ins else []),
        *(["Out out"] if outs else []),
    ]
    call = f"host.act({cpp_literal(path)}, context, {{{', '.join(views)}}})"
    return "\n".join(
        [
            f"class {type_.name} {{",
            "public:",
            f"  enum class Outcome : std::uint8_t {{ {', '.join(ends)} }};",
            *(["  struct In {", *ins, "  };"] if ins else []),
            *(["  struct Out {", *outs, "  };"] if outs else []),
            f"  static constexpr std::uint32_t smachac_interface = {interface_hash(type_)};",
            f"  explicit {type_.name}(Host &given) : host(given) {{}}",
            f"  smachac::step::Result<Outcome> step({', '.join(parameters)}) {{",
            f"    const int ended = {call};",
            "    if (ended < 0) { return smachac::step::failed; }",
            "    return static_cast<Outcome>(ended);",
            "  }",
            "  Host &host;",
            "};",
        ]
    )


def _told(machine: Machine, scopes: Mapping[str, Any]) -> Iterator[str]:
    """Statements that print the keys of every container that it does not share with the one around
    it."""
    members = {machine.root.name: "ud"}
    for path, scope in scopes.items():
        for child in scope.node.children:
            members[f"{path}/{child.name}"] = f"{members[path]}.{member(child)}"
        yield f"    {{ std::string line = {cpp_literal(f'userdata {path} {{')};"
        for key in scope.keys:
            if key in scope.shared:
                continue
            held = f"{members[path]}.{identifier(key)}"
            yield f"      vectors::tell(line, {cpp_literal(key)}, {held});"
        yield '      host.say(line + "}"); static_cast<void>(ud); }'


def program(parts: Sequence[Part], *, stepped: bool = False) -> str:
    host = (STEP_HOST if stepped else HOST).read_text("utf-8")
    head, names, tail = host.partition("/// Run a machine so often")
    return "\n".join(
        [
            head,
            *(item.classes for item in parts),
            "} // namespace vectors",
            *(item.header for item in parts),
            "namespace vectors {",
            "template <class T> const char *name_of(T outcome) { return name(outcome); }",
            names + tail,
            "int main() {",
            *(item.call for item in parts),
            "}",
            "",
        ]
    )


class _Asked:
    """What a leaf in the other process sees of its userdata, and what it answers."""

    def __init__(self, held: dict[str, Json], asked: bool, leaf: Leaf, loose: bool) -> None:
        self.held, self.preempted, self.replies = held, asked, list[str]()
        self.names = {} if loose else remapping(leaf)
        self.leaf = leaf
        self.reads = None if loose else {key.name for key in leaf.inputs}
        self.writes = None if loose else {key.name for key in leaf.outputs}

    def __getitem__(self, key: str) -> Json:
        if self.reads is not None and key not in self.reads:
            raise UserdataError("undeclared-read", key)
        if key not in self.held:
            raise UserdataError("missing-key", key)
        return self.held[key]

    def __contains__(self, key: object) -> bool:
        return (self.reads is None or key in self.reads) and key in self.held

    def __setitem__(self, key: str, value: Json) -> None:
        if self.writes is None or key in self.writes:
            outer = self.names.get(key, key)
            same = [name for name, to in self.names.items() if to == outer]
            self.held |= dict.fromkeys([key, *same], value)
            self.replies.append(f"set {key} {encoded(value)}")

    def keys(self) -> list[str]:
        return sorted(key for key in self.held if key in self)

    def service_preempt(self) -> None:
        self.preempted = False
        self.replies.append("service")


def encoded(value: Json) -> str:
    """A value as the host reads it."""
    match value:
        case None:
            return "n"
        case bool():
            return "t" if value else "f"
        case int():
            return f"i{value}"
        case str():
            return f"s{len(value.encode())}:{value}"
        case list():
            return f"l{len(value)}:{''.join(map(encoded, value))}"
    raise AssertionError(f"no value for C++: {value!r}")


class Remote(Replay):
    """A case whose machine runs in another process."""

    def __init__(self, case: Json, name: str) -> None:
        self.case, self.name = case, name
        self.leaves = leaves_of(case)
        self.events = []
        self.graph = dict(_walk(declared(case), ""))
        self.without_outcome = ""
        self.visits: dict[str, int] = {}
        self.asked: _Asked | None = None
        self.leaving: list[Any] = []
        self.interpreter: Any = self
        self.preemption = self

    def request(self, path: str) -> None:
        """A leaf asks the machine to stop."""
        assert path == ""
        assert self.asked is not None
        self.asked.preempted = True
        self.asked.replies.append("preempt")

    def answer(self, line: str) -> str:
        """What a leaf is to do, as lines; `line` is what it asks."""
        head, *keys = line.split("\t")
        _, path, asked = head.split(" ")
        path = path.removeprefix(f"{self.name}/root")
        held = {key: json.loads(value) for key, _, value in (item.partition("=") for item in keys)}
        leaf = self.graph[path]
        around = self.graph[path.rpartition("/")[0]]
        self.asked = view = _Asked(held, asked == "1", leaf, isinstance(around, nodes.Iterator))
        visit = self.visits[path] = self.visits.get(path, 0) + 1
        before = len(self.events) + 1
        try:
            return self._behaved(path, leaf, visit, view)
        finally:
            self.events, self.leaving = self.events[:before], self.events[before:]

    def _behaved(self, path: str, leaf: Leaf, visit: int, view: _Asked) -> str:
        try:
            outcome = self.behave(path, leaf, visit, view)  # type: ignore[arg-type]
        except UserdataError as error:
            return "\n".join([*view.replies, f"raise {error.kind.replace('-', '_')}", ""])
        except Exception:
            return "\n".join([*view.replies, "raise user_exception", ""])
        if outcome is None:
            self.without_outcome = self._kind_of_nothing(path)
            return "\n".join([*view.replies, "end -1", ""])
        return "\n".join([*view.replies, f"end {outcome_names(leaf).index(outcome)}", ""])

    def _kind_of_nothing(self, path: str) -> str:
        """What the recordings call it where a state ends without an outcome: that goes by the
        container around it (M8, N11, I6). C++ has one error for it."""
        while path:
            path = path.rpartition("/")[0]
            if not isinstance(self.graph[path], nodes.Iterator):
                among = isinstance(self.graph[path], nodes.Concurrence)
                return "other" if among else "invalid_transition"
        return "no_outcome"


def _walk(node: Node, path: str) -> Iterator[tuple[str, Any]]:
    yield path, node
    for child in getattr(node, "children", ()):
        yield from _walk(child, f"{path}/{child.name}")


@dataclass(slots=True, kw_only=True)
class Ran:
    """One run of a case: its outcome or the kind of its error, its events, userdata by path."""

    outcome: str | None = None
    category: str | None = None
    events: list[Json]
    userdata: dict[str, Json]


def replay(
    parts: Sequence[Part],
    compiler: Compiler,
    folder: Path,
    *flags: str,
    standard: str = "c++17",
    stepped: bool = False,
) -> dict[str, list[Ran]]:
    """What the compiled machines do, by the names of the cases."""
    flags = (*flags, "-pthread", f"-I{HOST.parent}")
    made = compiler.compile(program(parts, stepped=stepped), folder, *flags, standard=standard)
    found: dict[str, list[Ran]] = {}
    by_name = {item.name: item for item in parts}
    with subprocess.Popen(
        [str(made)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        remote: Remote | None = None
        ran = Ran(events=[], userdata={})
        for line in map(str.rstrip, process.stdout):
            word, _, rest = line.partition(" ")
            if word == "case":
                remote = Remote(by_name[rest].case, rest)
                runs = found.setdefault(by_name[rest].case["id"], [])
                continue
            assert remote is not None
            match word:
                case "ask":
                    process.stdin.write(remote.answer(line))
                    process.stdin.flush()
                case "left":
                    remote.events += remote.leaving
                case "outcome":
                    ran.outcome = rest
                case "error":
                    ran.category = remote.without_outcome if rest == "no_outcome" else rest
                case "userdata":
                    path, _, text = rest.partition(" ")
                    ran.userdata[path.removeprefix(remote.name)] = json.loads(text)
                case "run":
                    ran.events = remote.events
                    runs.append(ran)
                    ran, remote.events = Ran(events=[], userdata={}), []
                case _:
                    event = json.loads(line)
                    event["path"] = event["path"].removeprefix(f"{remote.name}/root")
                    remote.events.append(event)
    assert process.returncode == 0, f"ended with {process.returncode}, after {list(found)[-1]}"
    return found
