"""What docs/semantics.md says of the differences from SMACH is all of them, and tested."""

from __future__ import annotations

import ast
import json
import re
from pathlib import Path
from typing import Any

import pytest

from smachac.runtime import smach
from tests.conformance.vector_deviations import DEVIATIONS
from tests.conformance.vector_replay import replay

ROOT = Path(__file__).parents[2]
CASES: dict[str, Any] = {
    case["id"]: case
    for path in sorted(Path(__file__).parent.glob("vectors-*.json"))
    for case in json.loads(path.read_text())["cases"]
}

DIFFERENT = {
    "N1": "test_an_empty_concurrence_raises",
    "N11": "test_a_child_without_an_outcome_has_failed",
    "N12": "test_a_raising_child_termination_cb_fails_the_run",
    "X6": "test_callbacks_may_request_a_preempt",
    "N10": "test_a_failing_child_preempts_the_others_and_is_the_cause",
    "N15": "test_shutdown_ends_the_children_and_waits_for_them",
    "M13": "test_an_idle_machine_keeps_the_request_to_itself",
    "I9": "test_a_container_whose_child_raised_runs_no_more",
    "T4": "test_a_container_runs_from_its_start_to_its_outcome",
    "K9": "test_an_exception_while_building_leaves_nothing_open",
    "K1": "test_threads_build_independently",
    "K7": "test_the_callers_collections_are_not_written_to",
    "I1": "test_the_exhausted_outcome_is_registered_once",
    "I3": "test_setting_the_child_again_starts_afresh",
    "P2": "test_a_second_request_reaches_what_runs_at_every_depth",
    "M9": "test_what_stops_the_process_passes",
    "I2": "test_an_error_of_the_items_passes_unchanged",
    "R7": "test_keys_and_update_obey_the_remapping",
    "R8": "test_keys_and_update_obey_the_remapping",
    "P9": "test_a_request_before_the_run_reaches_the_first_item",
    "P10": "test_a_request_before_the_run_reaches_all",
    "P8": "test_an_early_end_leaves_no_request_behind",
    "P7": "test_an_unanswered_request_does_not_reach_the_next_run",
    "R9": "test_values_are_never_wrapped",
    "R10": "test_values_are_never_wrapped",
    "S8": "test_cb_interface_keeps_io_keys",
    "T5": "test_set_initial_state_merges_userdata",
    "M16": "test_constants_are_written_before_each_entry",
    "U5": "test_copy_shares_the_store_and_deep_copy_and_pickle_do_not",
    "L1": "test_default_loggers_print_a_line_but_for_debugging",
    "S1": "test_keys_and_outcomes_are_sets_in_order",
}
"""Rule -> a test of what the runtime does instead."""

SWITCHED = ("M9", "I2", "R7", "R8", "P2", "P9", "P10", "P8", "P7", "L1")

KEPT = {
    "K2": "test_add_acts_on_the_innermost_container_whatever_it_is_called_on",
    "K8": "test_closing_an_inconsistent_machine_only_logs",
    "I3": "test_the_first_breaking_outcome_ends_the_loop",
    "X3": "test_callbacks_see_inputs_and_may_change_outputs",
    "U3": "test_absent_keys_raise_key_error",
}
"""Rules on which scripts depend, beyond those that recorded cases name."""

DEPENDED_ON = {
    *("K2", "K8", "M4", "M6", "V2", "V3", "R4", "V6", "I7", "I3", "N13", "X3", "U3", "M9", "N10"),
    "P7",
}
"""Odd, but kept (of M9 and N10 the classes of the errors)."""


pytestmark = pytest.mark.usefixtures("silent_smach")


def table() -> list[tuple[list[str], list[str], bool]]:
    """Rules, cases, and whether there is a switch, by line of the table of differences."""
    text = (ROOT / "docs" / "semantics.md").read_text("utf-8")
    section = text.partition("## Where the bundled runtime differs from SMACH")[2]
    rows = re.findall(r"^\| (\S[^|]*) \|.*\|([^|]*)\|$", section.partition("\n## ")[0], re.M)
    return [
        (re.findall(r"[A-Z]\d+", rules), re.findall(r"h\d+", cases), "**" in rules)
        for rules, cases in rows
        if rules not in ("rule", "---")
    ]


def known_tests() -> set[str]:
    return {
        node.name
        for path in (ROOT / "tests").rglob("test_*.py")
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(node, ast.FunctionDef)
    }


def test_every_rule_of_the_table_has_a_test() -> None:
    rules = [rule for rules, _, _ in table() for rule in rules]
    assert sorted(rules) == sorted(DIFFERENT)
    assert not (set(DIFFERENT.values()) | set(KEPT.values())) - known_tests()


def test_the_cases_of_the_table_are_those_that_deviate() -> None:
    listed = {case: rules for rules, cases, _ in table() for case in cases}
    assert sorted(listed) == sorted(name[:4] for name in DEVIATIONS)
    for name in DEVIATIONS:
        assert set(CASES[name]["rules"]) & set(listed[name[:4]]), name


def test_the_rules_with_a_switch_are_marked() -> None:
    assert [rule for rules, _, bold in table() if bold for rule in rules] == list(SWITCHED)


def test_what_scripts_depend_on_is_recorded_or_tested() -> None:
    recorded = {
        rule
        for name, case in CASES.items()
        if name not in DEVIATIONS
        for rule in case.get("rules", [])
    }
    assert not DEPENDED_ON - recorded - set(KEPT)


NOT_SWITCHED = {name for name in DEVIATIONS if {"hang", "noetic-only"} & set(CASES[name]["tags"])}


@pytest.mark.parametrize("name", [name for name in CASES if name not in NOT_SWITCHED])
def test_with_the_switch_all_is_as_recorded(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(smach, "compat", True)
    assert replay(CASES[name]) == CASES[name]["expect"]
