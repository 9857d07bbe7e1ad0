"""The files for pre-commit and GitHub, and the snippets of docs/ci.md: valid, and tried out."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import zipfile
from importlib.resources import files
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from smachac.robots.files import plain

ROOT = Path(__file__).parents[2]
BROKEN = (
    "name: sm\ntemplate: Base\noutcomes: [done]\nstates:\n"
    "  - A: {template: ScriptedState, outcomes: [ok], transitions: {ok: doen}}\n"
)
RIGHT = BROKEN.replace("doen", "done")


def load(text: str) -> Any:
    return plain(text)


def snippets() -> dict[str, Any]:
    """The YAML of docs/ci.md by the heading above it."""
    text = (ROOT / "docs" / "ci.md").read_text("utf-8")
    sections = re.split(r"^## (.*)$", text, flags=re.M)
    found = {}
    for title, section in zip(sections[1::2], sections[2::2], strict=True):
        for block in re.findall(r"^```yaml\n(.*?)^```", section, re.M | re.S):
            found[title] = load(block)
    return found


def faults(data: Any, schema: str) -> list[str]:
    """What a public schema, as the package check-jsonschema carries it, says against data."""
    folder = files("check_jsonschema.builtin_schemas.vendor")
    rules = json.loads(folder.joinpath(f"{schema}.json").read_text("utf-8"))
    return [error.message for error in jsonschema.Draft7Validator(rules).iter_errors(data)]


def test_files_and_snippets_fit_their_schemas() -> None:
    action = load((ROOT / "action.yml").read_text("utf-8"))
    assert faults(action, "github-actions") == []
    assert faults(action | {"runs": {}}, "github-actions") != []
    found = snippets()
    workflow = found["GitHub"]
    workflow["on"] = workflow.pop(True, workflow.get("on"))
    assert faults(workflow, "github-workflows") == []
    assert faults(found["GitLab"], "gitlab-ci") == []
    compare = found["What a pull request changes"]
    compare["on"] = compare.pop(True, compare.get("on"))
    assert faults(compare, "github-workflows") == []
    assert set(compare["jobs"]["diff"]["steps"][1]["with"]) <= set(action["inputs"])
    uses = workflow["jobs"]["check"]["steps"][1]
    assert set(uses["with"]) <= set(action["inputs"])


def installed(folder: Path) -> Path:
    """The program `smachac` as pip installs it: a script of Python that imports the package."""
    program = folder / "bin" / "smachac"
    program.parent.mkdir()
    # As pip writes it where the path of the interpreter has a space, which `#!` cannot hold.
    lines = ["#!/bin/sh", f'\'\'\'exec\' "{sys.executable}" "$0" "$@"', "' '''"]
    lines += ["import sys", "from smachac.commands.cli import main", "sys.exit(main())", ""]
    program.write_text("\n".join(lines))
    program.chmod(0o755)
    return program


def commands(folder: Path) -> dict[str, str]:
    """An environment in which `smachac` is what is tested here."""
    program = installed(folder)
    path = f"{program.parent}{os.pathsep}{os.environ['PATH']}"
    return {**os.environ, "PATH": path, "PYTHONPATH": str(ROOT)}


def checked(text: str, **inputs: str) -> dict[str, str]:
    """The environment of the step `Check`, its expressions filled in."""
    names = {
        "paths": ".",
        "arguments": "",
        "sarif": "",
        "diff": "",
        "base": "",
        "python": "false",
    } | inputs
    return {
        name: re.sub(r"\$\{\{ inputs\.(\w+) \}\}", lambda found: names[found[1]], value)
        for name, value in load(text)["runs"]["steps"][1]["env"].items()
    }


@pytest.mark.parametrize(
    ("script", "inputs", "ended"),
    [
        (BROKEN, {}, 1),
        (RIGHT, {}, 0),
        (BROKEN, {"paths": "*.yml"}, 1),
        (BROKEN, {"paths": "main.yml nothing*.yml"}, 2),
        (RIGHT.replace("[done]", "[done, x]"), {"arguments": "--strict --ignore SM1"}, 1),
    ],
)
def test_the_step_of_the_action(
    script: str, inputs: dict[str, str], ended: int, tmp_path: Path
) -> None:
    text = (ROOT / "action.yml").read_text("utf-8")
    (tmp_path / "main.yml").write_text(script)
    done = subprocess.run(
        ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c",
         load(text)["runs"]["steps"][1]["run"]],
        cwd=tmp_path,
        env={**commands(tmp_path), **checked(text, sarif="my report.sarif", **inputs),
             "SMACHAC": str(tmp_path / "bin" / "smachac")},
        capture_output=True, text=True, check=False, timeout=120,
    )  # fmt: skip
    assert done.returncode == ended, done.stderr
    if ended != 2:
        report = json.loads((tmp_path / "my report.sarif").read_text())
        assert bool(report["runs"][0]["results"]) == bool(ended)
        assert ("file=main.yml,line=" in done.stdout) == bool(ended)


MACHINE = (
    "import smach\nsm = smach.StateMachine(outcomes=['done'])\n"
    "with sm: sm.add('A', smach.State(outcomes=['ok']), {'ok': 'dnoe'})\n"
)


@pytest.mark.parametrize(("python", "ended"), [("true", 1), ("false", 0)])
def test_the_action_checks_python(python: str, ended: int, tmp_path: Path) -> None:
    (tmp_path / "main.yml").write_text(RIGHT)
    (tmp_path / "machine.py").write_text(MACHINE)
    text = (ROOT / "action.yml").read_text("utf-8")
    environment = {**commands(tmp_path), "SMACHAC": str(tmp_path / "bin" / "smachac")}
    code, output = run_step(1, tmp_path, environment | checked(text, python=python))
    assert code == ended, output
    assert ("file=machine.py,line=3" in output) == bool(ended)


@pytest.mark.parametrize("suffix", ["py", "yml"])
def test_the_hook_for_python(suffix: str, tmp_path: Path) -> None:
    hooks = {hook["id"]: hook for hook in load((ROOT / ".pre-commit-hooks.yaml").read_text())}
    hook = hooks["smachac-check-python"]
    assert re.search(hook["files"], f"src/machine.{suffix}")
    (tmp_path / "machine.py").write_text(MACHINE)
    done = subprocess.run(
        [*hook["entry"].split(), *hook["args"]], cwd=tmp_path, env=commands(tmp_path),
        capture_output=True, text=True, check=False, timeout=120,
    )  # fmt: skip
    assert (done.returncode, "machine.py:3" in done.stdout) == (1, True), done.stderr


@pytest.mark.slow
def test_the_action_writes_the_differences(tmp_path: Path) -> None:
    script = tmp_path / "main.yml"
    script.write_text(RIGHT)
    environment = {**commands(tmp_path), "SMACHAC": str(tmp_path / "bin" / "smachac")}
    environment |= {f"GIT_{who}_{what}": "x" for who in ("AUTHOR", "COMMITTER")
                    for what in ("NAME", "EMAIL")}  # fmt: skip
    for words in (["init", "-q"], ["add", "main.yml"], ["commit", "-qm", "x"]):
        subprocess.run(["git", *words], cwd=tmp_path, env=environment, check=True)
    text = (ROOT / "action.yml").read_text("utf-8")
    environment |= checked(text, paths="main.yml", diff="my diff.md", base="HEAD")
    for written, ended, found in (
        (RIGHT, 0, "No difference"),
        (RIGHT.replace("A:", "B:"), 0, "1 state renamed"),
        (BROKEN, 1, "1 transition changed"),
        ("name: [", 1, "cannot be read"),
    ):
        script.write_text(written)
        code, output = run_step(1, tmp_path, environment)
        assert code == ended, output
        assert found in (tmp_path / "my diff.md").read_text("utf-8")
    code, output = run_step(1, tmp_path, environment | {"BASE": "nothing"})
    assert (code, "git has no revision `nothing`" in output) == (2, True)


PASSES = "print('bypassed')\nraise SystemExit(0)\n"
"""A module of a hostile repository: it ends the program that imports it with success."""


def make_hostile(folder: Path) -> None:
    """A repository with an error in its script and modules of the names that a check imports."""
    folder.mkdir()
    (folder / "main.yml").write_text(BROKEN)
    for name in ("argparse", "json", "re", "venv", "pip", "yaml", "sitecustomize", "typing"):
        (folder / f"{name}.py").write_text(PASSES)
    for package in ("smachac", "smachac/commands"):
        (folder / package).mkdir()
        for name in ("__init__", "__main__", "cli"):
            (folder / package / f"{name}.py").write_text(PASSES)


def run_step(number: int, repository: Path, environment: dict[str, str]) -> tuple[int, str]:
    """The exit code and output of a step of the action in a repository."""
    text = load((ROOT / "action.yml").read_text("utf-8"))["runs"]["steps"][number]["run"]
    done = subprocess.run(
        ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", text],
        cwd=repository, env=environment, capture_output=True, text=True, check=False, timeout=300,
    )  # fmt: skip
    return done.returncode, done.stdout + done.stderr


def test_a_hostile_repository_does_not_pass_the_check(tmp_path: Path) -> None:
    make_hostile(tmp_path / "repository")
    environment = {
        **commands(tmp_path),
        **checked((ROOT / "action.yml").read_text("utf-8")),
        "SMACHAC": str(tmp_path / "bin" / "smachac"),
    }
    code, output = run_step(1, tmp_path / "repository", environment)
    assert (code, "bypassed" in output) == (1, False), output
    assert "SM101" in output


def test_no_step_of_the_action_imports_modules_of_the_repository() -> None:
    text = (ROOT / "action.yml").read_text("utf-8")
    runs = re.findall(r"-m \w+", text)
    assert len(runs) == text.count("-I -m ") == 2


@pytest.mark.slow
def test_a_hostile_repository_does_not_take_part_in_the_installation(tmp_path: Path) -> None:
    make_hostile(tmp_path / "repository")
    wheel = tmp_path / "smachac-0-py3-none-any.whl"
    with zipfile.ZipFile(wheel, "w") as archive:
        archive.writestr("smachac/__init__.py", "def main():\n    print('installed')\n")
        folder = "smachac-0.dist-info"
        archive.writestr(f"{folder}/METADATA", "Metadata-Version: 2.1\nName: smachac\nVersion: 0\n")
        tag = "Root-Is-Purelib: true\nTag: py3-none-any\n"
        archive.writestr(f"{folder}/WHEEL", f"Wheel-Version: 1.0\nGenerator: test\n{tag}")
        points = "[console_scripts]\nsmachac = smachac:main\n"
        archive.writestr(f"{folder}/entry_points.txt", points)
        archive.writestr(f"{folder}/RECORD", "")
    variables = tmp_path / "variables"
    environment = {
        **os.environ,
        "ACTION": str(wheel),
        "RUNNER_TEMP": str(tmp_path / "runner"),
        "GITHUB_ENV": str(variables),
        "PIP_NO_INDEX": "1",
    }
    code, output = run_step(0, tmp_path / "repository", environment)
    assert (code, "bypassed" in output) == (0, False), output
    name, _, program = variables.read_text().strip().partition("=")
    assert name == "SMACHAC"
    environment.pop("PYTHONPATH", None)
    done = subprocess.run([program], cwd=tmp_path / "repository", env=environment,
                          capture_output=True, text=True, check=False, timeout=60)  # fmt: skip
    assert done.stdout == "installed\n", done.stderr


def test_the_script_of_gitlab(tmp_path: Path) -> None:
    (tmp_path / "main.yml").write_text(BROKEN)
    install, check = snippets()["GitLab"]["smachac"]["script"]
    assert install.startswith("pip install ")
    done = subprocess.run(
        ["bash", "-ec", check], cwd=tmp_path, env=commands(tmp_path), check=False, timeout=120
    )
    assert done.returncode == 1
    assert "SM101" in (tmp_path / "smachac.xml").read_text()


@pytest.mark.slow
def test_the_hook_runs_when_it_has_to(tmp_path: Path) -> None:
    hook, *_ = load((ROOT / ".pre-commit-hooks.yaml").read_text("utf-8"))
    home = {"PRE_COMMIT_HOME": str(tmp_path / "home"), "HOME": str(tmp_path)}
    environment = {**commands(tmp_path), **home}
    environment |= {
        f"GIT_{who}_{what}": "x" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")
    }
    pre_commit = [sys.executable, "-m", "pre_commit"]

    def run(*words: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(words, cwd=tmp_path / "repo", env=environment, capture_output=True,
                              text=True, check=False, timeout=120)  # fmt: skip

    (tmp_path / "repo" / "scripts").mkdir(parents=True)
    assert run("git", "init", "-q").returncode == 0
    manifest = run(*pre_commit, "validate-manifest", str(ROOT / ".pre-commit-hooks.yaml"))
    assert manifest.returncode == 0, manifest.stdout
    # As a local hook it finds the program in the path, and installs nothing.
    local = {"repos": [{"repo": "local", "hooks": [hook | {"language": "system"}]}]}
    (tmp_path / "repo" / ".pre-commit-config.yaml").write_text(json.dumps(local))
    (tmp_path / "repo" / "notes.txt").write_text("x")
    assert run("git", "add", ".").returncode == 0
    assert run(*pre_commit, "run", "--files", "notes.txt").stdout.count("Skipped") == 1
    for text, ended in ((RIGHT, 0), (BROKEN, 1)):
        (tmp_path / "repo" / "scripts" / "main.yml").write_text(text)
        assert run("git", "add", ".").returncode == 0
        done = run(*pre_commit, "run")
        assert done.returncode == ended, done.stdout
        assert ("did you mean `done`?" in done.stdout) == bool(ended)
