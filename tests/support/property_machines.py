"""Random machines and properties, and a monitor of properties over traces.

The machines have every kind of container, exceptions that are caught, requests to stop, time limits
and loops. The monitor is written from docs/properties.md, not from the automata of the checker.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from smachac.diagnostics.source import NOWHERE
from smachac.interpreter.interpreter import run
from smachac.interpreter.result import Event
from smachac.interpreter.userdata import BehaviourError, Userdata
from smachac.ir.nodes import (
    Concurrence,
    Condition,
    Iterator,
    Leaf,
    Machine,
    Node,
    Origin,
    Outcome,
    OutcomeRule,
    StateMachine,
    Sugar,
    Transition,
    Value,
)
from smachac.ir.nodes import (
    Sequence as SequenceNode,
)
from smachac.ir.properties import (
    After,
    AlwaysEnds,
    AtMost,
    Atom,
    Atoms,
    Before,
    Form,
    Never,
    Property,
)
from smachac.ir.traversal import outcome_names, own_outcomes, walk

PREEMPTED = "preempted"
TAGS = ("safe", "moves")
CLAIMS = ("arm.left", "arm.right", "gripper")


def _outcomes(names: Sequence[str]) -> tuple[Outcome, ...]:
    return tuple(Outcome(name=name, span=NOWHERE) for name in dict.fromkeys(names))


class _Drawing:
    """Draws a machine. Every outcome of a state in a state machine has a transition."""

    def __init__(self, rng: random.Random, *, branches: int) -> None:
        self.rng = rng
        self.made = 0
        self.branches = branches

    def fresh(self) -> str:
        self.made += 1
        return f"S{self.made}"

    def likely(self, chance: float) -> bool:
        return self.rng.random() < chance

    def exits(self) -> list[str]:
        names = self.rng.sample(["done", "failed", "lost"], self.rng.randint(1, 2))
        return [*names, PREEMPTED] if self.likely(0.5) else names

    def node(self, depth: int) -> Node:
        kinds: list[Callable[[int], Node]] = [
            self.leaf,
            self.leaf,
            self.linear,
            self.concurrence,
            self.iterator,
        ]
        made = self.rng.choice(kinds if depth else kinds[:1])(depth)
        if self.likely(0.2) and not (isinstance(made, Concurrence | Iterator) and made.sugar):
            made = replace(made, catches="error", outcomes=(*made.outcomes, *_outcomes(["error"])))
        return made

    def leaf(self, depth: int) -> Leaf:
        return Leaf(
            name=self.fresh(),
            type=self.rng.choice(["Look", "Move"]),
            outcomes=_outcomes(self.exits()),
            tags=tuple(tag for tag in TAGS if self.likely(0.3)),
            claims=tuple(claim for claim in CLAIMS if self.likely(0.2)),
            span=NOWHERE,
        )

    def linear(self, depth: int, exits: Sequence[str] = ()) -> StateMachine | SequenceNode:
        name, exits = self.fresh(), exits or self.exits()
        children = [self.node(depth - 1) for _ in range(self.rng.randint(1, 3))]
        places = [child.name for child in children]
        linked = []
        for child in children:
            steps = []
            for outcome in outcome_names(child):
                target = self.rng.choice([*places, *exits, *exits])
                origin: Origin = "implicit" if target == outcome and self.likely(0.5) else "written"
                steps.append(
                    Transition(outcome=outcome, target=target, origin=origin, span=NOWHERE)
                )
            linked.append(replace(child, transitions=tuple(steps)))
        fields: dict[str, Any] = {
            "name": name,
            "outcomes": _outcomes(exits),
            "children": tuple(linked),
            "initial": self.rng.choice(places),
            "span": NOWHERE,
        }
        if self.likely(0.2):
            return SequenceNode(type="Sequence", connector_outcome="done", **fields)
        return StateMachine(type="StateMachine", **fields)

    def concurrence(self, depth: int) -> Concurrence:
        name, exits = self.fresh(), self.exits()
        sugar: Sugar = "timeout" if self.likely(0.2) else ""
        if sugar and PREEMPTED not in exits:
            exits.append(PREEMPTED)
        children = [self.node(depth - 1) for _ in range(self.rng.randint(2, self.branches))]
        rules = []
        for _ in range(self.rng.randint(0, 3)):
            chosen = self.rng.sample(children, self.rng.randint(1, len(children)))
            when = [
                Condition(
                    child=item.name, outcome=self.rng.choice(outcome_names(item)), span=NOWHERE
                )
                for item in chosen
            ]
            rules.append(
                OutcomeRule(outcome=self.rng.choice(exits), when=tuple(when), span=NOWHERE)
            )
        return Concurrence(
            name=name,
            type="Concurrence",
            outcomes=_outcomes(exits),
            children=tuple(children),
            default_outcome=self.rng.choice(exits),
            rules=tuple(rules),
            join=self.rng.choice(["all", "any"]),
            sugar=sugar,
            span=NOWHERE,
        )

    def iterator(self, depth: int) -> Iterator:
        name, exits = self.fresh(), self.exits()
        sugars: list[Sugar] = ["retry", "for_each"]
        sugar: Sugar = self.rng.choice(sugars) if self.likely(0.4) else ""
        if sugar and PREEMPTED not in exits:
            exits.append(PREEMPTED)
        child = self.node(depth - 1)
        names = outcome_names(child)
        loops = [item for item in names if self.likely(0.5)]
        final = [("exhausted", self.rng.choice(exits))]
        final += [
            (item, self.rng.choice(exits))
            for item in names
            if item not in exits or self.likely(0.3)
        ]
        return Iterator(
            name=name,
            type="Iterator",
            outcomes=_outcomes(exits),
            children=(child,),
            items=Value(data=tuple(range(self.rng.randint(0, 3))), span=NOWHERE),
            loop_outcomes=tuple(loops),
            final_map=tuple(final),
            sugar=sugar,
            span=NOWHERE,
        )


def random_machine(rng: random.Random, *, depth: int = 3, branches: int = 3) -> Machine:
    """A machine with some leaves in containers of every kind."""
    root = _Drawing(rng, branches=branches).linear(depth, ["succeeded", "aborted"])
    fields: dict[str, Any] = {
        name: getattr(root, name) for name in ("outcomes", "children", "initial", "span")
    }
    return Machine(root=StateMachine(name="sm", type="StateMachine", **fields))


def random_property(rng: random.Random, machine: Machine) -> Property:
    """A property over states, outcomes, tags, types and claims of a machine."""
    places = [(path, node) for path, node in walk(machine.root)]
    nodes = [node for _, node in places]
    tags = [tag for node in nodes for tag in node.tags]
    claims = [claim for node in nodes for claim in node.claims]

    def atom() -> Atom:
        kind = rng.random()
        if kind < 0.1 and tags:
            return Atom(subject="tag", name=rng.choice(tags), span=NOWHERE)
        if kind < 0.2 and claims:
            return Atom(subject="claim", name=rng.choice(claims), span=NOWHERE)
        node = rng.choice(nodes)
        names = outcome_names(node)
        outcome = rng.choice(names) if names and rng.random() < 0.4 else None
        return Atom(subject="path", name=node.name, outcome=outcome, span=NOWHERE)

    def some() -> Atoms:
        return tuple(atom() for _ in range(rng.choice([1, 1, 2])))

    number = rng.randint(1, 3)
    forms: list[Form] = [
        Never(after=some(), until=some() if rng.random() < 0.6 else (), enter=some()),
        Never(enter=some(), until=some() if rng.random() < 0.5 else ()),
        Before(later=some(), earlier=some()),
        After(first=some(), answer=some()),
        After(first=some(), answer=some(), within=number),
        AtMost(event=some(), times=number),
        AlwaysEnds(),
    ]
    if claims:
        claim = Atom(subject="claim", name=rng.choice(claims), span=NOWHERE)
        forms.append(After(first=some(), answer=some(), before_claim=(claim,)))
    form = rng.choice(forms)
    return Property(name="p", form=form, stops=rng.random() < 0.7, span=NOWHERE)


class Monitor:
    """Whether a trace violates a property; `leaves` are entered one at a time in `within`."""

    def __init__(self, machine: Machine, form: Form) -> None:
        self.nodes = dict(walk(machine.root))
        self.form = form

    def matches(self, atoms: Atoms, event: tuple[str, str | None]) -> bool:
        path, outcome = event
        node = self.nodes[path]
        for atom in atoms:
            if atom.outcome != outcome:
                continue
            match atom.subject:
                case "path" if f"/{path}".endswith(f"/{atom.name}"):
                    return True
                case "tag" if atom.name in node.tags:
                    return True
                case "claim" if any(
                    f"{claim}.".startswith(f"{atom.name}.") for claim in node.claims
                ):
                    return True
        return False

    def violated(self, trace: Sequence[Event], *, ended: bool) -> bool:
        """`ended`: the run has ended with an outcome."""
        events = [
            (event["path"], event.get("outcome"))
            for event in trace
            if event["event"] in ("start", "enter", "exit", "finish")
        ]
        match self.form:
            case Never(after=after, until=until, enter=enter):
                return self._never(events, after, until, enter)
            case Before(later=later, earlier=earlier):
                return self._never(events, (), earlier, later)
            case AtMost(event=event, times=times):
                return sum(self.matches(event, item) for item in events) > times
            case After():
                return any(
                    self._unanswered(events[number + 1 :], self.form, ended=ended)
                    for number, each in enumerate(events)
                    if self.matches(self.form.first, each)
                    and not self.matches(self.form.answer, each)
                )
        raise AssertionError("a finite trace cannot violate it")

    def _never(
        self, events: Sequence[tuple[str, str | None]], after: Atoms, until: Atoms, enter: Atoms
    ) -> bool:
        forbidden = not after
        for event in events:
            if forbidden and self.matches(until, event):
                if not after:
                    return False
                forbidden = self.matches(after, event)
            elif forbidden and self.matches(enter, event):
                return True
            elif not forbidden:
                forbidden = self.matches(after, event)
        return False

    def _unanswered(
        self, rest: Sequence[tuple[str, str | None]], form: After, *, ended: bool
    ) -> bool:
        entered = 0
        for item in rest:
            if self.matches(form.answer, item):
                return False
            if self.matches(form.before_claim, item):
                return True
            entered += item[1] is None and isinstance(self.nodes[item[0]], Leaf)
            if form.within and entered >= form.within:
                return True
        return ended


def random_trace(
    machine: Machine, seed: int, *, stops: bool, most: int = 60
) -> tuple[list[Event], bool]:
    """The trace of a run with random outcomes, caught exceptions and requests to stop, and whether
    it ended with an outcome. A run of too many states is cut."""
    rng = random.Random(seed)
    nodes = dict(walk(machine.root))
    trace: list[Event] = []

    def is_caught(path: str) -> bool:
        parts = path.split("/")
        return any(nodes["/".join(parts[: end + 1])].catches for end in range(1, len(parts)))

    def behave(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
        if stops and rng.random() < 0.1:
            userdata.stop_machine()
        if userdata.preempted and PREEMPTED in outcome_names(leaf):
            userdata.service_preempt()
            return PREEMPTED
        if is_caught(path) and rng.random() < 0.2:
            raise BehaviourError("random")
        return rng.choice([name for name in own_outcomes(leaf) if name != PREEMPTED])

    result = run(machine, behave, trace.append, seed=seed, max_steps=most)
    return trace, result.outcome is not None
