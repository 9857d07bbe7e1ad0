"""State machines and sequences: one switch over the states, in a loop."""

from __future__ import annotations

from collections.abc import Iterable

from smachac.ir.nodes import Node, Sequence, StateMachine
from smachac.ir.walk import leads_to_child
from smachac.targets.cpp.inside import (
    CAUGHT,
    Inside,
    Lines,
    case,
    caught_switch,
    guarded,
    indented,
    results,
    switch,
    used,
)
from smachac.targets.cpp.types import cpp_literal
from smachac.targets.cpp.words import identifier

MOST_STATES = 40
"""Of one function. Of as many, compilers go from state to state by jumps; with more they look each
up in a table, and the time they take themselves is quadratic in the branches of a function."""


def machine(inside: Inside) -> Lines:
    """The body of the function of a state machine or sequence."""
    node = inside.node
    assert isinstance(node, StateMachine | Sequence)
    first = identifier(node.initial or node.children[0].name)
    start = f"State state = State::{first};"
    if len(node.children) > MOST_STATES:
        return [start, "Outcome ended{};", *_dispatch(len(node.children))]
    cases = [line for child in node.children for line in _step(inside, child, "")]
    steps = guarded(["for (;;) {", *switch(cases), "}"], _caught_steps(inside, node.children, ""))
    again = any(child.catches for child in node.children)
    return [start, *(["for (;;) {", *indented(steps), "}"] if again else steps)]


def _caught_steps(inside: Inside, children: Iterable[Node], ended: str) -> Lines:
    """The cases for the states that end with their exceptions, as in `_step`."""
    lines: Lines = []
    for child in children:
        if child.catches:
            ways = _way(inside, child, child.catches, ended)
            ways = ["break;" if line == "continue;" else line for line in ways]
            lines += [f"case State::{identifier(child.name)}:", f"  {CAUGHT}", *indented(ways)]
    return caught_switch(lines)


def parts(inside: Inside) -> Lines:
    """The functions that hold the states of a machine with too many for one; none where they fit.

    Each goes on while it has the state, and says whether the machine has ended.
    """
    node = inside.node
    if len(node.children) <= MOST_STATES or not isinstance(node, StateMachine | Sequence):
        return []
    lines: Lines = []
    for number, start in enumerate(range(0, len(node.children), MOST_STATES)):
        children = node.children[start : start + MOST_STATES]
        cases = [line for child in children for line in _step(inside, child, "ended")]
        states, userdata = used(cases)
        ends = [*cases, *_caught_steps(inside, children, "ended")]
        ended = "ended" if any(line.endswith("return true;") for line in ends) else ""
        here = f"while (static_cast<std::size_t>(state) / {MOST_STATES} == {number}) {{"
        loop = [here, *switch(cases), "}"]
        caught = _caught_steps(inside, children, "ended")
        steps = guarded(loop, caught)
        lines += [
            *([""] if lines else []),
            "template <class Run>",
            f"bool part_{number}(States &{states}, Userdata &{userdata}, Run &run, State &state,",
            f"{' ' * len(f'bool part_{number}(')}Outcome &{ended}) {{",
            *indented([here, *indented(steps), "}"] if caught else steps),
            "  return false;",
            "}",
        ]
    return lines


def _dispatch(count: int) -> Lines:
    cases = []
    for number in range(-(-count // MOST_STATES)):
        cases += [f"case {number}:", f"  if (part_{number}(states, ud, run, state, ended)) {{"]
        cases += ["    return ended;", "  }", "  break;"]
    head = f"switch (static_cast<std::size_t>(state) / {MOST_STATES}) {{"
    return ["for (;;) {", f"  {head}", *indented(cases), "  default:", "    break;", "  }", "}"]


def _step(inside: Inside, child: Node, ended: str) -> Lines:
    """The case of one state: the child runs and the machine goes on. `ended`: the variable for how
    it ends, in a function that only says whether it does."""
    ways: Lines = []
    for name in results(child):
        ways.append(f"case {inside.outcome(child, name)}:")
        ways += indented(_way(inside, child, name, ended))
    return case(inside, child, ways)


def _way(inside: Inside, child: Node, name: str, ended: str) -> Lines:
    """Where a state of a machine leads with an outcome."""
    told = cpp_literal(name)
    edge = next((edge for edge in child.transitions if edge.outcome == name), None)
    if edge is None:
        return [f"run.undeclared(places, state, {told});"]
    if leads_to_child(edge, inside.names):
        return [f"run.go(places, state, {told}, State::{identifier(edge.target)});", "continue;"]
    how = "end_asked" if inside.hears(child) else "end"
    end = f"run.{how}(places, state, {told}, {inside.ends(edge.target)});"
    return [f"{ended} = {end}", "return true;"] if ended else [f"return {end}"]
