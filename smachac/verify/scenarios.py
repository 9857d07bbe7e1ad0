"""Scenarios for the outcomes of a machine, made of the paths on which targets are verified."""

from __future__ import annotations

from collections.abc import Collection

from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run
from smachac.interpreter.scenario import (
    Scenario,
    scenario_behaviour,
    scenario_text,
)
from smachac.ir.nodes import Machine
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.script_paths import walk_script
from smachac.ir.written import written
from smachac.verify.generate import PathGenerator
from smachac.verify.paths import Path

MOST_PATHS = 400
"""Paths that are tried for all outcomes together."""


def outcome_scenarios(machine: Machine, script: str, outcomes: Collection[str]) -> dict[str, str]:
    """For each of `outcomes` of a machine the text of a scenario that ends with it: of the paths
    that were tried, the one with the fewest visits, without a request to stop if there is one. An
    outcome that no path reached is missing. A timer or a pause of a written state ends as
    `preempted` only after a request to stop.
    Each scenario was played once, as `smachac run SCRIPT --mock` plays it."""
    found: dict[str, Path] = {}
    parts = written(machine).parts
    waits = {path for path, part in parts.items() if part.role != "state"}
    for path in PathGenerator(machine, most=MOST_PATHS).paths():
        if path.stopped or not path.ends:
            continue
        outcome = _outcome(machine, path.scenario)
        if outcome is None or outcome not in outcomes:
            continue
        best = found.get(outcome)
        if best is None or _rank(path, waits) < _rank(best, waits):
            found[outcome] = path
    return {
        name: _text(machine, found[name].scenario, script, name)
        for name in outcomes
        if name in found
    }


def _rank(path: Path, waits: Collection[str]) -> tuple[int, int, int]:
    """The place of a path among those with its outcome: the ends of `waits`, which are timers and
    pauses, that only a request to stop causes; its requests to stop; its visits."""
    steps = [(state, step) for state, row in path.scenario.steps.items() for step in row]
    unasked = sum(state in waits and step.outcome == PREEMPTED for state, step in steps)
    return unasked, sum(step.stop for _, step in steps), path.visits


def _outcome(machine: Machine, scenario: Scenario) -> str | None:
    return run(machine, scenario_behaviour(scenario, machine, builtin_behaviour())).outcome


def _text(machine: Machine, scenario: Scenario, script: str, outcome: str) -> str:
    """The file of a scenario: its states by their paths in the script, without the timers and
    pauses that the script does not contain unless the outcome needs them."""
    paths = {path.full: path for path in walk_script(machine.root)}
    written = {full: steps for full, steps in scenario.steps.items() if not paths[full].added}
    if _outcome(machine, Scenario(steps=written)) == outcome:
        scenario = Scenario(steps=written)
    head = f"# smachac run {script} --mock FILE --expect {outcome}\n"
    return head + scenario_text({paths[full].shown: row for full, row in scenario.steps.items()})
