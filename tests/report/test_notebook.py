"""Machines and findings in a notebook: IPython's formatters show them as MIME types."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

import smachac
from smachac.report.notebook import COLUMNS, Findings, bundle

ROOT = Path(__file__).parents[2]
SCRIPT = """\
name: door
template: Base
outcomes: [succeeded, aborted]
states:
  - OPEN:
      template: ScriptedState
      outcomes: [opened, stuck]
      transitions: {opened: succeeded, stuck: aborted}
"""
CELLS = """
import json, sys
from IPython.core.interactiveshell import InteractiveShell
shell = InteractiveShell.instance()
shown = []
for cell in json.load(sys.stdin):
    value = shell.run_cell(cell).result
    shown.append(shell.display_formatter.format(value)[0])
print(json.dumps(shown))
"""
"""Runs cells in IPython, and prints what each would show, by MIME type."""


def cells(*texts: str, path: str | None = None) -> list[dict[str, str]]:
    pytest.importorskip("IPython")
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    if path is not None:
        environment["PATH"] = path
    done = subprocess.run(
        [sys.executable, "-c", CELLS],
        input=json.dumps(texts),
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    found: list[dict[str, str]] = json.loads(done.stdout.splitlines()[-1])
    return found


def test_cells_of_the_page_are_shown_as_table_and_picture() -> None:
    if shutil.which("dot") is None:
        pytest.skip("no Graphviz")
    page = (ROOT / "docs" / "api.md").read_text("utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    start, table, picture = blocks[0], *(block for block in blocks if "cell:" in block)
    _, findings, machine = cells(start, table, picture)
    assert "<td" in findings["text/html"]
    assert "SM101" in findings["text/html"]
    assert "did you mean `aborted`?" in findings["text/plain"]
    svg = ElementTree.fromstring(machine["image/svg+xml"])
    words = {node.text for node in svg.iter("{http://www.w3.org/2000/svg}text")}
    assert {"OPEN", "opened", "succeeded"} <= words
    assert machine["text/plain"] == "machine door with the outcomes succeeded, aborted"


def test_without_graphviz_a_machine_is_a_table(tmp_path: Path) -> None:
    (shown,) = cells(f"import smachac\nsmachac.load({SCRIPT!r}, name='door.yml')", path="")
    assert "image/svg+xml" not in shown
    assert shown["text/markdown"].splitlines()[-1] == (
        "| door/OPEN | ScriptedState | opened → succeeded, stuck → aborted |"
    )


def test_a_graphviz_that_fails_is_as_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program = tmp_path / "dot"
    program.write_text("#!/bin/sh\nexit 1\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert list(bundle(smachac.load(SCRIPT, name="door.yml"))) == ["text/plain", "text/markdown"]


def test_findings_are_a_list_and_an_escaped_table() -> None:
    found = smachac.check(SCRIPT.replace("aborted}", '"<b>&"}'), name="door.yml")
    assert isinstance(found, Findings)
    assert found == list(found)
    html = found._repr_html_()
    assert "&lt;b&gt;&amp;" in html
    assert "<b>" not in html
    table = ElementTree.fromstring(f"<div>{html}</div>")
    assert [cell.text for cell in table.iter("th")] == list(COLUMNS)
    assert len(list(table.iter("tr"))) == len(found) + 1


def test_no_findings_are_one_line() -> None:
    found = smachac.check(SCRIPT, name="door.yml")
    assert isinstance(found, Findings)
    assert found._repr_html_() == "<p>no findings</p>"
