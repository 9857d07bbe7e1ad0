"""What all containers are printed with: their states, as calls in a switch."""

from __future__ import annotations

import re
from collections.abc import Mapping
from collections.abc import Set as AbstractSet
from dataclasses import dataclass

from smachac.ir.nodes import Concurrence, Iterator, Leaf, Node, Sequence, StateMachine
from smachac.ir.walk import own_outcomes
from smachac.targets.cpp.leaves import STOP, LeafCode
from smachac.targets.cpp.plan import Scope, member, place
from smachac.targets.cpp.types import UnportableError
from smachac.targets.cpp.words import identifier

Lines = list[str]

NEVER = ["default:", "  smachac::never();"]
"""With it compilers know that there are no other states, and look a state up without a test."""

NO_OUTCOME = "run.no_outcome(places, state);"
"""Where a state gets to that ended with none of its outcomes, a number cast to one. As this never
returns, compilers need not keep what it takes to run the state again."""

CAUGHT = "run.caught(places, state);"
GOES_ON = "SMACHAC_CATCH { run.failed(places, state); }"
"""What is done about an exception where it is caught, and where it is not."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Inside:
    """A container that is to be printed, the code of its leaves by name, and the names of all
    its states; `scopes` are those of the machine. `stopping` are the paths of containers in which
    something hears of requests to stop."""

    scope: Scope
    leaves: Mapping[str, LeafCode]
    names: frozenset[str]
    scopes: Mapping[str, Scope]
    stopping: AbstractSet[str]

    def hears(self, child: Node) -> bool:
        """Whether a state, or something in it, is told of requests to stop."""
        if isinstance(child, Leaf):
            return STOP in self.leaves[child.name].call
        return f"{self.scope.path}/{child.name}" in self.stopping

    @property
    def node(self) -> StateMachine | Sequence | Concurrence | Iterator:
        return self.scope.node

    def outcome(self, child: Node, name: str) -> str:
        """An outcome of a child."""
        if isinstance(child, Leaf):
            return self.leaves[child.name].outcome(name)
        return f"{identifier(child.name)}::Outcome::{identifier(name)}"

    def ends(self, name: str) -> str:
        """An outcome of the container."""
        if name not in results(self.node):
            raise UnportableError(f"`{self.scope.path}` has no outcome `{name}`")
        return f"Outcome::{identifier(name)}"


def results(node: Node) -> tuple[str, ...]:
    """The outcomes that a state itself ends with: an iterator that is asked to stop ends as its
    state did, declared or not (smach-semantics P9)."""
    found = dict.fromkeys(own_outcomes(node))
    if isinstance(node, Iterator):
        final = dict(node.final_map)
        ends = [name for child in node.children for name in all_results(child)]
        found |= dict.fromkeys(final.get(name, name) for name in ends)
    return tuple(found)


def all_results(node: Node) -> tuple[str, ...]:
    """The outcomes that a state can end with, the one for its exceptions among them."""
    return (*results(node), *([node.catches] if node.catches else []))


def indented(lines: Lines, by: int = 1) -> Lines:
    """Lines, so many levels deeper."""
    return [f"{'  ' * by}{line}" if line else "" for line in lines]


def called(inside: Inside, child: Node) -> tuple[Lines, str]:
    """The statements that run a child, and the expression for its outcome."""
    if isinstance(child, Leaf):
        return [], inside.leaves[child.name].call
    own = f"ud.{member(child)}"
    inner = inside.scopes[f"{inside.scope.path}/{child.name}"]
    names = inside.scope.names(child)
    before, after = [], []
    for key in child.inputs:
        outer = names.get(key.name, key.name)
        before.append(copied(f"{own}.", key.name, inside.scope, "ud.", outer))
    for key in child.outputs:
        outer = names.get(key.name, key.name)
        held = outer in inside.scope.sure
        after.append(copied("ud.", outer, inner, f"{own}.", key.name, held=held))
    call = f"{identifier(child.name)}::execute(states.{member(child)}, {own}, run)"
    if not after:
        return before, call
    return [*before, f"const auto outcome = {call};", *after], "outcome"


def copied(to: str, key: str, source: Scope, place: str, name: str, *, held: bool = False) -> str:
    """The statement that copies a key at the border of a container. `held`: where it goes to,
    there is a value already."""
    target, given = f"{to}{identifier(key)}", f"{place}{identifier(name)}"
    if name in source.sure:
        return f"{target}.{'replace' if held else 'hold'}({given}.get());"
    return f"{target}.take({given});"


def case(inside: Inside, child: Node, cases: Lines, result: str = "") -> Lines:
    """A case of the switch over the states: the child runs, then the switch over its outcomes."""
    before, outcome = called(inside, child)
    head = f"case State::{identifier(child.name)}:"
    where = f" // {place(child)}" if place(child) else ""
    if result:
        before, outcome = [*before, f"{result} = {outcome};"], result
        outcome = f"*{result}" if child.catches else result
    body = [*before, f"switch ({outcome}) {{", *cases, "}", "break;"]
    if any(line.startswith("const auto") for line in before):
        return [f"{head} {{{where}", *indented(body), "}"]
    return [f"{head}{where}", *indented(body)]


def switch(cases: Lines) -> Lines:
    """The switch over the states, as the body of a loop."""
    return [
        "  run.enter(places, state);",
        "  switch (state) {",
        *indented([*cases, *NEVER]),
        "  }",
        f"  {NO_OUTCOME}",
    ]


def guarded(lines: Lines, caught: Lines) -> Lines:
    """Statements, and what is done about their exceptions; if nothing, they go on with the place of
    the state."""
    catch = ["SMACHAC_CATCH {", *indented(caught), "}"] if caught else [GOES_ON]
    return ["SMACHAC_TRY {", *indented(lines), "}", *catch]


def caught_switch(cases: Lines) -> Lines:
    """What is done about an exception by states that end with theirs: nothing where none does."""
    if not cases:
        return []
    return ["switch (state) {", *cases, "default:", "  run.failed(places, state);", "}"]


def used(lines: Lines) -> tuple[str, str]:
    """The names of the states and of the userdata, as far as they are used."""
    return "states" if says(lines, "states") else "", "ud" if says(lines, "ud") else ""


def says(lines: Lines, name: str) -> bool:
    """Whether statements use a name, beyond texts."""
    code = (re.sub(r'"(?:[^"\\]|\\.)*"|//.*', "", line) for line in lines)
    return any(re.search(rf"(?<![\w.:]){name}\b", line) for line in code)
