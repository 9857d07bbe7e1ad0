"""The class in a template that has no interface: its constructor and its outcomes are checked."""

from __future__ import annotations

from dataclasses import replace

import pytest

from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.loader import memory_library
from smachac.pysource.modules.ros_names import Ros
from tests.trust.project_text import BUILT_IN, analysed

TEMPLATE = """\
{% block class_defs %}
class Open(smach.State):
    def __init__(self, width, speed=1.0):
        super().__init__(outcomes=["done"])
        self.width, self.speed = width, speed

    def execute(self, userdata):
        return "done"
{% endblock %}
"""
ADDED = '{% block body %}{{ add("Open", 0.1) }}{% endblock %}\n'


MAIN = """\
name: sm
template: Base
outcomes: [done]
states:
  - OPEN: {template: Open, FIELDS transitions: {done: done}}
"""


def findings(fields: str, **files: str) -> list[tuple[str, str, str]]:
    """Code, marked text and help of each finding about a state with these fields."""
    main = MAIN.replace("FIELDS", fields)
    texts = {name.replace("_", ".", 1).replace("_", "."): text for name, text in files.items()}
    project = {"main.yml": main} | {f"templates/{name}": text for name, text in texts.items()}
    return [(item.code, item.span.text, item.help or "") for item in analysed(project).report]


@pytest.mark.parametrize(
    ("fields", "expected"),
    [
        ("", [("SM005", "OPEN", "add `width: ...`")]),
        ("width: 0.1,", []),
        ("width: 0.1, speed: 2.0, timeout: 2 s, tags: [slow],", []),
        ("widht: 0.1,", [("SM003", "widht", "did you mean `width`?")]),
        ("width: 0.1, force: 2,", [("SM003", "force", "its variables are `speed`, `width`")]),
    ],
)
def test_variables_are_the_parameters_of_the_constructor(
    fields: str, expected: list[tuple[str, str, str]]
) -> None:
    found = findings(fields, Open_tpl_py=TEMPLATE)
    assert [item for item in found if item[0] != "SM104"] == expected


def test_a_wrong_return_is_found() -> None:
    code = TEMPLATE.replace('return "done"', 'return "dnoe"')
    found = findings("width: 1,", Open_tpl_py=code)
    assert found == [("SM309", '"dnoe"', "did you mean `done`?")]


@pytest.mark.parametrize(
    "code",
    [
        TEMPLATE + ADDED,  # the block passes what it likes
        TEMPLATE.replace("width, speed=1.0", "**given").replace("width, speed", "given"),
        TEMPLATE.replace("class Open", "class Gripper"),  # not the class that a program makes
        TEMPLATE.replace("speed=1.0", "{{ speed }}"),
    ],
)
def test_a_constructor_that_decides_nothing(code: str) -> None:
    code = code.replace("self.width = given", "self.width, self.speed = given")
    assert [
        finding for finding in findings("force: 2,", Open_tpl_py=code) if finding[0] != "SM003"
    ] == []


INTERFACE = 'outcomes: {done: {}}\nvariables: {VARIABLES}\ncode: {python: "Open.tpl.py"}\n'


@pytest.mark.parametrize(
    ("variables", "fields", "expected"),
    [
        ('width: {type: float, default: 0.1}, "*": {}', "speed: 1,", False),
        ('width: {type: float}, "*": {}', "speed: 1, width: 1,", False),
        ('"*": {}', "speed: 1,", True),
        ('"*": {}', "width: 1,", False),
    ],
)
def test_an_argument_that_nothing_passes(variables: str, fields: str, expected: bool) -> None:
    found = findings(
        fields, Open_tpl_py=TEMPLATE, Open_yml=INTERFACE.replace("VARIABLES", variables)
    )
    help = "add `width: ...` to the state, or give `width` a default value in `__init__`"
    assert found == ([("SM609", "OPEN", help)] if expected else [])


@pytest.mark.parametrize(("ros", "expected"), [(1, ["SM609"]), (2, [])])
def test_a_program_for_ros_2_passes_its_node(ros: Ros, expected: list[str]) -> None:
    main = MAIN.replace("FIELDS", "width: 0.1,")
    module = (
        TEMPLATE.partition("\n")[2].rpartition("{%")[0].replace("self, width", "self, node, width")
    )
    interface = INTERFACE.replace("VARIABLES", '"*": {}').replace("Open.tpl.py", "cell:Open")
    files = {"templates/Open.yml": interface, "cell.py": f"import smach\n\n\n{module}"}
    library = replace(memory_library(files, BUILT_IN), ros=ros)
    report = analyse(Source("main.yml", main), library, []).report
    assert [item.code for item in report] == expected


def test_an_argument_that_the_constructor_does_not_accept() -> None:
    interface = INTERFACE.replace("VARIABLES", '"*": {}')
    found = findings("widht: 1,", Open_tpl_py=TEMPLATE, Open_yml=interface)
    assert found == [("SM609", "widht", "did you mean `width`?")]
