"""The functions that run containers, from their entry to their end."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from itertools import islice

from smachac.ir.nodes import (
    Concurrence,
    Expression,
    Iterator,
    Leaf,
    Node,
    OutcomeRule,
    Sequence,
    StateMachine,
)
from smachac.ir.traversal import leads_to_child, own_outcomes, walk
from smachac.ir.types import Type
from smachac.targets.cpp.builtin_states import STOP, LeafCode
from smachac.targets.cpp.expressions import cpp_expression, cpp_function
from smachac.targets.cpp.identifiers import identifier
from smachac.targets.cpp.plan import Scope, member, place
from smachac.targets.cpp.types import UnportableError, cpp_literal, cpp_type, cpp_value


def execute(inside: Inside) -> Lines:
    """The function that runs a container from its entry to its end."""
    match inside.node:
        case Iterator():
            body = iterator(inside)
        case Concurrence():
            body = concurrence(inside)
        case _:
            body = machine(inside)
    states, userdata = used(body)
    run = next((name for name in ("around", "run") if says(body, name)), "")
    # A container is run from one place only: if it is small, what surrounds it takes it in.
    few = len(list(islice(walk(inside.node), MOST_STATES + 1))) <= MOST_STATES
    inline = "[[gnu::always_inline]] inline" if few else "inline"
    return [
        "template <class Run>",
        f"{inline} Outcome execute(States &{states}, Userdata &{userdata}, Run &{run}) {{",
        *indented(body),
        "}",
    ]


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


def concurrence(inside: Inside) -> Lines:
    """The body of the function of a concurrence."""
    node = inside.node
    assert isinstance(node, Concurrence)
    fields: Lines = []
    cases: Lines = []
    caught: Lines = []
    for child in node.children:
        type_ = inside.outcome(child, "x").rpartition("::")[0]
        fields.append(
            f"  {f'std::optional<{type_}>' if child.catches else type_} {identifier(child.name)};"
        )
        ways: Lines = []
        for name in results(child):
            ways.append(f"case {inside.outcome(child, name)}:")
            ways += [f"  run.exit(places, state, {cpp_literal(name)});", "  return;"]
        cases += case(inside, child, ways, f"ended.{identifier(child.name)}")
        if child.catches:
            exit_ = f"run.exit(places, state, {cpp_literal(child.catches)});"
            caught += [
                f"case State::{identifier(child.name)}:",
                f"  {CAUGHT}",
                f"  {exit_}",
                "  break;",
            ]
    return [
        "struct {",
        *fields,
        "} ended{};",
        f"smachac::Branches<Run, {len(node.children)}> branches(around, places);",
        f"branches.run({str(node.join == 'any').lower()}, [&](std::size_t branch, Run &run) {{",
        "  const auto state = static_cast<State>(branch);",
        *indented(guarded([line[2:] for line in switch(cases)], caught_switch(caught))),
        "});",
        *_rules(inside, node),
    ]


def _rules(inside: Inside, node: Concurrence) -> Lines:
    """Rules with more conditions first, of as many the last listed first (smach-semantics N5)."""
    children = {child.name: child for child in node.children}

    def order(item: tuple[int, OutcomeRule]) -> tuple[int, int]:
        return -len(item[1].when), -item[0]

    lines: Lines = []
    for _, rule in sorted(enumerate(node.rules), key=order):
        tests = []
        for one in rule.when:
            child = children.get(one.child)
            if child is None or one.outcome not in all_results(child):
                break
            how = inside.outcome(child, one.outcome)
            how = "std::nullopt" if one.outcome == child.catches else how
            tests.append(f"ended.{identifier(one.child)} == {how}")
        else:
            end = f"return {inside.ends(rule.outcome)};"
            if not tests:
                return [*lines, end]
            lines += [*_test(tests), f"  {end}", "}"]
    return [*lines, f"return {inside.ends(node.default_outcome)};"]


def _test(tests: Lines) -> Lines:
    """The head of an `if` over several tests, one a line."""
    starts = ["if (", *["    "] * (len(tests) - 1)]
    ends = [*[" &&"] * (len(tests) - 1), ") {"]
    return [start + test + end for start, test, end in zip(starts, tests, ends, strict=True)]


def iterator(inside: Inside) -> Lines:
    """The body of the function of an iterator."""
    node = inside.node
    assert isinstance(node, Iterator)
    final = dict(node.final_map)
    done = inside.ends(final.get(node.exhausted_outcome, node.exhausted_outcome))
    items = _items(inside, node)
    if items is None or not node.children:
        return [f"return {done};"]
    child = node.children[0]
    item = f"ud.{identifier(node.item_key)}"
    state = f"State::{identifier(child.name)}"
    ways: Lines = []
    for name in results(child):
        ways.append(f"case {inside.outcome(child, name)}:")
        ways += indented(_round(inside, node, name))
    caught: Lines = []
    if child.catches:
        told = _over(node, [child.catches])
        ways_out = _round(inside, node, child.catches)
        caught = [CAUGHT, told, *(line for line in ways_out if line != "continue;")]
    before, outcome = called(inside, child)
    if outcome != "outcome":
        before, outcome = [*before, f"const auto outcome = {outcome};"], "outcome"
    steps = [
        "run.enter(places, state);",
        *before,
        _over(node, results(child)),
        "switch (outcome) {",
        *ways,
        "}",
        NO_OUTCOME,
    ]
    return [
        *items,
        "if (items.empty()) {",
        f"  return {done};",
        "}",
        f"const auto state = {state};",
        "smachac::Round round(run.stop, places[0], items.size());",
        "for (const auto &item : items) {",
        f"  {item}.hold(item);",
        *([f"  // {place(child)}"] if place(child) else []),
        *indented(guarded(steps, caught)),
        "}",
        f"return {done};",
    ]


def _over(node: Iterator, outcomes: Iterable[str]) -> str:
    """The statement that ends an item, and notes where it matters whether that ends them all."""
    matters = any(name in node.loop_outcomes for name in outcomes)
    return f"{'const bool over = ' if matters else ''}round.over();"


def _round(inside: Inside, node: Iterator, name: str) -> Lines:
    """Where an iterator's state leads with an outcome."""
    final = dict(node.final_map)
    told = cpp_literal(name)
    end = f"return run.end(places, state, {told}, {inside.ends(final.get(name, name))});"
    if name not in node.loop_outcomes:
        return [end]
    done = inside.ends(final.get(node.exhausted_outcome, node.exhausted_outcome))
    return [
        *("if (over) {", f"  {end}", "}"),
        *("if (round.last()) {", f"  return run.end(places, state, {told}, {done});", "}"),
        *(f"run.again(places, state, {told});", "continue;"),
    ]


def _items(inside: Inside, node: Iterator) -> Lines | None:
    """The statement that finds the items; None where there are none."""
    wanted = inside.scope.key(node.item_key)
    if node.items_key:
        type_ = inside.scope.key(node.items_key)
        if type_.name not in ("list", "array"):
            raise UnportableError(f"`{node.items_key}` is `{type_}`, not a list of items")
        need = f"smachac::need(ud.{identifier(node.items_key)}, {cpp_literal(node.items_key)})"
        return [f"const auto items = {need};"]
    if node.items is None or node.items.data == ():
        return None
    listed = Type("list", (wanted,))
    if isinstance(node.items.data, Expression):
        spelt = {key: inside.scope.read(key, key) for key in inside.scope.keys}
        body, names = cpp_function(node.items.data.text, spelt)
        return [f"const {cpp_type(listed)} items = {cpp_expression(body, names, listed).text};"]
    if not isinstance(node.items.data, tuple):
        raise UnportableError("its items are no list")
    listed = Type("array", (wanted, len(node.items.data)))
    return [f"const {cpp_type(listed)} items = {cpp_value(node.items.data, listed)};"]
