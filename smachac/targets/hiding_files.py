"""Generated files whose names hide what programs import: SM611."""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator, Mapping
from pathlib import PurePosixPath
from unicodedata import normalize

from smachac.diagnostics.diagnostic import Diagnostic
from smachac.ir.nodes import Machine
from smachac.ir.python_code import parse_module
from smachac.pysource.modules.ros_names import MESSAGES, ROS_VERSIONS, importable
from smachac.targets import stem
from smachac.targets.errors import hiding_file

_COMMON = {
    "smachac",
    *(name.partition(".")[0] for ros in ROS_VERSIONS for name in importable(ros) if name.islower()),
    *(name.partition(".")[0] for name in MESSAGES),
}
"""The modules of SMACH and ROS that programs import, or modules that they import."""


_APART = {"chunk", "pipes", "turtle", "wave"}
"""Words for tasks, and modules of the standard library for sound and drawing: no program imports
them without naming them."""


def hiding_files(files: Mapping[str, str], machine: Machine) -> Iterator[Diagnostic]:
    """The files that hide a module of Python, each with another name."""
    for file, text in files.items():
        path = PurePosixPath(file)
        hidden = _hidden_module(path, text, files) if path.suffix == ".py" else ""
        if hidden:
            yield hiding_file(machine.root.span, file, hidden, stem(machine))


def _hidden_module(path: PurePosixPath, text: str, files: Mapping[str, str]) -> str:
    """The module that a file hides; empty if it hides none. A file of a package is imported by the
    name of the package, and its program may import the package."""
    known = [*(sys.stdlib_module_names - _APART), *_COMMON]
    if str(path.parent / "__init__.py") in files:
        if path.name != "__init__.py":
            return ""
        path = path.parent
    elif _can_import(text, path.stem):
        known += _imported(text)
    modules = {text.casefold(): text for text in known}
    return modules.get(path.stem.casefold(), "")


def _can_import(text: str, name: str) -> bool:
    """Whether a line with an import has a word: to read a long program takes a second."""
    word = re.compile(rf"\b{re.escape(name.casefold())}\b")
    lines = normalize("NFKC", text).casefold().replace("\\\n", " ").split("\n")
    return any("import" in line and word.search(line) is not None for line in lines)


def _imported(text: str) -> Iterator[str]:
    """The outermost names of the modules that a program imports; none of one that is too deep to be
    read."""
    try:
        tree = parse_module(text)
    except SyntaxError:
        return
    for node in ast.walk(tree):
        match node:
            case ast.Import(names=names):
                yield from (name.name.partition(".")[0] for name in names)
            case ast.ImportFrom(module=str(module), level=0):
                yield module.partition(".")[0]
