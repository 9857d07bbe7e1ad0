"""The proof that two machines behave alike: what it proves, and that it proves nothing false."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from smachac.commands.cli import main
from smachac.diagnostics.source import NOWHERE
from smachac.diff.same_behaviour import paired_states
from smachac.driver import Analysis
from smachac.interpreter.interpreter import run
from smachac.interpreter.userdata import Userdata
from smachac.ir.nodes import Checked, Key, Leaf, Machine, Node, Outcome, Remap, StateMachine
from smachac.ir.traversal import (
    leads_to_child,
    outcome_names,
    outer_inputs,
    outer_outputs,
    remapping,
)
from smachac.refactor.equivalence import map_nodes
from tests.strategies.machines import transition, valid_machines
from tests.strategies.userdata_machines import data_machines

LIMIT = 200


def analysed(machine: Machine) -> Analysis:
    return Analysis(script="main.yml", machine=machine, checked=Checked(machine), report=[])


def pairs(one: Machine, other: Machine) -> dict[str, str] | None:
    return paired_states(analysed(one), analysed(other))


Visit = tuple[str, tuple[tuple[str, object], ...], bool]
"""A visit of a leaf: its path, what it reads, and whether it is asked to stop."""


def visits(machine: Machine, seed: int, stops: list[int]) -> tuple[list[Visit], object]:
    """The visits of a run in which the n-th one ends and writes as the seed wants, whatever the
    state is called, and how the run ends. Every state answers a request to stop."""
    rng, found = random.Random(seed), []

    def behave(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
        read = [(name, name in userdata and userdata[name])
                for name in sorted(key.name for key in leaf.inputs)]  # fmt: skip
        found.append((path, tuple(read), userdata.preempted))
        userdata.service_preempt()
        for name in sorted(key.name for key in leaf.outputs):
            number = rng.randrange(100)
            if rng.random() < 0.7:
                userdata[name] = number
        return rng.choice(sorted(outcome_names(leaf)))

    ended = run(machine, behave, seed=seed, max_steps=LIMIT, preempt_at=stops)
    return found, ended.outcome or (ended.error and ended.error.kind)


def assert_alike(one: Machine, other: Machine, twins: dict[str, str], seed: int) -> None:
    """Some runs of both, stopped at some moments, take paired states with equal values."""
    rng = random.Random(seed)
    for number in range(6):
        stops = [rng.randrange(12) for _ in range(number % 3)]
        ours, our_end = visits(one, number, stops)
        theirs, their_end = visits(other, number, stops)
        if "no-end" in (our_end, their_end):  # the steps of containers count too
            least = min(len(ours), len(theirs))
            ours, theirs = ours[:least], theirs[:least]
        else:
            assert our_end == their_end
        assert [(twins[visit[0]], *visit[1:]) for visit in ours] == theirs


# --- changes


Change = Callable[[Any, random.Random], Node]
"""A random change of a node of some kind."""


def changed_in(machine: Machine, rng: random.Random, kind: type[Node], change: Change) -> Machine:
    """The machine with a random node of a kind changed."""
    places = [path for path, node in _nodes(machine) if isinstance(node, kind)]
    if not places:
        return machine
    at = rng.choice(places)
    paths = iter([path for path, _ in _inner_first(machine.root, machine.root.name)])

    def one(node: Node) -> Node:
        return change(node, rng) if next(paths) == at else node

    root = map_nodes(machine.root, one)
    assert isinstance(root, StateMachine)
    return replace(machine, root=root)


def _nodes(machine: Machine) -> Iterator[tuple[str, Node]]:
    return _inner_first(machine.root, machine.root.name)


def _inner_first(node: Node, path: str) -> Iterator[tuple[str, Node]]:
    if not isinstance(node, Leaf):
        for child in node.children:
            yield from _inner_first(child, f"{path}/{child.name}")
    yield path, node


def renamed(node: StateMachine, rng: random.Random) -> StateMachine:
    """A machine with another name for one of its states."""
    child = rng.choice(node.children)
    names = frozenset(other.name for other in node.children)
    if "ELSE" in names:
        return node

    def led(other: Node) -> Node:
        steps = tuple(
            replace(step, target="ELSE")
            if step.target == child.name and leads_to_child(step, names)
            else step
            for step in other.transitions
        )
        name = "ELSE" if other is child else other.name
        return replace(other, name=name, transitions=steps)

    return replace(
        node,
        children=tuple(map(led, node.children)),
        initial="ELSE" if node.initial == child.name else node.initial,
    )


def nested(node: StateMachine, rng: random.Random) -> StateMachine:
    """A machine with some of its states in a new one, whose keys are right, or one is missing."""
    first = next((child for child in node.children if child.name == node.initial), node.children[0])
    inside = [child for child in node.children if child is first or rng.random() < 0.5]
    mine = {child.name for child in inside}
    others = [child for child in node.children if child.name not in mine]
    names = frozenset(child.name for child in node.children)
    if "BOX" in names or any(
        step.target in mine and leads_to_child(step, names) and step.target != first.name
        for child in others
        for step in child.transitions
    ):
        return node
    targets: dict[tuple[str, bool], str] = {}

    def led(child: Node) -> Node:
        steps = []
        for step in child.transitions:
            inner = leads_to_child(step, names)
            if inner and step.target in mine:
                steps.append(transition(step.outcome, step.target, "written"))
            else:
                end = targets.setdefault((step.target, inner), f"end_{len(targets)}")
                steps.append(transition(step.outcome, end, "implicit"))
        return replace(child, transitions=tuple(steps))

    children = tuple(map(led, inside))
    reads = {key for child in inside for key in outer_inputs(child)}
    writes = {key for child in inside for key in outer_outputs(child)}
    inputs = sorted(reads | writes) if rng.random() < 0.6 else sorted(reads)
    outputs = sorted(writes)
    for keys in (inputs, outputs):
        if keys and rng.random() < 0.3:
            keys.remove(rng.choice(keys))
    own = {key: f"{key}_in" if rng.random() < 0.3 else key for key in (*reads, *writes)}
    box = StateMachine(
        name="BOX",
        type="StateMachine",
        outcomes=tuple(Outcome(name=end, span=NOWHERE) for end in targets.values()),
        inputs=tuple(Key(name=own[key], span=NOWHERE) for key in inputs),
        outputs=tuple(Key(name=own[key], span=NOWHERE) for key in outputs),
        remaps=tuple(
            Remap(key=own[key], to=key, span=NOWHERE, to_span=NOWHERE) for key in sorted(own)
        ),
        transitions=tuple(
            transition(end, target, "written" if inner else "implicit")
            for (target, inner), end in targets.items()
        ),
        children=tuple(
            replace(
                child,
                remaps=tuple(
                    Remap(key=key.name, to=own[remapping(child)[key.name]], span=NOWHERE,
                          to_span=NOWHERE)
                    for key in {key.name: key for key in (*child.inputs, *child.outputs)}.values()
                ),
            )
            for child in children
        ),
        initial=first.name,
        span=NOWHERE,
    )  # fmt: skip
    return replace(
        node,
        children=(box, *(_into(child, first.name, names) for child in others)),
        initial="BOX",
    )


def _into(child: Node, first: str, names: frozenset[str]) -> Node:
    """A state outside the box, whose transitions to the first state in it lead to the box."""
    steps = tuple(
        transition(step.outcome, "BOX", "written")
        if step.target == first and leads_to_child(step, names)
        else step
        for step in child.transitions
    )
    return replace(child, transitions=steps)


def redirected(node: StateMachine, rng: random.Random) -> StateMachine:
    """A machine with another target for one transition."""
    child = rng.choice(node.children)
    if not child.transitions:
        return node
    step = rng.choice(child.transitions)
    target = rng.choice([other.name for other in node.children])
    steps = tuple(
        transition(other.outcome, target, "written") if other is step else other
        for other in child.transitions
    )
    children = (replace(child, transitions=steps) if one is child else one for one in node.children)
    return replace(node, children=tuple(children))


def variant(machine: Machine, rng: random.Random) -> Machine:
    """The machine after some random changes, of which most keep its behaviour."""
    for _ in range(rng.randint(1, 3)):
        change = rng.choices([renamed, nested, redirected], [3, 5, 1])[0]
        machine = changed_in(machine, rng, StateMachine, change)
        if rng.random() < 0.15:
            machine = changed_in(machine, rng, Leaf, _with_other_key)
    return machine


def _with_other_key(leaf: Leaf, rng: random.Random) -> Leaf:
    keys = [key.name for key in (*leaf.inputs, *leaf.outputs)]
    if not keys:
        return leaf
    key = rng.choice(keys)
    kept = tuple(remap for remap in leaf.remaps if remap.key != key)
    return replace(leaf, remaps=(*kept, Remap(key=key, to="other", span=NOWHERE, to_span=NOWHERE)))


@given(st.one_of(valid_machines(), data_machines()), st.integers(0, 10**6))
@pytest.mark.slow
def test_machines_that_are_proved_to_be_alike_have_equal_runs(whole: Machine, seed: int) -> None:
    other = variant(whole, random.Random(seed))
    for one, two in ((whole, other), (other, whole)):
        twins = pairs(one, two)
        if twins is not None:
            assert_alike(one, two, twins, seed)


# --- what is proved


SCRIPT = """\
name: sm
outcomes: [good, bad]
userdata: {place: 1, tries: 0}
properties: [{never: {enter: REST, after: TIDY}}]
states:
  - FIND:
      template: CallbacksState
      callbacks: {place: 'lambda ud: ud.place + 1'}
      input_keys: [place]
      output_keys: [place]
      transitions: {succeeded: GRASP}
  - GRASP:
      template: CallbacksState
      callbacks: {tries: 'lambda ud: ud.tries + ud.place'}
      input_keys: [tries, place]
      output_keys: [tries]
      retry: {on: [error], max: 2}
      transitions: {succeeded: CHECK, exhausted: TIDY, preempted: bad}
  - CHECK:
      template: ConditionalOutcomeState
      input_keys: [tries]
      outcomes: [found, lost]
      default_outcome: found
      callbacks: {lost: 'lambda ud: ud.tries < 3'}
      transitions: {found: REST, lost: FIND}
  - REST:
      template: SleepState
      time: 1
      timeout: 5s
      transitions: {succeeded: good, timeout: bad, preempted: bad}
  - TIDY:
      template: SleepState
      time: 1
      transitions: {succeeded: bad, preempted: bad}
"""


@pytest.fixture(name="script")
def _script(tmp_path: Path) -> Path:
    (tmp_path / "old.yml").write_text(SCRIPT, "utf-8")
    (tmp_path / "main.yml").write_text(SCRIPT, "utf-8")
    return tmp_path / "main.yml"


def proved(script: Path, capsys: pytest.CaptureFixture[str]) -> bool:
    capsys.readouterr()
    code = main(["diff", str(script.with_name("old.yml")), str(script)])
    shown = capsys.readouterr().out
    assert code == 1, shown
    return "  same behaviour: " in shown


@pytest.mark.parametrize(
    "command",
    [
        ["rename", "{}", "FIND", "SEEK"],
        ["rename", "{}", "GRASP", "TAKE"],
        ["contain", "{}", "PICK", "StateMachine", "FIND", "GRASP", "CHECK"],
        ["contain", "{}", "PICK", "StateMachine", "FIND", "GRASP", "CHECK", "REST"],
    ],
    ids=lambda command: "-".join(command[:1] + command[2:]),
)
def test_a_refactoring_keeps_the_behaviour(
    command: list[str], script: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([word.format(script) for word in command]) == 0
    assert proved(script, capsys)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("1\n      transitions: {succeeded: bad", "2\n      transitions: {succeeded: bad"),
        ("place: 1", "place: true"),
        ("place: 1", "place: 1.0"),
        ("succeeded: good, timeout: bad", "succeeded: bad, timeout: good"),
        ("timeout: 5s", "timeout: 6s"),
        ("max: 2", "max: 3"),
        ("ud.tries < 3", "ud.tries < 4"),
        ("name: sm", "name: machine"),
        ("{found: REST, lost: FIND}", "{found: REST, lost: GRASP}"),
        ("  - FIND:", "  - FIND:\n      remapping: {place: tries}"),
    ],
)
def test_another_behaviour_is_not_called_the_same(
    old: str, new: str, script: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert SCRIPT.count(old) == 1
    script.write_text(SCRIPT.replace(old, new), "utf-8")
    assert not proved(script, capsys)


def test_the_reports_have_the_proof(script: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["rename", str(script), "TIDY", "CLEAN"]) == 0
    old = str(script.with_name("old.yml"))
    capsys.readouterr()
    assert main(["diff", old, str(script), "--format", "json"]) == 1
    assert '"same_behaviour": true' in capsys.readouterr().out
    assert main(["diff", old, str(script), "--format", "md"]) == 1
    assert "\nSame behaviour: every run " in capsys.readouterr().out
    assert main(["diff", old, str(script)]) == 1
    text = capsys.readouterr().out
    assert "1 state renamed\n" in text
    assert "property" not in text
