"""Containers in C++: one function for each, which runs it from its entry to its outcome.

A state machine or sequence is a loop around a switch over its states; with many states the switch
is divided among several functions. A concurrence runs its states in threads and then evaluates its
rules. An iterator is a loop over its items.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from collections.abc import Set as AbstractSet
from itertools import islice
from typing import NamedTuple

from smachac.diagnostics.source import assert_never
from smachac.ir.nodes import (
    Concurrence,
    Container,
    Expression,
    Iterator,
    Key,
    Leaf,
    Node,
    OutcomeRule,
    Sequence,
    StateMachine,
    Transition,
)
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import ends_preempted, leads_to_child, own_outcomes, walk
from smachac.ir.types import Type
from smachac.records import dataclass, replace
from smachac.targets.cpp.builtin_states import LeafCode
from smachac.targets.cpp.expressions import cpp_expression, cpp_function
from smachac.targets.cpp.identifiers import identifier
from smachac.targets.cpp.plan import ContainerScope, member, place
from smachac.targets.cpp.types import UnportableError, cpp_literal, cpp_type, cpp_value

Lines = list[str]

MOST_STATES = 40
"""The most states in one function. Up to this number a compiler goes from state to state by jumps;
with more it uses a table, and its own running time is quadratic in the branches of a function."""

NEVER = ["default:", "  smachac::never();"]
"""The last case of the switch over the states. There is no other state, so the compiler can
omit the range check."""

NO_OUTCOME = "run.no_outcome(places, state);"
"""The statement after the switch over the outcomes: the state has ended with none of them (a number
cast to an outcome). It never returns, so the compiler keeps no values for a next turn after it."""

ENTER = "run.enter(places, state);"
"""The first statement of a state."""

CAUGHT = "run.caught(places, state);"
"""The statement for an exception that is an outcome of the state."""

FAILED = "SMACHAC_CATCH { run.failed(places, state); }"
"""The handler for an exception that leaves the container."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ContainerPlan:
    """A container to be printed: its scope, the code of its leaves and the names of its states.

    `scopes` are those of the machine, by path. `stopping` holds the paths of the containers in
    which a state receives requests to stop.
    """

    scope: ContainerScope
    leaves: Mapping[str, LeafCode]
    names: frozenset[str]
    scopes: Mapping[str, ContainerScope]
    stopping: AbstractSet[str]

    @property
    def node(self) -> Container:
        return self.scope.node

    def receives_stop(self, child: Node) -> bool:
        """Whether a state, or a state in it, receives requests to stop."""
        if isinstance(child, Leaf):
            return self.leaves[child.name].uses_stop
        return f"{self.scope.path}/{child.name}" in self.stopping

    def outcome_type(self, child: Node) -> str:
        """The enumeration of the outcomes of a child."""
        if isinstance(child, Leaf):
            return self.leaves[child.name].outcome_type
        return f"{identifier(child.name)}::Outcome"

    def child_outcome(self, child: Node, name: str) -> str:
        """An outcome of a child."""
        return f"{self.outcome_type(child)}::{identifier(name)}"

    def own_outcome(self, name: str) -> str:
        """An outcome of the container. Raises UnportableError where it has none of that name."""
        if name not in results(self.node):
            raise UnportableError(f"`{self.scope.path}` has no outcome `{name}`")
        return f"Outcome::{identifier(name)}"


@dataclass(frozen=True, slots=True, kw_only=True)
class FunctionBody:
    """The body of a function, and the names of those parameters that it uses; a parameter that is
    not used has no name."""

    statements: Lines
    states: str = ""
    userdata: str = ""
    run: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class ChildCall:
    """The call of a state: the statements before it and the expression for its outcome.

    `declares`: the statements declare a variable. `uses_userdata`: they use the userdata of the
    container.
    """

    statements: Lines
    outcome: str
    declares: bool
    uses_userdata: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class OutcomeCode:
    """The C++ statements for one outcome of a state.

    `jump`: the last statement, which starts the next state or item. `label`: the target of `jump`.
    `ends`: the outcome ends the container.
    """

    statements: Lines
    jump: str = ""
    label: str = ""
    ends: bool = False

    @property
    def with_jump(self) -> Lines:
        """All statements."""
        return [*self.statements, self.jump] if self.jump else self.statements


def results(node: Node) -> tuple[str, ...]:
    """The outcomes that a state itself ends with. An iterator that is stopped ends with the outcome
    of its state, whether it declares that outcome or not."""
    found = dict.fromkeys(own_outcomes(node))
    if isinstance(node, Iterator):
        final = dict(node.final_map)
        ends = [name for child in node.children for name in all_results(child)]
        found |= dict.fromkeys(final.get(name, name) for name in ends)
    return tuple(found)


def all_results(node: Node) -> tuple[str, ...]:
    """The outcomes that a state can end with, including the one for its exceptions."""
    return (*results(node), *([node.catches] if node.catches else []))


def execute(plan: ContainerPlan) -> Lines:
    """The function that runs a container from its entry to its outcome."""
    node = plan.node
    match node:
        case Iterator():
            body = _iterator(plan, node)
        case Concurrence():
            body = _concurrence(plan, node)
        case StateMachine() | Sequence():
            body = _machine(plan, node)
        case _:
            assert_never(node)
    # A container has one call only. It is inlined there unless that function becomes too large.
    caller = plan.scopes.get(plan.scope.path.rpartition("/")[0], plan.scope)
    inline = "[[gnu::always_inline]] inline" if is_small(caller.node) else "inline"
    return [
        "template <class Run>",
        f"{inline} Outcome execute(States &{body.states},"
        f" {plan.scope.userdata_type}{body.userdata}, Run &{body.run}) {{",
        *indented(body.statements),
        "}",
    ]


def is_small(node: Node) -> bool:
    """Whether one function can contain all states in a container."""
    return len(list(islice(walk(node), MOST_STATES + 1))) <= MOST_STATES


def indented(lines: Lines) -> Lines:
    """Lines, one level deeper."""
    return [f"  {line}" if line else "" for line in lines]


class CopiedKey(NamedTuple):
    """A key that is copied into a container before its call, or out of it after the call: its name
    inside and outside, and its C++ object in the userdata of the container and around it."""

    name: str
    outer: str
    inside: str
    around: str


def copied_keys(
    scope: ContainerScope, inner: ContainerScope, child: Container, keys: Iterable[Key]
) -> list[CopiedKey]:
    """Those of the input or output keys of a container that it does not share with `scope`, which
    is around it."""
    own, names = scope.userdata_of(child), scope.names(child)
    found: list[CopiedKey] = []
    for key in keys:
        if key.name not in inner.shared:
            inside, outer = f"{own}.{identifier(key.name)}", names[key.name]
            found.append(CopiedKey(key.name, outer, inside, scope.object(outer)))
    return found


def userdata_argument(scope: ContainerScope, inner: ContainerScope, child: Container) -> str:
    """The userdata in the call of a container: its own, and the keys that it shares."""
    own, names = scope.userdata_of(child), scope.names(child)
    if not inner.shared:
        return own
    return f"{{{', '.join([own, *(scope.object(names[key]) for key in inner.view)])}}}"


def _call(plan: ContainerPlan, child: Node) -> ChildCall:
    """The call of a child. The keys of a container are copied in before and out after its call."""
    if isinstance(child, Leaf):
        leaf = plan.leaves[child.name]
        return ChildCall(
            statements=[], outcome=leaf.call, declares=False, uses_userdata=leaf.uses_userdata
        )
    scope, inner = plan.scope, plan.scopes[f"{plan.scope.path}/{child.name}"]
    before = [
        _copy(key.inside, key.around, key.outer in scope.sure)
        for key in copied_keys(scope, inner, child, child.inputs)
    ]
    after = [
        _copy(key.around, key.inside, key.name in inner.sure, held=key.outer in scope.sure)
        for key in copied_keys(scope, inner, child, child.outputs)
    ]
    userdata = userdata_argument(scope, inner, child)
    call = f"{identifier(child.name)}::execute(states.{member(child)}, {userdata}, run)"
    found = ChildCall(statements=before, outcome=call, declares=False, uses_userdata=True)
    if not after:
        return found
    found = _with_variable(found)
    return replace(found, statements=[*found.statements, *after])


def _with_variable(call: ChildCall) -> ChildCall:
    """A call whose outcome is in a variable."""
    if call.declares:
        return call
    declared = f"const auto outcome = {call.outcome};"
    statements = [*call.statements, declared]
    return replace(call, statements=statements, outcome="outcome", declares=True)


def _copy(target: str, source: str, sure: bool, *, held: bool = False) -> str:
    """The statement that copies a key into or out of a container. `sure`: the source surely holds
    a value; `held`: the target does."""
    if sure:
        return f"{target}.{'replace' if held else 'hold'}({source}.unchecked());"
    return f"{target}.take({source});"


def _case(
    child: Node, call: ChildCall, outcomes: Lines, *, result: str = "", labelled: bool = False
) -> Lines:
    """The case of a state: the state runs, then the switch over its outcomes.

    `result` is a variable that keeps the outcome. `labelled`: other states jump to this one.
    """
    before, outcome = [ENTER, *call.statements], call.outcome
    if result:
        before = [*before, f"{result} = {outcome};"]
        outcome = f"*{result}" if child.catches else result
    name = identifier(child.name)
    where = f" // {place(child)}" if place(child) else ""
    begin, end = (" {", ["}"]) if call.declares else ("", [])
    heads = [f"case State::{name}:{begin}{where}", *([f"{name}:"] if labelled else [])]
    body = [*before, f"switch ({outcome}) {{", *outcomes, "}", "break;"]
    return [*heads, *indented(body), *end]


def _switch(cases: Lines) -> Lines:
    """The switch over the states."""
    return ["switch (state) {", *cases, *NEVER, "}", NO_OUTCOME]


def _guarded(lines: Lines, caught: Lines) -> Lines:
    """Statements in a `try`. `caught` are the statements of the handler; without any, exceptions
    leave the container with the place of the state."""
    handler = ["SMACHAC_CATCH {", *indented(caught), "}"] if caught else [FAILED]
    return ["SMACHAC_TRY {", *indented(lines), "}", *handler]


def _caught_switch(cases: Lines) -> Lines:
    """The handler with a case for each state that catches its exceptions; empty without any."""
    if not cases:
        return []
    return ["switch (state) {", *cases, "default:", "  run.failed(places, state);", "}"]


# State machines and sequences


def _machine(plan: ContainerPlan, node: StateMachine | Sequence) -> FunctionBody:
    """The body of the function of a state machine or sequence."""
    first = identifier(node.initial or node.children[0].name)
    start = f"State state = State::{first};"
    if len(node.children) > MOST_STATES:
        lines = [start, "Outcome ended{};", *_dispatch(len(node.children))]
        return FunctionBody(statements=lines, states="states", userdata="ud", run="run")
    part = _part(plan, node.children, "")
    steps = _guarded(_switch(part.cases), part.caught)
    if part.caught:
        steps = ["for (;;) {", *indented(steps), "}"]
    return FunctionBody(
        statements=[start, *steps],
        states="states",
        userdata="ud" if part.uses_userdata else "",
        run="run",
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Part:
    """The cases of some states of a machine, and the handler for their exceptions.

    `ends`: the machine ends in one of them.
    """

    cases: Lines
    caught: Lines
    uses_userdata: bool
    ends: bool


def _part(plan: ContainerPlan, children: tuple[Node, ...], ended: str) -> _Part:
    """The code of some states of a machine. `ended` is the variable for the outcome of the machine,
    in a function that returns whether the machine has ended."""
    cases: Lines = []
    caught: Lines = []
    calls: list[ChildCall] = []
    here = frozenset(child.name for child in children)
    codes: dict[tuple[str, str], OutcomeCode] = {}
    for child in children:
        edges = {edge.outcome: edge for edge in reversed(child.transitions)}
        for name in all_results(child):
            code = _outcome(plan, child, name, edges.get(name), ended, here)
            codes[child.name, name] = code
    labels = {codes[child.name, name].label for child in children for name in results(child)}
    for child in children:
        lines: Lines = []
        for name in results(child):
            lines.append(f"case {plan.child_outcome(child, name)}:")
            lines += indented(codes[child.name, name].with_jump)
        calls.append(_call(plan, child))
        labelled = identifier(child.name) in labels
        cases += _case(child, calls[-1], lines, labelled=labelled)
        if child.catches:
            code = codes[child.name, child.catches]
            after = ["break;"] if code.jump else []
            caught += [f"case State::{identifier(child.name)}:", f"  {CAUGHT}"]
            caught += indented([*code.statements, *after])
    return _Part(
        cases=cases,
        caught=_caught_switch(caught),
        uses_userdata=any(call.uses_userdata for call in calls),
        ends=any(code.ends for code in codes.values()),
    )


def parts(plan: ContainerPlan) -> Lines:
    """The functions that hold the states of a machine with too many for one; empty for others.

    Each function runs as long as its states follow one another, and returns whether the machine
    has ended.
    """
    node = plan.node
    if len(node.children) <= MOST_STATES or not isinstance(node, StateMachine | Sequence):
        return []
    lines: Lines = []
    for number, start in enumerate(range(0, len(node.children), MOST_STATES)):
        part = _part(plan, node.children[start : start + MOST_STATES], "ended")
        userdata, ended = "ud" if part.uses_userdata else "", "ended" if part.ends else ""
        here = f"while (static_cast<std::size_t>(state) / {MOST_STATES} == {number}) {{"
        steps = _guarded(_switch(part.cases), part.caught)
        head = f"bool part_{number}("
        lines += [
            *([""] if lines else []),
            "template <class Run>",
            f"{head}States &states, {plan.scope.userdata_type}{userdata}, Run &run, State &state,",
            f"{' ' * len(head)}Outcome &{ended}) {{",
            *indented([here, *indented(steps), "}", "return false;"] if part.caught else steps),
            "}",
        ]
    return lines


def _dispatch(count: int) -> Lines:
    """The loop that calls the function of the present state."""
    cases = []
    for number in range(-(-count // MOST_STATES)):
        cases += [f"case {number}:", f"  if (part_{number}(states, ud, run, state, ended)) {{"]
        cases += ["    return ended;", "  }", "  break;"]
    head = f"switch (static_cast<std::size_t>(state) / {MOST_STATES}) {{"
    return ["for (;;) {", f"  {head}", *indented(cases), "  default:", "    break;", "  }", "}"]


def _outcome(
    plan: ContainerPlan, child: Node, name: str, edge: Transition | None, ended: str,
    here: AbstractSet[str],
) -> OutcomeCode:  # fmt: skip
    """The transition of a state of a machine for an outcome; `ended` as in `_part`. `here` are the
    states of the same function."""
    text = cpp_literal(name)
    if edge is None:
        return OutcomeCode(statements=[f"run.undeclared(places, state, {text});"])
    if leads_to_child(edge, plan.names):
        target = identifier(edge.target)
        go = [f"run.go(places, state, {text}, State::{target});"]
        if edge.target not in here:
            return OutcomeCode(statements=go, jump="return false;")
        return OutcomeCode(statements=go, jump=f"goto {target};", label=target)
    end = "end_asked" if plan.receives_stop(child) else "end"
    value = f"run.{end}(places, state, {text}, {plan.own_outcome(edge.target)});"
    if ended:
        return OutcomeCode(statements=[f"{ended} = {value}", "return true;"], ends=True)
    return OutcomeCode(statements=[f"return {value}"], ends=True)


# Concurrences


def _concurrence(plan: ContainerPlan, node: Concurrence) -> FunctionBody:
    """The body of the function of a concurrence."""
    fields: Lines = []
    cases: Lines = []
    caught: Lines = []
    calls: list[ChildCall] = []
    for child in node.children:
        type_ = plan.outcome_type(child)
        type_ = f"std::optional<{type_}>" if child.catches else type_
        fields.append(f"  {type_} {identifier(child.name)};")
        lines: Lines = []
        for name in results(child):
            lines.append(f"case {plan.child_outcome(child, name)}:")
            lines += [f"  run.exit(places, state, {cpp_literal(name)});", "  return;"]
        calls.append(_call(plan, child))
        cases += _case(child, calls[-1], lines, result=f"ended.{identifier(child.name)}")
        if child.catches:
            caught += [
                f"case State::{identifier(child.name)}:",
                f"  {CAUGHT}",
                f"  run.exit(places, state, {cpp_literal(child.catches)});",
                "  break;",
            ]
    lines = [
        "struct {",
        *fields,
        "} ended{};",
        f"smachac::Branches<Run, {len(node.children)}> branches(around, places);",
        f"branches.run({str(node.join == 'any').lower()}, [&](std::size_t branch, Run &run) {{",
        "  const auto state = static_cast<State>(branch);",
        *indented(_guarded(_switch(cases), _caught_switch(caught))),
        "});",
        *_stopped(plan, node),
        *concurrence_rules(plan, node, lambda child, name: _ended(plan, child, name)),
    ]
    userdata = "ud" if any(call.uses_userdata for call in calls) else ""
    return FunctionBody(statements=lines, states="states", userdata=userdata, run="around")


def _stopped(plan: ContainerPlan, node: Concurrence) -> Lines:
    """The statements that end a time limit after a request to stop."""
    if not ends_preempted(node):
        return []
    return ["if (branches.stopped()) {", f"  return {plan.own_outcome(PREEMPTED)};", "}"]


def _ended(plan: ContainerPlan, child: Node, outcome: str) -> str:
    """The test whether a branch ended with an outcome."""
    value = plan.child_outcome(child, outcome)
    value = "std::nullopt" if outcome == child.catches else value
    return f"ended.{identifier(child.name)} == {value}"


def concurrence_rules(
    plan: ContainerPlan, node: Concurrence, ended: Callable[[Node, str], str]
) -> Lines:
    """The statements that return the outcome: of the rules that hold the one with the most
    conditions, among equals the last one listed. `ended` is the test whether a child ended with an
    outcome."""
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
            tests.append(ended(child, one.outcome))
        else:
            end = f"return {plan.own_outcome(rule.outcome)};"
            if not tests:
                return [*lines, end]
            lines += [*_test(tests), f"  {end}", "}"]
    if not node.default_outcome and node.rules:
        # The rules cover every combination, or SM401 is reported: C++ needs a last statement.
        return [*lines, f"return {plan.own_outcome(node.rules[-1].outcome)};"]
    return [*lines, f"return {plan.own_outcome(node.default_outcome)};"]


def _test(tests: Lines) -> Lines:
    """The head of an `if` over several tests, one a line."""
    starts = ["if (", *["    "] * (len(tests) - 1)]
    ends = [*[" &&"] * (len(tests) - 1), ") {"]
    return [start + test + end for start, test, end in zip(starts, tests, ends, strict=True)]


# Iterators


def _iterator(plan: ContainerPlan, node: Iterator) -> FunctionBody:
    """The body of the function of an iterator."""
    final = dict(node.final_map)
    done = plan.own_outcome(final.get(node.exhausted_outcome, node.exhausted_outcome))
    items = _items(plan, node)
    if items is None and node.children and ends_preempted(node):
        start = "smachac::Round round(run.stop, places[0], 0);"
        end = f"return round.over() ? {plan.own_outcome(PREEMPTED)} : {done};"
        return FunctionBody(statements=[start, end], run="run")
    if items is None or not node.children:
        return FunctionBody(statements=[f"return {done};"])
    child = node.children[0]
    cases: Lines = []
    for name in results(child):
        cases.append(f"case {plan.child_outcome(child, name)}:")
        cases += indented(_item_outcome(plan, node, name).with_jump)
    caught: Lines = []
    if child.catches:
        code = _item_outcome(plan, node, child.catches)
        caught = [CAUGHT, _end_of_item(node, [child.catches]), *code.statements]
    call = _with_variable(_call(plan, child))
    steps = [
        "run.enter(places, state);",
        *call.statements,
        _end_of_item(node, results(child)),
        f"switch ({call.outcome}) {{",
        *cases,
        "}",
        NO_OUTCOME,
    ]
    rounds = "smachac::Round round(run.stop, places[0], items.size());"
    state = f"const auto state = State::{identifier(child.name)};"
    begin = ["if (items.empty()) {", f"  return {done};", "}", state, rounds]
    if ends_preempted(node):
        none = f"  return round.over() ? {plan.own_outcome(PREEMPTED)} : {done};"
        begin = [rounds, "if (items.empty()) {", none, "}", state]
    lines = [
        *items,
        *begin,
        "for (const auto &item : items) {",
        f"  {plan.scope.object(node.item_key)}.hold(item);",
        *([f"  // {place(child)}"] if place(child) else []),
        *indented(_guarded(steps, caught)),
        "}",
        f"return {done};",
    ]
    return FunctionBody(statements=lines, states="states", userdata="ud", run="run")


def _end_of_item(node: Iterator, outcomes: Iterable[str]) -> str:
    """The statement that ends an item. It keeps whether a request to stop ends the iterator where
    an outcome would start the next item."""
    used = ends_preempted(node) or any(name in node.loop_outcomes for name in outcomes)
    return f"{'const bool over = ' if used else ''}round.over();"


def _item_outcome(plan: ContainerPlan, node: Iterator, name: str) -> OutcomeCode:
    """The code for an outcome of an iterator's state."""
    final = dict(node.final_map)
    text = cpp_literal(name)

    def end(outcome: str) -> str:
        return f"return run.end(places, state, {text}, {plan.own_outcome(outcome)});"

    result = final.get(name, name)
    stopped = ["if (over) {", f"  {end(PREEMPTED if ends_preempted(node) else result)}", "}"]
    if name not in node.loop_outcomes:
        before = stopped if ends_preempted(node) and result != PREEMPTED else []
        return OutcomeCode(statements=[*before, end(result)], ends=True)
    done = final.get(node.exhausted_outcome, node.exhausted_outcome)
    lines = [
        *stopped,
        *("if (round.last()) {", f"  {end(done)}", "}"),
        f"run.again(places, state, {text});",
    ]
    return OutcomeCode(statements=lines, jump="continue;")


def _items(plan: ContainerPlan, node: Iterator) -> Lines | None:
    """The statement that declares the items; None where there are none."""
    wanted = plan.scope.key(node.item_key)
    if node.items_key:
        type_ = plan.scope.key(node.items_key)
        if type_.name not in ("list", "array"):
            raise UnportableError(f"the items key `{node.items_key}` is `{type_}`, not a list")
        key = plan.scope.object(node.items_key)
        need = f"smachac::need({key}, {cpp_literal(node.items_key)})"
        return [f"const auto items = {need};"]
    if node.items is None or node.items.data == ():
        return None
    listed = Type("list", (wanted,))
    if isinstance(node.items.data, Expression):
        keys = {key: plan.scope.read(key, key) for key in plan.scope.keys}
        body, names = cpp_function(node.items.data.text, keys)
        return [f"const {cpp_type(listed)} items = {cpp_expression(body, names, listed).text};"]
    if not isinstance(node.items.data, tuple):
        raise UnportableError("the items of the iterator are not a list")
    listed = Type("array", (wanted, len(node.items.data)))
    return [f"const {cpp_type(listed)} items = {cpp_value(node.items.data, listed)};"]
