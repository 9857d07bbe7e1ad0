"""YAML to trees: places to the character, one result from both parsers, limits."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.frontend.text import yaml_tree
from smachac.frontend.text.fields import as_map
from smachac.frontend.text.yaml_tree import Map, Scalar, Seq, Tree, parse, syntax_error_line


def read(text: str, codes: list[str] | None = None) -> Tree | None:
    report: Report = []
    tree = parse(Source("x.yml", text), report)
    assert [item.code for item in report] == (codes or [])
    return tree


def plain(tree: Tree | None) -> object:
    """Values alone, duplicates kept."""
    match tree:
        case Map():
            return [(entry.key.value, plain(entry.value)) for entry in tree.entries]
        case Seq():
            return [plain(item) for item in tree.items]
        case Scalar():
            return tree.value
    return None


def places(tree: Tree) -> list[tuple[int, int]]:
    found = [(tree.span.start, tree.span.end)]
    if isinstance(tree, Map):
        for entry in tree.entries:
            found += [*places(entry.key), *places(entry.value)]
    elif isinstance(tree, Seq):
        for item in tree.items:
            found += places(item)
    return found


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("yes", "yes"),
        ("on", "on"),
        ("true", True),
        ("010", 10),
        ("0o17", 15),
        ("0x1F", 31),
        ("1_000", "1_000"),
        ("1.50", 1.5),
        (".5e3", 500.0),
        ("-.inf", -math.inf),
        ("~", None),
        ("'~'", "~"),
        ("1.2.3", "1.2.3"),
        ("12:30", "12:30"),
        ("!!str 12", "12"),
        ("!!float 12", 12.0),
        ("!!int '12'", 12),
        ("!!bool 'true'", True),
        ("!!null ~", None),
        ("9" * 400, "9" * 400),
    ],
)
def test_scalars_follow_the_core_schema(text: str, value: object) -> None:
    tree = read(text)
    assert isinstance(tree, Scalar)
    assert tree.value == value
    assert type(tree.value) is type(value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a: !mine 3", "only the YAML tags `!!str`, `!!int`, `!!float`, `!!bool`, `!!null`,"),
        ("a: !!int abc", "`abc` is not a value of the type `!!int`"),
        ("a: !!float 'x'", "`x` is not a value of the type `!!float`"),
        ("a: !!map [1]", "only the YAML tags"),
        ("a: !!seq {b: 1}", "only the YAML tags"),
    ],
)
def test_a_wrong_tag_is_one_finding(text: str, message: str) -> None:
    report: Report = []
    parse(Source("main.yml", text), report)
    assert [item.message[: len(message)] for item in report] == [message]


def test_the_tags_of_lists_and_mappings_are_accepted() -> None:
    report: Report = []
    assert parse(Source("main.yml", "{a: !!seq [1], b: !!map {c: !!str 2}}"), report) is not None
    assert report == []


def test_every_part_knows_its_place() -> None:
    text = "\u00e4: 'x'\r\nb:\r\n  - \U0001f600\r\n  - {c: d}\r\ne:\r\nf: |\r\n  z\r\n"
    tree = read(text)
    assert isinstance(tree, Map)
    found = {text[start:end] for start, end in places(tree)}
    assert {"\u00e4", "'x'", "b", "\U0001f600", "{c: d}", "c", "d", "e", "", "f"} <= found
    assert tree.entries[1].value.span.text == "- \U0001f600\r\n  - {c: d}"


def test_duplicate_keys_stay_and_are_told() -> None:
    assert plain(read("a: 1\na: 2\n", ["SM002"])) == [("a", 1), ("a", 2)]
    assert plain(read("1: a\n'1': b\n")) == [(1, "a"), ("1", "b")]


def test_aliases_and_merges() -> None:
    text = "base: &b {x: 1, y: 2}\nuse: {<<: *b, y: 3}\nlist: {<<: [*b, {z: 4}]}\n"
    assert plain(read(text)) == [
        ("base", [("x", 1), ("y", 2)]),
        ("use", [("y", 3), ("x", 1)]),
        ("list", [("x", 1), ("y", 2), ("z", 4)]),
    ]


@pytest.mark.parametrize(
    ("text", "place", "words", "help"),
    [
        (
            "a: [1\nb: 2\n",
            (1, 4),
            "this list is not closed before the next key",
            "write `]` at the end of line 1",
        ),
        (
            "a: {b: 1,\n    c: 2\nd: 3\n",
            (1, 4),
            "this mapping is not closed before",
            "write `}` at the end of line 2",
        ),
        ("a: [1\n  b: 2]\n", (2, 4), "expected `,` or `]`, found `:`", "with `]`"),
        ("a: {b: 1", (1, 4), "this mapping is not closed", "with `}`"),
        ("a: {f: lambda ud: 1}", (1, 17), "`}`, found `:`", "in quotes"),
        ("a: 'left\nb: 2\n", (1, 4), "quote is not closed", "the same quote"),
        ("- A: b: c\n", (1, 7), "a colon is not allowed here", "in quotes: `A: 'b: c'`"),
        ("- A:{b: c, d: e}\n", (1, 13), "a colon is not allowed here", "a space after"),
        (
            "a:\n    b: 1\n   c: 2\n",
            (3, 4),
            "the indentation of this line",
            "by 4 spaces, like `b`",
        ),
        ("a: 1\n- b\n", (2, 1), "a list item cannot follow", "items of one list"),
        ("a: 'x' y\n", (1, 8), "text after the end of the value", "in quotes"),
        ("a: 1\nb\nc: 2\n", (2, 1), "a `:` is missing", "write `b:`"),
        ("a: %d\n", (1, 4), "a value cannot begin with `%`", "in quotes"),
        ("a:\n\tb: 1\n", (2, 1), "YAML does not allow a tab in the indentation", "spaces"),
        ('a: "\\d"\n', (1, 6), "unknown escape character `d`", "in single quotes"),
        ("%YAML x\n---\na: 1\n", (1, 1), "a directive of YAML", "remove the line"),
        ("s:\n  - GRASP\n      t: X\n", (2, 5), "a `:` is missing", "write `- GRASP:`"),
        ("- A:\n    to\n      ok: B\n", (2, 5), "a `:` is missing", "write `to:`"),
        ("doc: some\n  text\n  b: 1\n", (3, 4), "a colon is not allowed here", "in quotes"),
        ("a: 1\n  b: 2\n", (2, 3), "more than `a` above it, which has a value", "like `a`"),
        ("- a: x y\n\n   b: 2\n", (3, 4), "more than `a` above it", "like `a`"),
        ("a:1\nb: 2\n", (1, 1), "a space is missing after the colon", "`a: 1`"),
        ("a: 1\nb:2\nc: 3\n", (2, 1), "a space is missing after the colon", "`b: 2`"),
        (
            "s:\n  - A: 1\n   - B: 2\n",
            (3, 4),
            "indented by 3 spaces, the",
            "by 2 spaces, like `- A:`",
        ),
        ("- A: 1\n - B: 2\n", (2, 2), "is indented by 1 space", "without indentation, like `- A:`"),
        ("s:\n  - A: [\n]\n - B: 2\n", (4, 2), "a list item is not allowed", "equally"),
        ("s:\n  - A:\n     - x\n - B: 2\n", (4, 2), "the items of the script by 2", "like `- A:`"),
        ("s:\n  - A: 1\n  B: 2\n", (3, 3), "a key cannot follow the items", "key of the list"),
        ("s:\n  - A: 1\n  -B: 2\n", (3, 3), "a space is missing after this `-`", "`- B:`"),
        ("a: - b\n", (1, 4), "a list item is not allowed here", "a line of its own"),
        ("a: [- b]\n", (1, 5), "a list in brackets has no `-`", "`[a, b]`"),
        ("a: [1]]\n", (1, 7), "`]` closes no `[`", "write the `[`"),
        ("a: }\n", (1, 4), "`}` closes no `{`", "write the `{`"),
        ("a: ['b' 'c']\n", (1, 9), "expected `,` or `]`, found text", "a `,` between"),
        ("a: {,}\n", (1, 5), "a value is missing before this `,`", "remove the `,`"),
        ("a: ,b\n", (1, 4), "a value cannot begin with `,`", "in quotes"),
        ("a: * 3\n", (1, 4), "a value cannot begin with `*`", "in quotes"),
        ("a: ? b\n", (1, 4), "`?` is not allowed here", "in quotes"),
        ("a: |x\n  b\n", (1, 5), "cannot begin in the line of its `|`", "in the next line"),
        (" a: 1\nb: 2\n", (2, 1), "the indentation of this line", "by 1 space, like `a`"),
        ("[a]\nb: 2\n", (2, 1), "text after the end of the value", "in quotes"),
    ],
    ids=lambda value: repr(value)[:20],
)
def test_syntax_errors_name_the_fault_and_its_place(
    text: str, place: tuple[int, int], words: str, help: str
) -> None:
    report: Report = []
    assert parse(Source("x.yml", text), report) is None
    (item,) = report
    before = text[: item.span.start].split("\n")
    assert (len(before), len(before[-1]) + 1) == place
    assert words in item.finding.message
    assert help in (item.finding.help or "")


def test_a_colon_without_a_space_in_a_flow_mapping_is_reported_and_read_as_meant() -> None:
    report: Report = []
    tree = parse(Source("x.yml", "{held:succeeded, n:3, a: b:c, 'x:y', lost: }"), report)
    assert [item.message for item in report] == ["a space is missing after the colon"] * 2
    held, n = report
    assert held.span.text == "held:succeeded"
    assert held.help == "write a space after the colon in `held:succeeded`: `held: succeeded`"
    assert [(edit.span.start, edit.text) for edit in held.finding.edits] == [(6, " ")]
    assert n.span.text == "n:3"
    assert plain(tree) == [
        ("held", "succeeded"),
        ("n", 3),
        ("a", "b:c"),
        ("x:y", None),
        ("lost", None),
    ]
    assert read("{http://x, std::string, a: 1}") is not None


@pytest.mark.parametrize(
    ("text", "codes"),
    [
        ("a: [1", ["SM001"]),
        ("\ta: 1", ["SM001"]),
        ("a: *nowhere", ["SM001"]),
        ("a: &a [*a]", ["SM001"]),
        ("a: \x00", ["SM001"]),
        ("a: 1\n---\nb: 2", ["SM004"]),
        ("? [a]\n: 1", ["SM004"]),
        ("a: !thing 1", ["SM004"]),
        ("<<: 3", ["SM004"]),
        ("[" * (yaml_tree.MAX_DEPTH + 1) + "]" * (yaml_tree.MAX_DEPTH + 1), ["SM006"]),
        (" " * yaml_tree.MAX_CHARACTERS, ["SM006"]),
    ],
    ids=lambda value: repr(value)[:20],
)
def test_bad_text_is_a_problem_with_a_place(text: str, codes: list[str]) -> None:
    report: Report = []
    parse(Source("x.yml", text), report)
    assert [item.code for item in report] == codes
    assert all(0 <= item.span.start <= item.span.end <= len(text) for item in report)


def test_aliases_may_repeat_only_so_much() -> None:
    """A short text must not become a million nodes that every rule goes through."""
    item = f"&a [{', '.join('0' * 99)}]"
    much = ", ".join(["*a"] * (yaml_tree.MAX_ALIASED // 100))
    assert read(f"[{item}, {much}]") is not None
    assert read(f"[{item}, {much}, *a]", ["SM006"]) is None
    longer = "#" * yaml_tree.MAX_ALIASED * 2
    assert read(f"[{item}, {much}, *a] {longer}") is not None


def test_a_script_has_a_limit_of_values_at_any_depth(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(yaml_tree, "MAX_NODES", 10)
    assert read("[1, 2, 3, 4, 5, 6, 7, 8, 9]") is not None
    assert read("[1, 2, 3, 4, 5, 6, 7, 8, 9, 10]", ["SM006"]) is None
    assert read("{a: [1, 2, 3], b: [1, 2]}") is not None
    assert read("{a: [1, 2, 3], b: [1, 2], c: [1]}", ["SM006"]) is None


@pytest.mark.parametrize("item", ["0,", "[],", "[[0]],", "{a: 0},"])
def test_the_number_of_values_is_limited_by_the_length_of_the_text(
    item: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Memory stays in proportion to the text, however short its values are."""
    monkeypatch.setattr(yaml_tree, "MAX_SMALL_NODES", 100)
    assert read(f"[{item * 30}]") is not None
    assert read(f"[{item * 1_000}]", ["SM006"]) is None
    assert read(f"[{item.ljust(20) * 1_000}]") is not None


def test_of_many_duplicate_keys_only_some_are_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(yaml_tree, "MAX_DUPLICATES", 3)
    assert read("{a, a, a, a}", ["SM002"] * 3) is not None
    assert read("{a, a, a, a, a, a}", ["SM002"] * 4 + ["SM006"]) is None


def test_an_alias_bomb_is_defused() -> None:
    lines = ["a0: &a0 [x, x, x, x, x, x, x, x, x]"]
    lines += [f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]" for n in range(1, 30)]
    assert read("\n".join(lines), ["SM006"]) is None


WORDS = st.sampled_from(["a", "b", "on", "1", "1.5", "~", "'q'", '"d"', "\u00fc", "\U0001f600", ""])
YAML = st.recursive(
    WORDS,
    lambda inner: st.one_of(
        st.lists(inner, max_size=3).map(lambda items: "[" + ", ".join(filter(None, items)) + "]"),
        st.lists(st.tuples(st.sampled_from("abc"), inner), max_size=3).map(
            lambda pairs: "{" + ", ".join(f"{key}: {value}" for key, value in pairs) + "}"
        ),
    ),
    max_leaves=8,
)
DOCUMENTS = st.lists(
    st.tuples(st.sampled_from(["a: ", "- ", "b:\n  - ", "# c\n", "&x ", "*x", "\t", "  "]), YAML),
    max_size=6,
).map(lambda lines: "\n".join(start + rest for start, rest in lines))


@given(DOCUMENTS)
def test_a_text_has_a_tree_or_a_fault_with_a_place(text: str) -> None:
    report: Report = []
    tree = parse(Source("x.yml", text), report)
    assert tree is not None or report or not text.strip("# c\n\t-") or "#" in text
    assert all(0 <= item.span.start <= item.span.end <= len(text) for item in report)
    assert all("did not find" not in item.finding.message for item in report)
    assert (syntax_error_line(text) is None) >= (tree is not None)


@given(st.text(max_size=60))
def test_no_text_makes_it_fail(text: str) -> None:
    report: Report = []
    tree = parse(Source("x.yml", text), report)
    assert all(0 <= item.span.start <= item.span.end <= len(text) for item in report)
    assert tree is None or tree.span.end <= len(text)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("- A:\t# first\n    b: 1\n", [("A", [("b", 1)])]),
        ("a: b\t\nc:\t\n - d\t\ne: f\t#g\n", [("a", "b"), ("c", ["d"]), ("e", "f")]),
        ("a:\t|\n  x\n  \ty\n", [("a", "x\n\ty\n")]),
        ("a: |\n \n    hello\n", [("a", "\nhello\n")]),
        ("a: >\n \n  \n  b\n", [("a", "\n\nb\n")]),
        ("a: b\n \t\nc: d\n", [("a", "b"), ("c", "d")]),
        ("{url: http://x.org, b: a?c, d: e}", [("url", "http://x.org"), ("b", "a?c"), ("d", "e")]),
        ("a: &left_home 1\nb: *left_home\n", [("a", 1), ("b", 1)]),
        ("a: !!str &x-1 1\nb: [*x-1, *x-1]\n", [("a", "1"), ("b", ["1", "1"])]),
    ],
    ids=lambda value: repr(value)[:20],
)
def test_unusual_yaml_is_read(text: str, value: object) -> None:
    tree = read(text)
    assert plain(tree) == ([value] if text.startswith("-") else value)


@pytest.mark.parametrize(
    ("text", "place", "words", "help"),
    [
        ("a: &left:home 0.5\n", (1, 4), "not `left:home`", "write `&left_home`"),
        ("a: &x 1\nb: [*x:y]\n", (2, 5), "not `x:y`", "write `*x_y`"),
        ("a: &x 1\nb: *x:y\n", (2, 4), "not `x:y`", "write `*x_y`"),
        ("a: [&l:x 1]\n", (1, 5), "not `l:x`", "write `&l_x`"),
        ("a: &l.x {b: 1}\n", (1, 4), "not `l.x`", "write `&l_x`"),
        ("a: !!str &l:x 1\n", (1, 10), "not `l:x`", "write `&l_x`"),
        ("&a: key\n", (1, 1), "not `a:`", "a space before the colon: `&a :`"),
        ("a: &\u00fc 1\n", (1, 4), "cannot begin with `&`", "in quotes"),
        ("a: |\n\tb\n", (2, 2), "is indented too little", "by 2 spaces"),
        ("a: |\n \tb\n", (2, 2), "does not allow a tab", "with 2 spaces"),
        ("a: b\n\t\nc: d\n", (2, 1), "does not allow a tab", "remove the tab"),
        ("{a: :x}\n", (1, 5), "a name is missing before this `:`", "in quotes"),
        (": a\n: b\n", (1, 1), "a name is missing before this `:`", "in quotes"),
        ("{a:[1]}\n", (1, 3), "a space is missing after the colon", "in quotes"),
        ("{a:,}\n", (1, 3), "a space is missing after the colon", "in quotes"),
        ("{a: ?, b: 1}\n", (1, 5), "`?` is not allowed here", "in quotes"),
        ("[a,\n...\n", (2, 1), "a value is missing here", "write the value"),
        ("%FOO x\n---\na\n", (1, 1), "is a directive of YAML", "remove the line"),
        ("%YAML 1.3\n---\na\n", (1, 1), "is a directive of YAML", "remove the line"),
        ("a: !!str, x\n", (1, 4), "cannot begin with `!`", "in quotes"),
        ("a: !foo!bar x\n", (1, 4), "cannot begin with `!`", "in quotes: `'!foo!bar x'`"),
        ("a: |0\n  b\n", (1, 5), "is 1 to 9", "remove the number"),
        ('a: "b\n--- c"\n', (1, 4), "is not closed before the line that ends", "same quote"),
        ('a: "\\ud800"\n', (1, 5), "`\\ud800` is no character", "the number"),
        ('a: "\\ud83e\\udd16"\n', (1, 5), "one character in JSON", "write `\\U0001F916`"),
        ('a: "\\U00110000"\n', (1, 5), "the last one is \\U0010FFFF", "the number"),
        ('a: "\\x4"\n', (1, 5), "`\\x4` is no character", "the number"),
    ],
    ids=lambda value: repr(value)[:20],
)
def test_what_libyaml_does_not_read_as_yaml_1_2_is_a_fault(
    text: str, place: tuple[int, int], words: str, help: str
) -> None:
    """Of some of these texts YAML 1.2 has a meaning; libyaml refuses them or reads another one."""
    test_syntax_errors_name_the_fault_and_its_place(text, place, words, help)


@pytest.mark.parametrize("opening", ["[", "{a: ", "- ", "? "])
@pytest.mark.parametrize("levels", [901, 3_000])
def test_deep_nesting_is_one_fault_for_every_libyaml(opening: str, levels: int) -> None:
    """libyaml 0.2.6 reads no more than 1,000 levels, those before it more."""
    report: Report = []
    assert parse(Source("x.yml", opening * levels), report) is None
    (item,) = report
    assert (item.code, item.message) == ("SM006", "the nesting is deeper than 900 levels")


def test_a_text_in_place_of_a_mapping_may_need_a_space_after_its_colon() -> None:
    report: Report = []
    tree = parse(Source("x.yml", "held:succeeded\n"), report)
    assert tree is not None
    assert as_map(tree, report) == ()
    (item,) = report
    assert item.help == "write a space after the colon in `held:succeeded`: `held: succeeded`"
