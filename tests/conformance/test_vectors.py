"""The bundled runtime against what SMACH itself did, machine by machine."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.conformance.vector_deviations import DEVIATIONS, NOETIC
from tests.conformance.vector_replay import replay

Json = Any
CASES: dict[str, Json] = {
    case["id"]: case
    for path in sorted(Path(__file__).parent.glob("vectors-*.json"))
    for case in json.loads(path.read_text())["cases"]
}


AS_RECORDED = [name for name in CASES if name not in DEVIATIONS]


pytestmark = pytest.mark.usefixtures("silent_smach")


@pytest.mark.parametrize("name", AS_RECORDED)
def test_does_what_smach_did(name: str) -> None:
    assert replay(CASES[name]) == CASES[name]["expect"]


@pytest.mark.parametrize("name", DEVIATIONS)
def test_deviates_as_stated(name: str) -> None:
    reason, instead = DEVIATIONS[name]
    expected = CASES[name]["expect_noetic"] if instead == NOETIC else instead
    assert replay(CASES[name]) == expected, reason
    assert expected != CASES[name]["expect"]


def test_only_advised_deviations() -> None:
    for name in DEVIATIONS:
        assert {"quirk", "hang", "noetic-only", "preempt"} & set(CASES[name]["tags"]), name
