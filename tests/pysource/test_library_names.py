"""Attributes of modules of Python's library that these do not have (SM019, SM609)."""

from __future__ import annotations

import sys
from types import ModuleType

import pytest

from smachac.pysource.modules.library_names import MODULES, missing_name, module_of_library
from tests.trust.project_text import analysed

MAIN = """\
name: sm
template: Own
outcomes: [done]
userdata: {{started: {code}}}
states:
  - WAIT: {{template: Wait, transitions: {{done: SHOW}}}}
  - SHOW: {{template: PrintUserdataState, input_keys: [started], transitions: {{succeeded: done}}}}
"""

BASE = """\
{{% extends "Base.tpl.py" %}}

{{% block imports %}}
{{{{ super() }}}}
{line}
{{% endblock imports %}}
"""

WAIT = """\
outcomes: {done: {}}
code: {python: "cell.wait:Wait"}
"""

CLASS = """\
{line}
import smach


class Wait(smach.State):
    def __init__(self):
        super().__init__(outcomes=["done"])

    def execute(self, userdata):
        {body}
        return "done"
"""


def found(
    code: str = "", line: str = "import time", body: str = "pass", base: str = "import time",
    files: dict[str, str] | None = None,
) -> list[tuple[str, str, str | None]]:  # fmt: skip
    texts = {
        "main.yml": MAIN.format(code=code or "time.time()"),
        "templates/Own.tpl.py": BASE.format(line=base),
        "templates/Wait.yml": WAIT,
        "cell/__init__.py": "",
        "cell/wait.py": CLASS.format(line=line, body=body),
    }
    items = analysed(texts | (files or {})).report
    return [(item.code, item.span.text, item.help) for item in items]


@pytest.mark.parametrize(
    ("module", "name", "meant"),
    [
        ("time", "now", "time.time()"),
        ("math", "squareroot", "math.sqrt()"),
        ("random", "choise", "random.choice"),
        ("datetime", "now", "datetime.datetime.now"),
        ("os.path", "exist", "os.path.exists"),
        ("statistics", "average", ""),
        ("math", "pi", None),
        ("math", "cbrt", None),  # since Python 3.11
        ("os", "startfile", None),  # on Windows
        ("numpy", "squareroot", None),
    ],
)
def test_names_that_a_module_lacks(module: str, name: str, meant: str | None) -> None:
    assert missing_name(module, name) == meant


def test_every_module_of_the_list_is_of_the_library() -> None:
    assert [name for name in sorted(MODULES) if module_of_library(name) is None] == []


def test_a_module_of_a_user_is_not_imported(monkeypatch: pytest.MonkeyPatch) -> None:
    fake = ModuleType("random")
    monkeypatch.setitem(sys.modules, "random", fake)
    assert module_of_library("random") is None or module_of_library("random") is not fake


def test_attributes_in_the_script() -> None:
    assert found("time.now()") == [("SM019", "now", "write `time.time()`")]
    assert found("math.squareroot(2)") == [("SM019", "squareroot", "write `math.sqrt()`")]
    assert found("time.monotonic()") == []


@pytest.mark.parametrize(
    "base",
    ["from cell.clock import time", "import arrow as time", "time = 3", "def time(): pass"],
)
def test_another_object_of_the_name_in_a_template(base: str) -> None:
    files = {"cell/clock.py": "time = 1\n"}
    assert found("time.now()", base=base, files=files) == []


def test_a_module_of_the_project_with_the_name() -> None:
    assert found("time.now()", body="time.now()", files={"time.py": "now = print\n"}) == []


def test_attributes_in_a_class() -> None:
    assert found(body="time.now()") == [("SM609", "now", "write `time.time()`")]
    assert found(line="import random", body="random.choise([1])") == [
        ("SM609", "choise", "did you mean `random.choice`?")
    ]
    assert found(line="import os", body="os.path.exist('a')") == [
        ("SM609", "exist", "did you mean `os.path.exists`?")
    ]
    assert found(line="import os.path", body="x = os.path.joni('a')") != []


@pytest.mark.parametrize(
    ("line", "body"),
    [
        ("import time", "time.sleep(1)"),
        ("from cell import time", "time.now()"),
        ("import arrow as time", "time.now()"),
        ("try:\n    import arrow as time\nexcept ImportError:\n    import time", "time.now()"),
        ("import time", "time = open('clock'); time.now()"),
        ("import time", "x = lambda time: time.now()"),
        ("import time", "x = time.now() if hasattr(time, 'now') else 1"),
        ("import time\ntime.now = time.time", "x = time.now()"),
        ("from arrow import *\nimport time", "x = time.now()"),
        ("import time", "try:\n            x = time.now()\n        except AttributeError: pass"),
    ],
)
def test_attributes_that_can_exist(line: str, body: str) -> None:
    files = {"cell/time.py": "now = print\n"}
    assert found(line=line, body=body, files=files) == []
