"""A state type of the user is not the built-in one of its name."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import smachac
from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.files import disk_library
from smachac.frontend.loader import memory_library
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run
from smachac.targets import BuildContext
from smachac.targets.python import emit

TEMPLATE = """\
{% block class_defs %}
class NAME(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=['awake', 'late'])
    def execute(self, userdata):
        return 'late'
{% endblock %}
"""
INTERFACE = "name: NAME\noutcomes: {awake: {}, late: {}}\ncode: {python: NAME.tpl.py}\n"
SCRIPT = """\
name: sm
outcomes: [first, second]
states:
  - A: {template: NAME, transitions: {awake: first, late: second}}
"""
CLASS = """\
from smachac.runtime import smach


class Count(smach.State):
    def __init__(self):
        super().__init__(outcomes=["done"])

    def execute(self, userdata):
        return "done"
"""
BUILT_IN = ["SleepState", "RandomOutcomeState", "ScriptedState", "PrintUserdataState"]


def project(folder: Path, name: str, *, interface: bool = True) -> Path:
    (folder / "templates").mkdir()
    (folder / "templates" / f"{name}.tpl.py").write_text(TEMPLATE.replace("NAME", name))
    if interface:
        (folder / "templates" / f"{name}.yml").write_text(INTERFACE.replace("NAME", name))
    (folder / "main.yml").write_text(SCRIPT.replace("NAME", name))
    return folder / "main.yml"


@pytest.mark.parametrize("interface", [True, False])
@pytest.mark.parametrize("name", BUILT_IN)
def test_there_is_no_code_of_ours_for_it(tmp_path: Path, name: str, interface: bool) -> None:
    path = project(tmp_path, name, interface=interface)
    with pytest.raises(smachac.ScriptError) as caught:
        smachac.compile(path, "cpp")
    assert "SM602" in [item.code for item in caught.value.report]
    text = smachac.compile(path, "python")["sm.py"]
    assert text.count(f"class {name}") == 1
    assert "return 'late'" in text


def test_the_interpreter_takes_its_outcomes(tmp_path: Path) -> None:
    machine = smachac.load(project(tmp_path, "SleepState"))
    assert run(machine, builtin_behaviour()).outcome == "first"


OWN = """
name: {name}
variables: {{force: {{type: float, default: 1.0}}}}
outcomes: {{done: {{}}}}
code: {{python: "{module}:Grasp"}}
"""
OWN_CLASS = """\
import smach


class Grasp(smach.State):
    def __init__(self, force):
        super().__init__(outcomes=["done"])
        self.force = force

    def execute(self, userdata):
        return "done"
"""


def test_classes_of_one_name_and_defaults_that_a_constructor_requires() -> None:
    script = """
name: sm
outcomes: [done]
states:
  - ONE: {template: Grasp, transitions: {done: TWO}}
  - TWO: {template: Grip, force: 2.0, transitions: {done: THREE}}
  - THREE: {template: Grip, transitions: {done: done}}
"""
    files = {
        "main.yml": script,
        "templates/Grasp.yml": OWN.format(name="Grasp", module="left.grasp"),
        "templates/Grip.yml": OWN.format(name="Grip", module="right.grasp"),
        "left/grasp.py": OWN_CLASS,
        "right/grasp.py": OWN_CLASS,
    }
    library = memory_library(files, disk_library(Path("main.yml"), []))
    analysis = analyse(Source("main.yml", script), library, [])
    assert analysis.report == []
    assert analysis.checked is not None
    text = emit(analysis.checked, BuildContext(library=library), [])["sm.py"]
    assert "from left.grasp import Grasp\n" in text
    assert "from right.grasp import Grasp as Grip\n" in text
    assert '"ONE", Grasp(force=1.0)' in text
    assert '"TWO", Grip(force=2.0)' in text
    assert "Grip(force=1.0)" in text


def test_a_program_does_not_hide_a_module_of_the_user(tmp_path: Path) -> None:
    """A program whose folder is searched first is found before a module of the same name."""
    (tmp_path / "templates").mkdir()
    interface = 'outcomes: {done: {}}\ncode: {python: "tally.count:Count"}\n'
    (tmp_path / "templates" / "Count.yml").write_text(interface)
    (tmp_path / "tally").mkdir()
    (tmp_path / "tally" / "__init__.py").write_text("")
    (tmp_path / "tally" / "count.py").write_text(CLASS)
    script = "name: NAME\noutcomes: [done]\nstates:\n  - A: {template: Count}\n"
    (tmp_path / "main.yml").write_text(script.replace("NAME", "tally"))
    files = smachac.compile(tmp_path / "main.yml", "python")
    assert list(files) == ["tally_program.py"]
    program = tmp_path / "tally_program.py"
    program.write_text(files["tally_program.py"])
    ended = subprocess.run(
        [sys.executable, str(program)], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert "ImportError" not in ended.stderr
    (tmp_path / "main.yml").write_text(script.replace("NAME", "count"))
    assert list(smachac.compile(tmp_path / "main.yml", "python")) == ["count.py"]


def test_a_template_beside_an_interface_without_code_gets_the_variables(tmp_path: Path) -> None:
    files = {
        "main.yml": "name: sm\noutcomes: [said]\nstates:\n  - SAY: {template: Say, word: hello}\n",
        "templates/Say.yml": "name: Say\nvariables: {word: {type: str}}\noutcomes: [said]\n",
        "templates/Say.tpl.py": (
            '{% extends "State.tpl.py" %}\n{% block class_defs %}\nclass Say(smach.State):\n'
            '    def __init__(self, word):\n        super().__init__(outcomes=["said"])\n'
            "        self.word = word\n\n    def execute(self, userdata):\n"
            '        print(self.word)\n        return "said"\n{% endblock %}\n'
            '{% block body %}{{ add("Say", word) }}{% endblock %}\n'
        ),
    }
    for name, text in files.items():
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, "utf-8")
    (program,) = smachac.compile(tmp_path / "main.yml", "python").values()
    assert 'Say("hello")' in program
