"""The names of built-in state types stand in the modules that implement them, and nowhere else."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import smachac

PACKAGE = Path(smachac.__file__).parent

ALLOWED = {
    "interpreter/behaviours.py": "their behaviour in the interpreter",
    "targets/cpp/builtin_states.py": "their code in C++",
    "targets/scxml/leaves.py": "their states in SCXML",
    "frontend/resolved_script.py": "the timer, which sugar adds to a machine",
    "pysource/machines/yasmin_library.py": "the classes of yasmin_ros of the same names",
    "refactor/imports/scripts.py": "the base of a machine that is a ROS node",
    "refactor/imports/state_types.py": "the types for classes of smach_ros",
    "refactor/smacha/template_differences.py": "the templates that templates of SMACHA extend",
}

NAMES = {path.stem for path in PACKAGE.joinpath("stdlib").glob("*.yml")} - {"Base"}
"""All built-in types but `Base`, the word of the language for a script without a base."""


def test_no_module_names_a_built_in_state_type() -> None:
    assert len(NAMES) > 20
    naming = set()
    for path in PACKAGE.rglob("*.py"):
        if path.name.endswith(".tpl.py") or "runtime" in path.parts:
            continue
        tree = ast.parse(path.read_text("utf-8"))
        if any(isinstance(node, ast.Constant) and node.value in NAMES for node in ast.walk(tree)):
            naming.add(path.relative_to(PACKAGE).as_posix())
    assert naming == set(ALLOWED)


def test_each_built_in_state_type_is_in_the_docs() -> None:
    pages = [PACKAGE.parent / "docs" / f"{name}.md" for name in ("state_types", "migrating")]
    words = set(re.findall(r"\w+", "".join(page.read_text("utf-8") for page in pages)))
    assert NAMES - words == set()
