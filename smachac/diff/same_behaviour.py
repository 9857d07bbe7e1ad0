"""The proof that two machines have the same behaviour, with other names and other nesting.

A nested state machine is *transparent* if its states could stand in the container around it, with
the same runs: its keys are those of that container under other names. Without the transparent
containers, the states of both machines are paired one to one, from the first states along equal
outcomes (a bisimulation): paired states have one type, equal values, the same outcomes, and keys
that are paired one to one too. Concurrences, iterators and machines that are not transparent are
paired as wholes, and what is in them in the same way. All of it is linear in the states.

Runs in which a state does not answer a request to stop are not part of the proof: how long such a
request stays depends on the nesting (docs/semantics.md, Preemption, P7). What it cannot see counts
as different: a state without an interface, an exception that a
container of states catches, the name of a state where its code uses the name.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cached_property

from smachac.driver import Analysis
from smachac.frontend import schema
from smachac.ir.nodes import (
    Concurrence,
    Container,
    Leaf,
    Machine,
    Node,
    Sequence,
    StateMachine,
)
from smachac.ir.nodes import Iterator as IteratorNode
from smachac.ir.printer import print_data
from smachac.ir.traversal import (
    containers,
    leads_to_child,
    outcome_names,
    outer_inputs,
    outer_outputs,
    remapping,
    walk,
)

Key = tuple[str, str]
"""A key of userdata: the path of the container that has it, and its name."""

Next = tuple[str, bool]
"""What follows a state: the path of a state, or an outcome of the machine around; whether it is a
state."""


class _DifferentError(Exception):
    """There is no proof that the machines have the same behaviour."""


def paired_states(before: Analysis | None, after: Analysis | None) -> dict[str, str] | None:
    """The paths of the states of `after` by those of `before` that take their place in every run,
    if the machines behave alike; None if that is not proved.

    A state that no run enters has no pair.
    """
    if before is None or after is None or before.checked is None or after.checked is None:
        return None
    if _settings(before.checked) != _settings(after.checked):
        return None
    try:
        proof = _Proof(_Side(before, before.checked), _Side(after, after.checked))
        proof.compare()
    except _DifferentError:
        return None
    return proof.states


def _settings(machine: Machine) -> object:
    """What a machine has beside its states. The name of the machine is that of its node of ROS."""
    variables = {variable.name: print_data(variable.value.data) for variable in machine.variables}
    robot = machine.robot
    described = None if robot is None else (robot.name, robot.description)
    return machine.root.name, machine.base, variables, described


class _Side:
    """One of the two machines, with its nodes by path and its transparent containers."""

    def __init__(self, analysis: Analysis, machine: Machine) -> None:
        self.machine, self._library = machine, analysis.library
        self.root = machine.root.name
        self.nodes: dict[str, Node] = {}
        self.around: dict[str, str] = {}
        for path, node in walk(machine.root):
            if path in self.nodes or path in machine.unknown:
                raise _DifferentError
            self.nodes[path] = node
        for path, node in containers(machine.root):
            self.around |= {f"{path}/{child.name}": path for child in node.children}
        self._keys: dict[Key, Key] = {}
        self._named: dict[str, bool] = {}

    @cached_property
    def transparent(self) -> frozenset[str]:
        """The paths of the transparent containers. None is in a container that catches exceptions:
        what its states have written is lost with an exception."""
        found: set[str] = set()
        catching: set[str] = set()
        for path, parent in containers(self.machine.root):
            if parent.catches or self.around.get(path) in catching:
                catching.add(path)
            elif isinstance(parent, StateMachine | Sequence):
                found |= {f"{path}/{child.name}" for child in _transparent_in(parent)}
        return frozenset(found)

    @cached_property
    def presets(self) -> dict[Key, str]:
        """The userdata that is set before the run."""
        return {
            self.key(path, preset.key): print_data(preset.value.data)
            for path, node in containers(self.machine.root)
            for preset in node.userdata
        }

    @cached_property
    def read(self) -> set[Key]:
        """The keys that a state reads, or that leave a container which is not transparent."""
        found: set[Key] = set()
        for path, node in containers(self.machine.root):
            if path not in self.transparent:
                found |= {self.key(path, key.name) for key in node.outputs}
            if isinstance(node, IteratorNode):
                found |= {(path, node.item_key), (path, node.items_key)}
            for child in node.children:
                if f"{path}/{child.name}" not in self.transparent:
                    found |= {self.key(path, name) for name in outer_inputs(child)}
        return found

    def key(self, path: str, name: str) -> Key:
        """The key with which a key of a container shares its value: the remapped key outside, if
        the container is transparent; else the key itself."""
        passed: list[Key] = []
        found = (path, name)
        while found not in self._keys and found[0] in self.transparent:
            node = self.nodes[found[0]]
            if all(key.name != found[1] for key in (*node.inputs, *node.outputs)):
                break
            passed.append(found)
            found = (self.around[found[0]], remapping(node)[found[1]])
        found = self._keys.get(found, found)
        self._keys.update(dict.fromkeys(passed, found))
        return found

    def entered(self, path: str) -> str:
        """The state that runs first where a path is entered."""
        while path in self.transparent:
            node = self.nodes[path]
            assert isinstance(node, StateMachine)
            path = f"{path}/{node.initial or node.children[0].name}"
        if path not in self.nodes:
            raise _DifferentError
        return path

    def following(self, path: str, outcome: str) -> Next:
        """What follows the end of a state with an outcome."""
        while True:
            above = self.around[path]
            parent = self.nodes[above]
            assert not isinstance(parent, Leaf)
            step = self._steps(path, parent).get(outcome)
            if step is None:
                raise _DifferentError
            target, inside = step
            if inside:
                return self.entered(f"{above}/{target}"), True
            if above not in self.transparent:
                return target, False
            path, outcome = above, target

    def _steps(self, path: str, parent: Container) -> dict[str, Next]:
        """The targets of the outcomes of a state in a container, and whether they are states."""
        names = self._names(self.around[path], parent)
        return {
            step.outcome: (step.target, leads_to_child(step, names))
            for step in reversed(self.nodes[path].transitions)
        }

    def _names(self, path: str, container: Container) -> frozenset[str]:
        known = self._children.get(path)
        if known is None:
            known = self._children[path] = frozenset(child.name for child in container.children)
        return known

    @cached_property
    def _children(self) -> dict[str, frozenset[str]]:
        return {}

    def type_facts(self, name: str) -> object:
        """What the interface of a state type adds to its states: their code, and default values."""
        type_ = self.machine.state_types.get(name)
        if type_ is None:
            return None
        defaults = {
            variable.name: print_data(variable.default.data)
            for variable in type_.variables.values()
            if variable.default is not None
        }
        return type_.code, type_.classes, defaults

    def is_named(self, leaf: Leaf) -> bool:
        """Whether the code of a state may use its name."""
        if leaf.type not in self._named:
            self._named[leaf.type] = self._uses_name(leaf.type)
        return self._named[leaf.type]

    def _uses_name(self, name: str) -> bool:
        type_ = self.machine.state_types.get(name)
        if type_ is None or not type_.prints_itself:
            return False
        template = type_.code.get("python", f"{name}.tpl.py")
        if not type_.built_in or self._library is None:
            return True
        source = self._library.template(template)
        return source is None or re.search(r"\bname\b", source.text) is not None


def _transparent_in(parent: Container) -> Iterator[StateMachine]:
    """The transparent containers among the children of a container."""
    writers: dict[str, set[str]] = {}
    for child in parent.children:
        for key in outer_outputs(child):
            writers.setdefault(key, set()).add(child.name)
    given = {key.name for key in parent.inputs} | {preset.key for preset in parent.userdata}
    for child in parent.children:
        if not isinstance(child, StateMachine) or child.catches:
            continue
        if child.type not in schema.CONTAINERS:
            continue
        others = given | {key for key, names in writers.items() if names != {child.name}}
        if child.children and _is_transparent(child, others):
            yield child


def _is_transparent(node: StateMachine, given: set[str]) -> bool:
    """Whether a key of the container around a machine has, at each moment at which it is read, the
    value of the key of the machine. `given` are the keys around that are set elsewhere too."""
    names = remapping(node)
    inputs, outputs = ({key.name for key in keys} for keys in (node.inputs, node.outputs))
    outer = [names[key] for key in inputs | outputs]
    if len({*outer}) < len(outer) or any(
        preset.key in inputs | outputs for preset in node.userdata
    ):
        return False
    written = {key for child in node.children for key in outer_outputs(child)}
    if written & (inputs - outputs):
        return False  # what is written there does not leave the machine
    # A key that only leaves the machine would undo what others write in its absence.
    return not any(names[key] in given for key in outputs - inputs)


class _Proof:
    """The pairs of states and of keys that were found; each belongs to one pair."""

    def __init__(self, before: _Side, after: _Side) -> None:
        self._before, self._after = before, after
        self.states: dict[str, str] = {}
        self._sources: dict[str, str] = {}
        self._keys: dict[Key, Key] = {}
        self._key_sources: dict[Key, Key] = {}
        self._todo: list[tuple[str, str]] = []

    def compare(self) -> None:
        """Pair the states of the machines. Raises _DifferentError."""
        self._pair(self._before.root, self._after.root)
        while self._todo:
            one, other = self._todo.pop()
            if self._kind(self._before, one) != self._kind(self._after, other):
                raise _DifferentError
            old, new = self._before.nodes[one], self._after.nodes[other]
            self._compare_keys(one, other, old, new)
            if isinstance(old, Leaf) or isinstance(new, Leaf):
                self._compare_names(one, other)
            else:
                self._compare_inside(one, other, old, new)
            above = self._before.around.get(one), self._after.around.get(other)
            if above[0] is None or above[1] is None:
                continue
            if not isinstance(self._before.nodes[above[0]], Concurrence | IteratorNode):
                for outcome in outcome_names(old):
                    self._follow(one, other, outcome)

    def _pair(self, one: str, other: str) -> None:
        if self.states.get(one) == other and self._sources.get(other) == one:
            return
        if one in self.states or other in self._sources:
            raise _DifferentError
        self.states[one], self._sources[other] = other, one
        self._todo.append((one, other))

    def _follow(self, one: str, other: str, outcome: str) -> None:
        (left, is_state), (right, also) = (
            self._before.following(one, outcome),
            self._after.following(other, outcome),
        )
        if is_state != also or (not is_state and left != right):
            raise _DifferentError
        if is_state:
            self._pair(left, right)

    def _compare_names(self, one: str, other: str) -> None:
        leaf = self._before.nodes[one]
        assert isinstance(leaf, Leaf)
        named = self._before.is_named(leaf) or self._after.is_named(leaf)
        if named and one.rpartition("/")[2] != other.rpartition("/")[2]:
            raise _DifferentError

    def _compare_keys(self, one: str, other: str, old: Node, new: Node) -> None:
        """Pair the keys around two states which these read and write."""
        for mine, theirs in ((old.inputs, new.inputs), (old.outputs, new.outputs)):
            if {key.name for key in mine} != {key.name for key in theirs}:
                raise _DifferentError
        names, others = remapping(old), remapping(new)
        left, right = self._before.around.get(one), self._after.around.get(other)
        if left is None or right is None:
            if left is not right:
                raise _DifferentError
            return
        for key in {key.name: None for key in (*old.inputs, *old.outputs)}:
            self._pair_keys((left, names[key]), (right, others[key]))

    def _pair_keys(self, one: Key, other: Key) -> None:
        left, right = self._before.key(*one), self._after.key(*other)
        if left not in self._before.read and right not in self._after.read:
            return
        if self._keys.setdefault(left, right) != right:
            raise _DifferentError
        if self._key_sources.setdefault(right, left) != left:
            raise _DifferentError
        if self._before.presets.get(left) != self._after.presets.get(right):
            raise _DifferentError

    def _compare_inside(self, one: str, other: str, old: Container, new: Container) -> None:
        """Compare two containers from within: their keys, and the states that they start."""
        own = {key.name: None for key in (*old.inputs, *old.outputs)}
        for key in own:
            self._pair_keys((one, key), (other, key))
        match old, new:
            case ((StateMachine() | Sequence()), (StateMachine() | Sequence())):
                first, second = (
                    side.entered(f"{path}/{node.initial or node.children[0].name}")
                    for side, path, node in ((self._before, one, old), (self._after, other, new))
                )
                self._pair(first, second)
                return
            case IteratorNode(), IteratorNode():
                if old.items_key:
                    self._pair_keys((one, old.items_key), (other, new.items_key))
                self._pair_keys((one, old.item_key), (other, new.item_key))
            case _:
                pass
        for child, twin in zip(old.children, new.children, strict=True):
            self._pair(f"{one}/{child.name}", f"{other}/{twin.name}")

    def _kind(self, side: _Side, path: str) -> object:
        """What two states of a pair have in common, beside their keys and what follows them."""
        node = side.nodes[path]
        common = node.type, frozenset(outcome_names(node)), node.catches
        match node:
            case Leaf():
                if node.open or node.synthetic:
                    raise _DifferentError
                values = {held.name: print_data(held.value.data) for held in node.variables}
                order = outcome_names(node)  # the code may use it
                return common, order, values, node.writes, node.blocking, side.type_facts(node.type)
            case Concurrence():
                at = {child.name: number for number, child in enumerate(node.children)}
                rules = [
                    (rule.outcome, frozenset((at.get(one.child), one.outcome) for one in rule.when))
                    for rule in node.rules
                ]
                more: object = (node.default_outcome, node.join, rules)
            case IteratorNode():
                items = None if node.items is None else print_data(node.items.data)
                ends = node.exhausted_outcome, frozenset(node.loop_outcomes), {*node.final_map}
                # Its state sees all keys of an iterator by their names there.
                names = node.items_key, node.item_key, [remapping(child) for child in node.children]
                more = (items, ends, names)
            case _:
                return "machine", common[1:], _own_kind(node.type)
        return common, more, len(node.children)


def _own_kind(type_: str) -> str:
    """The type of a machine whose template is one of the user; empty for those of the language."""
    return "" if type_ in schema.CONTAINERS else type_
