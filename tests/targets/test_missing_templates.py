"""An interface that names the file of a template, or a class, which does not exist."""

from __future__ import annotations

import pytest

from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.loader import memory_library
from tests.trust.project_text import BUILT_IN

MAIN = """
name: sm
template: Base
outcomes: [done]
states:
  - SEE: {template: Detect, transitions: {done: done}}
"""
TEMPLATE = '{% extends "State.tpl.py" %}\n{% block execute %}\nreturn "done"\n{% endblock %}\n'


def found(code: str) -> list[tuple[str, str, str | None]]:
    files = {
        "main.yml": MAIN,
        "templates/Detect.yml": f"name: Detect\noutcomes: {{done: {{}}}}\ncode: {code}\n",
        "templates/Detector.tpl.py": TEMPLATE,
    }
    library = memory_library(files, BUILT_IN)
    report = analyse(Source("main.yml", MAIN), library, [], render=True).report
    return [(item.code, item.span.text, item.help) for item in report if "Detect" in item.message]


@pytest.mark.parametrize(
    ("code", "expected"),
    [
        (
            "{python: Detectr.tpl.py}",
            ("SM605", "Detectr.tpl.py", "did you mean `Detector.tpl.py`?"),
        ),
        (
            "{python: See.tpl.py}",
            ("SM605", "See.tpl.py", "add the file `See.tpl.py` to a folder of templates"),
        ),
        (
            "{python: robot.states.Detect}",
            (
                "SM004",
                "robot.states.Detect",
                "write a colon before the class: `robot.states:Detect`",
            ),
        ),
    ],
)
def test_code_that_does_not_exist(code: str, expected: tuple[str, str, str]) -> None:
    assert found(code) == [expected]


@pytest.mark.parametrize("code", ["{python: Detector.tpl.py}", "{}"])
def test_code_that_exists_or_is_not_written_yet(code: str) -> None:
    assert found(code) == []
