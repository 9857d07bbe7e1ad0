"""The headers compile for a microcontroller: GCC over Newlib, whose library has no threads."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from smachac.verify.players.cpp import HEADERS
from tests.cpp.compilers import WARNINGS
from tests.cpp.test_user_classes import made
from tests.support.examples import every

NAME = "arm-none-eabi-g++"
ROOT = Path(__file__).parents[2]


def problems(text: str, folder: Path, *flags: str) -> str:
    """The messages of the compiler for a translation unit."""
    if shutil.which(NAME) is None:
        pytest.skip(f"no {NAME}")
    source = folder / "main.cpp"
    source.write_text(text, "utf-8")
    call = [NAME, "-std=c++17", "-mcpu=cortex-m7", *WARNINGS, *flags, f"-I{HEADERS}"]
    call += ["-fsyntax-only", str(source)]
    return subprocess.run(call, capture_output=True, text=True, check=False).stderr


@pytest.mark.parametrize("bare", every(2, [("-fno-exceptions", "-fno-rtti"), ()]), ids=["bare", ""])
def test_the_headers_compile(bare: tuple[str, ...], tmp_path: Path) -> None:
    assert problems('#include "smachac/arm.hpp"\n', tmp_path, *bare) == ""


@pytest.mark.parametrize("example", ["05_userdata", "06_callbacks", "07_iterator"])
@pytest.mark.slow
def test_machines_compile(example: str, tmp_path: Path) -> None:
    folder = ROOT / "tests" / "cases" / "examples" / example / "expected" / "cpp"
    (header,) = folder.glob("*.hpp")
    assert problems(f'#include "{header}"\n', tmp_path) == ""


CONCURRENCE = """
name: sm
outcomes: [done]
states:
  - BOTH:
      template: Concurrence
      outcomes: [done]
      default_outcome: done
      outcome_map: {done: {A: done, B: done}}
      states:
        - A: {template: ScriptedState, outcomes: [done]}
        - B: {template: ScriptedState, outcomes: [done]}
"""


@pytest.mark.slow
def test_a_concurrence_is_refused_with_the_reason(tmp_path: Path) -> None:
    report, header = made({"main.yml": CONCURRENCE})
    assert report == []
    text = header.replace("#pragma once\n", "")
    assert "a concurrence needs the threads of the standard library" in problems(text, tmp_path)
