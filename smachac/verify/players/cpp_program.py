"""The C++ program that plays scenes.

The containers are printed as the target prints them. Each leaf is a class of its own, which has
all that it ever does as the cases of a switch; a scene says which one at which visit. On live
paths some leaves are as the target prints them: there is a second machine for those.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from importlib import resources

from smachac.diagnostics.diagnostic import Report, in_order
from smachac.frontend.loader import Library, memory_library
from smachac.frontend.state_types import find_state_type
from smachac.interpreter.scenario import Row
from smachac.ir.nodes import Leaf, Node, Outcome, StateMachine
from smachac.ir.traversal import PREEMPTED, containers, own_outcomes, walk
from smachac.ir.types import Type
from smachac.targets.cpp.builtin_states import enumeration
from smachac.targets.cpp.header import header_of
from smachac.targets.cpp.identifiers import identifier
from smachac.targets.cpp.plan import Plan, Scope, place, scope_name
from smachac.targets.cpp.types import cpp_literal, cpp_type, cpp_value, plain, script_data
from smachac.targets.cpp.user_classes import interface_hash, parameter_type
from smachac.verify.guidance import leaf_outcomes
from smachac.verify.paths import LIVE_TYPES
from smachac.verify.test_case import OPAQUE, Scene


class Program:
    """A machine as a program for some scenes.

    What it reads is for each scene the number of the machine that plays it, then the scene
    (play.hpp).
    """

    def __init__(self, planned: Plan, library: Library, scenes: Sequence[Scene]) -> None:
        self._plan = planned
        self._library = library
        self._scenes = scenes
        self._stages = sorted({scene.live for scene in scenes}, key=sorted)
        self._leaves: dict[str, CppLeaf] = {}
        for number, (path, node) in enumerate(walk(planned.machine.root)):
            if isinstance(node, Leaf):
                scope = planned.scopes[path.rpartition("/")[0]]
                self._leaves[path] = CppLeaf(number=number, path=path, leaf=node, scope=scope)
        for scene in scenes:
            for path, row in scene.rows.items():
                for step in row:
                    self._leaves[path].case_of(step)

    def script(self) -> str:
        """What the program reads."""
        lines = []
        for scene in self._scenes:
            rows = {path: row for path, row in scene.rows.items() if row}
            lines.append(f"{self._stages.index(scene.live)} {scene.most} {len(rows)}")
            for path, row in rows.items():
                leaf = self._leaves[path]
                cases = " ".join(str(leaf.case_of(step)) for step in row)
                lines.append(f"{leaf.number} {len(row)} {cases}")
        return "\n".join(lines) + "\n"

    def text(self) -> str:
        """What is to be compiled."""
        library = self._all()
        play = resources.files("smachac.verify").joinpath("play.hpp").read_text("utf-8")
        leaves = [leaf.text(library, self._reads) for leaf in self._leaves.values()]
        machines = [
            f"namespace stage{number} {{\n{self._machine(live, library)[0]}\n}}"
            for number, live in enumerate(self._stages)
        ]
        spaces = ["namespace verify {", *leaves, "} // namespace verify"]
        return "\n".join([play, *spaces, *machines, *self._main()])

    def refused(self) -> Report:
        """What C++ cannot say of the machine; the code of its states does not matter but where
        scenes may leave it to them."""
        live = frozenset(
            path for path, leaf in self._leaves.items() if leaf.leaf.type in LIVE_TYPES
        )
        return self._machine(live, self._all())[1]

    def _all(self) -> Library:
        """The library with the interfaces of the leaves."""
        made = self._leaves.values()
        interfaces = {f"templates/{leaf.type}.yml": leaf.interface() for leaf in made}
        return memory_library(interfaces, self._library)

    @property
    def _reads(self) -> Mapping[str, Sequence[str]]:
        return {path: keys for scene in self._scenes for path, keys in scene.reads.items()}

    def _machine(self, live: frozenset[str], library: Library) -> tuple[str, Report]:
        """What the target prints of the machine with scripted leaves but for live ones, and what
        it refuses."""
        made: dict[str, Node] = {}
        for path, node in reversed(list(walk(self._plan.machine.root))):
            if isinstance(node, Leaf):
                made[path] = node if path in live else self._leaves[path].scripted()
            else:
                children = tuple(made[f"{path}/{child.name}"] for child in node.children)
                made[path] = replace(node, children=children)
        root = made[self._plan.machine.root.name]
        assert isinstance(root, StateMachine)
        machine = replace(self._plan.machine, root=root)
        scopes = {
            path: replace(self._plan.scopes[path], node=node) for path, node in containers(root)
        }
        planned = Plan(machine=machine, scopes=scopes, report=list(self._plan.report))
        lines = header_of(planned, library).text.splitlines()
        text = "\n".join(line for line in lines if not line.startswith("#"))
        return text, in_order(planned.report)

    def _main(self) -> Iterator[str]:
        scope = self._plan.scopes[self._plan.machine.root.name]
        name = scope_name(scope.path)
        given = {key: value for scene in self._scenes for key, value in scene.userdata.items()}
        yield "int main() {"
        yield "  for (std::size_t stage = 0; std::cin >> stage;) {"
        for number in range(len(self._stages)):
            here = f"stage{number}::{name}"
            yield f"    if (stage == {number}) {{"
            yield f"      verify::play<{here}::States, {here}::Userdata>([](auto &ud) {{"
            yield "        static_cast<void>(ud);"
            for key, value in given.items():
                if key in scope.keys:
                    text = cpp_value(script_data(value), scope.keys[key])
                    yield f"        ud.{identifier(key)}.hold({text});"
            yield f"      }}, {here}::run);"
            yield "    }"
        yield "  }"
        yield "}"


@dataclass(slots=True, kw_only=True)
class CppLeaf:
    """A leaf that follows scenes, and all that it does in them: cases by what they say."""

    number: int
    path: str
    leaf: Leaf
    scope: Scope
    cases: dict[str, int] = field(default_factory=dict)
    rows: list[Row] = field(default_factory=list)

    @property
    def type(self) -> str:
        return f"VerifyLeaf{self.number}"

    def case_of(self, row: Row) -> int:
        """The number of the case that does what a row says."""
        told = json.dumps(row)
        if told not in self.cases:
            self.cases[told] = len(self.rows)
            self.rows.append(row)
        return self.cases[told]

    def scripted(self) -> Leaf:
        """The leaf of a state type of its own. What an open one ends with is what leads on."""
        span = self.leaf.span
        outcomes = self.leaf.outcomes or tuple(
            Outcome(name=name, span=span) for name in leaf_outcomes(self.leaf)
        )
        return replace(self.leaf, type=self.type, outcomes=outcomes, open=False, variables=())

    def keys(self) -> dict[str, dict[str, Type]]:
        """The inputs and outputs that C++ has, with their types; inputs may hold nothing."""
        names = self.scope.names(self.leaf)
        found: dict[str, dict[str, Type]] = {"input_keys": {}, "output_keys": {}}
        for key in self.leaf.outputs:
            outer = names.get(key.name, key.name)
            if outer in self.scope.keys:
                found["output_keys"][key.name] = self.scope.keys[outer]
        for key in self.leaf.inputs:
            outer = names.get(key.name, key.name)
            if outer in self.scope.keys:
                type_ = plain(Type("optional", (self.scope.keys[outer],)))
                if type_.name == "optional":
                    found["input_keys"][key.name] = type_
        return found

    def interface(self) -> str:
        keys = {
            part: {name: str(type_) for name, type_ in types.items()}
            for part, types in self.keys().items()
        }
        told = {
            **keys,
            "outcomes": {name: {} for name in own_outcomes(self.scripted())},
            "blocking": True,
            "code": {"cpp": {"header": "smachac/smachac.hpp", "class": f"verify::{self.type}"}},
        }
        return json.dumps(told)

    def text(self, library: Library, reads: Mapping[str, Sequence[str]]) -> str:
        """The class. The library has its interface."""
        keys, type_ = self.keys(), find_state_type(self.type, library, [])
        assert type_ is not None
        ins = [f"{parameter_type(t)} {identifier(k)};" for k, t in keys["input_keys"].items()]
        outs = [
            f"smachac::Key<{cpp_type(t)}> &{identifier(k)};" for k, t in keys["output_keys"].items()
        ]
        parameters = ["In in"] * bool(ins) + ["Out out"] * bool(outs) + ["smachac::Stop &stop"]
        spot = f"{{{cpp_literal(self.path)}, {cpp_literal(place(self.leaf))}}}"
        lines = [
            f"struct {self.type} {{",
            *enumeration(own_outcomes(self.scripted())),
            f"struct In {{ {' '.join(ins)} }};",
            f"struct Out {{ {' '.join(outs)} }};",
            f"static constexpr std::uint32_t smachac_interface = {interface_hash(type_)};",
            f"Outcome execute({', '.join(parameters)}) {{",
            f"  const std::size_t step = next({self.number});",
            f"  [[maybe_unused]] constexpr smachac::Place place{spot};",
            *self._told(reads.get(self.path, ()), keys["input_keys"]),
            "  switch (step) {",
            *self._cases(keys["output_keys"]),
            "  default:",
            "    smachac::never();",
            "  }",
            "}",
            "};",
        ]
        return "\n".join(lines)

    def _told(self, reads: Sequence[str], types: Mapping[str, Type]) -> Iterator[str]:
        for key in reads:
            name, text = identifier(key), cpp_literal(key)
            if key in types:
                yield f"  if (in.{name}) {{ read(place, {text}, smachac::json(*in.{name})); }}"
            else:
                yield f"  read(place, {text}, {cpp_literal(json.dumps(OPAQUE))});"

    def _cases(self, types: Mapping[str, Type]) -> Iterator[str]:
        able = PREEMPTED in own_outcomes(self.leaf)
        for number, row in enumerate(self.rows):
            yield f"  case {number}:"
            waits, asks = (str(each).lower() for each in (row.wait, row.stop))
            yield f"    if (asked(stop, {waits}, {asks}) && {str(able).lower()}) {{"
            yield "      stop.service();"
            outcome = PREEMPTED if able else row.outcome
            yield f"      return Outcome::{identifier(outcome)};"
            yield "    }"
            if row.error:
                yield f"    throw std::runtime_error({cpp_literal(row.error)});"
                continue
            for key, value in row.writes.items():
                if key in types:
                    text = cpp_value(script_data(value), types[key])
                    yield f"    out.{identifier(key)} = {text};"
            yield f"    return Outcome::{identifier(row.outcome)};"
