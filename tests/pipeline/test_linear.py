"""No command is quadratic: twice the input takes at most 2.3 times the lines of Python.

Lines are counted, not seconds: the number is the same on each machine.
"""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import FrameType
from typing import Any

import pytest

from smachac.commands.cli import main
from tests.support.examples import every

BENCH = Path(__file__).parents[2] / "bench" / "hostile.py"
SIZE = 250
MOST = 2.3

INPUTS = (
    "wrong_targets",
    "near_targets",
    "wrong_outcomes",
    "wrong_remappings",
    "unknown_fields",
    "outcomes",
    "transitions",
    "userdata",
    "unset_keys",
    "params",
    "fields_outside_of_states",
    "project_settings",
    "project_folders",
    "scenario_states",
)


def hostile() -> Any:
    """The module bench/hostile.py."""
    spec = importlib.util.spec_from_file_location("hostile", BENCH)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def lines(arguments: list[str]) -> int:
    """The lines of Python that a command runs."""
    count = 0

    def trace(frame: FrameType, event: str, argument: object) -> Any:
        nonlocal count
        count += event == "line"
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        main(arguments)
    except SystemExit:
        pass
    finally:
        sys.settrace(before)
    return count


@pytest.mark.parametrize("name", every(8, INPUTS))
def test_twice_the_input_takes_about_twice_the_lines(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _, write = hostile().INPUTS[name]
    counts = []
    for size in (10, SIZE, 2 * SIZE):  # the first one imports what is needed
        folder = tmp_path / str(size)
        folder.mkdir()
        arguments = write(folder, size)
        monkeypatch.chdir(folder)
        counts.append(lines(arguments))
    _, one, two = counts
    assert two / one < MOST, counts


STATE = """\
class C{0}(smach.State):
    def __init__(self, speed):
        super().__init__(outcomes=["done"], input_keys=["a{0}"], output_keys=["b{0}"])
        self.speed = speed
        self.times = helper()

    def execute(self, userdata):
        self.times += 1
        userdata.b{0} = userdata.a{0} * self.speed + math.sqrt(self.{1})
        return "done"

"""
INTERFACE = """\
name: C{0}
variables: {{speed: float}}
input_keys: {{a{0}: float}}
output_keys: {{b{0}: float}}
outcomes: {{done: {{}}}}
code: {{python: "cell:C{0}"}}
"""
USE = (
    "  - S{0}: {{template: C{0}, speed: 1.0, remapping: {{a{0}: x, b{0}: x}},"
    " transitions: {{done: {1}}}}}\n"
)


@pytest.mark.slow
@pytest.mark.parametrize("attribute", ["times", "timez"])
def test_the_classes_of_one_module(
    attribute: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    counts = []
    for size in (2, 15, 30):
        folder = tmp_path / str(size)
        (folder / "templates").mkdir(parents=True)
        monkeypatch.chdir(folder)
        head = "import math\nfrom smachac.runtime import smach\ndef helper(): return 1\n"
        classes = [STATE.format(at, attribute if at == 1 else "times") for at in range(size)]
        Path("cell.py").write_text(head + "\n".join(classes))
        for at in range(size):
            Path(f"templates/C{at}.yml").write_text(INTERFACE.format(at))
        uses = (USE.format(at, f"S{at + 1}" if at + 1 < size else "done") for at in range(size))
        start = "name: sm\ntemplate: Base\noutcomes: [done]\nuserdata: {x: 1.0}\nstates:\n"
        Path("main.yml").write_text(start + "".join(uses))
        counts.append(lines(["check", "main.yml"]))
    assert main(["check", "main.yml"]) == 0
    _, one, two = counts
    assert two / one < MOST, counts
