"""A second witness beside the recordings: SMACH itself, without ROS, runs the recorded machines and
the generated programs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import smachac
from tests.conformance.standalone_smach import FOLDER, ROOT, results, run_python
from tests.support.examples import every
from tests.targets.test_additions import WAIT, written

CASES: list[Any] = [
    case
    for path in sorted(Path(__file__).parent.glob("vectors-*.json"))
    for case in json.loads(path.read_text())["cases"]
    if "hang" not in case.get("tags", ())  # SMACH never returns
]

CAUSE_IS_LOST = ("A20-343",)
"""The InvalidStateError of a failed Concurrence names no cause (rule N10 in docs/semantics.md), so
the replay cannot read it; the recording has it from the log."""

VERIFY = """\
import smach
from smachac.commands.cli import main
runs, execute = [], smach.StateMachine.execute
smach.StateMachine.execute = lambda self, *given: runs.append(self) or execute(self, *given)
code = main(["verify", sys.argv[1]])
assert runs and "standalone-smach" in smach.__file__
sys.exit(code)
"""


@pytest.fixture(autouse=True)
def installed() -> None:
    if not FOLDER.exists():
        pytest.skip("standalone-smach is not installed: scripts/setup.sh dev")


@pytest.mark.parametrize(
    "part", [0, *(pytest.param(at, marks=pytest.mark.slow) for at in range(1, 8))]
)
def test_recorded_machines(part: int, tmp_path: Path) -> None:
    cases = CASES[part::8]
    found = results(cases, tmp_path / "cases.json")
    expected = {case["id"]: case["expect"] for case in cases}
    for name in set(CAUSE_IS_LOST) & set(found):
        del found[name]["runs"][0]["category"], expected[name]["runs"][0]["category"]
    assert found == expected


EXAMPLES = sorted(path.parent.name for path in (ROOT / "examples").glob("[01]*/main.yml"))


@pytest.mark.parametrize("example", every(6, EXAMPLES))
def test_the_program_of_an_example_with_stand_in_states(example: str) -> None:
    done = run_python(VERIFY, f"examples/{example}/main.yml")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "python: agrees" in done.stdout


@pytest.mark.parametrize("options", [{}, {"standalone": "true"}, {"ros": "1"}])
def test_a_program_with_a_time_limit(options: dict[str, str], tmp_path: Path) -> None:
    (text,) = smachac.compile(
        written(tmp_path, WAIT.format("WAIT")), "python", options=options
    ).values()
    assert ("smachac.runtime.additions" in text) is (options == {})
    hidden = "import sys; sys.modules['smachac'] = None; " if options else ""
    (tmp_path / "sm.py").write_text(text, "utf-8")
    done = run_python(f"{hidden}import runpy; runpy.run_path('sm.py', run_name='__main__')",
                      cwd=tmp_path)  # fmt: skip
    assert (done.returncode, done.stdout.splitlines()[-1]) == (0, "outcome: good"), done.stderr
