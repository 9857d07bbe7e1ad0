"""Hypothesis strategy for machines that use every feature, and may fail.

They may contain errors or run forever: a test limits the number of steps.
"""

from __future__ import annotations

import dataclasses
from typing import Any

from hypothesis import strategies as st

from smachac.diagnostics.source import NOWHERE
from smachac.ir.nodes import (
    Concurrence,
    Condition,
    Data,
    Expression,
    Iterator,
    Leaf,
    Machine,
    Node,
    Origin,
    OutcomeRule,
    Preset,
    Remap,
    StateMachine,
    Struct,
    Value,
    Variable,
)
from smachac.ir.traversal import outcome_names, walk
from tests.strategies.machines import BOOLEANS, FEW, Building, keys_of, outcomes_of, transition
from tests.support.typed_machines import as_built_in

NUMBERS = ["a", "b", "c"]
SOME_NUMBERS = st.lists(st.sampled_from(NUMBERS), max_size=3, unique=True)
NUMBER = st.sampled_from(NUMBERS)
SMALL = st.integers(0, 4)
ITEMS = st.lists(SMALL, max_size=3).map(tuple)
OUTCOMES = st.lists(
    st.sampled_from(["succeeded", "done", "failed", "preempted"]),
    min_size=1,
    max_size=3,
    unique=True,
)
RESULTS = st.sampled_from(
    [
        "ud.{0} + 1",
        "ud.{0} * 2 - ud.{1}",
        "max(ud.{0}, ud.{1})",
        "ud.{0} if ud.{1} > 1 else 7",
        "(ud.{0} + ud.{1}) % 5",
        "len(str(ud.{0}))",
        "sum([ud.{0}, ud.{1}, 1])",
        "-ud.{0}",
    ]
)
FAILING = st.sampled_from(["ud.{0} // ud.{1}", "ud.{0}[0]", "ud.lost"])
TESTS = st.sampled_from(["ud.{0} > 1", "ud.{0} == ud.{1}", "ud.{0} % 2 == 0 and not ud.{1} < 1"])


class _Busy(Building):
    """What draws the parts of a machine.

    Where `in_concurrence` is set, nothing fails, all numbers are there, and no two branches write
    the same key: so that a run does not hang on who is first.
    """

    in_concurrence = False

    def exits(self, first: str | None = None) -> list[str]:
        drawn = self.draw(OUTCOMES)
        return drawn if first is None else [first, *(name for name in drawn if name != first)]

    def leaf(self, exits: list[str], *, stored: bool) -> Leaf:
        kind = self.draw(st.integers(0, 6))
        if kind in (1, 5, 6) and exits[0] == "succeeded":
            return self.made_leaf("CallbacksState", ["succeeded"], *self.callbacks())
        if kind == 2 and exits[0] == "succeeded":
            time = self.draw(st.sampled_from([0, 0.001]))
            return self.made_leaf("SleepState", ["succeeded", "preempted"], {"time": time}, [], [])
        if kind == 3:
            return self.conditional(exits)
        written = self.writable()
        steps = tuple(self.step(name, written) for name in self.visits(exits))
        return self.made_leaf("ScriptedState", exits, {"steps": steps}, [], [written])

    def writable(self) -> str:
        return f"w{self.made + 1}" if self.in_concurrence else self.draw(NUMBER)

    def made_leaf(
        self, kind: str, exits: list[str], variables: dict[str, Data], ins: Any, outs: Any
    ) -> Leaf:
        remaps = []
        for key in sorted({*ins, *outs}) if not self.in_concurrence else ():
            if self.draw(BOOLEANS):
                remaps.append(Remap(key=key, to=self.draw(NUMBER), span=NOWHERE))
        leaf = Leaf(
            name=self.fresh(),
            type=kind,
            outcomes=outcomes_of(exits),
            inputs=keys_of(*ins),
            outputs=keys_of(*outs),
            remaps=tuple(remaps),
            variables=tuple(
                Variable(name=name, value=Value(data=data, span=NOWHERE), span=NOWHERE)
                for name, data in variables.items()
            ),
            span=NOWHERE,
        )
        return as_built_in(leaf)

    def expression(self, shapes: st.SearchStrategy[str]) -> Expression:
        text = self.draw(shapes).format(self.draw(NUMBER), self.draw(NUMBER))
        return Expression(text=f"lambda ud: {text}", span=NOWHERE)

    def callbacks(self) -> tuple[dict[str, Data], list[str], list[str]]:
        fails = not self.in_concurrence and self.draw(BOOLEANS)
        entries = tuple(
            (key, self.expression(FAILING if fails else RESULTS))
            for key in ([self.writable()] if self.in_concurrence else self.draw(SOME_NUMBERS))
        )
        return {"callbacks": Struct(entries=entries)}, self.readable(), [key for key, _ in entries]

    def readable(self) -> list[str]:
        every = self.in_concurrence or self.draw(st.integers(0, 3))
        return NUMBERS if every else self.draw(SOME_NUMBERS)

    def conditional(self, exits: list[str]) -> Leaf:
        asked = [name for name in exits if self.draw(BOOLEANS)]
        callbacks = Struct(entries=tuple((name, self.expression(TESTS)) for name in asked))
        variables: dict[str, Data] = {"callbacks": callbacks, "default_outcome": exits[0]}
        return self.made_leaf("ConditionalOutcomeState", exits, variables, self.readable(), [])

    def held(self) -> tuple[Preset, ...]:
        """Numbers that a container holds: all, or nearly all where something may fail."""
        missing = "" if self.in_concurrence or self.draw(st.integers(0, 2)) else self.draw(NUMBER)
        return tuple(
            Preset(key=key, value=Value(data=self.draw(SMALL), span=NOWHERE), span=NOWHERE)
            for key in NUMBERS
            if key != missing
        )

    def holding(self, children: list[Node], exits: list[str], *, stored: bool) -> dict[str, Any]:
        return {
            **self.common(exits),
            "children": tuple(children),
            "initial": children[0].name,
        }

    def common(self, exits: list[str]) -> dict[str, Any]:
        """The interface of a container: numbers handed in and out under other names."""
        inputs = self.draw(SOME_NUMBERS)
        outputs = [] if self.in_concurrence else self.draw(SOME_NUMBERS)
        remaps = () if self.in_concurrence else sorted({*inputs, *outputs})
        return {
            "name": self.fresh(),
            "outcomes": outcomes_of(exits),
            "inputs": keys_of(*inputs),
            "outputs": keys_of(*outputs),
            "remaps": tuple(
                Remap(key=key, to=self.draw(NUMBER), span=NOWHERE)
                for key in remaps
                if self.draw(BOOLEANS)
            ),
            "userdata": self.held(),
            "span": NOWHERE,
        }

    def linked(self, children: list[Node], exits: list[str], origin: Origin) -> list[Node]:
        """What a condition or a hurried concurrence decides only leads on, lest most runs loop."""
        found = []
        names = [child.name for child in children]
        for at, child in enumerate(super().linked(children, exits, origin)):
            if not isinstance(child, Leaf) or child.type == "ConditionalOutcomeState":
                onward = st.sampled_from([*names[at + 1 :], *exits])
                first, *others = child.transitions
                redrawn = [
                    transition(edge.outcome, self.draw(onward), "written") for edge in others
                ]
                child = dataclasses.replace(child, transitions=(first, *redrawn))
            found.append(self.caught(child, [*names[at + 1 :], *exits]))
        return found

    def caught(self, child: Node, targets: list[str]) -> Node:
        """The child, in one of six cases with an outcome for its exceptions."""
        if self.draw(st.integers(0, 5)) != 1:
            return child
        step = transition("error", self.draw(st.sampled_from(targets)), "written")
        return dataclasses.replace(
            child,
            catches="error",
            outcomes=(*child.outcomes, *outcomes_of(["error"])),
            transitions=(*child.transitions, step),
        )

    def concurrence(self, depth: int, exits: list[str]) -> Concurrence:
        outer, self.in_concurrence = self.in_concurrence, True
        hurried = self.draw(st.integers(0, 2)) == 0
        children = self.hurried() if hurried else self.children(depth, stored=False)
        rules = [self.rule(children, exits) for _ in range(self.draw(SMALL))]
        self.in_concurrence = outer
        common = self.common(exits)
        self.in_concurrence = True
        common["userdata"] = self.held()
        self.in_concurrence = outer
        return Concurrence(
            type="Concurrence",
            children=tuple(children),
            default_outcome=self.draw(st.sampled_from(exits)),
            rules=tuple(rules),
            join="any" if hurried else "all",
            **common,
        )

    def hurried(self) -> list[Node]:
        """One child that ends at once, and others that wait until they are asked to stop."""
        waiting = [
            self.made_leaf("SleepState", ["succeeded", "preempted"], {"time": 60}, [], [])
            for _ in range(self.draw(FEW))
        ]
        at = self.draw(st.integers(0, len(waiting)))
        quick: Node = self.conditional(["done", "failed"])
        return [*waiting[:at], quick, *waiting[at:]]

    def rule(self, children: list[Node], exits: list[str]) -> OutcomeRule:
        """Any rule: several may hold at once, several may have the same outcome."""
        asked = self.draw(st.lists(st.sampled_from(children), min_size=1, max_size=3, unique_by=id))
        when = tuple(
            Condition(
                child=child.name,
                outcome=self.draw(st.sampled_from(outcome_names(child))),
                span=NOWHERE,
            )
            for child in asked
        )
        return OutcomeRule(outcome=self.draw(st.sampled_from(exits)), when=when, span=NOWHERE)

    def iterator(self, depth: int, exits: list[str]) -> Iterator:
        made = super().iterator(depth, exits)
        common = self.common(exits)
        keyed = self.draw(BOOLEANS)
        items = Preset(key="todo", value=Value(data=self.draw(ITEMS), span=NOWHERE), span=NOWHERE)
        if keyed and (self.in_concurrence or self.draw(SMALL)):
            common["userdata"] += (items,)
        loops = made.loop_outcomes
        child = self.caught(made.children[0], exits)
        if child.catches and self.draw(BOOLEANS):
            loops += ("error",)
        return dataclasses.replace(
            made,
            children=(dataclasses.replace(child, transitions=()),),
            loop_outcomes=loops,
            items=None if keyed else made.items,
            items_key="todo" if keyed else "",
            item_key=self.draw(st.sampled_from(["item", "a"])),
            **common,
        )


@st.composite
def busy_machines(draw: st.DrawFn, depth: int = 3) -> tuple[Machine, tuple[str, int]]:
    """A machine, and the visit (path of a leaf, number) in which it is asked to stop.

    Nobody asks where there is a concurrence: threads decide what runs then.
    """
    building = _Busy(draw)
    root: StateMachine = building.state_machine(depth, building.exits(), stored=False)
    root = dataclasses.replace(root, name="sm", inputs=(), outputs=(), remaps=())
    nodes = list(walk(root))
    asked = ("", 0)
    if not any(isinstance(node, Concurrence) for _, node in nodes) and draw(BOOLEANS):
        leaves = [path for path, node in nodes if isinstance(node, Leaf)]
        asked = (draw(st.sampled_from(leaves)), draw(FEW))
    return Machine(root=root, source="main.yml"), asked
