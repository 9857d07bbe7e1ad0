"""Whether targets do what the interpreter does: the same scenarios played on both, traces compared.

A target is a player (scenes.py): it gets scenes and gives a trace of each. States do not run their
own code in it, but follow the scene: user code is not executed, and nothing waits. Beside the
events of a trace each leaf tells what it finds in its inputs (`read`), so that a value gone astray
is seen.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

from smachac.ir.nodes import Machine
from smachac.verify.coverage import reasons
from smachac.verify.generate import Scenarios
from smachac.verify.paths import Path
from smachac.verify.result import Disagreement, Verdict
from smachac.verify.test_case import Player, Scene, differ, expected, scenes_of


def verify(
    machine: Machine,
    players: Mapping[str, Player],
    *,
    script: str,
    most: int | None = None,
    seed: int = 0,
) -> Verdict:
    """Play the paths of a machine on every target, up to the first difference of each.

    `most` and `seed` are those of `Scenarios`. What a player raises passes through.
    """
    scenarios = Scenarios(machine, most=most, seed=seed)
    walks = scenarios.walks
    paths = list(scenarios.paths())
    scenes = scenes_of(machine, paths, walks.live)
    found = [
        _first_difference(machine, target, player, paths, scenes)
        for target, player in players.items()
    ]
    known, missing = walks.taken.known, walks.taken.missing()
    why = reasons(machine, missing, walks.steering)
    return Verdict(
        script=script,
        targets=tuple(players),
        paths=Counter(path.kind for path in paths),
        taken=len(known) - len(missing),
        total=len(known),
        missing=[(way, known[way], why[way]) for way in missing],
        left_out=scenarios.left_out,
        disagreements=[each for each in found if each is not None],
    )


def _first_difference(
    machine: Machine,
    target: str,
    player: Player,
    paths: Sequence[Path],
    scenes: Sequence[Scene],
) -> Disagreement | None:
    traces = zip(paths, scenes, player(scenes), strict=True)
    for number, (path, scene, theirs) in enumerate(traces, 1):
        difference = differ(expected(machine, path.scenario, scene), theirs)
        if difference is not None:
            return Disagreement(
                target=target,
                path=number,
                expected=difference.first,
                found=difference.second,
                at=difference.at,
                rows={path: row for path, row in scene.rows.items() if row},
                live=path.live,
            )
    return None
