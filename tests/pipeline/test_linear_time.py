"""Small texts that regular expressions could take quadratic time for: none takes long.

Each text is given to a child process with a limit on its processor time. The limit is far above
the need, and far below what the same text took with a quadratic pattern.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

import pytest
from _pytest.mark import ParameterSet

SECONDS = 10
"""The processor time of a child process; the start of the program takes about 1 s of it."""

CHILD = """
import resource, sys
resource.setrlimit(resource.RLIMIT_CPU, (int(sys.argv[1]), int(sys.argv[1])))
from smachac.commands.cli import main
sys.exit(max(main(command.split()) for command in sys.argv[2:]))
"""

COMMANDS = ("check main.yml", "build --target python main.yml", "migrate .")

MAIN = """\
name: sm
template: Base
outcomes: [done]
states:
  - A: {template: Own, outcomes: [done], transitions: {done: done}}
"""

STATE = "class Own(smach.State):\n    def execute(self, userdata):\n        return 'done'\n"

TEMPLATES = {
    "expressions that do not end": "{{" * 25_000,
    "statements that do not end": "{%" * 25_000,
    "comments that do not end": "{#" * 25_000,
    "extends that do not end": '{% extends "' * 4_000,
    "includes that do not end": "{% include '" * 4_000,
    "meta blocks that do not end": "{% block meta %}" * 3_000,
    "a tag of spaces": "{%" + " " * 50_000 + "x %}",
    "outcomes that do not end": "outcomes=[" * 5_000,
    "words before uuid": "{{ x" * 10_000 + " uuid",
    "blank lines": "\n" * 50_000 + "x",
    "print with spaces": "{% block class_defs %}\nprint x" + " " * 50_000 + "y\n{% endblock %}",
    "raise with spaces": "{% block class_defs %}\nraise A, x" + " " * 50_000 + "y\n{% endblock %}",
    "lines of spaces": "{% block class_defs %}\n'''" + " " * 50_000 + "x'''\n{% endblock %}",
}

SCRIPTS = {
    "a doc of spaces": MAIN.replace("template: Base", f"template: Base\ndoc: 'a{' ' * 50_000}b'"),
    "parentheses": MAIN.replace("outcomes: [done], t", f"x: '{'(' * 50_000}', outcomes: [done], t"),
    "nested lists": MAIN + f"params: {{x: {'[' * 3_000}{']' * 3_000}}}\n",
    "comments": MAIN + "# smachac: allow " * 3_000,
    "dots": MAIN.replace("outcomes: [done], t", f"x: {'a.' * 25_000}1, outcomes: [done], t"),
}

SETTINGS = {
    "a long key": "a" * 200_000 + " = 1\n",
    "a key of many parts": "a." * 100_000 + "a = 1\n",
    "a code of many letters": '[severity]\n"' + "S" * 200_000 + '" = "off"\n',
}

HEADERS = {
    "classes": "class Own " * 5_000,
    "outcomes": "class Own {\n" + "enum class Outcome " * 2_500,
    "spaces": "class Own {\nstatic constexpr int smachac_interface = 1" + " " * 50_000 + "x};",
    "quotes": "class Own {" + "'\\" * 25_000,
}

INTERFACE = "outcomes: {done: {}}\ncode: {python: Own.tpl.py, cpp: {header: own.hpp, class: Own}}\n"


def first_quick(texts: Iterable[str]) -> list[ParameterSet]:
    """All texts; those after the third are slow tests."""
    return [
        pytest.param(text, marks=[pytest.mark.slow] if place > 2 else [])
        for place, text in enumerate(texts)
    ]


def run(folder: Path, *commands: str) -> None:
    """Run commands in a folder, all in one process; fail where its limit ends it."""
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    done = subprocess.run(
        [sys.executable, "-c", CHILD, str(SECONDS), *commands],
        cwd=folder, env=environment, capture_output=True, text=True, check=False, timeout=300,
    )  # fmt: skip
    assert done.returncode in (0, 1), (done.returncode, done.stderr[-500:])


def write(folder: Path, name: str, text: str) -> None:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, "utf-8")


@pytest.mark.parametrize("text", first_quick(TEMPLATES))
@pytest.mark.slow
def test_templates(text: str, tmp_path: Path) -> None:
    write(tmp_path, "main.yml", MAIN)
    write(tmp_path, "templates/Own.tpl.py", f"{{% extends 'State.tpl.py' %}}\n{TEMPLATES[text]}")
    run(tmp_path, *COMMANDS)


@pytest.mark.parametrize("text", SCRIPTS)
@pytest.mark.slow
def test_scripts(text: str, tmp_path: Path) -> None:
    write(tmp_path, "main.yml", SCRIPTS[text])
    write(tmp_path, "templates/Own.tpl.py", "{% extends 'State.tpl.py' %}\n" + STATE)
    run(tmp_path, *COMMANDS)


@pytest.mark.parametrize("text", SETTINGS)
def test_settings(text: str, tmp_path: Path) -> None:
    write(tmp_path, "main.yml", MAIN.replace("Own", "ScriptedState"))
    write(tmp_path, "smachac.toml", SETTINGS[text])
    run(tmp_path, "check main.yml")


@pytest.mark.parametrize("text", first_quick(HEADERS))
def test_headers(text: str, tmp_path: Path) -> None:
    write(tmp_path, "main.yml", MAIN.replace("outcomes: [done], t", "t"))
    write(tmp_path, "templates/Own.yml", INTERFACE)
    write(tmp_path, "templates/Own.tpl.py", "{% block class_defs %}\n" + STATE + "{% endblock %}\n")
    write(tmp_path, "include/own.hpp", HEADERS[text])
    run(tmp_path, "check main.yml")
