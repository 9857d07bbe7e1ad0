"""The public API: the functions, the exported names, and the examples of docs/api.md."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import smachac

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "examples"
GOOD = EXAMPLES / "06_callbacks" / "main.yml"
PAGE = (ROOT / "docs" / "api.md").read_text("utf-8")
BLOCKS = re.findall(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
FILES = {
    text.split("\n", 1)[0].removeprefix("# "): text
    for text in BLOCKS
    if re.match(r"# \w+\.py\n", text)
}


def test_a_good_script(capsys: pytest.CaptureFixture[str]) -> None:
    assert smachac.check(GOOD) == []
    assert smachac.load(GOOD).root.name == "three_tries"
    assert list(smachac.compile(GOOD, "dot")) == ["three_tries.dot"]
    events: list[dict[str, Any]] = []
    result = smachac.run(GOOD, observe=events.append)
    assert result.outcome == "succeeded"
    assert list(result.events) == events
    assert events[-1]["event"] == "finish"
    assert result.userdata == {"tries": 2}
    assert capsys.readouterr().out == ""


def test_a_script_with_errors(tmp_path: Path) -> None:
    path = tmp_path / "main.yml"
    path.write_text(GOOD.read_text().replace("enough: aborted", "enough: abroted"))
    assert [item.code for item in smachac.check(str(path))] == ["SM101"]
    for function in (smachac.load, smachac.run):
        with pytest.raises(smachac.ScriptError, match="did you mean `aborted`") as raised:
            function(path)
        assert [item.code for item in raised.value.report] == ["SM101"]
    with pytest.raises(smachac.ScriptError):
        smachac.compile(tmp_path / "no.yml", "dot")


def test_a_text_is_the_same_as_a_file(tmp_path: Path) -> None:
    text = GOOD.read_text("utf-8")
    path = tmp_path / "main.yml"
    path.write_text(text, "utf-8")
    source = smachac.Source(str(path), text)
    made = smachac.compile(path, "python")
    assert smachac.compile(source, "python") == made
    assert smachac.compile(text, "python", name=str(path)) == made
    assert smachac.load(source) == smachac.load(path)
    assert smachac.run(text, name=str(path)).outcome == smachac.run(source).outcome == "succeeded"


def test_a_text_finds_the_files_beside_its_name() -> None:
    folder = EXAMPLES / "09_stacking"
    text = (folder / "main.yml").read_text("utf-8")
    others = [EXAMPLES / "08_pick_and_place"]
    assert smachac.check(text, name=str(folder / "main.yml"), scripts=others) == []
    found = smachac.check(text, name="main.yml")
    assert found
    assert {item.span.source.name for item in found} == {"main.yml"}


def test_wrong_use() -> None:
    with pytest.raises(LookupError, match="no target"):
        smachac.compile(GOOD, "pyton")
    with pytest.raises(ValueError, match="depth"):
        smachac.compile(GOOD, "dot", options={"depth": "x"})
    with pytest.raises(AttributeError, match="no attribute `build`"):
        smachac.build  # noqa: B018


def test_more_folders() -> None:
    script = EXAMPLES / "09_stacking" / "main.yml"
    assert smachac.load(script, scripts=[EXAMPLES / "08_pick_and_place"]).root.name == "stacking"


def test_compile_adds_the_runtime_files() -> None:
    files = smachac.compile(GOOD, "cpp")
    assert next(iter(files)) == "three_tries.hpp"
    assert "smachac/smachac.hpp" in files


@pytest.mark.parametrize("name", smachac.__all__)
def test_every_exported_name_is_there(name: str) -> None:
    assert getattr(smachac, name) is not None
    assert name in dir(smachac)


def test_the_page_names_everything_that_is_exported() -> None:
    inner = {"Code", "Edit", "Node", "Related", "Span", "__version__"}
    assert [name for name in smachac.__all__ if name not in PAGE and name not in inner] == []


def test_importing_smachac_imports_nothing_else() -> None:
    code = (
        "import sys; before = set(sys.modules); import smachac;"
        "print(sorted(set(sys.modules) - before))"
    )
    ended = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=120, check=True
    )
    assert eval(ended.stdout) == ["__future__", "smachac", "smachac.version"]


def test_the_examples_of_the_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, text in FILES.items():
        (tmp_path / name).write_text(text, "utf-8")
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))
    names: dict[str, Any] = {}
    for text in BLOCKS:
        if text not in FILES.values():
            exec(compile(text, "docs/api.md", "exec"), names)
    assert names["table"].startswith("state;outcome;target\n")
    assert sum("assert " in text for text in BLOCKS) >= 4
    assert set(FILES) == {"check_scripts.py", "transition_table.py"}


@pytest.mark.parametrize(
    ("target", "ended", "printed"),
    [
        ("done", 0, ""),
        ("doen", 1, "main.yml:5:68: error: `doen` is neither"),
    ],
)
def test_the_script_for_ci(target: str, ended: int, printed: str, tmp_path: Path) -> None:
    (tmp_path / "check_scripts.py").write_text(FILES["check_scripts.py"], "utf-8")
    (tmp_path / "main.yml").write_text(
        "name: sm\ntemplate: Base\noutcomes: [done]\nstates:\n"
        f"  - A: {{template: ScriptedState, outcomes: [ok], transitions: {{ok: {target}}}}}\n"
    )
    program = [sys.executable, "check_scripts.py", "."]
    done = subprocess.run(
        program, cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == ended, done.stderr
    assert printed in done.stdout


def test_two_projects_may_have_modules_of_one_name(tmp_path: Path) -> None:
    outcomes = []
    for outcome in ("first", "second"):
        folder = tmp_path / outcome
        (folder / "templates").mkdir(parents=True)
        (folder / "robot_parts").mkdir()
        (folder / "robot_parts" / "__init__.py").write_text("")
        (folder / "robot_parts" / "act.py").write_text(
            "from smachac.runtime import smach\n\n\nclass Act(smach.State):\n"
            "    def __init__(self):\n        super().__init__(outcomes=['first', 'second'])\n\n"
            f"    def execute(self, userdata):\n        return '{outcome}'\n"
        )
        (folder / "templates" / "Act.yml").write_text(
            'name: Act\noutcomes: {first: {}, second: {}}\ncode: {python: "robot_parts.act:Act"}\n'
        )
        (folder / "main.yml").write_text(
            "name: sm\ntemplate: Base\noutcomes: [first, second]\nstates:\n"
            "  - ACT: {template: Act, transitions: {first: first, second: second}}\n"
        )
        outcomes.append(smachac.run(folder / "main.yml").outcome)
    assert outcomes == ["first", "second"]
    assert "robot_parts" not in sys.modules
