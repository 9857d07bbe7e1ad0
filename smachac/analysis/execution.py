"""Execution: the configurations of a machine, and the steps from each to the next.

A configuration is the state of a run between two turns of leaves: the active leaf of each branch,
the states with an unserved request to stop, the items that iterators have used. A step is the end
of one leaf, with an outcome or an exception, or a request to stop from outside. The semantics are
those of the interpreter (docs/semantics.md). Values are left out, so each outcome of a leaf is
possible; only `preempted` is possible after a request, and only then.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator
from typing import NamedTuple, TypeAlias

from smachac.ir import nodes
from smachac.ir.concurrence_rules import matching_rule, outcome_of
from smachac.ir.leaf import variable_of
from smachac.ir.nodes import Concurrence, Leaf, Node, StateMachine
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.properties import Exceptions
from smachac.ir.traversal import leads_to_child, outcome_names, own_outcomes

Control: TypeAlias = "int | tuple[int, tuple[Control, ...], bool] | tuple[str | None] | tuple[()]"
"""Where a branch is: at a leaf; in a concurrence, with its branches and whether they are being
stopped; at its end, with its outcome or None for an exception; or not started."""

Event: TypeAlias = "tuple[int, str | None]"
"""A state, by number, is entered (None), or ends with an outcome."""

Watched: TypeAlias = "Container[Event]"
"""The events that matter."""

STOP = -1
"""In place of a leaf: a request to stop arrives from outside."""

START = -2
"""In place of a leaf: the run begins."""

MOST_EMPTY = 50
"""Limit on the iterators without items in one step: a loop of them has no end."""

MOST_ITEMS = 32
"""Limit on the items of an iterator that are counted one by one; with more of them, any number is
possible."""


class TooLargeError(Exception):
    """The configurations are too many to be examined."""


NO_STATES: frozenset[int] = frozenset()


class Config(NamedTuple):
    """A configuration of a run: the states that run, the preempt requests that are not served, and
    the items that iterators have used.

    `asked`: the states with an unserved preempt request. `used`: pairs of an iterator and the
    number of its used items.
    """

    control: Control
    asked: frozenset[int] = NO_STATES
    used: tuple[tuple[int, int], ...] = ()

    @property
    def outcome(self) -> tuple[str | None] | None:
        """The outcome where the run has ended, in a tuple."""
        return self.control if isinstance(self.control, tuple) and len(self.control) == 1 else None


class ExecutionStep(NamedTuple):
    """A step to another configuration: a leaf and its outcome, None for an exception. `events` are
    the watched events, in their order."""

    leaf: int
    outcome: str | None
    events: tuple[Event, ...]
    config: Config


class Execution:
    """The steps of one machine.

    `paths`, `nodes` and `parents` are by number, in the order of the script; the root is 0 and has
    the parent -1. `few_items`: iterators run at most two items, which changes no outcome.
    """

    def __init__(
        self,
        root: StateMachine,
        *,
        exceptions: Exceptions = "caught",
        stops: bool = True,
        few_items: bool = False,
    ) -> None:
        self.stops = stops
        self.few_items = few_items
        self.paths: list[str] = []
        self.nodes: list[Node] = []
        self.parents: list[int] = []
        self.children: list[list[int]] = []
        self.last: list[int] = []
        self._number(root)
        self.first: list[int] = [-1] * len(self.nodes)
        self.targets: list[dict[str, tuple[int, str]]] = [{} for _ in self.nodes]
        self.outcomes: list[tuple[str | None, ...]] = [()] * len(self.nodes)
        self.named: list[frozenset[str]] = [frozenset()] * len(self.nodes)
        self.able = [PREEMPTED in outcome_names(node) for node in self.nodes]
        caught: list[bool] = []
        for number, node in enumerate(self.nodes):
            up = self.parents[number]
            caught.append(bool(node.catches) or (up >= 0 and caught[up]))
            if isinstance(node, Leaf):
                raises = exceptions == "all" or (exceptions == "caught" and caught[number])
                self.outcomes[number] = _leaf_outcomes(node, raises=raises)
            elif isinstance(node, StateMachine | nodes.Sequence):
                self._connect(number, node)
            elif isinstance(node, Concurrence):
                for child in self.children[number]:
                    self.named[child] = _named_outcomes(node, self.nodes[child].name)

    def _number(self, root: Node) -> None:
        todo = [(root, root.name, -1)]
        while todo:
            node, path, parent = todo.pop()
            number = len(self.nodes)
            self.nodes.append(node)
            self.paths.append(path)
            self.parents.append(parent)
            self.children.append([])
            self.last.append(number)
            if parent >= 0:
                self.children[parent].append(number)
            if not isinstance(node, Leaf):
                todo.extend(
                    (child, f"{path}/{child.name}", number) for child in node.children[::-1]
                )
        for number in range(len(self.nodes) - 1, 0, -1):
            parent = self.parents[number]
            self.last[parent] = max(self.last[parent], self.last[number])

    def _connect(self, number: int, node: StateMachine | nodes.Sequence) -> None:
        """The initial state and the transitions of a container."""
        numbers = {self.nodes[child].name: child for child in self.children[number]}
        names, exits = frozenset(numbers), frozenset(outcome_names(node))
        self.first[number] = numbers.get(node.initial, -1)
        for child in self.children[number]:
            inner = self.nodes[child]
            has_no_interface = isinstance(inner, Leaf) and inner.open
            declared = frozenset(outcome_names(inner))
            for step in inner.transitions:
                if not has_no_interface and step.outcome not in declared:
                    continue
                if leads_to_child(step, names):
                    self.targets[child][step.outcome] = (numbers[step.target], "")
                elif step.target in exits:
                    self.targets[child][step.outcome] = (-1, step.target)

    @property
    def is_complete(self) -> bool:
        """Whether every container has a state to start with."""
        return all(
            isinstance(node, Leaf)
            or (
                bool(self.children[number])
                and (self.first[number] >= 0 or isinstance(node, Concurrence | nodes.Iterator))
            )
            for number, node in enumerate(self.nodes)
        )

    def start(self, watched: Watched) -> list[ExecutionStep]:
        """The configurations in which a run can begin."""
        return self._turns(Config(()), watched, START, None)

    def steps(self, config: Config, watched: Watched) -> list[ExecutionStep]:
        """The steps that can follow, the usual ones first."""
        control, asked, used = config
        if config.outcome is not None:
            return []
        found: list[ExecutionStep] = []
        raised: list[ExecutionStep] = []
        for leaf in leaves(control):
            if leaf in asked and self.able[leaf]:
                before = Config(control, asked - {leaf}, used)
                found += self._turns(before, watched, leaf, PREEMPTED)
                continue
            for outcome in self.outcomes[leaf]:
                steps = self._turns(config, watched, leaf, outcome)
                (raised if outcome is None else found).extend(steps)
        found += raised
        if self.stops:
            running = frozenset(self.active(control, 0))
            if not running <= asked:
                found.append(ExecutionStep(STOP, None, (), Config(control, asked | running, used)))
        return found

    def _turns(
        self, config: Config, watched: Watched, leaf: int, outcome: str | None
    ) -> list[ExecutionStep]:
        """The steps with the end of a leaf, or `START`: one for each way in which the iterators
        can find items."""
        found: list[ExecutionStep] = []
        todo: list[tuple[bool, ...]] = [()]
        while todo:
            answers = todo.pop()
            turn = _Turn(self, config, watched, answers)
            if leaf == START:
                control = turn.enter(0)
            else:
                control = turn.advance(config.control, leaf, outcome)
            for at in range(len(answers), len(turn.answers)):
                todo.append((*turn.answers[:at], not turn.answers[at]))
            found.append(ExecutionStep(leaf, outcome, tuple(turn.events), turn.config(control)))
        return found

    def active(self, control: Control, base: int) -> Iterator[int]:
        """The states that run in a branch, whose outermost state is `base`."""
        node = base
        if isinstance(control, int):
            node = control
        elif len(control) == 3:
            node = control[0]
            for child, branch in zip(self.children[node], control[1], strict=True):
                if len_of(branch) != 1:
                    yield from self.active(branch, child)
        while node != base:
            yield node
            node = self.parents[node]
        yield base


def len_of(control: Control) -> int:
    """The length of a tuple; 0 for a leaf and for a branch that has not started."""
    return 0 if isinstance(control, int) else len(control)


def leaves(control: Control) -> Iterator[int]:
    """The active leaves of a configuration."""
    if isinstance(control, int):
        yield control
    elif len(control) == 3:
        for branch in control[1]:
            yield from leaves(branch)


def _named_outcomes(node: Concurrence, child: str) -> frozenset[str]:
    """The outcomes of a child that the rules of a concurrence name. All others have the same
    effect, so configurations do not distinguish them."""
    return frozenset(
        condition.outcome
        for rule in node.rules
        for condition in rule.when
        if condition.child == child
    )


def _leaf_outcomes(leaf: Leaf, *, raises: bool) -> tuple[str | None, ...]:
    """The outcomes of a leaf without a request to stop; None is an exception, which a timer never
    raises."""
    names: Iterable[str] = own_outcomes(leaf)
    if leaf.open:
        names = (*names, *(step.outcome for step in leaf.transitions))
    plain = [name for name in dict.fromkeys(names) if name != PREEMPTED]
    timer = leaf.built_in and variable_of(leaf, "function") is not None
    return (*plain, None) if raises and not timer else tuple(plain)


class _Turn:
    """One turn: from the end of a leaf to the next leaves.

    `answers` decide whether an iterator whose items are not known has another item.
    """

    __slots__ = ("answers", "asked", "empty", "events", "questions", "run", "used", "watched")

    def __init__(
        self, execution: Execution, config: Config, watched: Watched, answers: tuple[bool, ...]
    ) -> None:
        self.run = execution
        self.asked = set(config.asked)
        self.used = dict(config.used)
        self.watched = watched
        self.answers = list(answers)
        self.questions = 0
        self.empty = 0
        self.events: list[Event] = []

    def config(self, control: Control) -> Config:
        asked = frozenset(self.asked) if self.asked else NO_STATES
        return Config(control, asked, tuple(sorted(self.used.items())) if self.used else ())

    def emit(self, node: int, outcome: str | None) -> None:
        if (node, outcome) in self.watched:
            self.events.append((node, outcome))

    def advance(self, control: Control, leaf: int, outcome: str | None) -> Control:
        """End a leaf in one of the branches; the new control of the whole."""
        if not isinstance(control, tuple) or len(control) != 3:
            return self.ended(leaf, outcome)
        node, branches, stopping = control
        children = self.run.children[node]
        at = next(at for at, child in enumerate(children) if leaf <= self.run.last[child])
        changed = [*branches]
        changed[at] = self.advance(branches[at], leaf, outcome)
        if len_of(changed[at]) == 1:
            stopping = self.branch_ended(node, changed, at, stopping=stopping)
            if all(len_of(branch) == 1 for branch in changed):
                return self.joined(node, changed)
        return node, tuple(changed), stopping

    def enter(self, node: int) -> Control:
        """Enter a state and what it starts with."""
        run = self.run
        while True:
            self.emit(node, None)
            child = run.first[node]
            if child < 0:
                break
            if node in self.asked:
                self.asked.add(child)
            node = child
        match run.nodes[node]:
            case Concurrence():
                return self.fork(node)
            case nodes.Iterator():
                return self.iterate(node)
        return node

    def fork(self, node: int) -> Control:
        """Start the branches of a concurrence, in order."""
        children = self.run.children[node]
        if node in self.asked:
            self.asked.update(children)
        branches: list[Control] = [()] * len(children)
        stopping = False
        for at, child in enumerate(children):
            branches[at] = self.enter(child)
            if len_of(branches[at]) == 1:
                stopping = self.branch_ended(node, branches, at, stopping=stopping)
        if all(len_of(branch) == 1 for branch in branches):
            return self.joined(node, branches)
        return node, tuple(branches), stopping

    def branch_ended(self, node: int, branches: list[Control], at: int, *, stopping: bool) -> bool:
        """Stop the other branches if this one's end requires it; whether they are being stopped."""
        container = self.run.nodes[node]
        assert isinstance(container, Concurrence)
        decides = container.join == "any" or branches[at] == (None,)
        if container.join == "rule":
            decides = decides or matching_rule(container, self.ends(node, branches)) >= 0
        if stopping or not decides:
            return stopping
        if node not in self.asked:
            for child, branch in zip(self.run.children[node], branches, strict=True):
                if len_of(branch) != 1:
                    self.asked.update(self.run.active(branch, child))
        return True

    def joined(self, node: int, branches: list[Control]) -> Control:
        """End a concurrence, all of whose branches have ended."""
        container = self.run.nodes[node]
        assert isinstance(container, Concurrence)
        stopped = container.sugar and node in self.asked
        held = [child for child in self.run.children[node] if child in self.asked]
        for child in held:
            self.recall(child)
        if not held:
            self.asked.discard(node)
        if (None,) in branches:
            return self.ended(node, None)
        if stopped:
            self.asked.discard(node)
            return self.ended(node, PREEMPTED)
        return self.ended(node, outcome_of(container, self.ends(node, branches)))

    def ends(self, node: int, branches: list[Control]) -> dict[str, object]:
        """The outcomes of the branches of a concurrence that have ended, by name."""
        pairs = zip(self.run.children[node], branches, strict=True)
        return {self.run.nodes[child].name: branch[0] for child, branch in pairs
                if isinstance(branch, tuple) and len(branch) == 1}  # fmt: skip

    def recall(self, node: int) -> None:
        """Withdraw the requests of a state and of all states below it."""
        end = self.run.last[node]
        self.asked = {number for number in self.asked if not node <= number <= end}

    def iterate(self, node: int) -> Control:
        """Start an iterator: with its first item, or at its end if there is none."""
        iterator = self.run.nodes[node]
        assert isinstance(iterator, nodes.Iterator)
        child = self.run.children[node][0]
        if not self.has_item(node, iterator):
            self.empty += 1
            if self.empty > MOST_EMPTY:
                raise TooLargeError
            result = _renamed(iterator, iterator.exhausted_outcome)
            if iterator.sugar and node in self.asked:
                self.recall(node)
                result = PREEMPTED
            return self.ended(node, result)
        if node in self.asked:
            self.asked.add(child)
        return self.enter(child)

    def has_item(self, node: int, iterator: nodes.Iterator) -> bool:
        """Whether there is another item, which is then used."""
        items = iterator.items.data if iterator.items is not None else None
        used = self.used.get(node, 0)
        if isinstance(items, tuple) and len(items) <= MOST_ITEMS:
            found = used < len(items)
        elif self.run.few_items or isinstance(items, tuple):
            found = self.answer() if used or not items else True
        else:
            found = self.answer()
        if self.run.few_items:
            found = found and used < 2
        if not found:
            self.used.pop(node, None)
        elif isinstance(items, tuple) or self.run.few_items:
            self.used[node] = min(used + 1, MOST_ITEMS)
        return found

    def answer(self) -> bool:
        """The answer to the next question; a new one is answered with yes."""
        self.questions += 1
        if self.questions > len(self.answers):
            self.answers.append(True)
        return self.answers[self.questions - 1]

    def ended(self, node: int, result: str | None) -> Control:
        """End a state with an outcome or, None, with an exception, and go on in its container."""
        run = self.run
        while True:
            if result is None and node:
                result = run.nodes[node].catches or None
            if result is not None:
                self.emit(node, result)
            parent = run.parents[node]
            container = run.nodes[parent] if parent >= 0 else None
            if container is None or (result is None and isinstance(container, Concurrence)):
                return (result,)
            if isinstance(container, Concurrence):
                return (result if result in run.named[node] else "",)
            if result is None:
                if isinstance(run.nodes[node], Leaf):
                    self.asked.discard(node)
                self.used.pop(parent, None)
                node = parent
            elif isinstance(container, nodes.Iterator):
                following = self.next_item(parent, container, node, result)
                if following is None:
                    return self.enter(node)
                node, result = parent, following
            else:
                sibling, exit = run.targets[node].get(result, (-1, None))
                self.hand_on(parent, node, sibling)
                if sibling >= 0:
                    return self.enter(sibling)
                node, result = parent, exit

    def hand_on(self, parent: int, node: int, sibling: int) -> None:
        """Pass the unserved request of a machine on to its next state, or out of it (-1)."""
        asked = self.asked
        if parent in asked:
            if node not in asked:
                asked.discard(parent)
            elif sibling >= 0:
                asked.discard(node)
                asked.add(sibling)
        if node in asked and isinstance(self.run.nodes[node], Leaf):
            asked.discard(node)

    def next_item(
        self, parent: int, iterator: nodes.Iterator, child: int, outcome: str
    ) -> str | None:
        """The outcome of an iterator after one of its state; None if another item follows."""
        requested = parent in self.asked
        result = outcome
        if not requested and _loops(iterator, self.run.nodes[child], outcome):
            if isinstance(self.run.nodes[child], Leaf):
                self.asked.discard(child)
            if self.has_item(parent, iterator):
                return None
            result = iterator.exhausted_outcome
        self.used.pop(parent, None)
        if isinstance(self.run.nodes[child], Leaf):
            self.asked.discard(child)
        if requested:
            self.recall(parent)
            if iterator.sugar:
                return PREEMPTED
        return _renamed(iterator, result)


def _renamed(iterator: nodes.Iterator, outcome: str) -> str:
    return dict(iterator.final_map).get(outcome, outcome)


def _loops(iterator: nodes.Iterator, child: Node, outcome: str) -> bool:
    if iterator.loop_outcomes or (isinstance(child, Leaf) and child.open):
        return outcome in iterator.loop_outcomes
    return outcome not in outcome_names(child)
