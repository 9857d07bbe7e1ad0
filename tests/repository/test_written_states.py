"""What people see is the machine as it was written: no surface folds the containers of fields."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2] / "smachac"

SURFACES = (
    *("commands", "diff", "lsp", "report", "sweep", "view"),
    *("targets/dot", "targets/html", "targets/mermaid"),
)
"""The rooms whose output shows states."""


@pytest.mark.parametrize("surface", SURFACES)
def test_no_surface_reads_the_field_that_a_container_was_made_for(surface: str) -> None:
    readers = {
        path.relative_to(ROOT).as_posix()
        for path in sorted((ROOT / surface).rglob("*.py"))
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(node, ast.Attribute) and node.attr == "sugar"
    }
    assert readers == set()


@pytest.mark.parametrize("name", ["statistics_page", "statistics_report", "trace_report"])
def test_reports_of_traces_show_written_states(name: str) -> None:
    text = (ROOT / "verify" / f"{name}.py").read_text("utf-8")
    assert "script_paths" not in text
    assert ".sugar" not in text
