"""Scripts in block style and in flow style, and YAML files that are none."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.frontend.discovery import looks_like_a_script, scripts_of
from smachac.frontend.files import Disk

SCRIPTS = [
    "name: sm\nstates: []\n",
    "{n: sm_top, T: Base, o: [done], s: [{A: {T: Foo}}]}\n",
    '# a comment {\n\n{"name": "sm", "outcomes": ["done"], "states": []}\n',
    "{\n  name: sm,  # of all\n  states: [A: {template: Foo}]\n}\n",
    "{name : sm, states : []}",
    "- A: {template: Foo}\n",
    "[{A: {T: Foo}}]\n",
    "{name: 'it''s {', states: [",
]
OTHERS = [
    "{openapi: 3, info: {name: x, states: [a]}}\n",
    "{name: x, version: 1}\n",
    "[1, 2, 3]\n",
    "{}\n",
    "{states: {a: 1}, other: 2}\n",
    "'name': x\n",
    '{"text": "name: x, states: y"}\n',
]


@pytest.mark.parametrize("text", SCRIPTS)
def test_scripts(text: str) -> None:
    assert looks_like_a_script(text)


@pytest.mark.parametrize("text", OTHERS)
def test_other_files(text: str) -> None:
    assert not looks_like_a_script(text)


def test_a_folder_with_a_script_in_flow_style(tmp_path: Path) -> None:
    (tmp_path / "main.yml").write_text(SCRIPTS[1])
    (tmp_path / "other.yml").write_text(OTHERS[0])
    assert scripts_of([tmp_path], Disk()) == [tmp_path / "main.yml"]


@pytest.mark.parametrize("part", ['"', "'", "a ", "a", "{", "#", '"\\', " ", "'a", "a:"])
def test_long_texts_are_read_in_one_pass(part: str) -> None:
    """A pattern that backtracks would take hours for this text."""
    assert not looks_like_a_script("{" + part * 300_000)
