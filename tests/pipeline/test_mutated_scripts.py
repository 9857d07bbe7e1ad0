"""Real scripts with damage: there is a report or a program, never an escaped exception."""

from __future__ import annotations

from pathlib import Path

from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.driver import analyse, build
from smachac.frontend.files import disk_library
from smachac.frontend.loader import memory_library
from smachac.report.json import render_json
from smachac.report.text import render_text
from smachac.targets import load_target, target_names
from tests.support.examples import examples

ROOT = Path(__file__).parents[2]
SCRIPTS = [
    path.read_text()
    for folder in ("examples", "tests/cases")
    for path in sorted((ROOT / folder).glob("*/*.yml"))
    if 20 < path.stat().st_size < 6000
]
LIBRARY = memory_library(
    {"sub.yml": "- S: {template: ScriptedState, outcomes: [done]}\n", "round.yml": SCRIPTS[0]},
    disk_library(ROOT / "main.yml", []),
)
TARGETS = [load_target(name) for name in target_names()]
SIGNS = tuple("{}[]:,-?|>#&*!'\"`~")
WORDS = ("null", "yes", "states", "script", "template", "it", "callbacks", "<<", "Concurrence")
PHRASES = ("[params, x]", "[[x]]", "script: sub", "outcome_map: {a: {}}", "initial: A", "1e999")
SPACES = ("  ", "\n", "\t", "- ", "\u202e", "\U0001f600")
PIECES = st.sampled_from([*SIGNS, *WORDS, *PHRASES, *SPACES])
DAMAGE = st.tuples(st.floats(0, 1), st.integers(0, 20), PIECES)


@settings(max_examples=examples(300))
@given(st.sampled_from(SCRIPTS), st.lists(DAMAGE, min_size=1, max_size=4))
def test_nothing_escapes(text: str, damage: list[tuple[float, int, str]]) -> None:
    for where, removed, piece in damage:
        at = int(where * len(text))
        text = text[:at] + piece + text[at + removed :]
    analysis = analyse(Source("main.yml", text), LIBRARY, [])
    render_text(analysis.report)
    render_json(analysis.report)
    if analysis.checked is None:
        assert analysis.report
        return
    for target in TARGETS:
        assert target is not None
        report: Report = []
        files = build(analysis.checked, target, LIBRARY, report)
        assert bool(files) != bool(report)
        if target.name == "python" and files:
            compile("".join(files.values()), "generated.py", "exec")
