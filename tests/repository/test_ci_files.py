"""The files for pre-commit and GitHub, and the snippets of docs/ci.md: valid, and tried out."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from importlib.resources import files
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from ruamel.yaml import YAML

ROOT = Path(__file__).parents[2]
BROKEN = (
    "name: sm\ntemplate: Base\noutcomes: [done]\nstates:\n"
    "  - A: {template: ScriptedState, outcomes: [ok], transitions: {ok: doen}}\n"
)
RIGHT = BROKEN.replace("doen", "done")


def load(text: str) -> Any:
    return YAML(typ="safe", pure=True).load(text)


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
    uses = workflow["jobs"]["check"]["steps"][1]
    assert set(uses["with"]) <= set(action["inputs"])


def commands(folder: Path) -> dict[str, str]:
    """An environment in which `smachac` is what is tested here."""
    program = folder / "bin" / "smachac"
    program.parent.mkdir()
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m smachac "$@"\n')
    program.chmod(0o755)
    path = f"{program.parent}{os.pathsep}{os.environ['PATH']}"
    return {**os.environ, "PATH": path, "PYTHONPATH": str(ROOT)}


def checked(text: str, **inputs: str) -> dict[str, str]:
    """The environment of the step `Check`, its expressions filled in."""
    names = {"paths": ".", "arguments": "", "sarif": ""} | inputs
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
             "SMACHAC_PYTHON": sys.executable},
        capture_output=True, text=True, check=False, timeout=120,
    )  # fmt: skip
    assert done.returncode == ended, done.stderr
    if ended != 2:
        report = json.loads((tmp_path / "my report.sarif").read_text())
        assert bool(report["runs"][0]["results"]) == bool(ended)
        assert ("file=main.yml,line=" in done.stdout) == bool(ended)


def test_the_script_of_gitlab(tmp_path: Path) -> None:
    (tmp_path / "main.yml").write_text(BROKEN)
    install, check = snippets()["GitLab"]["smachac"]["script"]
    assert install.startswith("pip install ")
    done = subprocess.run(
        ["bash", "-ec", check], cwd=tmp_path, env=commands(tmp_path), check=False, timeout=120
    )
    assert done.returncode == 1
    assert "SM101" in (tmp_path / "smachac.xml").read_text()


def test_the_hook_runs_when_it_has_to(tmp_path: Path) -> None:
    hook, _ = load((ROOT / ".pre-commit-hooks.yaml").read_text("utf-8"))
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
