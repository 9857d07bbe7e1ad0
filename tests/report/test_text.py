"""The report for people: golden texts, and what holds for any span in any text."""

from __future__ import annotations

import sys
from textwrap import dedent

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.diagnostics.diagnostic import Code, Diagnostic, Finding, PathStep, Related, Severity
from smachac.diagnostics.source import NOWHERE, Source, Span
from smachac.report.terminal import columns, lay_out, visible, wrapped
from smachac.report.text import MOST_FINDINGS, Layout, render_text, steps, summary
from tests.support.examples import examples

SCRIPT = Source(
    "main.yml",
    dedent("""\
        name: sm
        outcomes: [succeeded, aborted]
        states:
          - PICK_BLOCK:
              template: Pick
              transitions: {succeeded: PALCE_BLOCK, aborted: 積み木を拾う}
          - PLACE_BLOCK:
              template: Place
              speed: 1.0
              arm: left
              grip: soft

              transitions: {succeeded: succeeded}
        """),
)
OTHER = Source("sub/pick.yml", "- PICK:\n    outcomes: [a]")


def place(text: str, source: Source = SCRIPT) -> Span:
    start = source.text.index(text)
    return Span(source, start, start + len(text))


def finding(
    span: Span,
    message: str = "a fault",
    severity: Severity = Severity.ERROR,
    related: tuple[Related, ...] = (),
    path: tuple[str, ...] = (),
    hint: str | None = None,
    effect: str | None = None,
    usual: str = "",
) -> Diagnostic:
    code = Code(
        code="SM101", name="unknown-target", severity=severity, explanation="", effect=usual
    )
    steps = tuple(map(PathStep, path))
    found = Finding(
        span=span, message=message, related=related, path=steps, help=hint, effect=effect
    )
    return Diagnostic(kind=code, severity=severity, finding=found)


def shown(*report: Diagnostic, width: int = 100) -> str:
    return render_text(list(report), Layout(width=width))


def test_an_effect_is_a_note_before_the_help_and_printed_once() -> None:
    item = finding(NOWHERE, hint="do it", usual="the robot stops")
    other = finding(NOWHERE, "again", effect="the robot waits", usual="the robot stops")
    without = finding(NOWHERE, "still", effect="", usual="the robot stops")
    assert shown(item, item, other, without) == dedent("""\
        error[SM101]: a fault
        note: the robot stops
        help: do it

        error[SM101]: a fault
        help: do it

        error[SM101]: again
        note: the robot waits

        error[SM101]: still
        """)


def test_a_finding_is_what_where_and_what_to_do() -> None:
    item = finding(
        place("PALCE_BLOCK"),
        "`PALCE_BLOCK` is neither a state nor an outcome of `sm`",
        hint="did you mean `PLACE_BLOCK`?",
    )
    assert shown(item) == dedent("""\
        error[SM101]: `PALCE_BLOCK` is neither a state nor an outcome of `sm`
         --> main.yml:6:32
          |
        6 |       transitions: {succeeded: PALCE_BLOCK, aborted: 積み木を拾う}
          |                                ^^^^^^^^^^^
        help: did you mean `PLACE_BLOCK`?
        """)


def test_findings_are_set_apart_by_an_empty_line() -> None:
    one = finding(place("name"))
    assert shown(one, one) == shown(one) + "\n" + shown(one)
    assert shown() == ""


def test_of_very_many_findings_only_the_first_are_printed() -> None:
    one = finding(place("name"))
    assert shown(*[one] * MOST_FINDINGS).count("error[SM101]") == MOST_FINDINGS
    text = shown(*[one] * (MOST_FINDINGS + 1234))
    assert text.startswith(shown(*[one] * MOST_FINDINGS))
    assert text.endswith("| ^^^^\n\n... and 1,234 findings more: `--format json` has all\n")
    assert text.count("error[SM101]") == MOST_FINDINGS


def test_near_places_share_a_snippet_and_others_follow() -> None:
    item = finding(
        place("積み木を拾う"),
        severity=Severity.WARNING,
        related=(
            Related(span=place("succeeded: P"), message="declared here"),
            Related(span=place("transitions"), message="among these"),
            Related(span=place("aborted]"), message="outcome of the machine"),
            Related(span=place("outcomes", OTHER), message="elsewhere"),
            Related(span=NOWHERE, message="built in"),
        ),
    )
    assert shown(item) == dedent("""\
        warning[SM101]: a fault
         --> main.yml:6:54
          |
        2 | outcomes: [succeeded, aborted]
          |                       -------- outcome of the machine
        ...
        6 |       transitions: {succeeded: PALCE_BLOCK, aborted: 積み木を拾う}
          |       -----------   ------------                     ^^^^^^^^^^^^
          |       |             |
          |       |             declared here
          |       among these
          |
         ::: sub/pick.yml:2:5
          |
        2 |     outcomes: [a]
          |     -------- elsewhere
        note: built in
        """)


def test_the_line_between_two_marked_ones_is_shown() -> None:
    item = finding(place("PICK_BLOCK"), related=(Related(span=place("PALCE"), message="x"),))
    assert shown(item).splitlines()[3:] == [
        "4 |   - PICK_BLOCK:",
        "  |     ^^^^^^^^^^",
        "5 |       template: Pick",
        "6 |       transitions: {succeeded: PALCE_BLOCK, aborted: 積み木を拾う}",
        "  |                                ----- x",
    ]


def test_a_span_over_many_lines_has_a_bar_and_loses_its_middle() -> None:
    text = SCRIPT.text[SCRIPT.text.index("  - PLACE") :]
    assert shown(finding(place(text))) == dedent("""\
        error[SM101]: a fault
          --> main.yml:7:1
           |
         7 | /   - PLACE_BLOCK:
         8 | |       template: Place
         9 | |       speed: 1.0
        10 | |       arm: left
        ...
        13 | |       transitions: {succeeded: succeeded}
           | |_________________________________________^
        """)


def test_a_span_that_starts_within_a_line_has_its_bar_bent() -> None:
    assert shown(finding(place("PLACE_BLOCK:\n      template: P"))).splitlines()[3:] == [
        "7 |     - PLACE_BLOCK:",
        "  |  _____^",
        "8 | |       template: Place",
        "  | |_________________^",
    ]


def test_empty_span_and_end_of_file() -> None:
    size = len(SCRIPT.text)
    assert shown(finding(Span(SCRIPT, 9, 9))).splitlines()[3:] == [
        "2 | outcomes: [succeeded, aborted]",
        "  | ^",
    ]
    assert shown(finding(Span(SCRIPT, size, size))).splitlines()[1:] == [
        "  --> main.yml:14:1",
        "   |",
        "14 |",
        "   | ^",
    ]
    end = len(OTHER.text)
    assert shown(finding(Span(OTHER, end, end))).splitlines()[3:] == [
        "2 |     outcomes: [a]",
        "  |                  ^",
    ]


def test_tabs_and_marks_over_letters_take_their_columns() -> None:
    source = Source("t.yml", "\ta\tcafe\u0301 x")
    assert shown(finding(place("x", source))).splitlines()[3:] == [
        "1 |     a   cafe\u0301 x",
        "  |              ^",
    ]


def test_nothing_steers_the_terminal_or_hides() -> None:
    source = Source("a\x1b]0;b\x07.yml", "k: \x1b[31m\u202e\xa0v\ud800")
    text = shown(finding(place("v", source), "bad \x1b[0m \r", hint="a\x00\nb"))
    assert text == dedent("""\
        error[SM101]: bad ␛[0m ␍
         --> a␛]0;b␇.yml:1:11
          |
        1 | k: ␛[31m<U+202E><U+00A0>v<U+D800>
          |                         ^
        help: a␀
        help: b
        """)


def test_a_long_line_is_cut_around_the_span() -> None:
    source = Source("t.yml", "x" * 200 + " HERE " + "y" * 200)
    code, carets = shown(finding(place("HERE", source)), width=40).splitlines()[3:]
    assert code == "1 | …xxxxxxxxxxxxxx HERE yyyyyyyyyyyyyy…"
    assert carets == "  |                 ^^^^"
    lines = shown(finding(place("x" * 200, source)), width=40).splitlines()
    assert lines[3] == "1 | " + "x" * 35 + "…"
    assert lines[4] == "  | " + "^" * 35


@pytest.mark.parametrize("word", ["a, bc: [d], ", "\ta: 日本, "])
def test_findings_on_one_long_line_cost_no_more_than_on_short_ones(word: str) -> None:
    """In calls, counted by the profiler: thousands of findings on such a line took seconds."""
    source = Source("t.yml", word * 10_000)
    step = len(word) * 100
    report = [finding(Span(source, at, at + 2)) for at in range(0, len(source.text), step)]
    calls = 0

    def count(*_: object) -> None:
        nonlocal calls
        calls += 1

    sys.setprofile(count)
    try:
        text = render_text(report)
    finally:
        sys.setprofile(None)
    assert calls < 1500 * len(report)
    assert len(text) < 600 * len(report)


def test_a_cut_line_of_wide_letters_and_tabs_has_its_mark_below_the_right_one() -> None:
    source = Source("t.yml", "日" * 50 + "\tHERE\t" + "本" * 60)
    code, carets = shown(finding(place("HERE", source)), width=40).splitlines()[3:]
    assert code == "1 | …" + "日" * 6 + " " * 2 + "HERE" + " " * 4 + "本" * 5 + "…"
    assert carets == "  | " + " " * 15 + "^^^^"


def test_witness_paths_show_outcomes_on_arrows_and_break() -> None:
    assert steps(("sm", "PICK", "(aborted)", "PLACE")) == [
        "sm",
        " -> PICK",
        " -(aborted)-> PLACE",
    ]
    short = shown(finding(NOWHERE, path=("PICK", "(aborted)", "PLACE", "(done)")))
    assert short.splitlines()[1] == "path: PICK -(aborted)-> PLACE -(done)->"
    long = shown(finding(NOWHERE, path=tuple(f"S{n}" for n in range(30))), width=60)
    assert long == dedent("""\
        error[SM101]: a fault
        path: S0 -> S1 -> S2 -> S3 -> S4 -> S5 -> S6 -> S7
              -> ... 14 more ... -> S22 -> S23 -> S24 -> S25 -> S26
              -> S27 -> S28 -> S29
        """)


def test_a_message_wraps_at_the_width_of_a_terminal() -> None:
    item = finding(
        place("PALCE_BLOCK"),
        message="the state `PICK` reads `part`, which is unset on some paths of `sm`",
        hint="set `part` on every path, or give it a value: `userdata: {part: [1, 2]}`",
    )
    text = render_text([item], Layout(width=50, wraps=True))
    lines = text.splitlines()
    assert lines[:2] == [
        "error[SM101]: the state `PICK` reads `part`, which",
        "              is unset on some paths of `sm`",
    ]
    assert lines[-2:] == [
        "help: set `part` on every path, or give it a",
        "      value: `userdata: {part: [1, 2]}`",
    ]
    snippet = [line for line in lines if "|" in line]
    assert snippet == [line for line in shown(item, width=50).splitlines() if "|" in line]


@pytest.mark.parametrize(
    ("text", "room", "lines"),
    [
        ("a b", 3, ["a b"]),
        ("a b", 2, ["a", "b"]),
        ("a  b", 4, ["a  b"]),
        ("see `a b c` here", 8, ["see", "`a b c`", "here"]),
        ("an `open tick", 8, ["an `open", "tick"]),
        ("日本 語", 4, ["日本", "語"]),
        ("longer_than_that it", 4, ["longer_than_that", "it"]),
        ("   ", 1, ["   "]),
    ],
)
def test_texts_are_broken_at_spaces_outside_of_code(text: str, room: int, lines: list[str]) -> None:
    assert wrapped(text, room) == lines


def test_places_are_links_to_files() -> None:
    item = finding(place("PALCE_BLOCK"))
    text = render_text([item], Layout(link=lambda name: f"file:///robot/{name}"))
    assert "\x1b]8;;file:///robot/main.yml\x1b\\main.yml:" in text
    assert "\x1b]8" not in render_text([item], Layout(link=lambda name: None))


def test_colours_only_when_asked() -> None:
    item = finding(place("PALCE_BLOCK"), hint="x")
    assert "\x1b" not in shown(item)
    coloured = render_text([item], Layout(colour=True))
    assert coloured.startswith("\x1b[1;31merror[SM101]\x1b[0m")
    assert "\x1b[1;31m^^^^^^^^^^^\x1b[0m" in coloured


def test_summary() -> None:
    error, warning = finding(place("name")), finding(place("sm"), severity=Severity.WARNING)
    assert summary([error, warning, error]) == "2 errors, 1 warning in main.yml"
    assert summary([error, finding(place("PICK", OTHER))]) == "2 errors in 2 files"
    assert summary([finding(NOWHERE, severity=Severity.INFO)]) == "1 note"
    assert summary([]) == "no findings"


@pytest.mark.parametrize("text", ["", "\n", "\r\n", "\u0301", "a\u0301", "\t", "\u200d"])
def test_smallest_texts(text: str) -> None:
    source = Source("t", text)
    for start in range(-1, len(text) + 2):
        for end in range(-1, len(text) + 2):
            assert shown(finding(Span(source, start, end))).startswith("error[SM101]: a fault\n")


ODD = st.text(
    alphabet=st.one_of(
        st.sampled_from("ab \t\n\r\x00\x1b\u0301\u200d\u2028\ud800日\u1161\uff21😀…"),
        st.characters(),
    ),
    max_size=200,
)
NUMBERS = st.integers(min_value=-3, max_value=210)


@settings(derandomize=True, deadline=None, max_examples=examples(300))
@given(ODD, ODD, st.lists(st.tuples(NUMBERS, NUMBERS), min_size=1, max_size=4), ODD, NUMBERS)
def test_any_span_in_any_text(
    text: str, other: str, spans: list[tuple[int, int]], label: str, width: int
) -> None:
    sources = [Source("a", text), Source("b", other)]
    places = [Span(sources[n % 3 == 2], *span) for n, span in enumerate(spans)]
    related = tuple(Related(span=span, message=label) for span in places[1:])
    item = finding(places[0], label, related=related, path=(label, text), hint=other)
    plain = render_text([item], Layout(width=width))
    assert plain.endswith("\n")
    assert all(c == "\n" or c >= " " for c in plain)
    plain.encode()
    coloured = render_text([item], Layout(colour=True, width=width))
    for code in ("1;31", "1;34", "34", "1;32", "1;35", "1", "0"):
        coloured = coloured.replace(f"\x1b[{code}m", "")
    squeezed = [line.rstrip() for line in plain.split("\n")]
    assert [line.rstrip() for line in coloured.split("\n")] == squeezed


@settings(derandomize=True, deadline=None, max_examples=examples(300))
@given(ODD, NUMBERS, NUMBERS, st.integers(min_value=20, max_value=60))
def test_a_laid_out_line_fits_and_keeps_the_span_in_view(
    text: str, start: int, size: int, room: int
) -> None:
    text = text.replace("\n", "")
    start = min(max(start, 0), len(text))
    end = min(start + max(size, 0), len(text))
    line = lay_out(text, start, end, room)
    assert columns(line.text) <= room
    places = [line.column(index) for index in range(len(text) + 1)]
    assert places == sorted(places)
    assert 0 <= line.column(start) <= line.column(end) <= room
    assert visible(line.text) == line.text
