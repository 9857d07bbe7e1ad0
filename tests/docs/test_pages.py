"""Every page of docs/ begins with its purpose, and docs/README.md lists it."""

from __future__ import annotations

from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = sorted((ROOT / "docs").glob("*.md"))
READMES = sorted((ROOT / "examples").glob("**/README.md"))
GENERATED = "rules.md"


@pytest.mark.parametrize(
    "page", [*PAGES, *READMES], ids=lambda page: f"{page.parent.name}/{page.name}"
)
def test_a_page_begins_with_its_purpose(page: Path) -> None:
    title, empty, purpose = page.read_text("utf-8").split("\n")[:3]
    assert title.startswith("# ")
    assert empty == ""
    assert page.name == GENERATED or purpose.startswith(("This page ", "This example "))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_the_index_lists_a_page(page: Path) -> None:
    index = (ROOT / "docs" / "README.md").read_text("utf-8")
    assert page.name == "README.md" or page.name in index
