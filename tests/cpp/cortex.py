"""Programs for a Cortex-M4, freestanding, and their runs in QEMU."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from smachac.verify.players.cpp import HEADERS
from tests.cpp.compilers import BARE, WARNINGS

NAME = "arm-none-eabi-g++"
QEMU = "qemu-system-arm"
EXAMPLE = Path(__file__).parents[2] / "examples" / "cpp_control_loop"
BOARD = EXAMPLE / "board"
FLAGS = (
    *("-std=c++17", "-mcpu=cortex-m4", "-mthumb", "-Os", "-ffreestanding", *BARE),
    *("-fno-threadsafe-statics", "-fno-use-cxa-atexit", "-fno-tree-loop-distribute-patterns"),
    *("-ffunction-sections", "-fdata-sections"),
)
LINK = ("-nostdlib", f"-Wl,--gc-sections,-T{BOARD / 'memory.ld'}")


def compiled(text: str, folder: Path, *flags: str) -> Path:
    """The program of a translation unit with the start of the board."""
    if shutil.which(NAME) is None:
        pytest.skip(f"no {NAME}")
    source, program = folder / "main.cpp", folder / "program.elf"
    source.write_text(text, "utf-8")
    call = [NAME, *FLAGS, *WARNINGS, f"-I{HEADERS}", *flags]
    call += [str(source), str(BOARD / "start.cpp"), *LINK, "-lgcc", "-o", str(program)]
    run = subprocess.run(call, capture_output=True, text=True, timeout=600, check=False)
    assert run.returncode == 0, run.stderr[:6000]
    return program


def sizes(program: Path) -> tuple[int, int]:
    """The bytes of flash and RAM of a program."""
    listed = subprocess.run(
        ["arm-none-eabi-size", str(program)], capture_output=True, text=True, check=True
    )
    code, data, zero = map(int, listed.stdout.splitlines()[1].split()[:3])
    return code + data, data + zero


def run(program: Path) -> str:
    """What a program prints in QEMU; fails where its exit code is not 0."""
    if shutil.which(QEMU) is None:
        pytest.skip(f"no {QEMU}")
    call = [QEMU, "-M", "mps2-an386", "-nographic", "-monitor", "none", "-serial", "none"]
    call += ["-semihosting-config", "enable=on,target=native", "-kernel", str(program)]
    ended = subprocess.run(call, capture_output=True, text=True, timeout=300, check=False)
    assert ended.returncode == 0, ended.stderr[-2000:] + ended.stdout[-2000:]
    return ended.stdout + ended.stderr
