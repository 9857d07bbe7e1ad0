"""smachac/grammars/standalone is what scripts/parsers.py writes, and needs no package."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "smachac" / "grammars" / "standalone"


@pytest.mark.parametrize("seed", ["1", "2"])
def test_the_parsers_are_those_of_the_grammars(seed: str, tmp_path: Path) -> None:
    """A new generation has the same bytes, whatever the order of sets is."""
    script = ROOT / "scripts" / "parsers.py"
    environment = {**os.environ, "PYTHONHASHSEED": seed}
    subprocess.run([sys.executable, script, tmp_path], env=environment, check=True, timeout=300)
    made = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    assert set(made) == {path.name for path in FOLDER.glob("*.py")} - {"__init__.py"}
    for name, text in made.items():
        assert text == (FOLDER / name).read_bytes(), f"{name}: run scripts/parsers.py"


SCRIPT = """\
name: m
template: Base
outcomes: [done]
properties:
- never: {after: "A:succeeded", enter: A}
userdata: {x: {type: "list[int]", value: [1]}}
states:
- A:
    template: CallbacksState
    input_keys: [x]
    output_keys: [x]
    callbacks: {x: "lambda ud: ud.x + [2]"}
    transitions: {succeeded: done}
"""
"""A script with a property, a type and an expression."""


@pytest.mark.parametrize(
    "package",
    [
        "raise ImportError('broken')",  # what is left where two packages write the same files
        "from sre_parse_of_no_python import x",
        "Lark = LarkError = UnexpectedInput = None",
        "import sys; sys.exit('imported')",
    ],
)
def test_a_broken_package_lark_does_no_harm(package: str, tmp_path: Path) -> None:
    """ROS 2 from PyPI brings lark-parser, which overwrites files of the package lark."""
    (tmp_path / "lark").mkdir()
    (tmp_path / "lark" / "__init__.py").write_text(package)
    (tmp_path / "main.yml").write_text(SCRIPT)
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), str(ROOT)])}
    command = [sys.executable, "-m", "smachac", "check", "main.yml"]
    done = subprocess.run(
        command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=120
    )
    assert (done.stdout, done.stderr) == ("no findings\n", "")
