"""docs/rules.md is what the docstrings of the rules say."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from smachac.driver import CODES
from smachac.report.explain_code import GROUPS, MAIN, explanation, render_code, render_rules
from tests.support.golden import compare_file

RULES = Path(__file__).parents[2] / "docs" / "rules.md"


def test_golden_document_of_the_rules_is_up_to_date() -> None:
    compare_file(render_rules(CODES), RULES)


def test_every_code_has_a_section_and_an_entry() -> None:
    text = render_rules(CODES)
    for code in CODES.values():
        assert f"\n### {code.code} {code.name}\n" in text
        assert f"](#{code.code.lower()}-{code.name}): " in text


def test_every_code_belongs_to_a_group() -> None:
    assert [name for name in CODES if name[:3] not in GROUPS] == []


def test_links_of_the_contents_lead_to_headings() -> None:
    text = render_rules(CODES)
    headings = re.findall(r"^#+ (.+)$", text, re.MULTILINE)
    anchors = {
        re.sub(r"[^a-z0-9 -]", "", heading.lower()).replace(" ", "-") for heading in headings
    }
    assert set(re.findall(r"\]\(#([^)]+)\)", text)) <= anchors


@pytest.mark.parametrize("name", sorted(CODES))
def test_names_are_words_with_hyphens(name: str) -> None:
    assert re.fullmatch(r"SM\d{3}", name)
    assert re.fullmatch(r"[a-z]+(-[a-z]+)*", CODES[name].name)


def test_files_of_an_example_are_told_apart() -> None:
    files = explanation(CODES["SM011"]).wrong
    assert list(files) == [MAIN, "pick_block.yml"]
    assert files[MAIN].startswith("name: sm\n")
    assert files["pick_block.yml"].startswith("- PICK_BLOCK:")


def test_an_explanation_as_text_names_the_code_first() -> None:
    text = render_code(CODES["SM201"])
    assert text.startswith("SM201 unreachable-state (error)\n\nNo path leads to this state")
    assert "\nWrong:\n\n    name: sm\n" in text
    assert max(map(len, text.split("Wrong:")[0].splitlines())) <= 88
