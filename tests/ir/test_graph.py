from __future__ import annotations

from dataclasses import replace

from smachac.diagnostics.source import NOWHERE
from smachac.ir import nodes
from smachac.ir.graph import START, can_end, edges, machine_graph, reachable
from smachac.ir.nodes import Concurrence, Leaf, StateMachine, Transition
from smachac.ir.traversal import walk


def outcomes(*names: str) -> tuple[nodes.Outcome, ...]:
    return tuple(nodes.Outcome(name=name, span=NOWHERE) for name in names)


def leaf(name: str, *, open: bool = False, has: str | None = None, **steps: str) -> Leaf:
    """A leaf with transitions `outcome=target`; `has` lists its outcomes where they differ."""
    return Leaf(
        name=name,
        type="T",
        open=open,
        outcomes=outcomes(*(steps if has is None else has.split())),
        transitions=tuple(
            Transition(outcome=outcome, target=target, span=NOWHERE)
            for outcome, target in steps.items()
        ),
        span=NOWHERE,
    )


def machine_of(*children: nodes.Node, ends: str = "done", initial: str = "A") -> StateMachine:
    return StateMachine(
        name="sm",
        type="StateMachine",
        outcomes=outcomes(*ends.split()),
        children=children,
        initial=initial,
        span=NOWHERE,
    )


def test_a_chain_is_reachable_and_ends() -> None:
    sm = machine_of(leaf("A", ok="B"), leaf("B", ok="done"))
    assert reachable(sm) == {"A", "B"}
    assert can_end(sm) == {"A", "B"}
    assert [(edge.source, edge.target, edge.kind) for edge in edges(sm)] == [
        (START, "A", "enter"),
        ("A", "B", "written"),
        ("B", ("outcome", "done"), "written"),
    ]


def test_an_edge_of_an_undeclared_outcome_does_not_count() -> None:
    sm = machine_of(leaf("A", has="bad", ok="B", bad="done"), leaf("B", ok="done"))
    assert reachable(sm) == {"A"}


def test_an_open_leaf_may_have_any_outcome() -> None:
    sm = machine_of(leaf("A", open=True, has="", ok="B"), leaf("B", ok="done"))
    assert reachable(sm) == {"A", "B"}
    assert can_end(sm) == {"A", "B"}


def test_a_loop_without_an_exit_cannot_end() -> None:
    sm = machine_of(leaf("A", ok="B"), leaf("B", ok="A"), leaf("C", ok="done"))
    assert can_end(sm) == {"C"}
    assert reachable(sm) == {"A", "B"}


def test_a_state_without_outcomes_cannot_end() -> None:
    assert can_end(machine_of(leaf("A"))) == frozenset()


def test_what_has_a_fault_of_its_own_counts_as_a_way_out() -> None:
    assert can_end(machine_of(leaf("A", ok="NOWHERE"))) == {"A"}
    assert can_end(machine_of(leaf("A", has="ok lost", ok="A"))) == {"A"}
    assert reachable(machine_of(leaf("A", ok="done"), initial="Z")) == {"A"}


def test_a_name_shared_by_a_state_and_an_outcome_means_the_state_unless_implicit() -> None:
    implicit = Transition(outcome="B", target="B", origin="implicit", span=NOWHERE)
    first = nodes.Leaf(
        name="A", type="T", outcomes=outcomes("B"), transitions=(implicit,), span=NOWHERE
    )
    sm = machine_of(first, leaf("B", ok="B"), ends="B")
    assert reachable(sm) == {"A"}
    assert can_end(sm) == {"A"}
    assert [edge.target for edge in edges(sm)] == ["A", ("outcome", "B"), "B"]


def concurrence(*children: nodes.Node, default: str = "lost") -> Concurrence:
    rule = nodes.OutcomeRule(
        outcome="done",
        when=tuple(
            nodes.Condition(child=child.name, outcome="ok", span=NOWHERE) for child in children
        ),
        span=NOWHERE,
    )
    return Concurrence(
        name="BOTH",
        type="Concurrence",
        outcomes=outcomes("done", "lost"),
        children=children,
        rules=(rule,),
        default_outcome=default,
        span=NOWHERE,
    )


def test_every_branch_of_a_concurrence_is_reachable() -> None:
    both = concurrence(leaf("A", has="ok"), leaf("B", has=""))
    assert reachable(both) == {"A", "B"}
    assert can_end(both) == {"A"}
    assert [tuple(edge)[:4] for edge in edges(both)] == [
        (START, "A", "", "enter"),
        ("A", ("outcome", "done"), "ok", "rule"),
        ("A", ("outcome", "lost"), "ok", "default"),
        (START, "B", "", "enter"),
    ]


def iterator(child: nodes.Node, items: nodes.Value | None) -> nodes.Iterator:
    return nodes.Iterator(
        name="EACH",
        type="Iterator",
        outcomes=outcomes("finished", "failed"),
        children=(child,),
        items=items,
        items_key="" if items else "todo",
        loop_outcomes=("ok",),
        final_map=(("exhausted", "finished"), ("bad", "failed")),
        span=NOWHERE,
    )


def test_an_iterator_loops_breaks_and_runs_out_of_items() -> None:
    each = iterator(leaf("A", has="ok bad other"), nodes.Value(data=(1, 2), span=NOWHERE))
    assert [tuple(edge)[:4] for edge in edges(each)] == [
        (START, "A", "", "enter"),
        ("A", "A", "ok", "loop"),
        ("A", ("outcome", "finished"), "ok", "exhausted"),
        ("A", ("outcome", "failed"), "bad", "break"),
    ]
    from_userdata = list(edges(iterator(leaf("A", has="ok"), None)))
    assert from_userdata[-1].source == START
    assert from_userdata[-1].target == ("outcome", "finished")
    assert reachable(each) == can_end(each) == {"A"}


def test_the_graph_of_a_machine_keeps_outcome_and_transition_of_a_container_together() -> None:
    inner = StateMachine(
        name="B",
        type="StateMachine",
        outcomes=outcomes("done", "lost"),
        children=(leaf("X", ok="done"),),
        initial="X",
        transitions=(
            Transition(outcome="done", target="done", span=NOWHERE),
            Transition(outcome="lost", target="A", span=NOWHERE),
        ),
        span=NOWHERE,
    )
    root = machine_of(leaf("A", ok="B"), inner)
    graph = machine_graph(walk(root), lambda path, container: edges(container))
    assert set(graph.edges()) == {
        (("sm", ""), ("sm/A", "")),
        (("sm/A", ""), ("sm/A", "ok")),
        (("sm/A", "ok"), ("sm/B", "")),
        (("sm/B", ""), ("sm/B/X", "")),
        (("sm/B/X", ""), ("sm/B/X", "ok")),
        (("sm/B/X", "ok"), ("sm/B", "done")),
        (("sm/B", "done"), ("sm", "done")),
        (("sm/B", "lost"), ("sm/A", "")),
    }
    assert graph.in_degree(("sm/B", "lost")) == 0


def test_an_exception_that_is_caught_leaves_from_the_entry_of_the_container() -> None:
    root = replace(machine_of(leaf("A", ok="done")), catches="done")
    graph = machine_graph(walk(root), lambda path, container: edges(container))
    assert list(graph.successors(("sm", ""))) == [("sm/A", ""), ("sm", "done")]


def test_searches_are_linear_in_the_size_of_a_container() -> None:
    many = [leaf(f"S{i}", ok=f"S{i + 1}", bad="done") for i in range(20_000)]
    sm = machine_of(*many, leaf("S20000", ok="done"), initial="S0")
    assert len(reachable(sm)) == len(can_end(sm)) == 20_001
