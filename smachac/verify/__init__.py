"""Differential testing of targets: each test case runs on the interpreter and on the targets.

A target is represented by a player (test_case.py), which runs test cases and returns their traces.
Leaves perform the steps of the test case instead of their own code, so no user code runs and
nothing waits. Each leaf also records the values of its inputs (`read` events), so that a wrong
value is found where it is first read.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack

from smachac.ir.nodes import Machine
from smachac.ir.script_paths import script_paths
from smachac.ir.written import Written, written
from smachac.runtime.tracing.writer import with_shown_paths
from smachac.verify.coverage import item_in_script, reasons, script_coverage
from smachac.verify.generate import PathGenerator
from smachac.verify.paths import Path
from smachac.verify.python_values import with_samples
from smachac.verify.result import Disagreement, Verdict
from smachac.verify.test_case import Player, TestCase, compare_traces, expected_trace, test_cases


def verify(
    machine: Machine,
    players: Mapping[str, Player],
    *,
    script: str,
    files: Mapping[str, str] = {},
    most: int | None = None,
    seed: int = 0,
    view: Callable[[Machine], Written] = written,
    progress: Callable[[str], None] = lambda text: None,
) -> Verdict:
    """Run the paths of a machine on every target, up to the first difference of each.

    `files` are the names of the files that players play, by target, where these are on disk. `most`
    and `seed` are those of `PathGenerator`. `view` has the states of the coverage. `progress` is
    called often, with how far the work is.
    Exceptions of players are not caught.
    """
    machine, samples = with_samples(machine)
    generator = PathGenerator(machine, most=most, seed=seed)
    runner = generator.runner
    paths = []
    for path in generator.paths():
        paths.append(path)
        progress(f"paths found: {len(paths)}")
    cases = test_cases(machine, paths, runner.live, samples)
    found = [
        _first_difference(machine, target, player, paths, cases, progress)
        for target, player in players.items()
    ]
    coverage = runner.coverage
    states = view(machine)
    shown = script_coverage(coverage.items, coverage.covered, states)
    why = reasons(machine, coverage.missing(), runner.planner)
    reason = {item_in_script(item, states): why[item] for item in reversed(why)}
    return Verdict(
        script=script,
        targets=tuple(players),
        files=files,
        paths=Counter(path.kind for path in paths),
        taken=len(shown.covered),
        total=len(shown.items),
        missing=[(item, shown.items[item], reason[item]) for item in shown.missing()],
        left_out=generator.left_out,
        disagreements=[disagreement for disagreement in found if disagreement is not None],
    )


def _first_difference(
    machine: Machine,
    target: str,
    player: Player,
    paths: Sequence[Path],
    cases: Sequence[TestCase],
    progress: Callable[[str], None],
) -> Disagreement | None:
    """The first path on which a target differs from the interpreter."""
    shown = script_paths(machine.root)
    with ExitStack() as stack:
        played = player(cases)
        stack.callback(getattr(played, "close", lambda: None))  # ends its processes
        traces = zip(paths, cases, played, strict=True)
        progress(f"{target}: starting")
        for number, (path, case, theirs) in enumerate(traces, 1):
            progress(f"{target}: {number} of {len(paths)} paths")
            difference = compare_traces(expected_trace(machine, path.scenario, case), theirs)
            if difference is not None:
                return Disagreement(
                    target=target,
                    path=number,
                    expected=[with_shown_paths(event, shown) for event in difference.first],
                    found=[with_shown_paths(event, shown) for event in difference.second],
                    at=difference.at,
                    steps={shown.get(full, full): row for full, row in path.scenario.steps.items()},
                    live=path.live,
                )
    return None
