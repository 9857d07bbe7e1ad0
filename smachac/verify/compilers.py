"""The C++ compilers of this machine."""

from __future__ import annotations

import functools
import importlib.util
import shutil
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import smachac

HEADERS = Path(smachac.__file__).parent / "runtime" / "cpp"
"""The folder that holds smachac/*.hpp."""


class Compiler(NamedTuple):
    """A compiler by its kind, `g++` or `clang++`, and how it is called."""

    name: str
    command: tuple[str, ...]


@functools.cache
def compilers() -> tuple[Compiler, ...]:
    """`g++` and `clang++`, one of each, where they are; else the one in the package `ziglang`."""
    versions = [f"clang++-{number}" for number in range(22, 11, -1)]
    found = [*_first("g++", ["g++"]), *_first("clang++", ["clang++", *versions])]
    if not found and importlib.util.find_spec("ziglang"):
        found = [Compiler("clang++", (sys.executable, "-m", "ziglang", "c++"))]
    return tuple(found)


def _first(kind: str, names: Sequence[str]) -> list[Compiler]:
    found = next(filter(None, map(shutil.which, names)), None)
    return [Compiler(kind, (found,))] if found else []
