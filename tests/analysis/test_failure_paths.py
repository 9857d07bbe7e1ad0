"""The failures of machines: who catches them, and how the machine ends."""

from __future__ import annotations

from smachac.analysis.context import Context
from smachac.analysis.failure_paths import Failure
from smachac.ir.nodes import Machine, StateMachine
from tests.support.ir_machines import concurrence, iterator, leaf, machine


def told(root: StateMachine) -> list[str]:
    return [row(failure) for failure in Context(Machine(root=root)).failures]


def row(each: Failure) -> str:
    name = each.path.partition("/")[2]
    return f"{name} {each.outcome}: {each.answer} {each.next} {'|'.join(each.ends)}"


def test_failures_of_a_flat_machine() -> None:
    root = machine(
        "sm",
        "good bad",
        leaf("A", {"ok": "B", "aborted": "A", "failed": "bad", "timeout": "HELP"}),
        leaf("B", {"succeeded": "C", "error": "C"}),
        leaf("C", {"succeeded": "good", "failed": "good"}),
        leaf("HELP", {"ok": "B", "preempted": "bad"}),
        leaf("NEVER", {"failed": "bad"}),
    )
    assert told(root) == [
        "A aborted: repeated sm/A good|bad",
        "A failed: not caught  bad",
        "A timeout: caught sm/HELP good",
        "B error: ignored sm/C good",
        "C failed: ignored  good",
    ]


def test_a_failure_leaves_containers_until_it_is_caught() -> None:
    a = leaf("A", {"ok": "out", "failed": "lost"})
    inner = machine("IN", "out lost", a, to={"out": "out", "lost": "lost"})
    middle = machine("MID", "out lost", inner, to={"out": "good", "lost": "FIX"})
    root = machine("sm", "good", middle, leaf("FIX", {"ok": "good"}))
    (found,) = Context(Machine(root=root)).failures
    assert row(found) == "MID/IN/A failed: caught sm/FIX good"
    assert found.way == ("A", "(failed)", "IN", "(lost)", "MID", "(lost)", "FIX")
    back = machine(
        "sm", "good", machine("MID", "out lost", inner, to={"out": "good", "lost": "MID"})
    )
    assert told(back) == ["MID/IN/A failed: repeated sm/MID good"]
    nowhere = machine("sm", "good", machine("MID", "out lost", inner, to={"out": "good"}))
    assert told(nowhere) == ["MID/IN/A failed: lost  "]


def branches(default: str, *rules: tuple[str, dict[str, str]], join: str = "all") -> list[str]:
    left = leaf("LEFT", outcomes="ok failed preempted")
    right = leaf("RIGHT", outcomes="ok aborted preempted")
    to = {"ok": "NEXT", "part": "FIX", "bad": "bad"}
    both = concurrence(
        "BOTH", "ok part bad", left, right, default=default, rules=rules, join=join, to=to
    )
    after = (leaf("NEXT", {"ok": "good"}), leaf("FIX", {"ok": "good"}))
    return told(machine("sm", "good bad", both, *after))


def test_in_a_concurrence_the_rules_say_what_follows() -> None:
    assert branches("bad", ("ok", {"LEFT": "ok", "RIGHT": "ok"}), ("part", {"LEFT": "failed"})) == [
        "BOTH/LEFT failed: caught sm/FIX good",
        "BOTH/RIGHT aborted: caught sm/FIX good",
        "BOTH/RIGHT aborted: not caught  bad",
    ]


def test_a_failure_that_a_concurrence_hides_is_passed_over() -> None:
    assert branches("ok") == [
        "BOTH/LEFT failed: ignored sm/NEXT good",
        "BOTH/RIGHT aborted: ignored sm/NEXT good",
    ]


def test_the_branch_that_ends_first_decides() -> None:
    rules = (("ok", {"LEFT": "ok"}), ("part", {"RIGHT": "aborted"}))
    assert branches("bad", *rules, join="any") == [
        "BOTH/LEFT failed: not caught  bad",
        "BOTH/RIGHT aborted: caught sm/FIX good",
    ]


def test_an_iterator_goes_on_or_breaks_off() -> None:
    a = leaf("A", outcomes="ok failed error")
    each = iterator("EACH", "done error", a, items=[1, 2], exhausted="done", loop="ok failed",
                    to={"done": "good", "error": "bad"})  # fmt: skip
    assert told(machine("sm", "good bad", each)) == [
        "EACH/A failed: repeated sm/EACH/A good|bad",
        "EACH/A failed: ignored  good",
        "EACH/A error: not caught  bad",
    ]


def test_a_machine_that_loops_for_ever_has_no_end() -> None:
    root = machine("sm", "", leaf("A", {"ok": "A", "failed": "B"}), leaf("B", {"ok": "A"}))
    assert told(root) == ["A failed: caught sm/B "]


def test_no_machine_without_a_state_fails() -> None:
    assert told(machine("sm", "good")) == []
