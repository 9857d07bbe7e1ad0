"""The ir target: the text of the graph under the line that says who made it."""

from __future__ import annotations

from pathlib import Path

from smachac.diagnostics.source import NOWHERE
from smachac.frontend.files import disk_library
from smachac.ir.nodes import Checked, Leaf, Machine, Outcome, StateMachine
from smachac.ir.printer import print_machine
from smachac.targets import BuildContext, made_by
from smachac.targets.ir import TARGET

LEAF = Leaf(name="GO", type="T", outcomes=(Outcome(name="done", span=NOWHERE),), span=NOWHERE)
MACHINE = Machine(
    root=StateMachine(name="sm", type="StateMachine", children=(LEAF,), initial="GO", span=NOWHERE),
    source="main.yml",
)


def test_one_file_with_the_text_of_the_machine() -> None:
    files = TARGET.emit(
        Checked(MACHINE), BuildContext(library=disk_library(Path("main.yml"), [])), []
    )
    assert files == {"sm.smir": f"# {made_by(MACHINE)}\n{print_machine(MACHINE)}"}
    assert "GO" in files["sm.smir"]
