"""Names that nobody means cost nothing: a guess at a spelling is not quadratic in its length."""

from __future__ import annotations

import random
import tracemalloc
from dataclasses import replace
from pathlib import Path

import pytest

from smachac.diagnostics.diagnostic import did_you_mean
from smachac.diagnostics.source import Source
from smachac.diagnostics.spelling import LONGEST_SLIP, Guesser, slips
from smachac.driver import analyse
from smachac.frontend.files import disk_library


def test_only_the_case_of_a_very_long_name_may_differ() -> None:
    name = "x" * LONGEST_SLIP
    assert len(slips(name)) > LONGEST_SLIP
    assert slips(f"{name}Y") == [f"{name}y"]
    assert Guesser([f"{name}y"])(f"{name}Y") == f"{name}y"
    assert Guesser([f"{name}y"])(f"{name}yz") is None
    assert Guesser([name])(f"{name}y") is None
    assert did_you_mean(f"{name}Y", [f"{name}y"]) == f"did you mean `{name}y`?"


def test_a_long_name_takes_no_memory() -> None:
    name = "".join(map(chr, range(0x4E00, 0x4E00 + 20_000)))
    other = "".join(random.Random(0).sample(name, len(name)))
    tracemalloc.start()
    try:
        assert Guesser([other])(name) is None
        assert did_you_mean(name, [other]) is None
        assert tracemalloc.get_traced_memory()[1] < 2_000_000
    finally:
        tracemalloc.stop()


def test_templates_are_looked_up_once_however_many_are_unknown() -> None:
    """Three thousand states of one unknown type read the folders as often (found by fuzzing)."""
    looked = []

    def names() -> list[str]:
        looked.append("names")
        return ["ScriptedState"]

    states = "".join(f"  - S{n}: {{template: Scriptedstat{n % 9}}}\n" for n in range(50))
    text = f"name: sm\ntemplate: Base\noutcomes: [done]\nstates:\n{states}"
    library = replace(disk_library(Path("main.yml"), []), template_names=names)
    analysis = analyse(Source("main.yml", text), library, [])
    assert sum(item.code == "SM013" for item in analysis.report) == 9
    assert looked == ["names"]


@pytest.mark.parametrize(
    ("word", "name"),
    [
        ("not_found", "found"),
        ("found", "not_found"),
        ("notFound", "found"),
        ("notfound", "found"),
        ("no_grasp", "grasp"),
        ("never_seen", "seen"),
        ("non_empty", "empty"),
        ("unreachable", "reachable"),
        ("unreachble", "reachable"),
        ("reachable", "unreachable"),
        ("invalid", "valid"),
        ("is_unlocked", "is_locked"),
        ("disconnected", "connected"),
    ],
)
def test_an_opposite_is_no_suggestion(word: str, name: str) -> None:
    assert Guesser([name])(word) is None
    assert Guesser([name]).unique_match(word) is None
    assert did_you_mean(word, [name]) is None


@pytest.mark.parametrize(
    ("word", "name"),
    [
        ("nto_found", "not_found"),
        ("nogrip", "no_grip"),
        ("not_fuond", "not_found"),
        ("no_fond", "no_found"),
        ("unreachble", "unreachable"),
        ("unlokced", "unlocked"),
        ("note_found", "not_found"),
        ("nobject", "object"),
        ("NOT_FOUND", "not_found"),
    ],
)
def test_a_misspelt_negation_is_a_misspelling(word: str, name: str) -> None:
    assert Guesser([name])(word) == name
    assert did_you_mean(word, [name]) == f"did you mean `{name}`?"
