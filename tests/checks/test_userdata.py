"""The rules over userdata, case by case, in machines made by hand."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from smachac.analysis.def_use import key_status, path_without, same_key, written_on
from smachac.analysis.definite_assignment import data_flow
from smachac.diagnostics.diagnostic import Severity
from smachac.diagnostics.source import NOWHERE
from smachac.ir.nodes import Key, Leaf, Machine, Node, StateMachine
from smachac.ir.types import Type
from tests.support.ir_machines import concurrence, iterator, leaf, machine, sequence
from tests.support.rule_findings import found, one, report
from tests.trust.project_text import analysed


def writer(name: str, to: dict[str, str], key: str = "k", **on: str) -> Leaf:
    """A leaf that writes a key; `on`: only on those outcomes."""
    node = leaf(name, to, outs=key)
    return replace(node, writes=tuple((outcome, (key,)) for outcome in on)) if on else node


def reader(name: str, to: dict[str, str], key: str = "k", **more: Any) -> Leaf:
    return leaf(name, to, ins=key, **more)


def root(*children: Node, **more: Any) -> StateMachine:
    return machine("sm", "done", *children, **more)


def severity(node: StateMachine, code: str = "SM301") -> Severity:
    return one(node, code).severity


DONE = {"ok": "done"}


def test_a_key_that_is_written_before_is_fine() -> None:
    assert found(root(writer("W", {"ok": "R"}), reader("R", DONE))) == []


def test_a_key_that_one_way_leaves_unset_is_a_warning_with_that_way() -> None:
    node = root(
        writer("W", {"ok": "R", "bad": "B"}, ok="1"), leaf("B", {"ok": "R"}), reader("R", DONE)
    )
    item = one(node, "SM301")
    assert item.severity is Severity.WARNING
    assert item.finding.path_labels == ("W", "(bad)", "B", "(ok)", "R")


def test_a_key_that_no_way_sets_is_an_error() -> None:
    node = root(leaf("A", {"ok": "R"}), reader("R", {"ok": "W"}), writer("W", DONE))
    assert severity(node) is Severity.ERROR


def test_what_the_first_visit_needs_is_not_set_by_a_later_one() -> None:
    node = root(reader("R", {"ok": "W"}), writer("W", {"ok": "R", "bad": "done"}))
    assert severity(node) is Severity.ERROR
    other = root(
        leaf("A", {"ok": "R", "bad": "W"}), reader("R", {"ok": "W"}), writer("W", {"ok": "R"})
    )
    assert severity(replace(other, forever=True)) is Severity.WARNING


def test_only_the_first_reader_on_a_way_is_reported() -> None:
    node = root(reader("R", {"ok": "S"}), reader("S", {"ok": "W"}), writer("W", DONE))
    assert found(node, "SM301") == ["SM301 sm/R"]


def test_two_ways_have_two_first_readers() -> None:
    node = root(
        leaf("A", {"ok": "R", "no": "S"}), reader("R", {"ok": "W"}), reader("S", {"ok": "W"}),
        writer("W", DONE),
    )  # fmt: skip
    assert found(node, "SM301") == ["SM301 sm/R", "SM301 sm/S"]


def test_a_key_that_nothing_sets_is_one_fault_however_many_read_it() -> None:
    node = root(leaf("A", {"ok": "R", "no": "S"}), reader("R", DONE), reader("S", DONE))
    assert found(node) == ["SM301 sm/R"]


def test_an_outcome_of_preemption_comes_without_the_outputs() -> None:
    node = root(writer("W", {"ok": "R", "preempted": "R"}), reader("R", DONE))
    assert one(node, "SM301").finding.path_labels == ("W", "(preempted)", "R")


def test_presets_and_inputs_of_the_machine_are_set() -> None:
    assert found(root(reader("R", DONE), held={"k": 1})) == []
    assert found(root(reader("R", DONE), ins="k")) == []


def test_nothing_is_said_after_a_state_of_an_unknown_type() -> None:
    node = root(leaf("X", {"ok": "R"}, open=True), reader("R", DONE))
    assert found(node, "SM3") == []
    before = root(reader("R", {"ok": "X"}), leaf("X", DONE, open=True))
    assert severity(before) is Severity.ERROR


def test_an_optional_input_may_be_absent() -> None:
    node = leaf("R", DONE)
    key = Key(name="k", type=Type("optional", (Type("int"),)), span=NOWHERE)
    assert found(root(replace(node, inputs=(key,)))) == []


def test_a_container_needs_what_is_read_in_it_first() -> None:
    inner = machine("C", "out", reader("R", {"ok": "out"}), ins="k", to={"out": "done"})
    item = one(root(inner, leaf("W", DONE, outs="k")), "SM301")
    assert item.finding.node == "sm/C"
    assert item.finding.path_labels == ("C", "R")
    own = machine("C", "out", writer("W", {"ok": "R"}), reader("R", {"ok": "out"}), ins="k",
                  to={"out": "done"})  # fmt: skip
    assert found(root(own)) == []


def test_a_container_keeps_what_it_does_not_hand_out() -> None:
    kept = machine("C", "out", writer("W", {"ok": "out"}), to={"out": "R"})
    assert severity(root(kept, reader("R", DONE)), "SM307") is Severity.ERROR
    handed = machine("C", "out", writer("W", {"ok": "out"}), outs="k", to={"out": "R"})
    assert found(root(handed, reader("R", DONE))) == []


def test_who_reads_after_a_container_gets_the_value_from_before() -> None:
    kept = machine("C", "out", writer("W", {"ok": "out"}), to={"out": "R"})
    node = root(kept, reader("R", DONE), held={"k": 0})
    assert found(node) == ["SM307 sm/C"]
    assert severity(node, "SM307") is Severity.WARNING
    again = root(
        replace(kept, transitions=leaf("X", {"out": "V"}).transitions),
        writer("V", {"ok": "R"}), reader("R", DONE), held={"k": 0},
    )  # fmt: skip
    assert found(again, "SM307") == []


def test_outputs_of_a_container_count_per_outcome() -> None:
    inner = machine("C", "good bad", writer("W", {"ok": "good", "no": "bad"}, ok="1"), outs="k",
                    to={"good": "R", "bad": "R"})  # fmt: skip
    item = one(root(inner, reader("R", DONE)), "SM301")
    assert item.finding.path_labels == ("C", "(bad)", "R")
    fine = replace(inner, transitions=leaf("X", {"good": "R", "bad": "done"}).transitions)
    assert found(root(fine, reader("R", DONE))) == []


def test_keys_pass_through_remaps() -> None:
    node = root(
        leaf("W", {"ok": "R"}, outs="a", remaps={"a": "shared"}),
        leaf("R", DONE, ins="b", remaps={"b": "shared"}),
    )
    assert found(node) == []
    lost = root(leaf("W", {"ok": "R"}, outs="a"), leaf("R", DONE, ins="b", remaps={"b": "c"}))
    assert found(lost) == ["SM302 sm/R"]


def test_a_remap_of_a_key_that_is_not_there_is_corrected_before_the_rest_is_judged() -> None:
    node = root(leaf("R", DONE, ins="pose", remaps={"psoe": "block"}), held={"block": 1})
    assert found(node) == ["SM302 sm/R"]
    assert one(node, "SM302").finding.help == "did you mean `pose`?"


def test_a_misspelt_target_does_not_hide_who_writes() -> None:
    node = root(writer("WRITE", {"ok": "RAED"}), reader("READ", DONE))
    assert found(node) == ["SM101 sm/WRITE"]


def test_all_containers_between_have_to_take_a_key_in() -> None:
    inner = machine("E", "out", reader("R", {"ok": "out"}), to={"out": "out"})
    outer = machine("D", "out", inner, to={"out": "done"})
    item = one(root(outer, held={"k": 1}), "SM303")
    assert item.finding.node == "sm/D/E/R"
    assert item.finding.help == "write `input_keys: [k]` in `D`, `E`"
    assert found(root(outer, held={"k": 1})) == ["SM303 sm/D/E/R"]


def test_children_that_run_together_have_all_written_at_the_end() -> None:
    both = concurrence("C", "out", writer("A", {}, "a"), writer("B", {}, "b"), default="out",
                       outs="a b", to={"out": "R"})  # fmt: skip
    both = replace(both, children=tuple(
        replace(child, outcomes=leaf("X", {"ok": "x"}).outcomes) for child in both.children
    ))  # fmt: skip
    assert found(root(both, leaf("R", DONE, ins="a b"))) == []


def test_the_rule_of_an_outcome_says_what_is_written() -> None:
    def node(target: str) -> StateMachine:
        a = replace(writer("A", {}, ok="1"), outcomes=leaf("X", {"ok": "", "no": ""}).outcomes)
        both = concurrence("C", "found lost", a, leaf("B", outcomes="ok"), default="lost", outs="k",
                           rules=(("found", {"A": "ok"}),),
                           to={"found": "R", "lost": target})  # fmt: skip
        return root(both, reader("R", DONE))

    assert found(node("done")) == []
    assert one(node("R"), "SM301").finding.path_labels == ("C", "(lost)", "R")


def test_a_race_is_no_missing_key() -> None:
    both = concurrence("C", "out", leaf("A", outcomes="ok", outs="k"),
                       leaf("B", outcomes="ok", ins="k"), default="out",
                       to={"out": "done"})  # fmt: skip
    assert [line[:5] for line in found(root(both))] == ["SM405"]


def test_an_iterator_sets_its_item_and_may_have_none() -> None:
    def node(items: Any) -> StateMachine:
        child = machine("B", "ok", writer("W", {"ok": "ok"}), reader("R", {"ok": "ok"}, "item"),
                        ins="item", outs="k")  # fmt: skip
        child = replace(child, children=(
            replace(child.children[0], transitions=leaf("X", {"ok": "R"}).transitions),
            child.children[1],
        ))  # fmt: skip
        each = iterator("I", "exhausted", child, items=items, item_key="item", loop="ok", outs="k",
                        to={"exhausted": "R"})  # fmt: skip
        return root(each, reader("R", DONE))

    assert found(node([1])) == []
    assert severity(node([])) is Severity.WARNING


def test_the_items_of_an_iterator_have_to_be_there() -> None:
    each = iterator("I", "exhausted", leaf("A", outcomes="ok"), items_key="todo", loop="ok",
                    to={"exhausted": "done"})  # fmt: skip
    assert found(root(each)) == ["SM301 sm/I"]
    assert found(root(replace(each, inputs=(Key(name="todo", span=NOWHERE),)), ins="todo")) == []


def test_callbacks_run_in_the_order_of_the_alphabet() -> None:
    def node(**functions: str) -> StateMachine:
        return root(leaf("C", {"succeeded": "done"}, type="CallbacksState", ins="a b", outs="a b",
                         callbacks=functions))  # fmt: skip

    assert found(node(a="`lambda ud: 1`", b="`lambda ud: ud.a + ud.b if 'b' in ud else 0`")) == []
    assert found(node(a="`lambda ud: ud.b`", b="`lambda ud: ud.a`")) == ["SM301 sm/C"]
    assert found(node(a="`make_a`", b="`lambda ud: ud.a`")) == ["SM301 sm/C", "SM301 sm/C"]


@pytest.mark.parametrize(
    ("steps", "severities"),
    [
        ([{"outcome": "ok", "set": {"k": 1}}], []),
        ([{"outcome": "ok", "set": {"k": 1}}, {"outcome": "ok"}], [Severity.WARNING]),
        ([{"outcome": "ok"}], []),
        ([], []),
    ],
)
def test_steps_say_what_a_scripted_state_sets(steps: Any, severities: list[Severity]) -> None:
    told = leaf("W", {"ok": "R"}, type="ScriptedState", outs="k", steps=steps)
    items = [item for item in report(root(told, reader("R", DONE))) if item.code == "SM301"]
    assert [item.severity for item in items] == severities


def test_what_is_kept_between_visits_counts() -> None:
    inner = machine("C", "out", leaf("A", {"w": "W", "r": "R"}), writer("W", {"ok": "out"}),
                    reader("R", {"ok": "out"}), to={"out": "C"})  # fmt: skip
    assert severity(replace(root(inner), forever=True)) is Severity.WARNING
    once = replace(inner, transitions=leaf("X", {"out": "done"}).transitions)
    assert severity(root(once)) is Severity.ERROR


def test_deep_nesting_is_judged() -> None:
    node: Node = reader("R", {"ok": "out"})
    for number in range(900):
        node = machine(f"C{number}", "out", node, ins="k", to={"out": "out"})
    assert found(root(replace(node, transitions=leaf("X", {"out": "done"}).transitions)),
                 "SM3") == ["SM301 sm/C899"]  # fmt: skip


def test_what_comes_after_an_iterator_that_was_asked_to_stop() -> None:
    """It ends with the outcome on which it goes on else, and with what that has set."""
    stopped = {"next": "halt", "bad": "all"}

    def each(of: Leaf) -> StateMachine:
        return root(
            iterator("E", "all halt", of, items=[1, 2], exhausted="all", loop="next", final=stopped,
                     outs="k", to={"all": "done", "halt": "R"}),
            reader("R", DONE),
        )  # fmt: skip

    outcomes = {"next": "", "bad": ""}
    assert severity(each(writer("W", outcomes, bad="1"))) is Severity.ERROR
    assert found(each(writer("W", outcomes)), "SM3") == []


def test_many_missing_keys_take_no_longer_than_they_should() -> None:
    names = [f"S{number}" for number in range(2000)]
    steps = zip(names, [*names[1:], "done"], strict=True)
    chain = [
        leaf(name, {"ok": to, "bad": name}, ins=f"k{name}", outs=f"k{to}") for name, to in steps
    ]
    chain = [replace(item, writes=(("bad", (item.outputs[0].name,)),)) for item in chain]
    assert len(found(root(*chain), "SM301")) == 2000


def test_a_dead_key_and_what_is_no_dead_key() -> None:
    inner = machine("C", "out", writer("W", {"ok": "out"}), to={"out": "done"})
    assert found(root(inner)) == ["SM305 sm/C/W"]
    assert found(root(leaf("A", DONE), held={"k": 1})) == ["SM305 sm"]
    assert found(root(leaf("A", DONE), held={"k": 1}, outs="k")) == []
    assert found(root(leaf("A", DONE, open=True), held={"k": 1})) == []
    assert found(root(writer("W", DONE))) == []
    assert severity(root(writer("W", DONE)), "SM305") is Severity.INFO


def test_a_declaration_without_use() -> None:
    inner = machine("C", "out", leaf("A", {"ok": "out"}), ins="k", outs="r", to={"out": "done"})
    assert found(root(inner, held={"k": 1})) == ["SM306 sm/C", "SM306 sm/C"]
    assert found(root(inner, held={"k": 1}), "SM305") == []


def test_an_input_that_a_container_inside_does_not_take_in_is_one_fault() -> None:
    """Not also one that nothing reads."""
    inner = machine("I", "out", reader("R", {"ok": "out"}), to={"out": "out"})
    outer = machine("O", "out", inner, ins="k", to={"out": "done"})
    assert found(root(outer, held={"k": 1})) == ["SM303 sm/O/I/R"]


def test_a_misspelt_key_in_code_is_one_fault() -> None:
    """Not also a key that nothing sets, nor an input that nothing reads."""
    judge = leaf("J", {"ok": "done"}, type="ConditionalOutcomeState", ins="level",
                 callbacks={"ok": "`lambda ud: ud.leevl < 3`"}, default_outcome="ok")  # fmt: skip
    assert found(root(judge, held={"level": 1})) == ["SM310 sm/J"]
    count = leaf("C", {"succeeded": "done"}, type="CallbacksState", ins="count", outs="count",
                 callbacks={"conut": "`lambda ud: ud.count + 1`"})  # fmt: skip
    assert found(root(count, held={"count": 1}, outs="count")) == ["SM308 sm/C"]


def test_code_that_reads_what_is_not_declared_is_one_fault() -> None:
    """Not also a key that nothing sets; and where something does, it is not dead."""
    count = leaf("C", {"succeeded": "done"}, type="CallbacksState", ins="n", outs="n",
                 callbacks={"n": "`lambda ud: ud.n + ud.step`"})  # fmt: skip
    assert found(root(count, held={"n": 1})) == ["SM310 sm/C"]
    assert found(root(count, held={"n": 1, "step": 1})) == ["SM310 sm/C"]


def test_a_sequence_is_judged_along_its_links() -> None:
    node = sequence("S", "ok", "ok", writer("W", {"ok": "R"}), reader("R", {"ok": "=ok"}),
                    to={"ok": "done"})  # fmt: skip
    assert found(root(node)) == []


def test_who_uses_a_key() -> None:
    inner = machine("C", "out", reader("R", {"ok": "out"}, "b"), ins="b", remaps={"b": "a"},
                    to={"out": "done"})  # fmt: skip
    node = root(writer("W", {"ok": "C", "bad": "C"}, "a", ok="1"), inner)
    flow = data_flow(Machine(root=node))
    found = flow.scopes["sm"].uses.of("a")
    assert [(use.kind, use.path, use.key) for use in found] == [
        ("writes", "sm/W", "a"),
        ("copies in", "sm/C", "b"),
    ]
    assert written_on(flow, flow.scopes["sm"], found[0]) == ("ok",)
    assert same_key(flow, "sm", "a") == (("sm", "a"), ("sm/C", "b"))
    assert key_status(flow, "sm/C/R", "b") == "sometimes"
    assert path_without(flow, "sm/C/R", "b") == ("W", "(bad)", "C", "R")
    assert key_status(flow, "sm/C/R", "zzz") == "never"
    assert key_status(flow, "sm/NOBODY", "a") == "unreachable"


def test_a_remapping_the_wrong_way_round_is_explained() -> None:
    node = reader("A", DONE, "pose", remaps={"block_pose": "pose"})
    helps = [item.finding.help for item in report(root(node)) if item.code == "SM302"]
    assert "the key of the state comes first: write `pose: block_pose`" in helps


def test_the_item_of_an_iterator_is_no_guess_for_its_items() -> None:
    inner = leaf("B", {"ok": "=ok"})
    node = iterator("A", "ok", inner, items_key="items", item_key="item", to=DONE)
    help = one(root(node), "SM301").finding.help
    assert help is not None
    assert "did you mean" not in help


UNSET = """
name: sm
template: Base
outcomes: [done]
userdata: {n: 1}
states:
  - A:
      STATE
  - B:
      template: ScriptedState
      input_keys: [w]
      outcomes: [ok]
      transitions: {ok: done}
"""


@pytest.mark.parametrize(
    ("state", "key"),
    [
        ("template: ScriptedState\n      outcomes: [ok]\n      output_keys: [w]\n"
         "      steps: [{outcome: ok, set: {widht: 0.05}}]\n      transitions: {ok: B}", "widht"),
        ("template: CallbacksState\n      input_keys: [n]\n      output_keys: [w]\n"
         "      callbacks: {total: 'lambda ud: ud.n'}\n      transitions: {succeeded: B}", "total"),
    ],
)  # fmt: skip
def test_no_edit_where_a_declared_output_is_never_set(state: str, key: str) -> None:
    items = analysed({"main.yml": UNSET.replace("STATE", state)}).report
    (item,) = [item for item in items if item.code == "SM308"]
    help = f"write `output_keys: [w, {key}]` in `A`; nothing in `A` sets `w`"
    assert item.finding.help == help
    assert item.finding.edits == ()
    every = state.replace("set: {widht", "set: {w: 1, widht").replace("{total", "{w: 1, total")
    if "set:" in every:
        items = analysed({"main.yml": UNSET.replace("STATE", every)}).report
        (item,) = [item for item in items if item.code == "SM308"]
        assert [edit.text for edit in item.finding.edits] == [", widht"]
