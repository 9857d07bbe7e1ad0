"""The C++ program that runs test cases on a stepped machine.

It contains its test cases and reads nothing, so it also runs on a microcontroller.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from importlib import resources

from smachac.ir.nodes import Leaf, StateType
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import own_outcomes
from smachac.ir.types import Type
from smachac.records import dataclass, replace
from smachac.targets.cpp.bounded import loose
from smachac.targets.cpp.builtin_states import enumeration
from smachac.targets.cpp.identifiers import identifier
from smachac.targets.cpp.plan import ContainerScope, Plan, place, scope_name
from smachac.targets.cpp.records import project_structs
from smachac.targets.cpp.types import cpp_literal, cpp_value, script_data
from smachac.targets.cpp.user_classes import interface_hash, step_field_type
from smachac.verify.players.cpp_program import CppLeaf, Program
from smachac.verify.test_case import OPAQUE, TestCase

HOSTED = """
#include <cstdio>

void verify::print(const char *text, std::size_t size) { std::fwrite(text, 1, size, stdout); }
"""
"""The output of a program on a computer with an operating system."""


class StepProgram(Program):
    """A stepped machine as a program for some test cases. `name` is that of its namespaces and of
    the function that runs it."""

    def __init__(self, planned: Plan, cases: Sequence[TestCase], name: str = "machine") -> None:
        self.name = name
        super().__init__(planned, cases)

    def _leaf(self, number: int, path: str, leaf: Leaf, scope: ContainerScope) -> CppLeaf:
        return _StepLeaf(number=number, path=path, leaf=leaf, scope=scope, space=self.name)

    def script(self) -> str:
        return ""

    def text(self) -> str:
        return program_text([self], HOSTED)

    @property
    def most_leaves(self) -> int:
        """A number larger than that of every leaf."""
        return 1 + max((leaf.number for leaf in self._leaves.values()), default=0)

    def parts(self) -> Iterator[str]:
        """The code of the leaves and machines, and the function that runs all test cases."""
        yield from project_structs(self._plan.names, self._plan.bounds)
        yield f"namespace verify::{self.name} {{"
        yield from (leaf.text(self._reads) for leaf in self._leaves.values())
        yield "}"
        for number, live in enumerate(self._stages):
            yield f"namespace {self.name}_{number} {{\n{self._machine(live)[0]}\n}}"
        yield f"namespace verify::{self.name} {{"
        yield from self._script()
        yield from self._run()
        yield "}"

    def _run(self) -> Iterator[str]:
        scope = self._plan.scopes[self._plan.machine.root.name]
        yield "inline void run() {"
        yield "  const auto given = [](auto &ud, auto &fault) {"
        yield "    static_cast<void>(ud), static_cast<void>(fault);"
        inputs = {key: value for case in self._test_cases for key, value in case.userdata.items()}
        for key, value in inputs.items():
            if key in scope.keys:
                text = cpp_value(script_data(value), scope.keys[key])
                yield f"    ud.{identifier(key)}.hold(fault, {cpp_literal(key)}, {text});"
        yield "  };"
        yield "  for (const TestCase &test_case : test_cases) {"
        for number in range(len(self._stages)):
            machine = f"::{self.name}_{number}::{scope_name(scope.path)}::Machine"
            yield f"    if (test_case.stage == {number}) {{"
            yield f"      play<{machine}<smachac::step::TraceWriter>>(test_case, given);"
            yield "    }"
        yield "  }"
        yield "}"

    def _script(self) -> Iterator[str]:
        """The tables of the test cases."""
        table = []
        for at, case in enumerate(self._test_cases):
            rows = []
            for path, row in case.rows.items():
                if row:
                    leaf = self._leaves[path]
                    steps = ", ".join(str(leaf.case_of(step)) for step in row)
                    name = f"steps_{at}_{leaf.number}"
                    yield f"constexpr std::uint16_t {name}[] = {{{steps}}};"
                    rows.append(f"{{{leaf.number}, {len(row)}, {name}}}")
            yield f"constexpr Row rows_{at}[] = {{{', '.join(rows) or '{0, 0, nullptr}'}}};"
            stage, stopped = self._stages.index(case.live), str(case.stopped).lower()
            table.append(f"{{{stage}, {case.most}, {stopped}, {len(rows)}, rows_{at}}}")
        yield f"constexpr TestCase test_cases[] = {{{', '.join(table)}}};"


def program_text(programs: Sequence[StepProgram], output: str) -> str:
    """A program that runs all test cases of several machines, one after the other. `output` is the
    text with the function that prints."""
    play = resources.files("smachac.verify").joinpath("play_step.hpp").read_text("utf-8")
    most = max(program.most_leaves for program in programs)
    return "\n".join(
        [
            f"#define MOST_LEAVES {most}",
            play,
            output,
            *(part for program in programs for part in program.parts()),
            "int main() {",
            *(f"  verify::{program.name}::run();" for program in programs),
            "  return 0;",
            "}",
        ]
    )


@dataclass(slots=True, kw_only=True)
class _StepLeaf(CppLeaf):
    """A leaf of a stepped machine that performs test cases; its class is in a namespace."""

    space: str

    def keys(self) -> dict[str, dict[str, Type]]:
        """The inputs and outputs that exist in C++, with their types and bounds."""
        names = self.scope.names(self.leaf)
        found: dict[str, dict[str, Type]] = {"input_keys": {}, "output_keys": {}}
        for kind, keys in (("input_keys", self.leaf.inputs), ("output_keys", self.leaf.outputs)):
            for key in keys:
                outer = names[key.name]
                if outer in self.scope.keys:
                    type_ = _written(self.scope.keys[outer])
                    if kind == "input_keys" and type_.name != "optional":
                        type_ = Type("optional", (type_,))
                    if type_ != Type("optional", (Type("none"),)):
                        found[kind][key.name] = type_
        return found

    def state_type(self) -> StateType:
        header = {"header": "smachac/step.hpp", "class": f"verify::{self.space}::{self.type}"}
        return replace(CppLeaf.state_type(self), classes={"cpp": header})

    def text(self, reads: Mapping[str, Sequence[str]]) -> str:
        keys, number = self.keys(), interface_hash(self.state_type())
        stored = {
            kind: {name: self._stored(kind, name) for name in names} for kind, names in keys.items()
        }
        ins, outs = (
            [f"{step_field_type(part, type_)} {identifier(key)};" for key, type_ in types.items()]
            for part, types in zip(("In", "Out"), stored.values(), strict=True)
        )
        parameters = ["smachac::step::Context &context"]
        parameters += ["[[maybe_unused]] In in"] * bool(ins)
        parameters += ["[[maybe_unused]] Out out"] * bool(outs)
        place_ = f"{cpp_literal(self.path)}, {cpp_literal(place(self.leaf))}"
        return "\n".join(
            [
                f"struct {self.type} {{",
                *enumeration(own_outcomes(self.scripted())),
                f"struct In {{ {' '.join(ins)} }};",
                f"struct Out {{ {' '.join(outs)} }};",
                f"static constexpr std::uint32_t smachac_interface = {number};",
                f"smachac::step::Result<Outcome> step({', '.join(parameters)}) {{",
                "  if (context.first) {",
                f"    step_ = next({self.number});",
                *self._first_reads(reads.get(self.path, ()), keys["input_keys"], place_),
                "  }",
                *self._switch(keys["output_keys"]),
                "}",
                "int step_ = -1;",
                "};",
            ]
        )

    def _stored(self, kind: str, name: str) -> Type:
        """The storage of a key as the class sees it."""
        stored = self.scope.keys[self.scope.names(self.leaf)[name]]
        optional = kind == "input_keys" and stored.name != "optional"
        return Type("optional", (stored,)) if optional else stored

    def _first_reads(
        self, reads: Sequence[str], types: Mapping[str, Type], place_: str
    ) -> Iterator[str]:
        """The statements that record the inputs."""
        for key in reads:
            name, text = identifier(key), cpp_literal(key)
            if key in types:
                yield f"    if (in.{name}) {{ read({place_}, {text}, *in.{name}); }}"
            else:
                yield f"    read({place_}, {text}, std::string_view({cpp_literal(OPAQUE)}));"

    def _switch(self, outputs: Mapping[str, Type]) -> Iterator[str]:
        """The switch over the step, with a case for each distinct step."""
        yield "  switch (step_) {"
        able = PREEMPTED in own_outcomes(self.leaf)
        for number, row in enumerate(self.rows):
            yield f"  case {number}:"
            waiting, asks = (str(flag).lower() for flag in (row.wait, row.stop))
            yield f"    if (waits(context, {waiting}, {asks})) {{ return smachac::step::running; }}"
            yield f"    if (context.stop_requested() && {str(able).lower()}) {{"
            yield "      context.service();"
            outcome = PREEMPTED if able else row.outcome
            yield f"      return Outcome::{identifier(outcome)};"
            yield "    }"
            if row.error:
                yield f"    return context.error({cpp_literal(row.error)});"
                continue
            for key, value in row.writes.items():
                if key in outputs:
                    stored = self._stored("output_keys", key)
                    text = cpp_value(script_data(value), stored)
                    yield f"    out.{identifier(key)} = {text};"
            yield f"    return Outcome::{identifier(row.outcome)};"
        yield "  default:"
        yield '    return context.error("is not in the script");'
        yield "  }"


def _written(type_: Type) -> Type:
    """A storage in the notation of scripts."""
    match type_.name, type_.args:
        case "text", (int(size),):
            return Type("str", (size,))
        case "bounded", (Type() as item, int(size)):
            return Type("list", (_written(item), size))
        case (("array" | "optional"), (Type() as item, *rest)):
            return Type(type_.name, (_written(item), *rest))
        case "struct", parts:
            fields = (_written(part) if isinstance(part, Type) else part for part in parts)
            return Type("struct", tuple(fields))
    return loose(type_)
