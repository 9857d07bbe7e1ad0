"""The rules of concurrences, against all combinations of small concurrences."""

from __future__ import annotations

import itertools
import random
from collections.abc import Iterator, Mapping
from dataclasses import replace

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from smachac.analysis import outcome_rules
from smachac.analysis.outcome_rules import Combination, Rules, UndecidedError, sound_concurrence
from smachac.checks.findings.help_text import in_conditions
from smachac.diagnostics.diagnostic import Diagnostic, Severity
from smachac.ir.nodes import Concurrence, Node, StateMachine
from tests.support.examples import examples
from tests.support.ir_machines import concurrence, iterator, leaf, machine, ran
from tests.support.rule_findings import report

ENDS = ("ok", "lost", "seen", "aborted", "preempted")
RESULTS = ("succeeded", "partly", "again", "bad")
Conditions = dict[str, str]


@st.composite
def concurrences(draw: st.DrawFn, join: str = "all") -> Concurrence:
    """Up to four branches of up to four outcomes, with rules of all sizes."""
    names = "ABCD"[: draw(st.integers(1, 4))]
    ends = {name: draw(st.lists(st.sampled_from(ENDS), min_size=1, max_size=4, unique=True))
            for name in names}  # fmt: skip
    rules = []
    for result in RESULTS[: draw(st.integers(0, 4))]:
        asked = draw(st.lists(st.sampled_from(names), min_size=1, unique=True))
        rules.append((result, {name: draw(st.sampled_from(ends[name])) for name in asked}))
    return concurrence(
        "BOTH",
        " ".join(RESULTS),
        *(leaf(name, outcomes=" ".join(ends[name])) for name in names),
        default=draw(st.sampled_from(["", *RESULTS])),
        rules=tuple(rules),
        join=join,
        to=dict.fromkeys(RESULTS, "done"),
    )


def around(node: Concurrence) -> StateMachine:
    return machine("sm", "done", node)


def said(node: Concurrence, code: str) -> list[Diagnostic]:
    return [item for item in report(around(node)) if item.code == code]


def every(node: Concurrence, left_out: tuple[str, ...] = ()) -> Iterator[Combination]:
    """All combinations without some outcomes."""
    ends = [
        [(child.name, one.name) for one in child.outcomes if one.name not in left_out]
        for child in node.children
    ]
    return map(dict, itertools.product(*ends))


def holding(node: Concurrence, ended: Combination) -> list[tuple[int, str]]:
    """The size and result of each rule that holds."""
    return [
        (len(rule.when), rule.outcome)
        for rule in node.rules
        if all(ended[one.child] == one.outcome for one in rule.when)
    ]


def winners(node: Concurrence, ended: Combination) -> list[str]:
    found = holding(node, ended)
    return [name for size, name in found if size == max(found)[0]]


def told(node: Concurrence, item: Diagnostic) -> list[Combination]:
    """All combinations that fit the one shown in a message."""
    message = item.finding.message
    return [
        ended
        for ended in every(node)
        if all(
            f"`{child}: {end}`" in message or f"`{child}: " not in message
            for child, end in ended.items()
        )
    ]


@settings(max_examples=examples(150))
@given(concurrences())
def test_a_combination_is_missed_if_and_only_if_one_is_uncovered(node: Concurrence) -> None:
    found = said(node, "SM401")
    open_ = [ended for ended in every(node) if not holding(node, ended)]
    if node.default_outcome:
        unstopped = [one for one in open_ if not {"aborted", "preempted"} & set(one.values())]
        assert bool(found) == (bool(unstopped) and bool(node.rules))
    else:
        assert bool(found) == bool(open_)
    for item in found:
        shown = told(node, item)
        assert shown
        assert all(ended in open_ for ended in shown)
        assert (item.severity is Severity.ERROR) == (not node.default_outcome)


@settings(max_examples=examples(150))
@given(concurrences())
def test_rules_overlap_if_and_only_if_two_win_in_one_combination(node: Concurrence) -> None:
    ties = [ended for ended in every(node) if len(winners(node, ended)) > 1]
    found = said(node, "SM402")
    assert bool(found) == (bool(ties) and not said(node, "SM407"))  # of which it would follow
    for item in found:
        for ended in told(node, item):
            first, *_, last = winners(node, ended)
            assert f"Noetic ends with `{first}`, SMACH for ROS 2 with `{last}`" in (
                item.finding.message
            )


@settings(max_examples=examples(150))
@given(concurrences())
def test_a_rule_is_dead_if_and_only_if_it_wins_in_no_combination(node: Concurrence) -> None:
    alive = {name for ended in every(node) for name in winners(node, ended)}
    dead = [rule.outcome for rule in node.rules if rule.outcome not in alive]
    found = [item.finding.message.split("`")[1] for item in said(node, "SM403")]
    assert found == dead


GOOD = {"succeeded"}


def result(node: Concurrence, ended: Combination) -> str:
    return [node.default_outcome, *winners(node, ended)][-1]


def always_good(node: Concurrence) -> set[str]:
    """The one result of all combinations in which every child is as good as it can be."""
    best = []
    for child in node.children:
        ends = [one.name for one in child.outcomes]
        picked = [end for end in ends if end == "ok"] or [
            end for end in ends if end in ("lost", "seen")
        ]
        best.append([(child.name, end) for end in picked])
    results = {name for ended in map(dict, itertools.product(*best))
               for name in winners(node, ended) or [node.default_outcome]}  # fmt: skip
    return results if len(results) == 1 else set()


def masks(node: Concurrence, ended: Combination, good: set[str]) -> bool:
    """Whether a combination hides a failure: by its definition, spelt out."""
    won = winners(node, ended)
    if len(won) > 1:
        return False
    failed = {child for child, end in ended.items() if end == "aborted"}
    return result(node, ended) in good and bool(failed - asked(node, ended))


def asked(node: Concurrence, ended: Combination) -> set[str]:
    """The children that the rule which wins lists."""
    won = winners(node, ended)
    return {one.child for rule in node.rules if rule.outcome in won for one in rule.when}


@settings(max_examples=200)
@given(concurrences())
@pytest.mark.slow
def test_a_failure_is_masked_if_and_only_if_a_combination_hides_it(node: Concurrence) -> None:
    assume(node.default_outcome)
    good = GOOD | always_good(node)
    hiding = [one for one in every(node, ("preempted",)) if masks(node, one, good)]
    found = said(node, "SM404")
    assert {item.finding.message.split("`")[3] for item in found} == {
        result(node, ended) for ended in hiding
    }
    for item in found:
        shown = [ended for ended in told(node, item) if "preempted" not in ended.values()]
        assert shown
        assert all(masks(node, ended, good) for ended in shown)


@settings(max_examples=examples(60))
@given(concurrences(), st.integers(0, 9))
def test_the_interpreter_ends_as_is_said(node: Concurrence, seed: int) -> None:
    """The combinations shown by SM402 and SM404 do give those results when they are played."""
    assume(node.default_outcome)
    for item in [*said(node, "SM404"), *said(node, "SM402")]:
        masked = item.code == "SM404"
        promised = item.finding.message.split("`")[3] if masked else (
            item.finding.message.split("`")[-2])  # fmt: skip
        for ended in told(node, item):
            _, events = ran(around(node), dict(ended), seed=seed)
            (end,) = [e for e in events if e["event"] == "exit" and e["path"] == "sm/BOTH"]
            assert end["outcome"] == promised


@settings(max_examples=examples(100))
@given(concurrences(join="any"))
def test_with_join_any_the_first_to_end_decides(node: Concurrence) -> None:
    """What is said holds in a combination in which all others answer a request to stop."""
    assume(node.default_outcome)
    first_ends: list[tuple[str, Combination]] = []
    for child in node.children:
        for ended in every(node):
            others = [one for one in node.children if one is not child]
            answered = all(
                ended[one.name] == "preempted" or "preempted" not in {o.name for o in one.outcomes}
                for one in others
            )
            if answered and ended[child.name] != "preempted":
                first_ends.append((child.name, ended))
    ties = [ended for _, ended in first_ends if len(winners(node, ended)) > 1]
    assert bool(said(node, "SM402")) == bool(ties)
    for item in said(node, "SM404"):
        failed = item.finding.message.split("`")[5]
        shown = [
            ended for name, ended in first_ends if name == failed and ended in told(node, item)
        ]
        assert shown
        assert {result(node, ended) for ended in shown} == {item.finding.message.split("`")[3]}
    hiding = {
        name
        for name, ended in first_ends
        if ended[name] == "aborted" and masks(node, ended, GOOD)
        and name not in asked(node, ended)
    }  # fmt: skip
    assert bool(hiding) <= bool(said(node, "SM404"))


@settings(max_examples=examples(100))
@given(concurrences(), st.data())
def test_shown_parts_decide_and_are_as_small_as_they_can_be(
    node: Concurrence, data: st.DataObject
) -> None:
    concurrence = sound_concurrence(node.name, node)
    assert concurrence is not None
    rules = concurrence.rules
    domains = {child.name: tuple(one.name for one in child.outcomes) for child in node.children}
    avoided = data.draw(st.integers(0, rules.all))
    found = rules.find(domains, {}, avoided)
    assume(found is not None)
    assert found is not None
    part = rules.shown(found, {}, avoided)

    def decides(kept: Mapping[str, str]) -> bool:
        fitting = [item for item in every(node) if kept.items() <= item.items()]
        return all(
            not all(ended[child] == end for child, end in rules.conditions[number].items())
            for ended in fitting
            for number in outcome_rules.bits(avoided)
        )

    assert decides(part)
    for child in part:
        assert not decides({name: end for name, end in part.items() if name != child})


def drawn(
    branches: int, outcomes: int, rules: int, seed: int
) -> tuple[Rules, dict[str, list[str]]]:
    source = random.Random(seed)
    ends = [f"o{number}" for number in range(outcomes)]
    domains = {f"B{number}": ends for number in range(branches)}
    made = [
        {name: source.choice(ends) for name in source.sample(list(domains), source.randint(1, 6))}
        for _ in range(rules)
    ]
    return Rules(made), domains


@pytest.mark.parametrize("branches", [12, 40])
def test_many_branches_take_little(branches: int) -> None:
    """4 ** 40 combinations; what is looked at is counted, as time would say nothing."""
    for seed in range(20):
        rules, domains = drawn(branches, 4, 40, seed)
        for number in range(40):
            larger = rules.larger_than(len(rules.conditions[number]))
            rules.find(domains, rules.conditions[number], larger)
        rules.find(domains, {}, rules.all)
        assert rules.looked_at < 30_000


def test_a_cover_of_all_combinations_is_seen() -> None:
    """A chain of rules that leaves nothing out: A0; not A0 but A1; ..."""
    names = [f"A{number}" for number in range(30)]
    chain = [
        {**dict.fromkeys(names[:number], "no"), name: "yes"} for number, name in enumerate(names)
    ]
    rules = Rules([*chain, dict.fromkeys(names, "no")])
    domains = dict.fromkeys(names, ("yes", "no"))
    assert rules.find(domains, {}, rules.all) is None
    assert rules.looked_at < 100_000
    assert Rules(chain).find(domains, {}, (1 << 30) - 1) == dict.fromkeys(names, "no")


def test_what_takes_too_much_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pigeons and holes: no rule about two of them alone excludes, and no short proof exists."""
    holes = [f"h{number}" for number in range(7)]
    pigeons = [f"P{number}" for number in range(8)]
    pairs = itertools.combinations(pigeons, 2)
    rules = [{a: hole, b: hole} for a, b in pairs for hole in holes]
    monkeypatch.setattr(outcome_rules, "MOST_LOOKED_AT", 10_000)
    with pytest.raises(UndecidedError):
        Rules(rules).find(dict.fromkeys(pigeons, holes), {}, (1 << len(rules)) - 1)
    node = concurrence(
        "BOTH", "x " + " ".join(f"r{n}" for n in range(len(rules))),
        *(leaf(name, outcomes=" ".join(holes)) for name in pigeons), default="",
        rules=tuple((f"r{number}", when) for number, when in enumerate(rules)),
    )  # fmt: skip
    assert said(node, "SM401") == []


def test_only_outcomes_that_come_count() -> None:
    """IN declares `lost`, which nothing brings about; so does what an iterator makes of it."""
    inside = machine("IN", "ok lost", leaf("X", {"a": "ok"}))
    each = iterator("EACH", "ok lost", replace(inside, name="Y"), items=[1], exhausted="ok",
                    loop="ok")  # fmt: skip
    rules = (("succeeded", {"IN": "ok", "EACH": "ok"}),)
    node = concurrence("BOTH", " ".join(RESULTS), inside, each, default="", rules=rules)
    assert said(node, "SM401") == []
    other = machine("IN", "ok lost", leaf("X", {"a": "ok", "b": "lost"}))
    (item,) = said(replace(node, children=(other, each)), "SM401")
    assert "`IN: lost`" in item.finding.message


def test_a_concurrence_inside_one_ends_only_as_its_rules_say() -> None:
    def missed(own: tuple[tuple[str, Conditions], ...], known: str) -> list[str | None]:
        inner = concurrence("IN", "a b c", leaf("X", outcomes="x y"), leaf("Y", outcomes="x y"),
                            default="a", rules=own)  # fmt: skip
        rules = tuple((result, {"IN": end}) for result, end in zip(RESULTS, known, strict=False))
        node = concurrence("BOTH", " ".join(RESULTS), inner, default="", rules=rules)
        return [
            item.finding.node for item in said(node, "SM401") if item.severity is Severity.ERROR
        ]

    sizes = (("b", {"X": "x"}), ("c", {"X": "x", "Y": "x"}))
    assert missed(sizes, "abc") == []
    assert missed(sizes, "bc") == missed(sizes, "ab") == ["sm/BOTH"]
    covering = (("b", {"X": "x"}), ("c", {"X": "y"}))
    assert missed(covering, "bc") == []
    shadowed = (("a", {"X": "y"}), ("b", {"X": "x"}), ("c", {"X": "x", "Y": "x"}))
    assert missed((*shadowed[:1], ("c", {"X": "x"})), "ac") == []


def test_combinations_are_written_as_in_a_script() -> None:
    assert in_conditions({"LEFT": "done", "RIGHT": "aborted"}) == "`LEFT: done`, `RIGHT: aborted`"


def test_a_misspelt_rule_is_one_fault() -> None:
    """The combinations are not judged then."""
    branches = (leaf("LEFT", outcomes="done aborted"), leaf("RIGHT", outcomes="done aborted"))
    names = ("succeeded", "failed")
    for child, outcome in (("RIHGT", "done"), ("RIGHT", "doen"), ("XYZ", "done"), ("RIGHT", "zzz")):
        rules = (("succeeded", {"LEFT": "done", child: outcome}),)
        node = concurrence("BOTH", " ".join(names), *branches, default="failed", rules=rules,
                           to=dict.fromkeys(names, "done"))  # fmt: skip
        loud = [item for item in report(around(node)) if item.severity is not Severity.INFO]
        assert [item.code for item in loud] == ["SM403"]
        whole = replace(node, default_outcome="")
        assert not said(whole, "SM401")


@pytest.mark.parametrize(
    ("right", "wanted", "join", "dead"),
    [
        (leaf("RIGHT", outcomes="ok preempted"), "ok", "any", True),
        (leaf("RIGHT", outcomes="ok preempted"), "ok", "all", False),
        (leaf("RIGHT", outcomes="ok preempted"), "preempted", "any", False),
        (leaf("RIGHT", outcomes="ok"), "ok", "any", False),
        (machine("RIGHT", "ok off", leaf("A", {"ok": "ok", "preempted": "off"})),
         "ok", "any", True),
        (machine("RIGHT", "ok off", leaf("A", {"ok": "ok", "preempted": "ok"})),
         "ok", "any", False),
        (machine("RIGHT", "ok off", leaf("A", {"ok": "B", "preempted": "off"}),
                 leaf("B", {"ok": "ok"})), "ok", "any", False),
    ],
    ids=["both", "all", "one stops the other", "does not answer", "machine", "machine succeeds",
         "machine goes on"],
)  # fmt: skip
def test_a_rule_of_a_race_that_needs_both(right: Node, wanted: str, join: str, dead: bool) -> None:
    rules = (("good", {"LEFT": "ok", "RIGHT": wanted}), ("bad", {"LEFT": "preempted"}))
    node = concurrence("BOTH", "good bad", leaf("LEFT", outcomes="ok preempted"), right,
                       default="bad", rules=rules, join=join,
                       to={"good": "done", "bad": "done"})  # fmt: skip
    items = [item for item in report(machine("sm", "done", node)) if item.code == "SM403"]
    assert [item.severity for item in items] == ([Severity.WARNING] if dead else [])
    assert all(f"`LEFT: ok`, `RIGHT: {wanted}`" in item.message for item in items)
