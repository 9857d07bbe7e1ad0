"""The example of a stepped machine: a control loop on Linux, and a firmware in QEMU."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from smachac.commands.cli import main
from tests.cpp import cortex
from tests.cpp.compilers import BARE, WARNINGS, compilers


def generated(folder: Path) -> str:
    script = str(cortex.EXAMPLE / "grip.yml")
    options = ["--option", "mode=step", "-o", str(folder)]
    assert main(["build", script, "--target", "cpp", *options]) == 0
    return f"-I{folder}"


@pytest.mark.slow
def test_the_loop_ends_with_an_outcome(tmp_path: Path) -> None:
    if not compilers():
        pytest.skip("no C++ compiler")
    include, program = generated(tmp_path / "generated"), tmp_path / "loop"
    call = [*compilers()[0].command, "-std=c++17", "-O2", *BARE, *WARNINGS, include]
    call += [
        f"-I{cortex.EXAMPLE / 'include'}",
        str(cortex.EXAMPLE / "loop.cpp"),
        "-o",
        str(program),
    ]
    subprocess.run(call, check=True)
    ran = subprocess.run([str(program)], capture_output=True, text=True, check=True)
    assert re.search(r"\d+ steps: held, width 0\.0\d+ m", ran.stdout)
    assert "periods that began late by" in ran.stdout


def test_the_firmware_runs(tmp_path: Path) -> None:
    include = generated(tmp_path / "generated")
    text = (cortex.EXAMPLE / "firmware.cpp").read_text("utf-8")
    program = cortex.compiled(text, tmp_path, include, f"-I{cortex.EXAMPLE / 'include'}")
    printed = cortex.run(program)
    assert '"event": "finish", "path": "grip", "outcome": "held"' in printed
    flash, ram = cortex.sizes(program)
    print(f"flash {flash} bytes, RAM {ram} bytes")
    assert flash < 12_000
    assert ram < 1_000
