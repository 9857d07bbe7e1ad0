"""What the tests of imports of machines for YASMIN and FlexBE share."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.commands.cli import main
from smachac.driver import analyse_script
from smachac.driver.python_machines import Built, PythonProject
from smachac.frontend.files import Disk
from smachac.ir.nodes import Machine
from smachac.refactor.imports.proof import differences


def imported_output(code: str, capsys: pytest.CaptureFixture[str]) -> str:
    """What the import of `machine.py` with this code into the folder `project` prints on one line;
    it has to succeed with a proof. The current folder becomes a git repository."""
    Path(".git").mkdir()
    Path("machine.py").write_text(code, "utf-8")
    assert main(["import", "machine.py", "-o", "project", "-q"]) == 0
    out = capsys.readouterr().out
    assert "proof: the graph of main.yml is the graph of machine.py" in out
    return out.replace("\n", " ")


def proven_machine() -> Machine:
    """The machine of `project/main.yml`, which has the graph of `machine.py`."""
    built: list[Built] = []
    PythonProject(Disk()).read(Path("machine.py"), built=built)
    found = analyse_script(Path("project/main.yml")).machine
    assert found is not None
    graph, constructions = built[0]
    assert differences(graph.machine.root, found.root, constructions) == []
    return found


def compare_second_imports(
    project: Path, edited: str, change: tuple[str, str], capsys: pytest.CaptureFixture[str]
) -> None:
    """A second import into a project changes no byte; after an edit of one of its files and a
    change of the machine nothing is written."""
    before = {path: path.read_bytes() for path in project.rglob("*") if path.is_file()}
    assert main(["import", "machine.py", "-o", "project"]) == 0
    assert "project is up to date\n" in capsys.readouterr().out
    assert before == {path: path.read_bytes() for path in project.rglob("*") if path.is_file()}
    own = project / edited
    own.write_text(own.read_text("utf-8") + "# mine\n", "utf-8")
    machine = project.parent / "machine.py"
    machine.write_text(machine.read_text("utf-8").replace(*change), "utf-8")
    assert main(["import", "machine.py", "-o", "project"]) == 1
    assert f"project/{edited} was edited" in capsys.readouterr().err
    assert (project / "main.yml").read_bytes() == before[project / "main.yml"]
