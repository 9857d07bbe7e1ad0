"""Renames reach the rules of a concurrence in a list, and levels of autonomy."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.commands.cli import main

SCRIPT = """\
name: sm
outcomes: [held, lost]
states:
  - BOTH:
      template: Concurrence
      join: rule
      outcomes: [held, lost]
      default_outcome: lost
      outcome_map: [{lost: {A: slipped}}, {lost: {B: slipped}}, {held: {A: done, B: done}}]
      autonomy: {lost: High}
      transitions: {held: held, lost: lost}
      states:
        - A: {template: ScriptedState, outcomes: [done, slipped], autonomy: {slipped: Low}}
        - B: {template: ScriptedState, outcomes: [done, slipped]}
"""

RENAMES = {
    ("BOTH/lost", "gone"): [
        ("outcomes: [held, lost]\n      default_outcome: lost",
         "outcomes: [held, gone]\n      default_outcome: gone"),
        ("[{lost: {A: slipped}}, {lost:", "[{gone: {A: slipped}}, {gone:"),
        ("autonomy: {lost: High}", "autonomy: {gone: High}"),
        ("held: held, lost: lost}", "held: held, gone: lost}"),
    ],
    ("A/slipped", "fell"): [
        ("{A: slipped}", "{A: fell}"),
        ("A: {template: ScriptedState, outcomes: [done, slipped]",
         "A: {template: ScriptedState, outcomes: [done, fell]"),
        ("{slipped: Low}", "{fell: Low}"),
    ],
    ("A", "LEFT"): [("{A: slipped}", "{LEFT: slipped}"), ("{A: done", "{LEFT: done"),
                    ("- A:", "- LEFT:")],
}  # fmt: skip


@pytest.mark.parametrize("words", RENAMES, ids=lambda words: words[1])
def test_renames(words: tuple[str, str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("main.yml").write_text(SCRIPT, "utf-8")
    assert main(["rename", "main.yml", *words, "-q"]) == 0
    expected = SCRIPT
    for before, after in RENAMES[words]:
        assert before in expected
        expected = expected.replace(before, after)
    assert Path("main.yml").read_text("utf-8") == expected
