"""Correct classes of state types add no finding to a correct project."""

from __future__ import annotations

from tests.trust.mutate_classes import MODULE, interfaces, module_of
from tests.trust.project_text import judged
from tests.trust.random_projects import correct_project

PROJECTS = 15


def test_correct_classes_bring_no_finding() -> None:
    seen = 0
    for seed in range(PROJECTS):
        project = correct_project(seed)
        seen += len(interfaces(project))
        before = judged(project).report
        after = judged({**project, MODULE: "\n".join(module_of(project))}).report
        found = [f"{item.code} {item.span} {item.message}" for item in after]
        assert found == [f"{item.code} {item.span} {item.message}" for item in before], seed
    assert seen > PROJECTS / 4
