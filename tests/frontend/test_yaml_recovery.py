"""A lost or wrong sign in YAML is one finding with the text to write."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.frontend.text.recovering_parser import parse_with_recovery
from smachac.frontend.text.yaml_tree import Map, parse

EXAMPLES = Path(__file__).parents[2] / "examples"


def recovered(text: str) -> tuple[object, Report]:
    report: Report = []
    return parse_with_recovery(Source("x.yml", text), report), report


@pytest.mark.parametrize(
    ("text", "place", "message", "help"),
    [
        # YAML with another meaning
        ("t: {done READY, no: b}", 4, "a `:` is missing after `done`", "`done: READY`"),
        ("t {done: READY}", 0, "a `:` is missing after `t`", "`t: {done: READY}`"),
        ("t:{done: READY}", 0, "a space is missing", "`t: {done: READY}`"),
        ("r = {to: station}", 2, "a `:` is due after `r`, not `=`", "`r: {to: station}`"),
        ("t: {a = b, c: d}", 6, "a `:` is due after `a`", "`a: b`"),
        ("t: {time 5}", 4, "a `:` is missing after `time`", "`time: 5`"),
        ("input_keys: a, b]", 12, "a `[` is missing before `a`", "`input_keys: [a, b]`"),
        ('c: {d: x::Y", e: "z"}', 7, 'a `"` is missing before', '`d: "x::Y"`'),
        ("o: [a b, c]\nt: {a: b}", 4, "a `,` is missing after `a`", "`o: [a, b, c]`"),
        ("s: [0.2, 0.1 0.05]", 9, "a `,` is missing after `0.1`", "`s: [0.2, 0.1, 0.05]`"),
        # no YAML
        ("T Foo\nt: {a: b}", 0, "a `:` is missing after `T`", "`T: Foo`"),
        ("t: a: b}", 3, "a `{` is missing before `a`", "`t: {a: b}`"),
        ("a: {b: c, d: e], f: g}", 13, "a `[` is missing before `e`", "`d: [e]`"),
        ("i: {min: 5 max: 6}", 9, "a `,` is missing after `5`", "`i: {min: 5, max: 6}`"),
        ("i: {a: {b: c}\nd: e", 12, "a `}` is missing at the end", "`i: {a: {b: c}}`"),
        ("o: [a, b\nd: e", 7, "a `]` is missing at the end", "`o: [a, b]`"),
        ('c: {python: "a:B}\nd: e', 13, 'a `"` is missing after `a:B`', '`python: "a:B"`'),
        ('t: "Base\nu: {a: "x"}', 7, 'a `"` is missing at the end', '`t: "Base"`'),
        ("t: 'Base\nd: e\nu: {a: 'x y'}", 7, "a `'` is missing at the end", "`t: 'Base'`"),
        ("s:\n  - GO\n      t: 5\n", 7, "a `:` is missing after this key", "`- GO:`"),
        ("s:\n  - A:\n      t\n        a: b\n", 16, "a `:` is missing after this key", "`t:`"),
        ("n: 1\nstates \n  - A:\n      t: 1\n", 5, "a `:` is missing after this", "`states:`"),
        ("o: {a: {}, b: }}", 14, "a `{` is missing before `}`", "`b: {}`"),
        ('t: a\nb: "true', 8, 'this `"` is one too many', "`b: true`"),
    ],
)
def test_the_sign_is_named_with_the_repaired_text(
    text: str, place: int, message: str, help: str
) -> None:
    tree, report = recovered(text)
    assert isinstance(tree, Map)
    (item,) = report
    assert (item.code, item.span.start) == ("SM001", place)
    assert message in item.finding.message
    assert item.finding.help == f"write {help}"


def test_the_places_are_those_of_the_text_as_written() -> None:
    text = "t: {done READY, no: b}\nu: x"
    tree, _ = recovered(text)
    assert isinstance(tree, Map)
    inner, last = tree.entries[0].value, tree.entries[1]
    assert isinstance(inner, Map)
    assert [entry.key.span.text for entry in inner.entries] == ["done", "no"]
    assert inner.entries[0].value.span.text == "READY"
    assert (last.key.span.text, last.value.span.text) == ("u", "x")


def test_two_lost_signs_are_two_findings() -> None:
    tree, report = recovered("t: {done READY}\nu: [a\nT: Foo\n")
    assert tree is not None
    assert [item.span.line for item in report] == [2, 1]


def test_the_rest_is_not_read_if_two_places_are_as_good() -> None:
    tree, report = recovered("a: {b: {c: 1, d: 2}\ne: f\n")
    assert tree is None
    assert [item.finding.help for item in report] == ["write `a: {b: {c: 1, d: 2}}`"]


def test_facts_of_one_name_are_not_mixed_with_names() -> None:
    _, report = recovered("outcomes: {done: {}, lost: {failure: true, preempted: {}}\ndoc: x\n")
    (item,) = report
    assert item.finding.message == "a `}` is missing after `true`"


@pytest.mark.parametrize(
    "text",
    [
        "doc: it is 5\" wide, and the users' own]",
        "doc: see a, b]",
        "n: [moving the, ' ', [params, limb], ' arm']",
        "text: smile :}",
        "o: [home low, failed]",
        't: "a = b"',
        "STROKE 2: {a: b}",
        "doc: a = b",
        "c: `a == b`".replace("`", "'"),
        "s: [A: {T: B}, C: {T: D}]",
    ],
)
def test_usual_texts_are_left_alone(text: str) -> None:
    before: Report = []
    tree = parse(Source("x.yml", text), before)
    assert recovered(text) == (tree, before)


@pytest.mark.parametrize("text", ["name: [", "a:\n  - {\n", "a: [b,"])
def test_a_text_that_is_still_written_is_not_repaired(text: str) -> None:
    tree, report = recovered(text)
    assert tree is None
    assert [item.code for item in report] == ["SM001"]


def test_examples_have_no_anomalies() -> None:
    for path in sorted(EXAMPLES.rglob("*.yml")):
        assert recovered(path.read_text("utf-8"))[1] == []


def test_a_list_of_names_has_no_entries() -> None:
    _, report = recovered("input_keys: [degrees limit]\ninput: {degrees: 1, limit: 2}\n")
    assert [item.finding.help for item in report] == ["write `input_keys: [degrees, limit]`"]
