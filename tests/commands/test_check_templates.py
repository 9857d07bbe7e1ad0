"""`check` renders the templates of the user, as `build` does."""

from __future__ import annotations

from pathlib import Path

import pytest

import smachac
from smachac import driver
from smachac.commands.cli import main
from smachac.pysource.templates.template_sources import uses_own_templates

SCRIPT = """\
name: sm
template: Base
outcomes: [done]
states:
  - A: {template: T, outcomes: [done], transitions: {done: done}}
"""
CLASS = """\
{% block class_defs %}
class T(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=['done'])
    def execute(self, userdata):
        CODE
        return 'done'
{% endblock %}
{% block body %}
smach.{{ parent_type }}.add('{{ name }}', T(), transitions={'done': 'done'})
{% endblock %}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "templates").mkdir()
    (tmp_path / "main.yml").write_text(SCRIPT)
    return tmp_path


@pytest.mark.parametrize(
    ("code", "finding", "ends"),
    [
        ("{{ gone }}", "SM605", 1),
        ("print 'x'", "SM606", 0),
        ("def:", "SM605", 1),
        ("pass", "", 0),
    ],
)
def test_findings_in_templates(
    folder: Path, code: str, finding: str, ends: int, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "templates" / "T.tpl.py").write_text(CLASS.replace("CODE", code))
    assert main(["check", str(folder)]) == ends
    assert (finding or "no findings") in capsys.readouterr().out
    script = str(folder / "main.yml")
    found = [item.code for item in smachac.check(script)]
    assert found == [finding] * bool(finding)
    assert main(["build", script, "-t", "python", "-o", str(folder / "out")]) == ends
    assert capsys.readouterr().err.count(finding or "SM6") == bool(finding)


def test_a_definition_that_two_templates_have(folder: Path) -> None:
    states = "  - A: {template: T, outcomes: [done], transitions: {done: B}}\n"
    states += "  - B: {template: U, outcomes: [done], transitions: {done: done}}\n"
    (folder / "main.yml").write_text(SCRIPT.partition("  - A")[0] + states)
    for name, code in (("T", "pass"), ("U", "print('x')")):
        text = CLASS.replace("CODE", code)
        (folder / "templates" / f"{name}.tpl.py").write_text(text)
    assert "SM607" in [item.code for item in smachac.check(folder / "main.yml")]


def test_scripts_without_templates_of_the_user_are_not_rendered(folder: Path) -> None:
    path = folder / "main.yml"
    path.write_text(SCRIPT.replace("template: T", "template: ScriptedState"))
    analysis = driver.analyse_script(path)
    assert analysis.machine is not None
    assert analysis.library is not None
    assert not uses_own_templates(analysis.machine, analysis.library)
    (folder / "templates" / "ScriptedState.tpl.py").write_text(CLASS)
    library = driver.analyse_script(path).library
    assert library is not None
    assert uses_own_templates(analysis.machine, library)


def test_a_name_that_a_template_lacks(folder: Path) -> None:
    script = str(folder / "main.yml")
    template = folder / "templates" / "T.tpl.py"
    template.write_text(CLASS.replace("parent_type", "parent_typ"))
    (found,) = smachac.check(script)
    assert (found.span.text, found.help) == ("parent_typ", "did you mean `parent_type`?")
    template.write_text(CLASS.partition("{% block body")[0].replace("CODE", "go({{ sped }})"))
    (folder / "templates" / "T.yml").write_text(
        "name: T\nvariables: {speed: {type: float}}\noutcomes: {done: {}}\n"
    )
    (folder / "main.yml").write_text(
        SCRIPT.replace("template: T, outcomes: [done]", "template: T, speed: 1.0")
    )
    (found,) = [item for item in smachac.check(script) if item.code == "SM605"]
    assert found.span.text == "sped"
    assert found.help is not None
    assert found.help.startswith("accept the parameter `speed` in `__init__`")


@pytest.mark.parametrize(
    ("block", "found"),
    [
        ("class_def", ["did you mean `class_defs`?"]),
        ("Class_defs", ["did you mean `class_defs`?"]),
        ("my_classes", []),  # a block of another tool
    ],
)
@pytest.mark.parametrize("first", ["", '{% extends "State.tpl.py" %}\n'])
def test_a_misspelt_block(folder: Path, first: str, block: str, found: list[str]) -> None:
    text = CLASS.replace("CODE", "pass") + f"{{% block {block} %}}\nX = 1\n{{% endblock %}}\n"
    own = text.replace("{% block class_defs %}", "{% block defs %}", 1)
    (folder / "templates" / "T.tpl.py").write_text(first + own)
    report = smachac.check(str(folder / "main.yml"))
    assert [item.finding.help for item in report if item.code == "SM605"] == found
    assert [item.span.text for item in report if item.code == "SM605"] == [block] * len(found)
