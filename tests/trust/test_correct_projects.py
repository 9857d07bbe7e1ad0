"""Correct projects give no error: a false positive fails here."""

from __future__ import annotations

import pytest

from smachac.diagnostics.diagnostic import Report, Severity
from smachac.report.text import render_text
from tests.support.examples import seeds
from tests.trust.correct_projects import texts_by_hand, written_by_hand
from tests.trust.project_text import analysed, judged
from tests.trust.random_projects import correct_project

RANDOM = 500
BLOCK = 25


def loud(report: Report) -> str:
    """What is said above an info."""
    return render_text([item for item in report if item.severity is not Severity.INFO])


@pytest.mark.parametrize("block", seeds(2, 6, RANDOM // BLOCK))
def test_random_projects_are_clean(block: int) -> None:
    """Not even a warning, with everything that the language has."""
    for seed in range(block * BLOCK, (block + 1) * BLOCK):
        assert (seed, loud(judged(correct_project(seed)).report)) == (seed, loud([]))


BY_HAND = dict(texts_by_hand())
PROJECTS = dict(written_by_hand())


@pytest.mark.parametrize("name", BY_HAND)
def test_what_is_written_by_hand_is_clean_and_means_the_same_when_printed(name: str) -> None:
    given, printed = analysed(BY_HAND[name]), judged(PROJECTS[name])
    assert given.checked is not None, loud(given.report)
    assert printed.checked is not None, loud(printed.report)
    assert printed.machine == given.machine
