"""The comparison of machines: laws over random machines, and what counts as renamed or moved."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from smachac.diagnostics.source import Source
from smachac.diff.comparison import Change, Comparison, Kind, compare
from smachac.driver import Analysis, analyse_script
from smachac.ir import nodes
from smachac.ir.nodes import Leaf, Machine, Node, StateMachine
from smachac.ir.traversal import walk
from smachac.refactor.equivalence import NodeMap
from tests.strategies.machines import machines, valid_machines
from tests.support.ir_machines import concurrence, leaf, machine, value

MIRROR: dict[Kind, Kind] = {"added": "removed", "removed": "added"}


def analysed(whole: Machine) -> Analysis:
    return Analysis(script="main.yml", machine=whole, report=[])


def changes(before: Node, after: Node) -> tuple[Change, ...]:
    assert isinstance(before, StateMachine)
    assert isinstance(after, StateMachine)
    return compared(Machine(root=before), Machine(root=after)).changes


def compared(before: Machine, after: Machine) -> Comparison:
    return compare(analysed(before), analysed(after))


def brief(found: tuple[Change, ...]) -> list[tuple[str, ...]]:
    return [(item.kind, item.what, item.path, item.name, item.before, item.after) for item in found]


def mirrored(each: Change) -> Change:
    """The same change in the other direction."""
    was = each.path if each.was else ""
    path = each.was or each.path
    return replace(
        each,
        kind=MIRROR.get(each.kind, each.kind),
        path=path,
        was=was,
        before=each.after,
        after=each.before,
    )


@given(machines())
def test_a_machine_equals_itself(whole: Machine) -> None:
    assert compared(whole, whole).equal


@given(valid_machines(), valid_machines())
@pytest.mark.slow
def test_the_other_direction_is_the_mirror(one: Machine, other: Machine) -> None:
    there, back = compared(one, other), compared(other, one)
    assert Counter(map(mirrored, there.changes)) == Counter(back.changes)
    assert {after: before for before, after in there.pairs.items()} == back.pairs


@given(valid_machines(), st.data())
def test_a_renamed_state_is_the_only_change(whole: Machine, data: st.DataObject) -> None:
    root, path = whole.root, chosen(whole, data)
    after = replace(whole, root=changed(root, path, "NEW"))
    (only,) = compared(whole, after).changes
    new = f"{path.rpartition('/')[0]}/NEW"
    assert (only.kind, only.what, only.was, only.path) == ("renamed", "state", path, new)


@given(valid_machines(), st.data())
def test_a_changed_transition_is_the_only_change(whole: Machine, data: st.DataObject) -> None:
    targets = [
        (path, step, name)
        for path, node in walk(whole.root)
        if isinstance(node, StateMachine)
        for child in node.children
        for step in child.transitions
        for name in (other.name for other in node.children)
        if name != step.target
    ]
    assume(targets)
    path, step, name = data.draw(st.sampled_from(targets))

    def lead(node: Node) -> Node:
        steps = [replace(other, target=name, origin="written") if other is step else other
                 for other in node.transitions]  # fmt: skip
        return replace(node, transitions=tuple(steps))

    after = with_root(whole, rebuilt(whole.root, whole.root.name, path, lead))
    (only,) = compared(whole, after).changes
    assert (only.kind, only.what, only.name) == ("changed", "transition", step.outcome)
    assert (only.path.rpartition("/")[0], only.after) == (path, name)


@given(valid_machines(), st.data())
def test_an_added_state_is_the_only_change(whole: Machine, data: st.DataObject) -> None:
    paths = [path for path, node in walk(whole.root) if isinstance(node, StateMachine)]
    path = data.draw(st.sampled_from(paths))

    def add(node: Node) -> Node:
        assert not isinstance(node, Leaf)
        return replace(node, children=(*node.children, leaf("NEW", type="ScriptedState")))

    root = at(whole.root, whole.root.name, path, add)
    (only,) = compared(whole, with_root(whole, root)).changes
    assert (only.kind, only.what, only.path) == ("added", "state", f"{path}/NEW")
    (back,) = compared(with_root(whole, root), whole).changes
    assert (back.kind, back.what, back.path) == ("removed", "state", f"{path}/NEW")


def with_root(whole: Machine, root: Node) -> Machine:
    assert isinstance(root, StateMachine)
    return replace(whole, root=root)


def chosen(whole: Machine, data: st.DataObject) -> str:
    """The path of a state below the root, without sugar."""
    paths = [path for path, _ in walk(whole.root)][1:]
    assume(paths)
    return data.draw(st.sampled_from(paths))


def changed(root: StateMachine, path: str, new: str) -> StateMachine:
    """A machine in which the state at a path has another name, wherever it is named."""
    around, _, old = path.rpartition("/")

    def rename(node: Node) -> Node:
        if node.name == old:
            node = replace(node, name=new)
        steps = [
            replace(step, target=new) if step.target == old and step.origin != "implicit" else step
            for step in node.transitions
        ]
        return replace(node, transitions=tuple(steps))

    def refer(node: Node) -> Node:
        if isinstance(node, StateMachine | nodes.Sequence) and node.initial == old:
            return replace(node, initial=new)
        if isinstance(node, nodes.Concurrence):
            rules = [
                replace(
                    rule,
                    when=tuple(
                        replace(item, child=new) if item.child == old else item
                        for item in rule.when
                    ),
                )
                for rule in node.rules
            ]
            return replace(node, rules=tuple(rules))
        return node

    found = rebuilt(at(root, root.name, around, refer), root.name, around, rename)
    assert isinstance(found, StateMachine)
    return found


def rebuilt(node: Node, here: str, path: str, change: NodeMap) -> Node:
    """A machine in which the children of the container at a path are changed."""

    def inside(container: Node) -> Node:
        assert not isinstance(container, Leaf)
        return replace(container, children=tuple(map(change, container.children)))

    return at(node, here, path, inside)


def at(node: Node, here: str, path: str, change: NodeMap) -> Node:
    """A machine in which the node at a path is changed."""
    if here == path:
        return change(node)
    if isinstance(node, Leaf):
        return node
    children = [
        at(child, f"{here}/{child.name}", path, change)
        if f"{path}/".startswith(f"{here}/{child.name}/")
        else child
        for child in node.children
    ]
    return replace(node, children=tuple(children))


PICK = {"done": "PLACE", "lost": "=lost"}


def pick(name: str = "PICK", speed: float = 1.0, **to: str) -> Leaf:
    return leaf(name, {**PICK, **to}, type="Grasp", speed=speed)


def place(name: str = "PLACE") -> Leaf:
    return leaf(name, {"done": "=done"}, type="Place")


def test_facts_of_states() -> None:
    before = machine("sm", "done lost", pick(), place())
    after = machine("sm", "done lost", pick(speed=0.5), place(), held={"height": 0.1}, ins="pose")
    assert brief(changes(before, after)) == [
        ("added", "input", "sm", "pose", "", "any"),
        ("added", "userdata", "sm", "height", "", "0.1"),
        ("changed", "variable", "sm/PICK", "speed", "1.0", "0.5"),
    ]


def test_a_state_that_is_renamed_and_changed() -> None:
    before = machine("sm", "done lost", pick(), place())
    after = machine("sm", "done lost", pick("GRASP", 0.5), place())
    assert brief(changes(before, after)) == [
        ("renamed", "state", "sm/GRASP", "", "sm/PICK", "sm/GRASP"),
        ("changed", "variable", "sm/GRASP", "speed", "1.0", "0.5"),
    ]


def test_a_state_of_another_type_is_another_state() -> None:
    before = machine("sm", "done lost", pick(), place())
    after = machine("sm", "done lost", leaf("SUCK", PICK, type="Suction"), place())
    assert [(change.kind, change.path) for change in changes(before, after)] == [
        ("changed", "sm"),
        ("added", "sm/SUCK"),
        ("removed", "sm/PICK"),
    ]


def test_two_states_that_changed_names() -> None:
    before = machine("sm", "done lost", pick(), place())
    after = machine("sm", "done lost", pick("A", done="B"), place("B"))
    assert [(change.kind, change.was, change.path) for change in changes(before, after)] == [
        ("renamed", "sm/PICK", "sm/A"),
        ("renamed", "sm/PLACE", "sm/B"),
    ]


def test_states_that_moved_into_a_container() -> None:
    before = machine("sm", "done lost", pick(), place())
    inner = machine("BOTH", "done lost", pick(), place(), to={"done": "=done", "lost": "=lost"})
    found = changes(before, machine("sm", "done lost", inner))
    assert [(item.kind, item.what, item.path, item.was) for item in found] == [
        ("changed", "field", "sm", ""),
        ("added", "state", "sm/BOTH", ""),
        ("moved", "state", "sm/BOTH/PICK", "sm/PICK"),
        ("moved", "state", "sm/BOTH/PLACE", "sm/PLACE"),
    ]


def test_rules_of_a_concurrence() -> None:
    def both(**when: str) -> StateMachine:
        children = (leaf("A", outcomes="done lost"), leaf("B", outcomes="done lost"))
        inner = concurrence("C", "done", *children, default="done", rules=(("done", when),))
        return machine("sm", "done", inner)

    assert brief(changes(both(A="done"), both(A="done", B="lost"))) == [
        ("changed", "rule", "sm/C", "done", "A = done", "A = done and B = lost")
    ]


SCRIPT = """\
name: sm
template: Base
outcomes: [done, lost]
states:
  - WAIT: {template: SleepState, time: 1, transitions: {succeeded: done, preempted: lost}}
"""


def of_text(text: str) -> Analysis:
    return analyse_script(Source("main.yml", text))


def test_sugar_is_a_fact_of_its_state() -> None:
    text = SCRIPT.replace("time: 1,", "time: 1, timeout: 2,")
    text = text.replace("lost}", "lost, timeout: lost}")
    assert brief(compare(of_text(SCRIPT), of_text(text)).changes) == [
        ("added", "outcome", "sm/WAIT", "timeout", "", ""),
        ("added", "field", "sm/WAIT", "timeout", "", "2 s"),
        ("added", "transition", "sm/WAIT", "timeout", "", "outcome lost"),
    ]


def test_findings_are_the_same_in_other_lines_and_under_other_names() -> None:
    broken = SCRIPT.replace("succeeded: done", "succeeded: doen")
    moved = "# A comment.\n" + broken.replace("WAIT", "PAUSE")
    found = compare(of_text(broken), of_text(moved))
    assert (found.added, found.removed, found.same > 0) == ([], [], True)
    fixed = compare(of_text(broken), of_text(SCRIPT))
    assert {item.code for item in fixed.removed} >= {"SM101"}
    assert fixed.added == []


def test_a_new_script_and_one_that_cannot_be_read() -> None:
    new = compare(None, of_text(SCRIPT))
    assert [(change.kind, change.path) for change in new.changes] == [
        ("added", "sm"),
        ("added", "sm/WAIT"),
    ]
    unread = of_text("name: [\n")
    assert unread.machine is None
    found = compare(of_text(SCRIPT), unread)
    assert (found.unread, found.changes, found.equal) == (True, (), False)
    assert compare(None, None).equal


def test_the_spans_do_not_count() -> None:
    text = SCRIPT.replace("name: sm", "\n# moved\nname: sm")
    assert compare(of_text(SCRIPT), of_text(text)).equal


def test_a_value_of_the_machine() -> None:
    before = Machine(root=machine("sm", "done", place()))
    params = (nodes.Param(name="speed", value=value(2)),)
    assert brief(compared(before, replace(before, params=params)).changes) == [
        ("added", "param", "sm", "speed", "", "2")
    ]
