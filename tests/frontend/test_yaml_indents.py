"""A wrong indentation is one finding at the line that has it, with the right column."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.frontend.text.recovering_parser import parse_with_recovery
from smachac.frontend.text.yaml_outline import dangling_count, form_of, outline, rows_of
from smachac.frontend.text.yaml_tree import Map, Tree, parse

EXAMPLES = Path(__file__).parents[2] / "examples"
SCRIPT = """\
name: pack
outcomes: [succeeded, aborted]
userdata:
  parts: [bolt, nut]
states:
  - LOOK:
      template: Look
      outcomes: [seen, nothing]
      retry: {on: [nothing], max: 3}
      transitions:
        seen: EACH
        nothing: aborted
  - EACH:
      template: Iterator
      it: parts
      outcomes: [succeeded]
      transitions: {succeeded: BOTH}
      states:
        - PLACE:
            template: Place
            force: 5.0
  - BOTH:
      template: Concurrence
      outcomes: [ready]
      outcome_map:
        ready: {ARM: done, LIGHT: done}
      states:
        - ARM:
            template: Arm
        - LIGHT:
            template: Light
      transitions:
        ready: PARK
  - PARK:
      template: Park
      transitions: {done: succeeded}
"""


def indented(text: str, first: str, last: str, by: int) -> str:
    """The text in which the lines from one to another are moved."""
    rows = text.split("\n")
    begin = next(at for at, row in enumerate(rows) if row.strip().startswith(first))
    end = next(at for at in range(begin, len(rows)) if rows[at].strip().startswith(last))
    for at in range(begin, end + 1):
        rows[at] = " " * by + rows[at] if by > 0 else rows[at][-by:]
    return "\n".join(rows)


def found(text: str) -> tuple[Tree | None, Report]:
    report: Report = []
    return parse_with_recovery(Source("main.yml", text), report), report


@pytest.mark.parametrize(
    ("first", "last", "by", "message", "help"),
    [
        ("retry", "retry", -2, "`retry` is indented by 4 spaces, `outcomes` beside it by 6",
         "indent `retry` by 6 spaces, like `outcomes`"),
        ("retry", "retry", 2, "`retry` is indented by 8 spaces, `outcomes` beside it by 6",
         "indent `retry` by 6 spaces, like `outcomes`"),
        ("template: Look", "template", -2, "`template` is indented by 4 spaces,",
         "indent `template` by 6 spaces, like `outcomes`"),
        ("seen: EACH", "seen", -2, "`seen` is indented by 6 spaces, `nothing` beside it by 8",
         "indent `seen` by 8 spaces, like `nothing`"),
        ("seen: EACH", "seen", 2, "`seen` is indented by 10 spaces, `nothing` beside it by 8",
         "indent `seen` by 8 spaces, like `nothing`"),
        ("transitions", "nothing", -2, "`transitions` is indented by 4 spaces, `retry` beside",
         "indent `transitions` by 6 spaces, like `retry`, and move the lines below it, down to"
         " `nothing`, equally"),
        ("- LOOK", "nothing", 2, "`- LOOK:` is indented by 4 spaces, `- EACH:` beside it by 2",
         "indent `- LOOK:` by 2 spaces, like `- EACH:`, and move the lines below it, down to"
         " `nothing`, equally"),
        ("- LIGHT", "template: L", 2, "`- LIGHT:` is indented by 10 spaces, `- ARM:` beside",
         "indent `- LIGHT:` by 8 spaces, like `- ARM:`, and move `template` equally"),
        ("outcome_map", "ready", -2, "`outcome_map` is indented by 4 spaces,",
         "indent `outcome_map` by 6 spaces, like `outcomes`, and move `ready` equally"),
        ("force", "force", -4, "`force` is indented by 8 spaces, `template` beside it by 12",
         "indent `force` by 12 spaces, like `template`"),
        ("userdata", "parts", 2, "`userdata` is indented by 2 spaces, `outcomes` beside it by 0",
         "write `userdata` in the first column, like `outcomes`, and move `parts` equally"),
        ("- BOTH", "ready: PARK", 6,
         "`- BOTH:` is indented as a state of `EACH`, an Iterator, which has one state",
         "indent `- BOTH:` by 2 spaces, like `- EACH:`, and move the lines below it, down to"
         " `ready`, equally"),
    ],
)  # fmt: skip
def test_the_line_is_marked_with_its_right_column(
    first: str, last: str, by: int, message: str, help: str
) -> None:
    text = indented(SCRIPT, first, last, by)
    tree, report = found(text)
    (item,) = report
    assert item.code == "SM001"
    assert message in item.message
    assert item.help == help
    assert tree == parse(Source("main.yml", SCRIPT), [])


@pytest.mark.parametrize("by", [-2, -1, 1, 2, 4])
def test_the_places_after_a_moved_line_are_those_of_the_text(by: int) -> None:
    text = indented(SCRIPT, "outcomes: [seen", "outcomes", by)
    tree, _ = found(text)
    assert isinstance(tree, Map)
    last = tree.entries[-1].value.span
    assert last.text.rstrip() == text[text.index("- LOOK") :].rstrip()


def test_examples_have_the_form_of_scripts() -> None:
    for path in sorted(EXAMPLES.rglob("*.yml")):
        text = path.read_text("utf-8")
        if re.search(r"^states:\n +- |template:", text, re.MULTILINE):
            assert form_of(outline(rows_of(text))) == 0.0, path
            assert dangling_count(outline(rows_of(text))) == 0, path


def test_two_states_of_an_iterator_of_which_one_leads_to_the_other_are_left_alone() -> None:
    text = SCRIPT.replace("force: 5.0", "transitions: {done: BOTH}").replace(
        "{succeeded: BOTH}", "{succeeded: succeeded}"
    )
    _, report = found(indented(text, "- BOTH", "ready: PARK", 6))
    assert report == []
