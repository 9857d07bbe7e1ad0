"""Containers of stepped machines: one function for each, which makes one step of it.

A step of a state machine or sequence is a switch over its states. A step of a concurrence is a turn
of each of its branches, in their order. An iterator is a machine with one state and a list of
items. A container that has ended, or has not started, is in no state (`State::none_`): its next
step starts it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

from smachac.diagnostics.source import assert_never
from smachac.ir.nodes import (
    Concurrence,
    Container,
    Expression,
    Iterator,
    Leaf,
    Node,
    Sequence,
    StateMachine,
)
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import ends_preempted, leads_to_child, walk
from smachac.ir.types import Bounds, Type
from smachac.records import dataclass
from smachac.targets.cpp.bounded import is_loose, loose, most_bytes
from smachac.targets.cpp.containers import (
    ContainerPlan,
    Lines,
    concurrence_rules,
    copied_keys,
    indented,
    is_small,
    results,
    userdata_argument,
)
from smachac.targets.cpp.expressions import Spelling, cpp_bounded, cpp_function, lowered
from smachac.targets.cpp.identifiers import identifier
from smachac.targets.cpp.plan import ContainerScope, member, place
from smachac.targets.cpp.terms import size_of
from smachac.targets.cpp.types import UnportableError, cpp_literal, cpp_type, cpp_value

NONE = "State::none_"
ACTIVE = "states.active_"
FAILED = {True: "smachac::step::FAILED", False: "smachac::step::FAILED_INSIDE"}
"""The codes of the failure of a leaf, and of a container."""

RESERVED = ("active_", "branches_", "items_", "position_")
"""The members of `States` that are no states."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StepPlan:
    """A container to be printed, the numbers of all nodes by path, in the order of `walk`, and the
    bounds of texts and lists without one."""

    container: ContainerPlan
    numbers: Mapping[str, int]
    bounds: Bounds

    @property
    def node(self) -> Container:
        return self.container.node

    @property
    def number(self) -> int:
        """The number of the container."""
        return self.numbers[self.container.scope.path]

    def number_of(self, child: Node) -> int:
        return self.numbers[f"{self.container.scope.path}/{child.name}"]

    def end_of(self, child: Node) -> int:
        """The number after those of a child and all nodes in it."""
        return self.number_of(child) + sum(1 for _ in walk(child))


def states_members(plan: StepPlan) -> list[tuple[str, int]]:
    """The members of `States` that keep the state of the container, and upper limits on their
    sizes in bytes."""
    node = plan.node
    if isinstance(node, Concurrence):
        count = len(node.children)
        return [
            (f"smachac::step::Branches<{count}> branches_{{}};", 48 + 4 * count),
            ("[[nodiscard]] bool idle() const { return branches_.idle(); }", 0),
        ]
    found = [(f"State active_ = {NONE};", 8)]
    if isinstance(node, Iterator):
        found.append(("std::size_t position_ = 0;", 8))
        stored = _stored_items(plan, node)
        if stored is not None:
            found.append((f"{cpp_type(stored)} items_{{}};", most_bytes(stored)))
    return [*found, (f"[[nodiscard]] bool idle() const {{ return active_ == {NONE}; }}", 0)]


def step(plan: StepPlan) -> Lines:
    """The function that makes one step of a container."""
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
    scope = plan.container.scope
    caller = plan.container.scopes.get(scope.path.rpartition("/")[0])
    small = caller is None or is_small(caller.node)
    inline = "[[gnu::always_inline]] inline" if small else "inline"
    return [
        "template <class Run>",
        f"{inline} smachac::step::Result<Outcome> step_([[maybe_unused]] States &states,"
        f" [[maybe_unused]] {scope.userdata_type}ud, [[maybe_unused]] Run &run) {{",
        *indented(body),
        "}",
    ]


def requests(plan: StepPlan) -> Lines:
    """The functions that send a request to stop: to a child and all states that run in it, and to
    the children that run."""
    node = plan.node
    numbers = [str(plan.number_of(child)) for child in node.children]
    if isinstance(node, Concurrence):
        numbers.append(str(plan.end_of(node.children[-1])))
    cases = [
        line
        for at, child in enumerate(node.children)
        if not isinstance(child, Leaf)
        for line in (
            f"case {at}:",
            f"  return {identifier(child.name)}::ask_running_(states.{member(child)}, run);",
        )
    ]
    inner = ["switch (child) {", *cases, "default:", "  return;", "}"] if cases else []
    states = "states" if cases else ""
    if isinstance(node, Concurrence):
        running = [
            f"for (std::size_t i = 0; i < {len(node.children)}; ++i) {{",
            "  if (states.branches_.live(i)) {",
            "    ask_(states, run, i);",
            "  }",
            "}",
        ]
    else:
        running = [
            "if (!states.idle()) {",
            f"  ask_(states, run, static_cast<std::size_t>({ACTIVE}) - 1);",
            "}",
        ]
    return [
        f"inline constexpr std::uint16_t nodes_[] = {{{', '.join(numbers)}}};",
        "",
        "template <class Run>",
        f"void ask_(States &{states}, Run &run, std::size_t child) {{",
        "  run.ask(nodes_[child]);",
        *indented(inner),
        "}",
        "",
        "template <class Run>",
        "void ask_running_(States &states, Run &run) {",
        *indented(running),
        "}",
    ]


# One child


def _turn(plan: StepPlan, child: Node) -> Lines:
    """The statements of one step of a child: they set `result` to the code of its result."""
    number = plan.number_of(child)
    if isinstance(child, Leaf):
        return _leaf_turn(plan, child, number)
    scope = plan.container.scope
    inner = plan.container.scopes[f"{scope.path}/{child.name}"]
    before = [
        _copy(key.inside, key.name, key.around, key.outer in scope.sure)
        for key in copied_keys(scope, inner, child, child.inputs)
    ]
    after = [
        _copy(key.around, key.outer, key.inside, key.name in inner.sure)
        for key in copied_keys(scope, inner, child, child.outputs)
    ]
    userdata = userdata_argument(scope, inner, child)
    states = f"states.{member(child)}"
    call = f"{identifier(child.name)}::step_({states}, {userdata}, run)"
    may_fail = any(
        _copies_may_fail(plan, child, key.name) for key in (*child.inputs, *child.outputs)
    )
    lines = [f"run.enter({number}, {states}.idle());"]
    if before:
        lines = [
            f"if ({states}.idle()) {{",
            f"  run.enter({number}, true);",
            *indented(before),
            "}",
        ]
    result = f"{call}.code()"
    if may_fail:
        result = f"run.context.has_failed() ? run.failed_leaf({number}) : {result}"
    lines += [f"result = {result};"]
    if not after:
        return lines
    kept = [f"result = run.kept({number}, result);"] if may_fail else []
    return [*lines, "if (result >= 0) {", *indented([*after, *kept]), "}"]


def _copy(target: str, name: str, source: str, sure: bool) -> str:
    """The statement that copies a key into or out of a container."""
    if sure:
        return f"{target}.hold(run.context, {cpp_literal(name)}, {source}.unchecked());"
    return f"{target}.take(run.context, {cpp_literal(name)}, {source});"


def _copies_may_fail(plan: StepPlan, child: Node, key: str) -> bool:
    """Whether a copy of a key across the border of a container can go over a bound, or needs a
    conversion."""
    scope = plan.container.scope
    inner = plan.container.scopes[f"{scope.path}/{child.name}"]
    return scope.keys.get(scope.names(child)[key]) != inner.keys.get(key)


def _leaf_turn(plan: StepPlan, leaf: Leaf, number: int) -> Lines:
    code = plan.container.leaves[leaf.name]
    lines = [f"result = {code.call};"]
    lines += [
        f"result = run.within_bound(result, {out}, {name});" for out, name in code.bounded_outputs
    ]
    return [*lines, *(f"run.wrote({number}, {written});" for written in code.written)]


# State machines and sequences


def _machine(plan: StepPlan, node: StateMachine | Sequence) -> Lines:
    """The body of the function of a state machine or sequence."""
    children = {child.name: child for child in node.children}
    first = children[node.initial or node.children[0].name]
    others = [child for child in node.children if child is not first]
    lines = [
        "int result = 0;",
        f"switch ({ACTIVE}) {{",
        f"case {NONE}:",
        f"  run.begin({plan.number}, {plan.number_of(first)});",
        f"  {ACTIVE} = State::{identifier(first.name)};",
        "  [[fallthrough]];",
    ]
    for child in (first, *others):
        where = f" // {place(child)}" if place(child) else ""
        lines += [
            f"case State::{identifier(child.name)}: {{{where}",
            *indented(_turn(plan, child)),
            *indented(_result_switch(plan, child, partial(_transition, plan, child))),
            "  break;",
            "}",
        ]
    return [*lines, "default:", "  smachac::step::never();", "}", *_unended(plan)]


def _unended(plan: StepPlan) -> Lines:
    """The statement after a step of a child that has not ended with one of its outcomes."""
    child = f"nodes_[static_cast<std::size_t>({ACTIVE}) - 1]"
    if all(isinstance(child, Leaf) for child in plan.node.children):  # their numbers follow
        child = f"{plan.number} + static_cast<std::size_t>({ACTIVE})"
    return [f"return run.unended({ACTIVE}, {plan.number}, {child}, result);"]


def _transition(plan: StepPlan, child: Node, outcome: str, code: str) -> Lines:
    """The statements for an outcome of a state of a machine."""
    number = plan.number_of(child)
    edge = next((edge for edge in child.transitions if edge.outcome == outcome), None)
    if edge is None:
        return [f"return run.undeclared({ACTIVE}, {plan.number}, {number});"]
    if leads_to_child(edge, plan.container.names):
        target = next(child for child in plan.node.children if child.name == edge.target)
        to = f"State::{identifier(target.name)}, {plan.number}, {number}, {code}"
        return [f"return run.go({ACTIVE}, {to}, {plan.number_of(target)});"]
    return [f"return {_end(plan, child, plan.container.own_outcome(edge.target), code)};"]


def _end(plan: StepPlan, child: Node, own: str, code: str) -> str:
    """The call that ends a container after a child."""
    return f"run.end({ACTIVE}, {own}, {plan.number}, {plan.number_of(child)}, {code})"


def _result_switch(plan: StepPlan, child: Node, outcome: Callable[[str, str], Lines]) -> Lines:
    """The statements after a step of a child that has ended, or whose failure is an outcome.
    `outcome` gives those for an outcome and the text of its index."""
    cases: Lines = []
    for name in results(child):
        label = f"case smachac::step::code({plan.container.child_outcome(child, name)}):"
        cases += [label, *indented(outcome(name, "result"))]
    if child.catches:
        lines = outcome(child.catches, str(len(results(child))))
        if isinstance(child, Leaf):
            lines = [f"run.failed_leaf({plan.number_of(child)});", *lines]
        cases += [f"case {FAILED[isinstance(child, Leaf)]}:", *indented(lines)]
    switch = ["switch (result) {", *cases, "default:", "  break;", "}"]
    if isinstance(child, Leaf):
        return switch
    # What runs in it has set `first`, which is that of the branch.
    running = ["if (result == smachac::step::RUNNING) {", "  return smachac::step::running;", "}"]
    return [*running, *switch]


# Concurrences


def _concurrence(plan: StepPlan, node: Concurrence) -> Lines:
    """The body of the function of a concurrence."""
    lines = [
        "auto &branches = states.branches_;",
        "if (branches.idle()) {",
        f"  branches.begin(run, {plan.number}, nodes_);",
        "}",
        "int result = 0;",
    ]
    any_ = str(node.join == "any").lower()
    for at, child in enumerate(node.children):
        number, count = plan.number_of(child), len(results(child))
        function = "ended_leaf" if isinstance(child, Leaf) else "ended_container"
        ended = f"run.{function}({number}, result, {count})"
        if child.catches:
            ended = f"run.caught_branch({number}, {ended}, {count})"
        where = f" // {place(child)}" if place(child) else ""
        lines += [
            f"if (branches.turn({at}, run)) {{{where}",
            *indented(_turn(plan, child)),
            f"  if (branches.turned({at}, {ended}, run, {plan.number}, {any_})) {{",
            "    ask_running_(states, run);",
            "  }",
            "}",
        ]
    lines += [
        "if (!branches.idle()) {",
        "  return smachac::step::running;",
        "}",
    ]
    leave = f"branches.leave(run, {plan.number}, nodes_)"
    lines += [f"const bool stopped = {leave};" if ends_preempted(node) else f"{leave};"]
    lines += [
        "if (branches.has_failed()) {",
        "  return smachac::step::Unended{smachac::step::FAILED_INSIDE};",
        "}",
    ]
    if ends_preempted(node):
        own = plan.container.own_outcome(PREEMPTED)
        lines += ["if (stopped) {", f"  run.recall({plan.number});", f"  return {own};", "}"]

    def holds(child: Node, outcome: str) -> str:
        at = node.children.index(child)
        code = f"smachac::step::code({plan.container.child_outcome(child, outcome)})"
        if outcome == child.catches:
            code = str(len(results(child)))
        return f"branches.ended({at}, {code})"

    return [*lines, *concurrence_rules(plan.container, node, holds)]


# Iterators


def _stored_items(plan: StepPlan, node: Iterator) -> Type | None:
    """The type of the items that an iterator keeps while it runs; None if they are constants."""
    scope = plan.container.scope
    if node.items_key:
        type_ = scope.key(node.items_key)
        if type_.name not in ("bounded", "array"):
            raise UnportableError(f"the items key `{node.items_key}` is `{type_}`, not a list")
        return type_
    if node.items is None or not isinstance(node.items.data, Expression):
        return None
    body, names = cpp_function(node.items.data.text, _reads(scope))
    size = size_of(lowered(body, names).type)
    if size is not None:
        return Type("array", (scope.key(node.item_key), size))
    if not plan.bounds.list:
        message = "the number of the items is not known, and a stepped machine has no heap"
        help_ = "write `bounds = {list = 8}` in smachac.toml"
        raise UnportableError(message, help=help_)
    return Type("bounded", (scope.key(node.item_key), plan.bounds.list))


def _reads(scope: ContainerScope) -> dict[str, Spelling]:
    """The keys that a function of the script in an iterator may read."""
    return {key: scope.read(key, key) for key in scope.keys}


def _items(plan: StepPlan, node: Iterator) -> Lines:
    """The statements that compute the items of an iterator."""
    scope = plan.container.scope
    fail = ["if (run.context.has_failed()) {", f"  return run.give_up({plan.number});", "}"]
    if node.items_key:
        key, name = scope.object(node.items_key), cpp_literal(node.items_key)
        need = f"const auto &given = smachac::step::need(run.context, {key}, {name});"
        return [need, *fail, "smachac::step::put(run.context, items, given);"]
    assert node.items is not None
    assert isinstance(node.items.data, Expression)
    body, names = cpp_function(node.items.data.text, _reads(scope))
    listed = Type("list", (loose(scope.key(node.item_key)),))
    value = cpp_bounded(body, names, listed).text
    return [f"smachac::step::put(run.context, items, {value});", *fail]


def _iterator(plan: StepPlan, node: Iterator) -> Lines:
    """The body of the function of an iterator."""
    final = dict(node.final_map)
    container, scope = plan.container, plan.container.scope
    done = container.own_outcome(final.get(node.exhausted_outcome, node.exhausted_outcome))
    stopped = _stopped(plan, node)
    stored = _stored_items(plan, node)
    constants = node.items.data if stored is None and node.items is not None else ()
    if not isinstance(constants, tuple):
        raise UnportableError("the items of the iterator are not a list")
    if not node.children or (stored is None and not constants):
        return [*stopped, f"return {done};"]
    child = node.children[0]
    first = plan.number_of(child)
    item = f"{scope.object(node.item_key)}.hold(run.context, {cpp_literal(node.item_key)}, "
    start: Lines = []
    if stored is None:
        wanted = scope.key(node.item_key)
        listed = Type("array", (wanted, len(constants)))
        kind = "static const" if is_loose(wanted) else "static constexpr"
        lines = [f"{kind} {cpp_type(listed)} items = {cpp_value(constants, listed)};"]
    else:
        lines = ["auto &items = states.items_;"]
        start = [
            *_items(plan, node),
            "if (items.size() == 0) {",
            *indented([*stopped, f"return {done};"]),
            "}",
        ]
    start += [
        f"{item}items[0]);",
        "states.position_ = 1;",
        f"run.begin_items({plan.number}, {first});",
        f"{ACTIVE} = State::{identifier(child.name)};",
    ]
    where = [f"// {place(child)}"] if place(child) else []
    return [
        *lines,
        "if (states.idle()) {",
        *indented(start),
        "}",
        "int result = 0;",
        *where,
        *_turn(plan, child),
        *_result_switch(plan, child, partial(_item_outcome, plan, node, child)),
        *_unended(plan),
    ]


def _stopped(plan: StepPlan, node: Iterator) -> Lines:
    """The statements that end an iterator without items after a request to stop."""
    if not ends_preempted(node):
        return []
    own = plan.container.own_outcome(PREEMPTED)
    end = plan.end_of(node.children[0]) if node.children else plan.number + 1
    return [
        f"if (run.asked({plan.number})) {{",
        f"  run.recall({plan.number}, {end});",
        f"  return {own};",
        "}",
    ]


def _item_outcome(plan: StepPlan, node: Iterator, child: Node, name: str, code: str) -> Lines:
    """The statements for an outcome of an iterator's state."""
    final = dict(node.final_map)
    result = final.get(name, name)
    after = PREEMPTED if ends_preempted(node) else result
    end = plan.end_of(child)
    stopped = [
        f"if (run.asked({plan.number})) {{",
        f"  run.recall({plan.number}, {end});",
        f"  return {_end(plan, child, plan.container.own_outcome(after), code)};",
        "}",
    ]
    if name not in node.loop_outcomes:
        return [*stopped, f"return {_end(plan, child, plan.container.own_outcome(result), code)};"]
    done = final.get(node.exhausted_outcome, node.exhausted_outcome)
    item = plan.container.scope.object(node.item_key)
    return [
        *stopped,
        "if (states.position_ == items.size()) {",
        f"  return {_end(plan, child, plan.container.own_outcome(done), code)};",
        "}",
        f"{item}.hold(run.context, {cpp_literal(node.item_key)}, items[states.position_++]);",
        f"return run.again({plan.number_of(child)}, {code});",
    ]
