"""The subjects of groups of rules: a rule that is left out finds nothing in the machine."""

from __future__ import annotations

import random
from collections.abc import Mapping
from pathlib import Path

import pytest
from hypothesis import given, settings

from smachac import checks
from smachac.analysis.context import Context
from smachac.checks import check_machine, rules, subjects
from smachac.driver import CODES, read_machine
from smachac.frontend.files import disk_library, read_source
from smachac.ir.nodes import Machine
from smachac.pysource.modules.user_code import ProjectCode
from smachac.report.explain_code import MAIN, explanation
from smachac.targets import load_target
from tests.strategies.machines import machines
from tests.support.examples import examples, seeds

CASES = sorted(Path(__file__).parents[1].glob("cases/*/main.yml"))

EXAMPLES = [
    pytest.param(files, id=f"{code}_{which}")
    for code in CODES
    for which in ("wrong", "right")
    if MAIN in (files := getattr(explanation(CODES[code]), which))
]
"""The examples of all codes: they have every subject, and a fault of each rule."""


def judged(main: Path) -> Context | None:
    """The context of the machine of a script, with the code of its project, if the rules that can
    find something in it find what all rules find; None without a machine."""
    source = read_source(main, [])
    assert source is not None
    library = disk_library(main, [])
    machine = read_machine(source, library, [])
    if machine is None:
        return None
    target = load_target("python")
    assert target is not None
    project = ProjectCode(
        library=library,
        declared=lambda language, type_: (
            target.declared(type_, library) if language == "python" else None
        ),
    )
    some, others = (Context(machine, project=project) for _ in range(2))
    assert check_machine(machine, context=some) == check_machine(machine, rules(), others)
    return some


@pytest.mark.parametrize("main", CASES, ids=lambda path: path.parent.name)
def test_the_scripts_of_the_cases(main: Path) -> None:
    judged(main)


@pytest.mark.parametrize("files", EXAMPLES)
def test_the_examples_of_all_codes(files: Mapping[str, str], tmp_path: Path) -> None:
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, "utf-8")
    judged(tmp_path / MAIN)


@settings(max_examples=examples(100))
@given(machines())
def test_random_machines(machine: Machine) -> None:
    assert check_machine(machine) == check_machine(machine, rules())


def numbers_only(rng: random.Random, depth: int = 0) -> list[str]:
    """The lines of states of built-in types whose values are numbers, many of them wrong."""
    names = [f"S{n}" for n in range(rng.randrange(1, 5))] + ["S1"] * rng.randrange(2)
    targets = [*names, "done", "failed", "lost", "preempted"]
    lines = []
    for name in names:
        outcomes = ["succeeded", "preempted", "aborted", "done", "failed"]
        steps = ", ".join(
            f"{outcome}: {rng.choice(targets)}"
            for outcome in rng.sample(outcomes, rng.randrange(4))
        )
        indent = "  " * (2 * depth + 1)
        lines.append(f"{indent}- {name}:")
        kind = rng.randrange(3) if depth < 2 else 0
        body = [
            "template: SleepState",
            f"time: {rng.choice(['1', '-0.5', '1e9', '[params, wait]'])}",
        ]
        if kind == 1:
            body = ["template: StateMachine", "outcomes: [done, failed]", "states:"]
        elif kind == 2:
            rules_ = "{done: {S0: succeeded}, failed: {S0: preempted, S1: lost}}"
            body = ["template: Concurrence", "outcomes: [done, failed]",
                    "default_outcome: failed", f"outcome_map: {rules_}", "states:"]  # fmt: skip
        if steps:
            body.insert(0, f"transitions: {{{steps}}}")
        lines += [f"{indent}    {line}" for line in body]
        if body[-1] == "states:":
            lines += numbers_only(rng, depth + 1)
    return lines


@pytest.mark.parametrize("seed", seeds(20, 60, 400))
def test_states_whose_values_are_numbers(seed: int, tmp_path: Path) -> None:
    main = tmp_path / "main.yml"
    rng = random.Random(seed)
    states = "\n".join(numbers_only(rng))
    declared = rng.choice(
        ["params: {wait: 2.0}", "types: {Load: int}\nparams: {wait: 1, spare: 2}"]
    )
    head = f"name: sm\ntemplate: Base\noutcomes: [done, failed]\n{declared}\n"
    main.write_text(f"{head}states:\n{states}\n")
    context = judged(main)
    assert context is not None
    assert not subjects.texts(context)


def test_each_rule_is_in_one_group() -> None:
    codes = [rule.code.code for _, group in checks.MACHINE_RULES for rule in group()]
    assert len(set(codes)) == len(codes)
    others = [rule.code.code for rule in checks.code_rules()]
    assert sorted([*codes, *others, "SM019"]) == sorted(rule.code.code for rule in rules())
