"""The search for repairs: proven by a new check, disjoint, the same in every run, never by knowing
less of the script."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest

from smachac.commands.cli import main
from smachac.diagnostics.clusters import Cluster
from smachac.diagnostics.diagnostic import Diagnostic, Severity
from smachac.diagnostics.repair import Certainty, edited_texts
from smachac.diagnostics.source import Source
from smachac.driver import Analysis, analyse
from smachac.frontend.loader import memory_library
from smachac.frontend.text.recovering_parser import parse_with_recovery
from smachac.repair.search import MOST_CLUSTERS, again, clusters, unknown
from tests.trust.judged_repairs import ALL_MUTATIONS, mutated
from tests.trust.project_text import BUILT_IN, MAIN
from tests.trust.unusual_projects import unusual_projects

SCRIPT = """\
name: sm
template: Base
outcomes: [succeeded, aborted]
userdata: {block_pose: 1}
states:
  - LOOK:
      template: ScriptedState
      outcomes: [done, failed]
      transitions: {done: PICK, failed: aborted}
  - PICK:
      template: ScriptedState
      outcomes: [done]
      input_keys: [block_pose]
      transitions: {done: succeeded}
"""

SLIPS = {
    "name of a state": ("done: PICK", "done: PIKC"),
    "name of a key": ("input_keys: [block_pose]", "input_keys: [blok_poes]"),
    "part of a name": ("input_keys: [block_pose]", "input_keys: [pose]"),
    "name of a field": ("input_keys:", "imput_kyes:"),
    "name of a state type": ("PICK:\n      template: Scripted", "PICK:\n      template: Scritpde"),
    "name and value": ("failed: aborted", "aborted: failed"),
    "declared name": ("outcomes: [succeeded,", "outcomes: [suceeded,"),
    "lost bracket": ("[succeeded, aborted]", "[succeeded, aborted"),
}


def analysed(files: Mapping[str, str]) -> Analysis:
    library = replace(memory_library(files, BUILT_IN), parse=parse_with_recovery)
    return analyse(Source(MAIN, files[MAIN]), library, [], render=True)


def found_in(files: Mapping[str, str]) -> tuple[Analysis, list[Cluster]]:
    analysis = analysed(files)
    return analysis, clusters(analysis, analysis.report, again(analysis))


def test_the_script_has_no_finding() -> None:
    assert analysed({MAIN: SCRIPT}).report == []


@pytest.mark.parametrize("slip", SLIPS)
def test_the_repair_of_a_slip_restores_the_text(slip: str) -> None:
    old, new = SLIPS[slip]
    _, found = found_in({MAIN: SCRIPT.replace(old, new)})
    assert edited_texts(found[0].repair.edits).popitem()[1] == SCRIPT


def test_to_silence_a_rule_is_no_repair() -> None:
    """With a state type that does not exist, no key would be missing."""
    slip = SCRIPT.replace("input_keys: [block_pose]", "input_keys: [weight]")
    _, found = found_in({MAIN: slip})
    for cluster in found:
        texts = [*edited_texts(cluster.repair.edits).values()]
        assert "ScriptedState\n      outcomes: [done]" in texts[0]


def test_a_sub_script_is_repaired_for_its_callers() -> None:
    main = SCRIPT.replace(
        "      template: ScriptedState\n      outcomes: [done]\n      input_keys: [block_pose]\n",
        "      script: pick\n",
    )
    pick = (
        "- PICK:\n    template: ScriptedState\n    outcomes: [done]\n    imput_keys: [block_pose]\n"
    )
    _, (cluster,) = found_in({MAIN: main, "pick.yml": pick})
    ((source, text),) = edited_texts(cluster.repair.edits).items()
    assert source.name == "pick.yml"
    assert text == pick.replace("imput", "input")


def mutants() -> list[tuple[str, str]]:
    """A kind of damage and the name of a project for each of 24 texts."""
    names = sorted(unusual_projects())
    kinds = [*ALL_MUTATIONS]
    return [(kinds[turn % len(kinds)], names[(11 * turn) % len(names)]) for turn in range(24)]


def test_clusters_of_damaged_texts_obey_the_laws() -> None:
    projects = unusual_projects()
    count = 0
    for kind, name in mutants():
        file, mutant = mutated(projects[name], kind, f"search {name}")
        if mutant is None:
            continue
        analysis, found = found_in({**projects[name], file: mutant.text})
        count += len(found)
        assert len(found) <= MOST_CLUSTERS
        assert_disjoint(analysis, found)
        for cluster in found:
            assert_proven(analysis, cluster)
    assert count > 8


def assert_disjoint(analysis: Analysis, found: list[Cluster]) -> None:
    """Each finding of a report is in at most one cluster, and no cluster has another finding."""
    members = [id(item) for cluster in found for item in (cluster.finding, *cluster.explained)]
    assert len(set(members)) == len(members)
    assert set(members) <= {id(item) for item in analysis.report}


def assert_proven(analysis: Analysis, cluster: Cluster) -> None:
    """With the repair a check has fewer findings, and not one of another kind, or more of the
    script is understood."""
    after = again(analysis)(edited_texts(cluster.repair.edits))
    assert unknown(after) <= unknown(analysis)
    if unknown(after) < unknown(analysis):
        return
    before, left = (serious(one) for one in (analysis, after))
    assert len(left) < len(before)
    assert {key(item) for item in left} <= {key(item) for item in before}


def serious(analysis: Analysis) -> list[Diagnostic]:
    return [item for item in analysis.report if item.severity is not Severity.INFO]


def key(item: Diagnostic) -> tuple[object, ...]:
    return item.code, item.span.source.name, item.finding.arguments


def test_safe_repairs_stay_safe() -> None:
    _, (cluster,) = found_in({MAIN: SCRIPT.replace("done: PICK", "done: PICKK")})
    assert cluster.repair.certainty is Certainty.SAFE


def test_the_report_is_the_same_with_another_hash_seed(tmp_path: Path) -> None:
    slips = [SLIPS[name] for name in ("name of a key", "name of a state", "declared name")]
    text = SCRIPT
    for old, new in slips:
        text = text.replace(old, new)
    (tmp_path / "main.yml").write_text(text)
    call = [sys.executable, "-m", "smachac", "check", "main.yml", "--format", "json"]
    printed = {
        subprocess.run(
            call, cwd=tmp_path, env={"PYTHONHASHSEED": seed}, capture_output=True, check=False
        ).stdout
        for seed in ("1", "2")
    }
    assert len(printed) == 1
    assert json.loads(printed.pop())["clusters"]


def test_a_report_shows_the_repair_and_what_it_explains(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "main.yml").write_text(
        SCRIPT.replace("input_keys: [block_pose]", "input_keys: [pose]")
    )
    assert main(["check", str(tmp_path / "main.yml")]) == 1
    printed = capsys.readouterr().out
    assert "help: did you mean `block_pose`?" in printed


HELPS = {
    "the error before the warning": (
        "      input_keys: [block_pose]\n",
        "      input_keys: [part]\n",
        ["did you mean `block_pose`?"],
        "SM301",
    ),
    "an exchange with its first name": (
        "{done: PICK, failed: aborted}",
        "{PICK: done, failed: aborted}",
        ["write `done: PICK`"],
        "SM102",
    ),
    "the second copy": (
        "  - PICK:\n",
        "  - LOOK:\n"
        "      template: ScriptedState\n"
        "      outcomes: [done, failed]\n"
        "      transitions: {done: PICK, failed: aborted}\n"
        "  - PICK:\n",
        ["delete lines 10 to 13", "or rename one of the two"],
        "SM106",
    ),
}


@pytest.mark.parametrize("case", HELPS)
def test_the_helps_of_a_cluster(
    case: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    old, new, helps, code = HELPS[case]
    (tmp_path / "main.yml").write_text(SCRIPT.replace(old, new))
    assert main(["check", str(tmp_path / "main.yml")]) == 1
    printed = capsys.readouterr().out
    assert printed.startswith(f"error[{code}]")
    lines = [line for line in printed.split("\n") if line.startswith("help: ")]
    assert all(any(f"help: {text}" in line for line in lines) for text in helps), printed


def test_exchanged_outcomes_are_written_once_and_with_both_names(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    both = """\
name: sm
outcomes: [both, one]
states:
  - BOTH:
      template: Concurrence
      outcomes: [both, one]
      default_outcome: one
      outcome_map: {both: {LEFT: seen, RIGHT: done}}
      transitions: {both: both, one: one}
      states:
        - LEFT: {template: ScriptedState, outcomes: [done, lost]}
        - RIGHT: {template: ScriptedState, outcomes: [seen, lost]}
"""
    (tmp_path / "main.yml").write_text(both)
    main(["check", str(tmp_path / "main.yml")])
    lines = [line for line in capsys.readouterr().out.split("\n") if line.startswith("help: ")]
    assert lines[0] == "help: write `LEFT: done, RIGHT: seen`"


def test_a_type_of_the_userdata_is_changed_there(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    script = SCRIPT.replace("block_pose: 1", "block_pose: {type: int, value: 1}")
    script = script.replace("[block_pose]", "{block_pose: str}")
    (tmp_path / "main.yml").write_text(script)
    assert main(["check", str(tmp_path / "main.yml")]) == 1
    printed = capsys.readouterr().out
    assert "output_keys" not in printed
    assert "declare `block_pose` as `str` in the `userdata` of `sm`" in printed


TWO_SLIPS = [
    # The rest of a text with a lost sign is checked, and operators read it as repaired.
    (("- PICK:", "- PICK"), ("failed: aborted", "aborted: failed")),
    (("name: sm", "name sm"), ("failed: aborted", "aborted: failed")),
    (("[succeeded, aborted]", "[succeeded, aborted"), ("failed: aborted", "aborted: failed")),
    (("states:\n", "states\n"), ("done: PICK", "done: PIKC")),
    (("- LOOK:", "- LOOK"), ("input_keys:", "imput_kyes:")),
]


@pytest.mark.parametrize(("lost", "slip"), TWO_SLIPS)
def test_a_slip_in_a_text_with_a_lost_sign_has_its_repair(
    lost: tuple[str, str], slip: tuple[str, str]
) -> None:
    text = SCRIPT.replace(*lost).replace(*slip)
    _, found = found_in({MAIN: text})
    edits = [edit for cluster in found for edit in cluster.repair.edits]
    assert edited_texts(edits).popitem()[1] == SCRIPT


def test_an_analysis_after_others_has_the_findings_of_a_fresh_one() -> None:
    edits = (("done: PICK", "done: PICKS"), ("block_pose: 1", "pose: 1"), ("- PICK:", "- PACK:"))
    library = memory_library({MAIN: SCRIPT}, BUILT_IN)
    source = Source(MAIN, SCRIPT)
    analysed = again(analyse(source, library, []))
    for old, new in edits:
        text = SCRIPT.replace(old, new)
        fresh = analyse(Source(MAIN, text), library, [], render=True).report
        later = analysed({source: text}).report
        assert [(item.code, item.span.start, item.finding.message) for item in later] == [
            (item.code, item.span.start, item.finding.message) for item in fresh
        ]
        assert later
