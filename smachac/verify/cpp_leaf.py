"""A leaf of C++ that follows scenes: all that it ever does as the cases of a switch."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from smachac.ir.nodes import Leaf, Outcome
from smachac.ir.scenario import Row
from smachac.ir.types import Type
from smachac.ir.walk import PREEMPTED, own_outcomes
from smachac.states import Library, find_state_type
from smachac.targets.cpp.classes import interface_hash, parameter_type
from smachac.targets.cpp.leaves import enumeration
from smachac.targets.cpp.plan import Scope, place
from smachac.targets.cpp.types import cpp_literal, cpp_type, cpp_value, plain, script_data
from smachac.targets.cpp.words import identifier
from smachac.verify.scenes import OPAQUE
from smachac.verify.steering import leaf_outcomes


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
