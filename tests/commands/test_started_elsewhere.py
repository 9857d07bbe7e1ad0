"""A generated program that is started in another folder finds the user's modules, or says how."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from smachac.commands.cli import main

ROOT = Path(__file__).parents[2]

CLASS = """\
{imports}
try:
    import smach
except ImportError:
    from smachac.runtime import smach


class {name}(smach.State):
    def __init__(self):
        super().__init__(outcomes=["done"])

    def execute(self, userdata):
        return "done"
"""


def project(folder: Path, *classes: str, imports: str = "") -> Path:
    """A project with a state of each class, `module:Class`; its script."""
    states = []
    for number, each in enumerate(classes):
        module, _, name = each.partition(":")
        path = folder / f"{module.replace('.', '/')}.py"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(CLASS.format(name=name, imports=imports))
        (folder / "templates").mkdir(exist_ok=True)
        (folder / "templates" / f"{name}.yml").write_text(
            f'outcomes: {{done: {{}}}}\ncode: {{python: "{each}"}}\n'
        )
        target = f"S{number + 1}" if number < len(classes) - 1 else "done"
        states.append(f"  - S{number}: {{template: {name}, transitions: {{done: {target}}}}}\n")
    script = folder / "main.yml"
    head = "name: mission\ntemplate: Base\noutcomes: [done]\nstates:\n"
    script.write_text(head + "".join(states))
    return script


def start(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, *words],
        cwd=folder, env={"PYTHONPATH": str(ROOT), "PATH": ""}, capture_output=True, text=True,
        timeout=120, check=False,
    )  # fmt: skip


@pytest.mark.parametrize("output", ["out", "build/python", "."])
def test_started_from_anywhere(output: str, tmp_path: Path) -> None:
    script = project(tmp_path / "project", "cell.arm:Move", "camera:Look")
    folder = script.parent / output
    assert main(["build", str(script), "--target", "python", "-o", str(folder)]) == 0
    assert main(["build", str(script), "--target", "python", "-o", str(folder), "--check"]) == 0
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    for words in ([str(folder / "mission.py")], [f"../project/{output}/mission.py"]):
        ended = start(elsewhere, "-W", "error", *words)
        assert ended.returncode == 0, ended.stderr
        assert ended.stdout.endswith("outcome: done\n")


def test_a_copy_names_the_folders_that_it_searched(tmp_path: Path) -> None:
    script = project(tmp_path / "project", "cell.arm:Move")
    copies = tmp_path / "copies"
    assert main(["build", str(script), "--target", "python", "-o", str(copies)]) == 0
    ended = start(tmp_path, str(copies / "mission.py"))
    assert ended.returncode == 1
    assert ended.stdout == ""
    first, second, *_, last = ended.stderr.splitlines()
    assert first == "No module named 'cell'; it was searched in these folders:"
    assert second == f"  {copies}"
    assert last == "Add the folder that contains it to PYTHONPATH."
    (copies / "cell").mkdir()
    ended = start(tmp_path, str(copies / "mission.py"))
    assert ended.stderr.startswith("No module named 'cell.arm'; it was")


def test_a_program_in_a_package_is_imported_as_usual(tmp_path: Path) -> None:
    script = project(tmp_path / "work", "cells.arm:Move")
    package = tmp_path / "work" / "package"
    assert main(["build", str(script), "--target", "python", "-o", str(package)]) == 0
    ended = start(tmp_path / "work", "-c", "from package import mission; print(mission.main())")
    assert ended.stdout.endswith("\ndone\n"), ended.stderr
    (tmp_path / "work" / "cells" / "arm.py").unlink()
    ended = start(tmp_path / "work", "-c", "from package import mission")
    assert ended.stderr.endswith("ModuleNotFoundError: No module named 'cells.arm'\n")


def test_a_module_that_the_users_module_lacks_is_its_own_error(tmp_path: Path) -> None:
    script = project(tmp_path, "cell.arm:Move", imports="import not_installed")
    assert main(["build", str(script), "--target", "python", "-o", str(tmp_path)]) == 0
    ended = start(tmp_path, "mission.py")
    assert ended.returncode == 1
    assert 'arm.py", line 1, in <module>' in ended.stderr
    assert ended.stderr.endswith("ModuleNotFoundError: No module named 'not_installed'\n")


def test_the_text_is_as_a_formatter_leaves_it(tmp_path: Path) -> None:
    classes = [f"a_package_of_states.module_with_a_long_name_{k}:State{k}" for k in range(6)]
    script = project(tmp_path, *classes, "b:B")
    assert main(["build", str(script), "--target", "python", "-o", str(tmp_path / "out")]) == 0
    for tool in (["check"], ["format", "--check"]):
        ended = subprocess.run(
            [sys.executable, "-m", "ruff", *tool, "--isolated", "--no-cache", "--line-length=99",
             "mission.py"],
            cwd=tmp_path / "out", capture_output=True, text=True, timeout=120, check=False,
        )  # fmt: skip
        assert ended.returncode == 0, ended.stdout


@pytest.mark.parametrize("words", [["run", "-q"], ["verify"]], ids=" ".join)
def test_modules_in_the_code_folders_of_the_project_are_found(
    words: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "src").mkdir()
    (tmp_path / "missions" / "templates").mkdir(parents=True)
    (tmp_path / "smachac.toml").write_text('code = ["src"]\n', "utf-8")
    (tmp_path / "src" / "own_states.py").write_text(CLASS.format(name="Look", imports=""), "utf-8")
    (tmp_path / "missions" / "templates" / "Look.yml").write_text(
        'name: Look\noutcomes: {done: {}}\ncode: {python: "own_states:Look"}\n', "utf-8"
    )
    script = tmp_path / "missions" / "main.yml"
    script.write_text("name: sm\noutcomes: [done]\nstates:\n  - LOOK: {template: Look}\n", "utf-8")
    monkeypatch.chdir(tmp_path)
    assert main([words[0], str(script), *words[1:]]) == 0
