"""Python files with machines: the graph that is read and the findings, compared with files.

The text at the top of each `machine.py` states what is expected of it.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from smachac.driver.python_machines import PythonProject
from smachac.frontend.files import Disk
from smachac.ir.nodes import Concurrence, Container, Node
from smachac.pysource.machines.graph import Graph
from smachac.report.coverage import coverage_lines
from smachac.report.text import render_text
from tests.support.golden import compare_file

CASES = Path(__file__).parents[2] / "python_cases"
NAMES = sorted(path.name for path in CASES.iterdir())


@pytest.mark.parametrize("name", NAMES)
def test_golden_graph_and_findings(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shutil.copytree(CASES / name, tmp_path / name)  # outside this repository: its own modules
    monkeypatch.chdir(tmp_path / name)
    found = PythonProject(Disk()).read(Path("machine.py"))
    graphs = "\n".join(line for graph in found.graphs for line in graph_lines(graph))
    known = {"machine.py": found.coverage} if found.coverage is not None else {}
    coverage = "\n".join(coverage_lines(known, every=True))
    compare_file(f"{graphs}\n{coverage}\n", CASES / name / "graph.txt")
    compare_file(render_text(found.report), CASES / name / "report.txt")


def graph_lines(graph: Graph) -> Iterator[str]:
    yield from node_lines(graph.machine.root, "")


def node_lines(node: Node, indent: str) -> Iterator[str]:
    """A state with its type, keys and transitions, and the states in it."""
    outcomes = ", ".join(outcome.name for outcome in node.outcomes)
    kind = f"open {node.type}" if getattr(node, "open", False) else node.type
    keys = "".join(
        f" {title} {', '.join(key.name for key in some)};"
        for title, some in (("reads", node.inputs), ("writes", node.outputs))
        if some
    )
    yield f"{indent}{node.name}: {kind} [{outcomes}]{keys}"
    for transition in node.transitions:
        yield f"{indent}  - {transition.outcome} -> {transition.target}"
    for remap in node.remaps:
        yield f"{indent}  - {remap.key} = {remap.to}"
    if isinstance(node, Concurrence):
        yield f"{indent}  ends with {node.join}, else {node.default_outcome}"
        for rule in node.rules:
            when = ", ".join(f"{part.child}/{part.outcome}" for part in rule.when)
            yield f"{indent}  {rule.outcome} after {when}"
    if isinstance(node, Container):
        initial = getattr(node, "initial", None)
        if initial:
            yield f"{indent}  first {initial}"
        for child in node.children:
            yield from node_lines(child, indent + "  ")


WITHOUT_FISSIX = """
import sys
sys.modules["fissix"] = None  # as if it were not installed
from smachac.commands.cli import main
sys.exit(main(["check", "machine.py"]))
"""


def test_python_2_without_the_extra_names_the_command_that_installs_it() -> None:
    done = subprocess.run(
        [sys.executable, "-c", WITHOUT_FISSIX],
        cwd=CASES / "python2", capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert "warning[SM805]: this is code for Python 2" in done.stdout
    assert "pip install 'smachac[python2]'" in done.stdout
    assert done.stderr == ""


TABS = "import smach\nsm = smach.StateMachine(['a'])\nif sm:\n        sm.open()\n\tsm.close()\n"


@pytest.mark.parametrize(
    ("first", "expected"), [("#!/usr/bin/env python", []), ("#!/usr/bin/env python3", ["SM805"])]
)
def test_tabs_and_spaces_are_no_fault_in_code_for_python_2(
    first: str, expected: list[str], tmp_path: Path
) -> None:
    path = tmp_path / "machine.py"
    path.write_text(f"{first}\n{TABS}", "utf-8")
    report = PythonProject(Disk()).read(path).report
    assert [item.code for item in report] == expected
