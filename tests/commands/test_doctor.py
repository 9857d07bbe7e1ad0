"""`smachac doctor` and `smachac completion`."""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path

import pytest

from smachac.commands import doctor
from smachac.commands.cli import COMMANDS, main

ROOT = Path(__file__).parents[2]


def test_what_is_installed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["doctor"]) == 0
    shown = capsys.readouterr().out
    assert re.search(r"^  networkx +\d+\.\d+", shown, re.MULTILINE)
    assert main(["doctor", "--format", "json"]) == 0
    parts = {part["name"]: part for part in json.loads(capsys.readouterr().out)["parts"]}
    assert parts["lark"]["found"]
    assert parts["g++"]["found"] in ("g++", "clang++", "c++")


def test_a_missing_package_is_named_with_its_remedy(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    missing = ("no_such_module", "nothing", "a test", "pip install nothing", True)
    monkeypatch.setattr(doctor, "MODULES", (missing,))
    assert main(["doctor"]) == 1
    shown = capsys.readouterr()
    assert re.search(r"^  nothing +missing +a test: pip install nothing$", shown.out, re.MULTILINE)
    assert shown.err == "\nsmachac cannot work without nothing\n"


def test_the_required_packages_are_those_of_the_project() -> None:
    text = (ROOT / "pyproject.toml").read_text("utf-8")
    stated = re.search(r"^dependencies = \[\n(.*?)^\]", text, re.MULTILINE | re.DOTALL)
    assert stated is not None
    names = {name.lower() for name in re.findall(r'^    "([\w.-]+)', stated[1], re.MULTILINE)}
    required = {name.lower() for _, name, *_, needed in doctor.MODULES if needed}
    assert required == names - {"tomli"}


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completions_have_every_command_and_its_options(
    shell: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["completion", shell]) == 0
    script = capsys.readouterr().out
    assert all(command in script for command in COMMANDS)
    assert "--schedule" in script or "-l schedule" in script


def test_bash_completes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["completion", "bash"]) == 0
    (tmp_path / "smachac.bash").write_text(capsys.readouterr().out, "utf-8")
    (tmp_path / "main.yml").write_text("", "utf-8")
    typed = (
        "source ./smachac.bash\n"
        'COMP_WORDS=(smachac "$@"); COMP_CWORD=$#; _shtab_smachac; echo "${COMPREPLY[@]}"\n'
    )

    def completed(*words: str) -> list[str]:
        command = ["bash", "-c", typed, "bash", *words]
        ended = subprocess.run(
            command, cwd=tmp_path, capture_output=True, text=True, timeout=60, check=True
        )
        return ended.stdout.split()

    assert completed("ver") == ["verify"]
    assert completed("run", "--sch") == ["--schedule"]
    assert "main.yml" in completed("check", "ma")
