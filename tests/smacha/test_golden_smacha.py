"""What SMACHA's scripts may hold, feature by feature, and the table that lists it (docs/smacha.md).

Each case has its report, its graph and its Python; `make golden` rewrites them.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.support.golden import compare_folder, outputs

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "tests" / "cases" / "smacha"
CASES = sorted(path.parent for path in FOLDER.glob("*/main.yml"))
TABLE = [
    line
    for line in (ROOT / "docs" / "smacha.md").read_text(encoding="utf-8").splitlines()
    if line.startswith("| ") and not line.startswith(("| SMACHA", "| ---"))
]
WORDS = {
    "1.1": "name manifest function_name node_name outcomes userdata template states script",
    "1.2": "n m nn T S o s p ud ik ok r t do om cb",
    "1.3": "params [params, [v] null",
    "1.4": "params userdata remapping transitions extract",
    "1.5": "input_keys output_keys remapping",
    "1.6": "base_header imports defs class_defs cb_defs main_def header header_userdata body "
    "footer execute base_footer main class_name name uuid parent_name parent_sm_name "
    "parent_template parent_type params local_vars defined_headers container_insertion_order",
    "1.7": "meta extends super() include import do expression not_string exptostr render_userdata "
    "render_outcomes render_input_keys render_output_keys render_goal_slots render_result_slots "
    "render_request_slots render_response_slots render_def_lambda_callbacks render_init_callbacks "
    "render_execute_callbacks render_callbacks render_outcome_map render_transitions "
    "render_remapping import_module import_module_as from_import from_import_as",
    "1.8": "Base ROSBase State StateMachine Concurrence CallbacksState ConditionalOutcomeState "
    "RandomOutcomeState PrintUserdataState DeleteFileState WriteCSVFileState ServiceState "
    "SimpleActionState SleepState PublishMsgState PublishObserverMsgState ReadTopicState "
    "WaitForMsgState RecordROSBagState TF2ListenerState TransformMsgState MsgPublisher "
    "MsgPublisherObserver TF2ListenerSingleton ROSBagCLIProcessRecorder ROSBagAPIThreadRecorder",
    "1.9": "generate execute contain extract help smacha_server -t -s -o -c -i -v",
    "1.10": "node_name",
}
"""What SMACHA has, by section of its description: each stands in a row of the table."""


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_golden(case: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(case)
    found = outputs(("ir", "python"))
    compare_folder(found, case / "expected")
    assert ("error[" in found["report.txt"]) == (len(found) == 1)
    assert (len(found["report.txt"]) > 0) >= case.name.startswith("bad_")


def named_by(row: str) -> list[str]:
    """What the last column of a row names."""
    return re.findall(r"`([^`]+)`", row.rstrip("| ").rpartition("|")[2])


def exists(name: str) -> bool:
    """Whether there is such a case, or such a test in such a file."""
    file, _, test = name.partition("::")
    if name.startswith("refactorings/"):
        return (ROOT / "tests" / name / "command").is_file()
    if not test:
        return (ROOT / "tests" / "cases" / name / "main.yml").is_file()
    path = ROOT / "tests" / file
    return path.is_file() and f"def {test}(" in path.read_text(encoding="utf-8")


@pytest.mark.parametrize("row", TABLE, ids=lambda row: row.split("|")[1].strip()[:40])
def test_every_row_names_tests_that_are_there(row: str) -> None:
    named = named_by(row)
    assert named
    assert [name for name in named if not exists(name)] == []


def test_every_case_is_in_the_table() -> None:
    named = {name for row in TABLE for name in named_by(row)}
    assert [case.name for case in CASES if f"smacha/{case.name}" not in named] == []


def test_there_are_enough_cases() -> None:
    assert len(CASES) >= 40


@pytest.mark.parametrize("section", WORDS)
def test_all_that_smacha_has_is_in_a_row_of_its_section(section: str) -> None:
    text = (ROOT / "docs" / "smacha.md").read_text(encoding="utf-8")
    part = re.split(r"^## ", text.partition(f"\n## {section} ")[2], maxsplit=1, flags=re.M)[0]
    rows = [line for line in part.splitlines() if line in TABLE]
    said = {
        word for row in rows for found in re.findall(r"`([^`]+)`", row) for word in found.split()
    }
    assert [word for word in WORDS[section].split() if word not in said] == []
