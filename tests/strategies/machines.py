"""Hypothesis strategies for types of userdata and for machines: arbitrary ones and valid ones.

A machine is drawn in one pass from the outside to the inside. That is fast, but examples shrink
less well.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any, Literal, TypeVar

from hypothesis import strategies as st

from smachac.diagnostics.source import NOWHERE
from smachac.ir.nodes import (
    Concurrence,
    Condition,
    Data,
    Expression,
    Iterator,
    Key,
    Leaf,
    Machine,
    Node,
    Origin,
    Outcome,
    OutcomeRule,
    Preset,
    Remap,
    Sequence,
    StateMachine,
    Struct,
    Transition,
    Value,
    Variable,
)
from smachac.ir.traversal import outcome_names
from smachac.ir.types import ANY, Type
from tests.support.typed_machines import as_built_in

T = TypeVar("T")

WORDS = st.sampled_from(["bool", "int", "Pose", "any", "list", "geometry_msgs/Pose", "a.b-c", "of"])
UNITS = st.sampled_from(["rad", "m", "rad/s", "kg*m^2"])
CHOICES = st.one_of(WORDS, st.text(max_size=4), st.integers(-9, 99), st.just("one_of"))


def types() -> st.SearchStrategy[Type]:
    """Every type that the notation can name."""
    quantities = st.builds(lambda unit: Type("float", (unit,)), UNITS)
    choices = st.lists(CHOICES, min_size=1, max_size=3)
    leaves = WORDS.map(Type) | quantities | choices.map(lambda all: Type("one_of", (*all,)))
    wrappers = st.sampled_from(["list", "dict", "optional", "array", "record"])

    def wrap(item: Type, names: list[str]) -> Type:
        for name in names:
            more = {"array": (item, len(names)), "record": ("a", item, "b c", Type("int"))}
            item = Type(name, more.get(name, (item,)))
        return item

    return st.builds(wrap, leaves, st.lists(wrappers, max_size=3))


# Strategies made once: one that is made anew for each draw costs more than the draw.
NAMES = st.sampled_from(["A", "B", "done", "on", "größe", "a b", "", "1", '"', "it's #"]) | st.text(
    max_size=4
)
DOCS = st.sampled_from(["", "", "Opens the gripper.", 'two\nlines "x" \\ # é']) | st.text(
    max_size=6
)
CODE = st.sampled_from(["lambda ud: ud.n + 1", "`", "", " x\n", "f('#\"')"]) | st.text(max_size=5)
NUMBERS = st.integers() | st.floats(allow_nan=False)
SCALARS = st.none() | st.booleans() | NUMBERS | st.text(max_size=5)
TYPES = types() | st.just(ANY)
ORIGINS: st.SearchStrategy[Origin] = st.sampled_from(["written", "implicit", "connector"])
BOOLEANS = st.booleans()
COUNTS = st.integers(0, 2)
JOINS: st.SearchStrategy[Literal["all", "any", "rule"]] = st.sampled_from(["all", "any", "rule"])


class _Drawing:
    """What draws the parts of any well-formed machine. Every field of every kind is reached."""

    def __init__(self, draw: st.DrawFn) -> None:
        self.draw = draw

    def name(self) -> str:
        return self.draw(NAMES)

    def some(self, make: Callable[[], T]) -> tuple[T, ...]:
        return tuple(make() for _ in range(self.draw(COUNTS)))

    def data(self, depth: int = 2) -> Data:
        kind = self.draw(st.integers(0, 4)) if depth else 0
        if kind == 1:
            return self.some(lambda: self.data(depth - 1))
        if kind == 2:
            return Struct(entries=self.some(lambda: (self.name(), self.data(depth - 1))))
        if kind == 3:
            return Expression(text=self.draw(CODE), span=NOWHERE)
        return self.draw(SCALARS)

    def value(self) -> Value:
        return Value(data=self.data(), span=NOWHERE)

    def key(self) -> Key:
        return Key(name=self.name(), type=self.draw(TYPES), doc=self.draw(DOCS), span=NOWHERE)

    def preset(self) -> Preset:
        return Preset(key=self.name(), value=self.value(), type=self.draw(TYPES), span=NOWHERE)

    def variable(self) -> Variable:
        type_ = self.draw(TYPES)
        return Variable(name=self.name(), type=type_, value=self.value(), span=NOWHERE)

    def outcome(self) -> Outcome:
        return Outcome(name=self.name(), doc=self.draw(DOCS), span=NOWHERE)

    def transition(self) -> Transition:
        return Transition(
            outcome=self.name(), target=self.name(), origin=self.draw(ORIGINS), span=NOWHERE
        )

    def remap(self) -> Remap:
        return Remap(key=self.name(), to=self.name(), span=NOWHERE)

    def condition(self) -> Condition:
        return Condition(child=self.name(), outcome=self.name(), span=NOWHERE)

    def rule(self) -> OutcomeRule:
        return OutcomeRule(outcome=self.name(), when=self.some(self.condition), span=NOWHERE)

    def common(self) -> dict[str, Any]:
        return {
            "name": self.name(),
            "type": self.name(),
            "doc": self.draw(DOCS),
            "outcomes": self.some(self.outcome),
            "inputs": self.some(self.key),
            "outputs": self.some(self.key),
            "transitions": self.some(self.transition),
            "remaps": self.some(self.remap),
            "claims": self.some(self.name),
            "catches": self.draw(st.sampled_from(["", "error"])),
            "span": NOWHERE,
        }

    def node(self, depth: int) -> Node:
        kinds = (self.leaf, self.state_machine, self.sequence, self.concurrence, self.iterator)
        return kinds[self.draw(st.integers(0, 4)) if depth else 0](depth)

    def inside(self, depth: int) -> dict[str, Any]:
        return {
            **self.common(),
            "children": self.some(lambda: self.node(depth - 1)) if depth else (),
            "userdata": self.some(self.preset),
        }

    def leaf(self, depth: int) -> Leaf:
        return Leaf(
            **self.common(),
            variables=self.some(self.variable),
            open=self.draw(BOOLEANS),
            blocking=self.draw(BOOLEANS),
        )

    def state_machine(self, depth: int) -> StateMachine:
        forever = self.draw(BOOLEANS)
        return StateMachine(**self.inside(depth), initial=self.name(), forever=forever)

    def sequence(self, depth: int) -> Sequence:
        connector = self.name()
        return Sequence(**self.inside(depth), connector_outcome=connector, initial=self.name())

    def concurrence(self, depth: int) -> Concurrence:
        return Concurrence(
            **self.inside(depth),
            default_outcome=self.name(),
            rules=self.some(self.rule),
            join=self.draw(JOINS),
        )

    def iterator(self, depth: int) -> Iterator:
        return Iterator(
            **self.inside(depth),
            items=self.value() if self.draw(BOOLEANS) else None,
            items_key=self.name(),
            item_key=self.name(),
            exhausted_outcome=self.name(),
            loop_outcomes=self.some(self.name),
            final_map=self.some(lambda: (self.name(), self.name())),
        )


@st.composite
def machines(draw: st.DrawFn) -> Machine:
    """Any well-formed machine, most of them nonsense: names clash, targets dangle."""
    drawing = _Drawing(draw)
    return Machine(
        root=drawing.state_machine(2),
        base=drawing.name(),
        variables=drawing.some(drawing.variable),
        source=drawing.name(),
        digest=drawing.name(),
    )


EXITS = st.lists(st.sampled_from(["done", "failed", "lost"]), min_size=1, max_size=3, unique=True)
FEW = st.integers(1, 3)
SHORT_ITEMS = st.lists(st.integers(0, 9), max_size=3).map(tuple)
STORED = "count"
"""The userdata key that state machines and sequences hold; leaves call it so or `value`."""


def outcomes_of(names: list[str]) -> tuple[Outcome, ...]:
    return tuple(Outcome(name=name, span=NOWHERE) for name in names)


def keys_of(*names: str) -> tuple[Key, ...]:
    return tuple(Key(name=name, span=NOWHERE) for name in names)


class Building:
    """What draws the parts of a machine without a fault.

    A chain of first outcomes leads from every initial state through all its siblings to the first
    outcome of the container, and every leaf ends with its first outcome sooner or later; so every
    state can be reached and every run ends.
    """

    def __init__(self, draw: st.DrawFn) -> None:
        self.draw = draw
        self.made = 0

    def fresh(self) -> str:
        self.made += 1
        return f"S{self.made}"

    def exits(self, first: str | None = None) -> list[str]:
        """Names of outcomes, `first` in front where it is given."""
        drawn = self.draw(EXITS)
        return drawn if first is None else [first, *(name for name in drawn if name != first)]

    def children(self, depth: int, first: str | None = None, *, stored: bool) -> list[Node]:
        count = self.draw(FEW)
        return [self.node(depth - 1, self.exits(first), stored=stored) for _ in range(count)]

    def node(self, depth: int, exits: list[str], *, stored: bool) -> Node:
        """A node that no transition leaves yet. `stored`: its container holds the key `count`."""
        kind = self.draw(st.integers(0, 5)) if depth else 0
        if kind == 2:
            return self.state_machine(depth, exits, stored=stored)
        if kind == 3:
            return self.sequence(depth, exits, stored=stored)
        if kind == 4:
            return self.concurrence(depth, exits)
        if kind == 5:
            return self.iterator(depth, exits)
        return self.leaf(exits, stored=stored)

    def leaf(self, exits: list[str], *, stored: bool) -> Leaf:
        reads, writes = (stored and self.draw(BOOLEANS) for _ in range(2))
        key = "value" if self.draw(BOOLEANS) else STORED
        steps = [self.step(name, key if writes else None) for name in self.visits(exits)]
        remap = Remap(key=key, to=STORED, span=NOWHERE)
        leaf = Leaf(
            name=self.fresh(),
            type="ScriptedState",
            outcomes=outcomes_of(exits),
            inputs=keys_of(key) if reads else (),
            outputs=keys_of(key) if writes else (),
            remaps=(remap,) if (reads or writes) and key != STORED else (),
            variables=(
                Variable(name="steps", value=Value(data=tuple(steps), span=NOWHERE), span=NOWHERE),
            ),
            span=NOWHERE,
        )
        return as_built_in(leaf)

    def visits(self, exits: list[str]) -> list[str]:
        """The outcome of each visit; the last one, which is repeated, is the first of `exits`."""
        return [*self.draw(st.lists(st.sampled_from(exits), max_size=2)), exits[0]]

    def step(self, outcome: str, key: str | None) -> Struct:
        told: tuple[tuple[str, Data], ...] = (("outcome", outcome),)
        if key is not None and self.draw(BOOLEANS):
            told = (*told, ("set", Struct(entries=((key, self.draw(st.integers(0, 9))),))))
        return Struct(entries=told)

    def holding(self, children: list[Node], exits: list[str], *, stored: bool) -> dict[str, Any]:
        """The fields of a container that holds `count`, handing it in and out where it may."""
        passed = stored and self.draw(BOOLEANS)
        return {
            "name": self.fresh(),
            "outcomes": outcomes_of(exits),
            "children": tuple(children),
            "initial": children[0].name,
            "inputs": keys_of(STORED) if passed else (),
            "outputs": keys_of(STORED) if passed else (),
            "userdata": (Preset(key=STORED, value=Value(data=0, span=NOWHERE), span=NOWHERE),),
            "span": NOWHERE,
        }

    def linked(self, children: list[Node], exits: list[str], origin: Origin) -> list[Node]:
        """The children with their transitions. `origin` is that of the links of the chain."""
        names = [child.name for child in children]
        anywhere = st.sampled_from([*names, *exits])
        found = []
        for child, following in zip(children, [*names[1:], exits[0]], strict=True):
            first, *others = outcome_names(child)
            chain = origin if following in names else self.origin(first, following)
            steps = [transition(first, following, chain)]
            for outcome in others:
                target = self.draw(anywhere)
                steps.append(transition(outcome, target, self.origin(outcome, target)))
            found.append(dataclasses.replace(child, transitions=tuple(steps)))
        return found

    def origin(self, outcome: str, target: str) -> Origin:
        return "implicit" if outcome == target and self.draw(BOOLEANS) else "written"

    def state_machine(self, depth: int, exits: list[str], *, stored: bool) -> StateMachine:
        children = self.linked(self.children(depth, stored=True), exits, "written")
        held = self.holding(children, exits, stored=stored)
        return StateMachine(type="StateMachine", **held)

    def sequence(self, depth: int, exits: list[str], *, stored: bool) -> Sequence:
        linked = self.linked(self.children(depth, exits[0], stored=True), exits, "connector")
        held = self.holding(linked, exits, stored=stored)
        return Sequence(type="Sequence", connector_outcome=exits[0], **held)

    def concurrence(self, depth: int, exits: list[str]) -> Concurrence:
        """No two rules hold at once: they differ in the outcome of the first child."""
        children = self.children(depth, stored=False)
        deciding, *others = children
        rules = []
        for number, outcome in enumerate(outcome_names(deciding)):
            if not self.draw(BOOLEANS):
                continue
            when = [Condition(child=deciding.name, outcome=outcome, span=NOWHERE)]
            for child in others:
                if self.draw(BOOLEANS):
                    ended = self.draw(st.sampled_from(outcome_names(child)))
                    when.append(Condition(child=child.name, outcome=ended, span=NOWHERE))
            result = self.draw(st.sampled_from(exits)) if number else exits[0]
            rules.append(OutcomeRule(outcome=result, when=tuple(when), span=NOWHERE))
        return Concurrence(
            name=self.fresh(),
            type="Concurrence",
            outcomes=outcomes_of(exits),
            children=tuple(children),
            default_outcome=exits[0],
            # A script, and SMACH, have one rule for an outcome.
            rules=tuple({rule.outcome: rule for rule in rules}.values()),
            span=NOWHERE,
        )

    def iterator(self, depth: int, exits: list[str]) -> Iterator:
        child = self.node(depth - 1, self.exits(), stored=False)
        loops, final = [], [("exhausted", exits[0])]
        for number, outcome in enumerate(outcome_names(child)):
            target = self.draw(st.sampled_from(exits)) if number else exits[0]
            if self.draw(BOOLEANS):
                loops.append(outcome)
            elif target != outcome:
                final.append((outcome, target))
        return Iterator(
            name=self.fresh(),
            type="Iterator",
            outcomes=outcomes_of(exits),
            children=(child,),
            items=Value(data=self.draw(SHORT_ITEMS), span=NOWHERE),
            item_key="item",
            loop_outcomes=tuple(loops),
            final_map=tuple(final),
            span=NOWHERE,
        )


def transition(outcome: str, target: str, origin: Origin) -> Transition:
    return Transition(outcome=outcome, target=target, origin=origin, span=NOWHERE)


@st.composite
def valid_machines(draw: st.DrawFn, depth: int = 3) -> Machine:
    """Machines that no rule finds an error in, with leaves of the type ScriptedState.

    Every kind of container, loops, implicit exits, userdata written and read, passed into nested
    machines and out of them. Every run ends, and ends the same: concurrences wait for all.
    """
    building = Building(draw)
    root = building.state_machine(depth, building.exits(), stored=False)
    return Machine(root=dataclasses.replace(root, name="sm"), source="main.yml")
