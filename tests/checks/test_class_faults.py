"""Slips in Python classes of a user, each found once, at the token that is wrong, with its cure."""

from __future__ import annotations

import pytest

from smachac.diagnostics.diagnostic import Diagnostic
from tests.trust.project_text import analysed

MAIN = """\
name: sm
template: Base
outcomes: [done, failed]
userdata: {parts: [a, b]}
states:
  - FIND:
      template: Find
      input_keys: [parts]
      transitions: {found: SHOW, nothing: failed}
  - SHOW: {template: PrintUserdataState, input_keys: [part], transitions: {succeeded: done}}
"""

FIND = """\
variables: {tries: {type: int, default: 2}}
input_keys: {parts: "list[str]"}
output_keys: {part: str}
outcomes: {found: {}, nothing: {}}
writes: {found: [part]}
code: {python: "cell.find:FindPart"}
"""

CLASS = """\
import time

import smach

from cell.camera import Camera

FOUND = "found"


class FindPart(smach.State):
    def __init__(self, tries=2):
        super().__init__(
            outcomes=[FOUND, "nothing"], input_keys=["parts"], output_keys=["part"]
        )
        self.tries = tries
        self.camera = Camera()

    def execute(self, userdata):
        if not userdata.parts:
            return "nothing"
        userdata.part = userdata.parts[0]
        return FOUND
"""

CAMERA = """\
class Camera:
    def look(self):
        return 1
"""

FILES = {
    "main.yml": MAIN,
    "templates/Find.yml": FIND,
    "cell/__init__.py": "",
    "cell/find.py": CLASS,
    "cell/camera.py": CAMERA,
}


def report(*changes: tuple[str, str], files: dict[str, str] | None = None) -> list[Diagnostic]:
    """The findings of the project with other parts in some of its files."""
    found = {**FILES, **(files or {})}
    for old, new in changes:
        assert any(old in text for text in found.values())
        found = {name: text.replace(old, new, 1) for name, text in found.items()}
    return [item for item in analysed(found).report if item.code not in ("SM305", "SM306")]


def only(*changes: tuple[str, str], files: dict[str, str] | None = None) -> Diagnostic:
    (item,) = report(*changes, files=files)
    return item


def test_the_project_has_no_finding() -> None:
    assert report() == []


# --- names of other objects

ENUM = """\
class FindPart(smach.State):
    class Out(enum.Enum):
        FOUND = "found"

        def __str__(self):
            self.execute = "x"
            return self.value if self.execute else self.vale

"""


def test_self_of_an_inner_class_is_another_object() -> None:
    changes = [("import time\n", "import enum\n"), ("class FindPart(smach.State):\n", ENUM)]
    assert report(*changes) == []


def test_self_of_an_inner_function_is_another_object() -> None:
    inner = "def execute(self, userdata):\n        def look(self):\n            return self.trees\n"
    assert report(("def execute(self, userdata):\n", inner)) == []
    assert report(("self.tries = tries", "self.tries = tries + self.trees"))[0].span.text == "trees"


@pytest.mark.parametrize("name", ["is_preempt_requested", "prempt_requested"])
def test_private_names_of_smach_are_not_suggested(name: str) -> None:
    item = only(("if not userdata.parts:", f"if self.{name}() or not userdata.parts:"))
    assert (item.code, item.span.text) == ("SM609", name)
    assert item.help == "did you mean `preempt_requested`?"


# --- variables with the name of a field


@pytest.mark.parametrize(
    ("name", "type_", "value"),
    [("it", "int", "3"), ("join", "int", "3"), ("initial", "list[str]", "[a]")],
)
def test_a_variable_has_its_own_type_also_under_the_name_of_a_field(
    name: str, type_: str, value: str
) -> None:
    variable = f'variables: {{tries: {{type: int}}, {name}: {{type: "{type_}"}}}}\n'
    changes = [
        ("variables: {tries: {type: int, default: 2}}\n", variable),
        ("tries=2", f"{name}, tries=2"),
        ("template: Find\n", f"template: Find\n      tries: 2\n      {name}: {value}\n"),
    ]
    assert report(*changes) == []
    (item,) = report(*changes, (f"{name}: {value}\n", f"{name}: {{a: 1}}\n"))
    assert item.code == "SM304"


# --- constructors

BASE = """\
class Arm(smach.State):
    def __init__(self{given}):
        super().__init__(
            outcomes=[FOUND, "nothing"], input_keys=["parts"], output_keys=["part"]
        )


class FindPart(Arm):
    def __init__(self, tries=2):
        pass
"""


@pytest.mark.parametrize(
    ("given", "call"),
    [
        ("", "super().__init__()"),
        (", tries, speed=1", "super().__init__(tries=tries)"),
        (", limits, *, speed", "super().__init__(limits=..., speed=...)"),
    ],
)
def test_the_constructor_of_an_own_base_class_is_called(given: str, call: str) -> None:
    head, tail = CLASS.partition("class FindPart")[0], CLASS.partition("        self.tries")[2]
    text = head + BASE.format(given=given) + "        self.tries" + tail
    item = only(files={"cell/find.py": text})
    assert (item.code, item.span.text, item.span.start) == (
        "SM609",
        "__init__",
        text.rfind("__init__"),
    )
    assert item.help == f"write `{call}` as the first line of `__init__`"
    called = text.replace("        pass\n", f"        {call}\n")
    assert report(files={"cell/find.py": called}) == []


def test_a_parameter_with_another_name_than_the_only_variable() -> None:
    item = only(
        ("def __init__(self, tries=2)", "def __init__(self, limit=2)"), ("= tries", "= limit")
    )
    assert (item.code, item.span.text) == ("SM609", "limit")
    assert "rename the parameter `limit` to `tries`" in (item.help or "")


# --- keys and outcomes


def test_an_input_key_in_place_of_the_output_key() -> None:
    item = only(("userdata.part = userdata", "userdata.parts = userdata"))
    assert (item.code, item.span.text) == ("SM308", "parts")
    assert (item.help, "`part` is never set" in item.message) == ("did you mean `part`?", True)
    both = ("userdata.part = userdata", "userdata.parts = userdata.part = userdata")
    assert "add `parts` to the `output_keys`" in (only(both).help or "")


@pytest.mark.parametrize(
    ("text", "help"),
    [
        ("fond", "did you mean `found`?"),
        ("foun", "did you mean `found`?"),
        (
            "there",
            'write `"found"`, as no path returns `found`, or add `there` to the outcomes of'
            " `Find` in its interface",
        ),
    ],
)
def test_a_wrong_constant_is_marked_where_its_text_is(text: str, help: str) -> None:
    (item,) = [
        one for one in report(('FOUND = "found"', f'FOUND = "{text}"')) if one.code == "SM309"
    ]
    assert (item.code, item.span.text, item.help) == ("SM309", f'"{text}"', help)
    assert item.related[0].span.text == "FOUND"


# --- imports


@pytest.mark.parametrize(
    ("line", "place", "help"),
    [
        ("from cell.camra import Camera", "cell.camra", "did you mean `cell.camera`?"),
        ("from cell.camera import Camer as Camera", "Camer", "did you mean `Camera`?"),
        ("from cell.camera import (\n Camera,\n Lens,\n)", "Lens", "define it in `cell/camera"),
        ("from .camra import Camera", "camra", "did you mean `camera`?"),
        ("from cell import camra as Camera", "camra", "did you mean `camera`?"),
        ("import cell.camra as Camera", "cell.camra", "did you mean `cell.camera`?"),
        ("from cells.camera import Camera", "cells.camera", "did you mean `cell.camera`?"),
        ("from tools.grp import Camera", "tools.grp", "did you mean `tools.grip`?"),
        ("from cell.camera import CAMERA", "CAMERA", "did you mean `Camera`?"),
        ("from cell.camera import Camera, Lamp", "Lamp", "import `Lamp` from `tools.lamp`, which"),
        ("from cell.camera import Camera, focus", "focus", "import `focus` from `cell.focus`"),
        ("from cell.camera import Camera, twice", "twice", "define it in `cell/camera.py`"),
    ],
)  # fmt: skip
def test_imports_that_fail(line: str, place: str, help: str) -> None:
    change = ("from cell.camera import Camera", line)
    files = {
        "tools/grip.py": "Camera = print\n\ndef twice(): pass\n",
        "tools/lamp.py": "class Lamp:\n    pass\n\ndef twice(): pass\n",
        "cell/focus.py": "def focus(distance):\n    return distance\n",
    }
    item = only(change, files=files)
    assert (item.code, item.span.text) == ("SM608", place)
    assert help in (item.help or "")


@pytest.mark.parametrize(
    "line",
    [
        "from tools.other import Camera",  # may be installed
        "from cell.camera_pb2 import Camera",
        "from cell.camera import Camera, __doc__",
        "try:\n    from cell.camra import Camera\nexcept ImportError:\n    Camera = print",
        "from cell import camera as Camera",
        "from cell.made import Camera, Lens",
        "from cell.star import Camera, Lens",
        "from cell.late import Camera, LENS",
        "from tools import grip as Camera",
        "from cells.cam import Camera",
        "import cell.camera\nCamera = cell.camera.Camera",
        "from cell import *\nfrom numpy import Camera",
    ],
)
def test_imports_that_can_work(line: str) -> None:
    files = {
        "tools/grip.py": "Camera = print\n",
        "cell/made.py": "for name in ['Camera', 'Lens']:\n    globals()[name] = print\n",
        "cell/star.py": "from cell.camera import *\n",
        "cell/late.py": "Camera = 1\ndef begin():\n    global LENS\n    LENS = 1\n",
    }
    assert report(("from cell.camera import Camera", line), files=files) == []


def test_a_use_of_what_the_import_should_have_is_one_finding() -> None:
    item = only(("from cell.camera import Camera", "from cell.camera import CamerA"))
    assert (item.code, item.span.text) == ("SM608", "CamerA")


OWN_BASE = """\
{% extends "Base.tpl.py" %}

{% block imports %}
{{ super() }}
import time
from cell.camera import Camera
{% endblock imports %}
"""


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("cell.camera", "cell.camera", []),
        ("cell.camera", "cell.camra", ["cell.camra"]),
        ("Camera", "Camra", ["Camra"]),
        ("from cell.camera", "from {{ package }}.camra", []),
        (
            "from",
            "try:\n    from cell.camra import Camera\nexcept ImportError:\n    pass\nfrom",
            [],
        ),
    ],
)
def test_imports_of_the_own_base(old: str, new: str, found: list[str]) -> None:
    files = {"templates/Own.tpl.py": OWN_BASE.replace(old, new, 1)}
    items = report(("template: Base\n", "template: Own\n"), files=files)
    assert [(item.code, item.span.text) for item in items] == [("SM608", one) for one in found]
