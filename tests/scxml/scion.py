"""SCION for the tests: it is in viewer/node_modules, with the other packages of Node."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest

from smachac.diagnostics.diagnostic import Report
from smachac.ir.nodes import Machine
from smachac.targets.scxml import document
from smachac.verify.players import scxml
from smachac.verify.test_case import Event, UnplayableError

VIEWER = Path(__file__).parents[2] / "viewer"


def text_of(machine: Machine) -> str | None:
    """The document of a machine with its trace; None where SCXML cannot express it."""
    report: Report = []
    text = document(machine, report, traced=True)
    return None if report else text


def played(
    documents: Sequence[str], cases: Sequence[Mapping[str, Any]], *, scripted: bool
) -> Iterator[list[Event]]:
    """The traces of cases (verify/play.js); without SCION the test is skipped."""
    try:
        yield from scxml.traces(documents, cases, folders=[VIEWER], scripted=scripted)
    except UnplayableError as error:
        pytest.skip(f"{error}: make test-browser")
