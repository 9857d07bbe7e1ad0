"""What `smachac check` costs on long scripts that use everything: containers with userdata remapped
into them and out of them, typed keys, code, concurrences, retries, sub-scripts.

    python bench/check.py [rounds [states ...]]

Everything is CPU time in processes of their own, taken in turn, the least of several; the garbage
collector is paused, as the command line does. The floor are libyaml's bare events over that text.
"""

from __future__ import annotations

import gc
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from smachac.analysis.context import Context
    from smachac.checks.rule import RuleFunction
    from smachac.diagnostics.diagnostic import Finding

SIZES = (1_000, 10_000, 100_000)
DEPTH = 290

HEAD = """name: sm
template: Base
outcomes: [done, stuck]
userdata: {target: [[0.5, 0.0, 0.1], [0.0, 0.0, 0.0, 1.0]], tries: 0, joints: [0.0, 0.0]}
states:
"""

PART = """\
- B%(n)d:
    template: StateMachine
    outcomes: [ok, bad]
    input_keys: [goal, tries]
    output_keys: [joints, tries]
    remapping: {goal: target}
    transitions: {ok: %(next)s, bad: FIX}
    states:
    - PLAN:
        template: PoseToJointPositionsState
        remapping: {pose: goal}
        transitions: {succeeded: MOVE, aborted: bad}
    - MOVE:
        template: MoveToJointPositionsState
        remapping: {positions: joints}
        transitions: {succeeded: BOTH, aborted: bad, preempted: bad}
    - BOTH:
        template: Concurrence
        outcomes: [ok, bad]
        default_outcome: bad
        outcome_map: {ok: {L: ok, R: succeeded}}
        transitions: {ok: COUNT, bad: bad}
        states:
        - L: {template: ScriptedState, outcomes: [ok, bad]}
        - R: {template: SleepState, time: 1}
    - COUNT:
        template: CallbacksState
        input_keys: [tries]
        output_keys: [tries]
        callbacks: {tries: "lambda ud: ud.tries + 1"}
        transitions: {succeeded: ASK}
    - ASK:
        template: ConditionalOutcomeState
        input_keys: [tries]
        outcomes: [more]
        callbacks: {more: "lambda ud: ud.tries < 9"}
        default_outcome: enough
        transitions: {more: C0, enough: bad}
"""

LINK = "    - C%d: {T: ScriptedState, o: [a, b], t: {a: %s, b: %s}}\n"
LINKS = 13

LAST = """\
    - TRY:
        template: ScriptedState
        outcomes: [ok, aborted]
        retry: {on: [aborted], max: 3}
        transitions: {ok: ok, exhausted: bad, preempted: bad}
"""

CALL = """\
- CALL%(n)d:
    script: part
    params: {seconds: 2}
    remapping: {pose: target}
    transitions: {ok: B%(n)d, bad: FIX}
"""

FIX = """\
- FIX:
    template: GripperState
    command: open
    remapping: {width: gripper}
    transitions: {succeeded: stuck, aborted: stuck, preempted: stuck}
"""

SUB_SCRIPT = """\
- PART:
    template: StateMachine
    outcomes: [ok, bad]
    input_keys: [pose]
    states:
    - GO:
        template: MoveAlongState
        transitions: {succeeded: REST, aborted: bad, preempted: bad}
    - REST:
        template: SleepState
        time: [params, seconds]
        transitions: {succeeded: ok, preempted: bad}
"""

EACH = 23.3
"""States of one part, those of its containers, its retry and a tenth of a sub-script included."""


def script(states: int) -> str:
    """A script of about so many states."""
    parts = round(states / EACH)
    text = [HEAD]
    for n in range(parts):
        ahead = n + 1
        calls = ahead % 10 == 0
        following = "done" if ahead == parts else f"CALL{ahead}" if calls else f"B{ahead}"
        if n and n % 10 == 0:
            text.append(CALL % {"n": n})
        text.append(PART % {"n": n, "next": following})
        for link in range(LINKS):
            after = f"C{link + 1}" if link < LINKS - 1 else "TRY"
            text.append(LINK % (link, after, "bad" if link % 2 else after))
        text.append(LAST)
    return "".join([*text, FIX])


def nested(levels: int) -> str:
    """Containers in containers."""
    inside = "{template: ScriptedState, outcomes: [done], transitions: {done: done}}"
    for number in range(levels - 2):
        body = f"[{{C{number}: {inside}}}]"
        inside = "{template: StateMachine, outcomes: [done], states: " + body
        inside += ", transitions: {done: done}}"
    return f"name: sm\ntemplate: Base\noutcomes: [done]\nstates:\n- C: {inside}\n"


def events(path: str) -> dict[str, float]:
    """CPU seconds of libyaml's events alone."""
    from yaml._yaml import CParser

    text = Path(path).read_text("utf-8")
    began = time.process_time()
    count = sum(1 for _ in iter(CParser(text).get_event, None))
    return {"events": time.process_time() - began, "count": count}


class Laps:
    """CPU seconds by name, each since the one before."""

    def __init__(self) -> None:
        self.found: dict[str, float] = {}
        self.began = self.last = time.process_time()

    def __call__(self, name: str) -> None:
        now = time.process_time()
        self.found[name] = now - self.last
        self.last = now


def phases(path: str) -> dict[str, float]:
    """CPU seconds of each phase and rule, and of `check` as a whole, without its start-up."""
    from smachac import checks
    from smachac.diagnostics.diagnostic import Report, in_order
    from smachac.diagnostics.severities import apply_severities
    from smachac.driver import CODES
    from smachac.frontend.files import disk_library, read_source
    from smachac.frontend.script.lower import lower
    from smachac.frontend.script.resolve import resolve
    from smachac.frontend.text.suppressions import apply_suppressions, suppressions_in
    from smachac.ir.recursion import deep_recursion
    from smachac.ir.traversal import walk

    warm_up()
    laps = Laps()
    report: Report = []
    source = read_source(Path(path), report)
    assert source is not None
    library = disk_library(Path(path), report)
    with deep_recursion():
        tree = library.parse(source, report)
        laps("parse")
        resolved = resolve(source, tree, library, report)
        assert resolved is not None, report
        library.release(source)
        del tree
        laps("resolve")
        machine, texts = lower(resolved), resolved.sources
        del resolved
        laps("lower")
        rules = [
            replace(rule, function=partial(timed, rule.function, laps, rule.code.code))
            for rule in checks.rules()
        ]
        report += checks.check_machine(machine, tuple(rules))
        parse = library.parse
        given = [fit for text in texts for fit in suppressions_in(text, report, CODES, parse)]
        report = apply_severities(in_order(apply_suppressions(report, given)[0]), library.policy)
        laps("report")
    return {
        **laps.found,
        "check": laps.last - laps.began,
        "states": sum(1 for _ in walk(machine.root)),
        "findings": sum(item.severity.value != "info" for item in report),
        "megabytes": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    }


def timed(rule: RuleFunction, laps: Laps, code: str, context: Context) -> Iterator[Finding]:
    found = list(rule(context))
    laps(code)
    return iter(found)


def warm_up() -> None:
    """Load what is loaded once: grammars, templates, packages."""
    from smachac import check

    with tempfile.TemporaryDirectory() as folder:
        write(Path(folder), "main.yml", script(500))
        check(Path(folder, "main.yml"))


def write(folder: Path, name: str, text: str) -> None:
    folder.joinpath(name).write_text(text, "utf-8")
    folder.joinpath("part.yml").write_text(SUB_SCRIPT, "utf-8")


def measured(what: str, path: Path) -> dict[str, float]:
    """One measurement in a process of its own."""
    command = [sys.executable, __file__, f"--{what}", path.name]
    ended = subprocess.run(command, cwd=path.parent, stdout=subprocess.PIPE, check=True)
    return dict(json.loads(ended.stdout))


def best(path: Path, rounds: int, known: dict[str, dict[str, float]]) -> None:
    """Measure a script once more; the least of each figure is kept."""
    for _ in range(rounds):
        for what in ("events", "phases"):
            old = known.setdefault(path.stem, {})
            for name, seconds in measured(what, path).items():
                old[name] = min(seconds, old.get(name, seconds))


def table(found: dict[str, dict[str, float]]) -> None:
    """Microseconds a state of each phase and rule, by script; then what they amount to."""
    names = list(found)
    print(f"{'us a state':<12}" + "".join(f"{name:>12}" for name in names))
    plain = ("states", "count", "megabytes", "findings")
    steps = sorted({step for item in found.values() for step in item} - {*plain})
    for step in sorted(steps, key=lambda step: (step.startswith("SM"), step)):
        times = (1e6 * found[name].get(step, 0.0) / found[name]["states"] for name in names)
        print(f"{step:<12}" + "".join(f"{time_:12.2f}" for time_ in times))
    for what in plain:
        print(f"{what:<12}" + "".join(f"{found[name][what]:12.0f}" for name in names))
    ratios = (found[name]["check"] / found[name]["events"] for name in names)
    print(f"{'of events':<12}" + "".join(f"{ratio:12.1f}" for ratio in ratios))
    beyond = (found[name]["check"] - found[name]["parse"] for name in names)
    print(f"{'beyond, s':<12}" + "".join(f"{item:12.2f}" for item in beyond))


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    sizes = [int(word) for word in sys.argv[2:]] or SIZES
    found: dict[str, dict[str, float]] = {}
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder, f"{size}.yml") for size in sizes]
        for path in paths:
            write(path.parent, path.name, script(int(path.stem)))
        deep = Path(folder, "deep.yml")
        write(deep.parent, deep.name, nested(DEPTH))
        for _ in range(rounds):
            for path in (*paths, deep):
                best(path, 1, found)
    table(found)
    for small, large in pairwise(sizes):
        ratio = found[str(large)]["check"] / found[str(small)]["check"]
        print(f"{large} states / {small} states: {ratio:.1f} for {large / small:.0f} times as many")


if __name__ == "__main__":
    if sys.argv[1:2] in (["--events"], ["--phases"]):
        gc.disable()
        print(json.dumps((events if sys.argv[1] == "--events" else phases)(sys.argv[2])))
        sys.stdout.flush()
        os._exit(0)  # taking the data apart is not what is measured
    main()
