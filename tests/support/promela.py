"""Machines and properties as Promela, the language of SPIN (spinroot.com).

The hierarchical machine is translated: one option for the turn of each leaf, then a loop that
enters and ends states until every branch is at a leaf. The property is a monitor in Promela.
Nothing is shared with the checker's search. Words in parentheses are sections of
docs/semantics.md.
"""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterator, Sequence
from pathlib import Path

from smachac.ir.nodes import Concurrence, Leaf, Machine, Node, StateMachine
from smachac.ir.nodes import Iterator as IteratorNode
from smachac.ir.nodes import Sequence as SequenceNode
from smachac.ir.properties import After, AlwaysEnds, AtMost, Before, Never, Property
from smachac.ir.traversal import leads_to_child, outcome_names, own_outcomes, walk
from tests.support.property_machines import PREEMPTED, Monitor

HEAD = """\
#define ENTER 1
#define END 2
#define SETTLED 3
#define DONE 4
#define ERR 0
byte chosen;
bool finished, quiet, m, over;
byte k;
byte act, cur, o, i;
bool running[{size}], asked[{size}], ended[{size}], stopping[{size}], held, stopped;
byte result[{size}], starting[{size}], used[{size}];
inline bad() {{ assert(false) }}
"""


class _Translation:
    """One machine as a proctype."""

    def __init__(self, number: int, machine: Machine, given: Property) -> None:
        self.number = number
        self.given = given
        self.nodes: list[Node] = []
        self.paths: list[str] = []
        numbers: dict[str, int] = {}
        for path, node in walk(machine.root):
            numbers[path] = len(self.nodes)
            self.nodes.append(node)
            self.paths.append(path)
        self.parent = [numbers.get(path.rpartition("/")[0], -1) for path in self.paths]
        self.below = [
            [number for number, parent in enumerate(self.parent) if parent == item]
            for item in range(len(self.nodes))
        ]
        names = {name: None for node in self.nodes for name in outcome_names(node)}
        for node in self.nodes:
            if isinstance(node, IteratorNode):
                names |= {node.exhausted_outcome: None}
                names |= {to: None for _, to in node.final_map}
        self.codes = {name: code for code, name in enumerate([*names, PREEMPTED], 1)}
        self.monitor = Monitor(machine, given.form)

    def subtree(self, number: int) -> list[int]:
        found = [number]
        for item in found:
            found += self.below[item]
        return found

    def around(self, number: int) -> str:
        """What follows when the branch of a state is at a leaf or at its end."""
        while self.parent[number] >= 0:
            number = self.parent[number]
            if isinstance(self.nodes[number], Concurrence):
                return f"act = SETTLED; cur = {number}"
        return "act = DONE"

    def text(self) -> Iterator[str]:
        yield f"proctype machine_{self.number}() {{"
        yield "act = ENTER; cur = 0; goto settle;"
        yield "turn:"
        yield "if :: finished -> goto finish :: else fi;"
        yield "if :: quiet -> accept_quiet: skip :: else fi;"
        yield "if"
        yield ":: atomic { !quiet -> quiet = true; goto turn }"
        if self.given.stops:
            yield ":: atomic { !quiet ->"
            for item in range(len(self.nodes)):
                yield f"  if :: running[{item}] -> asked[{item}] = true :: else fi;"
            yield "  goto turn }"
        for number, node in enumerate(self.nodes):
            if isinstance(node, Leaf):
                yield from self.leaf(number, node)
        yield "fi;"
        yield "settle: atomic { do"
        for number in range(len(self.nodes)):
            yield f":: act == ENTER && cur == {number} ->"
            yield from self.enter(number)
            yield f":: act == END && cur == {number} ->"
            yield from self.end(number)
            node = self.nodes[number]
            if isinstance(node, Concurrence):
                yield f":: act == SETTLED && cur == {number} ->"
                yield from self.settled(number, node)
        yield ":: act == DONE -> act = 0; break"
        yield "od }; goto turn;"
        yield "finish: skip }"

    def leaf(self, number: int, node: Leaf) -> Iterator[str]:
        able = PREEMPTED in outcome_names(node)
        caught = any(self.nodes[upward].catches for upward in self.upwards(number))
        if able:
            yield f":: atomic {{ running[{number}] && asked[{number}] -> asked[{number}] = false;"
            yield f"  o = {self.codes[PREEMPTED]}; act = END; cur = {number}; goto settle }}"
        free = f"running[{number}]" + (f" && !asked[{number}]" if able else "")
        for name in own_outcomes(node):
            if name != PREEMPTED:
                code = self.codes[name]
                yield f":: atomic {{ {free} -> o = {code}; act = END; cur = {number};"
                yield "  goto settle }"
        if caught:
            yield f":: atomic {{ {free} -> o = ERR; act = END; cur = {number}; goto settle }}"

    def upwards(self, number: int) -> Iterator[int]:
        while number >= 0:
            yield number
            number = self.parent[number]

    def enter(self, number: int) -> Iterator[str]:
        node = self.nodes[number]
        yield f"  running[{number}] = true;"
        yield from self.event(number, None)
        below = self.below[number]
        match node:
            case Leaf():
                yield f"  {self.around(number)}"
            case StateMachine() | SequenceNode():
                names = [self.nodes[item].name for item in below]
                first = below[names.index(node.initial)]
                yield f"  if :: asked[{number}] -> asked[{first}] = true :: else fi;"
                yield f"  cur = {first}"
            case Concurrence():
                for item in below:
                    yield f"  if :: asked[{number}] -> asked[{item}] = true :: else fi;"
                    yield f"  ended[{item}] = false;"
                yield f"  starting[{number}] = 0; stopping[{number}] = false; act = SETTLED"
            case IteratorNode():
                assert node.items is not None
                assert isinstance(node.items.data, tuple)
                if node.items.data:
                    yield f"  used[{number}] = 1;"
                    yield f"  if :: asked[{number}] -> asked[{below[0]}] = true :: else fi;"
                    yield f"  cur = {below[0]}"
                    return
                yield f"  o = {self.codes[self.renamed(node, node.exhausted_outcome)]};"
                if node.sugar:
                    yield f"  if :: asked[{number}] -> o = {self.codes[PREEMPTED]};"
                    yield f"    {self.withdrawn(number)} :: else fi;"
                yield "  act = END"

    def withdrawn(self, number: int) -> str:
        return "; ".join(f"asked[{item}] = false" for item in self.subtree(number))

    def renamed(self, node: IteratorNode, outcome: str) -> str:
        return dict(node.final_map).get(outcome, outcome)

    def end(self, number: int) -> Iterator[str]:
        """The end of a state with the outcome `o` (Errors, Steps and transitions)."""
        node, parent = self.nodes[number], self.parent[number]
        if node.catches:
            yield f"  if :: o == ERR -> o = {self.codes[node.catches]} :: else fi;"
        yield f"  running[{number}] = false;"
        if any(self.relevant(number, name) for name in outcome_names(node)):
            yield "  if"
            for name in outcome_names(node):
                if self.relevant(number, name):
                    yield f"  :: o == {self.codes[name]} ->"
                    yield from self.event(number, name)
                    yield "    skip"
            yield "  :: else fi;"
        if parent < 0:
            yield from self.finished()
            return
        around = self.nodes[parent]
        if isinstance(around, Concurrence):
            yield from self.branch_end(number, parent, around)
            return
        withdraw = f"asked[{number}] = false; " if isinstance(node, Leaf) else ""
        failed = f"{withdraw}used[{parent}] = 0; o = ERR; cur = {parent}"
        yield f"  if :: o == ERR -> {failed}"
        if isinstance(around, IteratorNode):
            yield from self.item_end(number, parent, around, withdraw)
        else:
            yield from self.follow(number, parent, around, withdraw, failed)
        yield "  fi"

    def follow(
        self, number: int, parent: int, around: Node, withdraw: str, failed: str
    ) -> Iterator[str]:
        assert isinstance(around, StateMachine | SequenceNode)
        names = {self.nodes[item].name: item for item in self.below[parent]}
        node = self.nodes[number]
        done = []
        for step in node.transitions:
            if step.outcome not in outcome_names(node):
                continue
            code = self.codes[step.outcome]
            served = f":: asked[{parent}] && !asked[{number}] -> asked[{parent}] = false"
            if leads_to_child(step, frozenset(names)):
                to = names[step.target]
                passed = f":: asked[{parent}] && asked[{number}] -> asked[{number}] = false; "
                yield f"  :: o == {code} -> if {served} {passed} asked[{to}] = true :: else fi;"
                yield f"     {withdraw}act = ENTER; cur = {to}"
            elif step.target in outcome_names(around):
                yield f"  :: o == {code} -> if {served} :: else fi;"
                yield f"     {withdraw}o = {self.codes[step.target]}; cur = {parent}"
            else:
                continue
            done.append(code)
        yield f"  :: else -> {failed}"

    def item_end(
        self, number: int, parent: int, around: IteratorNode, withdraw: str
    ) -> Iterator[str]:
        """The end of an item (Iterator)."""
        assert around.items is not None
        assert isinstance(around.items.data, tuple)
        own = outcome_names(self.nodes[number])
        count = len(around.items.data)
        preempted = self.codes[PREEMPTED]
        for name, code in self.codes.items():
            loops = name in around.loop_outcomes if around.loop_outcomes else name not in own
            final = self.codes.get(self.renamed(around, name), 255)
            yield f"  :: o == {code} && asked[{parent}] -> {self.withdrawn(parent)};"
            stopped = preempted if around.sugar else final
            yield f"     used[{parent}] = 0; o = {stopped}; cur = {parent}"
            yield f"  :: o == {code} && !asked[{parent}] -> {withdraw}"
            if loops:
                last = self.codes[self.renamed(around, around.exhausted_outcome)]
                yield f"     if :: used[{parent}] < {count} -> used[{parent}]++; act = ENTER"
                yield f"     :: else -> used[{parent}] = 0; o = {last}; cur = {parent} fi"
            else:
                yield f"     used[{parent}] = 0; o = {final}; cur = {parent}"

    def branch_end(self, number: int, parent: int, around: Concurrence) -> Iterator[str]:
        """The end of a branch (Concurrence, Preemption)."""
        yield f"  ended[{number}] = true; result[{number}] = o;"
        stops = "true" if around.join == "any" else "o == ERR"
        yield f"  if :: !stopping[{parent}] && ({stops}) -> stopping[{parent}] = true;"
        yield f"    if :: !asked[{parent}] ->"
        for item in self.below[parent]:
            yield f"      if :: !ended[{item}] -> asked[{item}] = true;"
            for inner in self.subtree(item):
                yield f"        if :: running[{inner}] -> asked[{inner}] = true :: else fi;"
            yield "      skip :: else fi;"
        yield "    skip :: else fi"
        yield f"  :: else fi; act = SETTLED; cur = {parent}"

    def settled(self, number: int, node: Concurrence) -> Iterator[str]:
        below = self.below[number]
        yield "  if"
        for at, each in enumerate(below):
            yield f"  :: starting[{number}] == {at} -> starting[{number}]++;"
            yield f"     act = ENTER; cur = {each}"
        every = " && ".join(f"ended[{item}]" for item in below)
        all_started = f"starting[{number}] == {len(below)}"
        yield f"  :: {all_started} && !({every}) -> {self.around(number)}"
        yield f"  :: {all_started} && ({every}) ->"
        yield f"    stopped = {f'asked[{number}]' if node.sugar else 'false'}; held = false;"
        for item in below:
            yield f"    if :: asked[{item}] -> held = true; {self.withdrawn(item)} :: else fi;"
        yield f"    if :: !held -> asked[{number}] = false :: else fi;"
        failed = " || ".join(f"result[{item}] == ERR" for item in below)
        yield f"    if :: {failed} -> o = ERR"
        preempted = self.codes[PREEMPTED]
        yield f"    :: else -> if :: stopped -> asked[{number}] = false; o = {preempted} :: else ->"
        names = {self.nodes[item].name: item for item in below}
        ranked = sorted(enumerate(node.rules), key=lambda pair: (len(pair[1].when), pair[0]))
        yield f"      o = {self.codes[node.default_outcome]};"
        for _, rule in ranked:
            when = " && ".join(
                f"result[{names[item.child]}] == {self.codes.get(item.outcome, 254)}"
                for item in rule.when
            )
            yield f"      if :: {when or 'true'} -> o = {self.codes[rule.outcome]} :: else fi;"
        yield "      skip fi fi;"
        for item in below:
            yield f"    ended[{item}] = false; result[{item}] = 0;"
        yield f"    starting[{number}] = 0; stopping[{number}] = false; stopped = false;"
        yield "    held = false; act = END"
        yield "  fi"

    def relevant(self, number: int, outcome: str | None) -> bool:
        return bool([*self.event(number, outcome)])

    def event(self, number: int, outcome: str | None) -> Iterator[str]:
        """The monitor of the property, at one event."""
        form, match = self.given.form, self.monitor.matches
        at = (self.paths[number], outcome)
        match form:
            case Never(after=after, until=until, enter=enter):
                yield from self.never(
                    bool(after), match(after, at), match(until, at), match(enter, at)
                )
            case Before(later=later, earlier=earlier):
                yield from self.never(False, False, match(earlier, at), match(later, at))
            case AtMost(event=event, times=times):
                if match(event, at):
                    yield f"  if :: k == {times} -> bad() :: else -> k++ fi;"
            case After():
                yield from self.after(number, outcome, form)
            case AlwaysEnds():
                return

    def never(self, armed: bool, after: bool, until: bool, enter: bool) -> Iterator[str]:
        """`m` holds while the event is forbidden; without `after` that is the case from the
        start, until `over`."""
        forbidden = "m" if armed else "!over"
        if not (after or until or enter):
            return
        yield "  if"
        if until:
            cleared = f"m = {'true' if after else 'false'}" if armed else "over = true"
            yield f"  :: {forbidden} -> {cleared}"
        elif enter:
            yield f"  :: {forbidden} -> bad()"
        if after:
            yield "  :: !m -> m = true"
        yield "  :: else fi;"

    def after(self, number: int, outcome: str | None, form: After) -> Iterator[str]:
        at = (self.paths[number], outcome)
        first, answer, claim = (
            self.monitor.matches(item, at) for item in (form.first, form.answer, form.before_claim)
        )
        leaf = outcome is None and isinstance(self.nodes[number], Leaf) and form.within > 0
        if answer:
            yield "  m = false; k = 0;"
            return
        if claim or leaf:
            what = "bad()" if claim else "k--; if :: k == 0 -> bad() :: else fi"
            yield f"  if :: m -> {what} :: else fi;"
        if first:
            yield f"  if :: !m -> m = true; k = {form.within} :: else fi;"

    def finished(self) -> Iterator[str]:
        if isinstance(self.given.form, After):
            yield "  if :: m && o != ERR -> bad() :: else fi;"
        yield "  finished = true; act = DONE"


def promela(pairs: Sequence[tuple[Machine, Property]]) -> str:
    """A model with one proctype for each machine; the environment variable MACHINE chooses one."""
    made = [_Translation(number, *pair) for number, pair in enumerate(pairs)]
    size = max(len(item.nodes) for item in made)
    lines = [HEAD.format(size=size)]
    for item in made:
        lines += item.text()
    lines.append('init { c_code { now.chosen = atoi(getenv("MACHINE")); }; if')
    lines += [f":: chosen == {item.number} -> run machine_{item.number}()" for item in made]
    lines.append("fi }")
    return "\n".join(lines) + "\n"


def spin_verdicts(pairs: Sequence[tuple[Machine, Property]], folder: Path) -> list[bool]:
    """For each machine whether SPIN finds its property to hold."""
    (folder / "model.pml").write_text(promela(pairs), "utf-8")

    def run(*command: str, **more: str) -> str:
        environment = {**os.environ, **more}
        done = subprocess.run(
            command, cwd=folder, env=environment, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, f"{command}: {done.stdout}{done.stderr}"
        return done.stdout

    run("spin", "-a", "model.pml")
    run("tcc", "-w", "-DVECTORSZ=4096", "-DNOFAIR", "-o", "pan", "pan.c")
    found = []
    for number, (_, given) in enumerate(pairs):
        cycles = ["-a"] if isinstance(given.form, AlwaysEnds) else []
        text = run("./pan", "-m1000000", "-w18", "-E", *cycles, MACHINE=str(number))
        assert "error: max search depth too small" not in text
        found.append("errors: 0" in text)
    return found
