"""The command `run`: the generated program, here and now, or a machine played from a scenario."""

from __future__ import annotations

import argparse
import gc
import os
import re
import sys
import traceback
from argparse import Namespace
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from smachac.commands.build import generate
from smachac.commands.output import FINDINGS, OK, print_report, shown, usage, wants_colour
from smachac.driver import analyse_file
from smachac.frontend.errors.script import wrong_shape

if TYPE_CHECKING:
    from smachac.diagnostics.diagnostic import Report
    from smachac.diagnostics.source import Span
    from smachac.frontend.loader import Library
    from smachac.frontend.yaml_tree import Tree
    from smachac.interpreter.result import RunResult
    from smachac.interpreter.scenario import Scenario
    from smachac.ir.nodes import Machine


def run(arguments: argparse.Namespace) -> int:
    """Ends with 0 when the machine ends with an outcome (the one of `--expect`, if given)."""
    from smachac.targets import load_target

    if arguments.mock is None and (arguments.schedule or arguments.orders):
        return usage("--schedule and --orders are for --mock: a program's threads run as they do")
    target = load_target("python")
    assert target is not None
    if arguments.mock is not None:
        analysis, library = analyse_file(arguments.script, arguments.scripts, arguments.templates)
        files = {}
        print_report(shown(analysis.report), arguments, sys.stderr)
    else:
        analysis, library, made = generate(arguments, target, {})
        files = made or {}
    machine = analysis.checked
    if machine is None or not (files or arguments.mock):
        return FINDINGS
    wrong = _wrong_film(arguments, machine, library if files else None)
    if wrong:
        return usage(wrong)
    scenario = None
    if arguments.mock is not None:
        report: Report = []
        scenario = read_scenario_file(arguments.mock, machine, report)
        print_report(report, arguments, sys.stderr)
        if scenario is None:
            return FINDINGS
        if arguments.orders is not None:
            text, agree = play_orders(machine, scenario, arguments.seed, arguments.orders)
            print(text)
            return OK if agree else FINDINGS
    try:
        with watching(arguments, wants_colour(arguments, sys.stdout)) as (observe, errors):
            try:
                if scenario is not None:
                    outcome = play(machine, scenario, arguments.seed, arguments.schedule, observe)
                else:
                    ((name, text),) = files.items()
                    outcome = perform(name, text, machine, arguments, observe)
            except FailedError as error:
                sys.stdout.flush()
                print(f"the run failed{_where(errors)}\n{error}", file=sys.stderr)
                return FINDINGS
    except OSError as error:
        print(f"cannot write the trace: {error.strerror or error}", file=sys.stderr)
        return FINDINGS
    print(f"outcome: {outcome}")
    if arguments.expect is not None and outcome != arguments.expect:
        print(f"expected: {arguments.expect}", file=sys.stderr)
        return FINDINGS
    return OK


def _wrong_film(arguments: argparse.Namespace, machine: Machine, library: Library | None) -> str:
    """What is wrong with `--record` and `--gui`, if anything. `library` is that of the program;
    None where no program runs."""
    from smachac.targets.python.template_sources import uses_simulation

    if arguments.record is None and not arguments.gui:
        return ""
    if library is None or not uses_simulation(machine, library):
        return "--record and --gui need a program for the simulated arm; this run has no arm"
    if arguments.record is not None and arguments.record.suffix.lower() not in (".gif", ".mp4"):
        return f"--record makes .gif and .mp4, not `{arguments.record}`"
    return ""


def _where(errors: list[dict[str, Any]]) -> str:
    """The state that failed first, and its line in the script."""
    if not errors:
        return ""
    source = f" ({errors[0]['src']})" if "src" in errors[0] else ""
    return f" in {errors[0]['path']}{source}"


Event = dict[str, Any]


class FailedError(Exception):
    """A run ended without an outcome; the words say why."""


def play(
    machine: Machine,
    scenario: Scenario,
    seed: int,
    schedule: list[str] | None,
    observe: Callable[[Event], None],
) -> str:
    """Play a scenario on the interpreter; the outcome. Raises FailedError."""
    from smachac.interpreter.behaviours import builtin_behaviour
    from smachac.interpreter.interpreter import run
    from smachac.interpreter.scenario import scenario_behaviour
    from smachac.interpreter.scheduler import ScheduleError

    behaviour = scenario_behaviour(scenario, machine, builtin_behaviour(seed))
    try:
        result = run(machine, behaviour, observe, seed=seed, schedule=schedule)
    except ScheduleError as error:
        raise FailedError(f"--schedule: {error}") from None
    if result.error is not None:
        span = result.error.span
        raise FailedError(
            f"{result.error}\n  --> {span}" if span.source.text else str(result.error)
        )
    assert result.outcome is not None
    return result.outcome


def play_orders(machine: Machine, scenario: Scenario, seed: int, most: int) -> tuple[str, bool]:
    """Play a scenario with the branches of concurrences in every order, at most so many.

    What came of them, in words, and whether all came to the same end.
    """
    from itertools import islice

    from smachac.interpreter.behaviours import builtin_behaviour
    from smachac.interpreter.explore import explore
    from smachac.interpreter.scenario import scenario_behaviour
    from smachac.interpreter.userdata import trace_value

    ends: dict[str, list[RunResult]] = {}
    orders = explore(
        machine, lambda: scenario_behaviour(scenario, machine, builtin_behaviour(seed))
    )
    for result in islice(orders, most):
        end = f"error: {result.error}" if result.error else f"outcome: {result.outcome}"
        held = (f"{key}={trace_value(result.userdata[key])!r}" for key in sorted(result.userdata))
        ends.setdefault(" ".join([end, *held]), []).append(result)
    tried = sum(map(len, ends.values()))
    more = next(orders, None) is not None
    which = "there are more" if more else "all there are" if tried > 1 else "the only one"
    lines = [f"{tried} order{'s' * (tried > 1)} of branches tried, {which}:"]
    for end, results in ends.items():
        turns = ",".join(_short_turns(results[0]))
        lines.append(
            f"{len(results):>6}  {end}" + (f"\n        --schedule {turns}" if turns else "")
        )
    if len(ends) > 1:
        lines.append("a race: how it ends depends on which branch comes first")
    return "\n".join(lines), len(ends) == 1


def _short_turns(result: RunResult) -> Iterator[str]:
    """The turns of a run as `--schedule` takes them: names where these are enough."""
    for choice in result.choices:
        name = choice.taken.rpartition("/")[2]
        alike = [path for path in choice.ready if path.endswith(f"/{name}")]
        yield name if len(alike) == 1 else choice.taken


def perform(
    name: str, text: str, machine: Machine, arguments: Namespace, observe: Callable[[Event], None]
) -> str:
    """Run the generated module; the outcome. Raises FailedError."""
    from smachac.targets.python.runner import execute

    gc.enable()  # from here on it is the user's program that runs
    try:
        outcome = execute(
            name,
            text,
            machine,
            observe,
            folder=arguments.script.parent,
            seed=arguments.seed,
            gui=arguments.gui,
            record=arguments.record,
            on_preempt=lambda: print(
                "asked to stop: states clean up; Ctrl-C again ends at once", file=sys.stderr
            ),
        )
    except Exception as error:
        raise FailedError(_told(error, name, arguments.script.parent)) from error
    if outcome is None:
        raise FailedError("the machine ended without an outcome")
    return outcome


def _told(error: BaseException, name: str, folder: Path) -> str:
    """What went wrong first, and where in the generated program or in code of the user."""
    first = error
    while (cause := first.__cause__ or first.__context__) is not None:
        first = cause
    own = [
        frame
        for frame in traceback.extract_tb(first.__traceback__)
        if frame.filename == name or Path(frame.filename).is_relative_to(folder.resolve())
    ]
    words = str(first).strip().splitlines() or [""]
    lines = [f"{type(first).__name__}: {words[0]}" if words[0] else type(first).__name__]
    lines += [f"  in {frame.filename}:{frame.lineno}, {frame.name}: {frame.line}" for frame in own]
    return "\n".join(lines)


@contextmanager
def watching(
    arguments: Namespace, colour: bool
) -> Iterator[tuple[Callable[[Event], None], list[Event]]]:
    """An observer that writes the trace and shows progress; and the errors it hears of."""
    from smachac.runtime.tracing.progress import Progress
    from smachac.runtime.tracing.writer import TraceWriter

    errors: list[Event] = []
    sinks: list[Callable[[Event], None]] = []
    with ExitStack() as stack:
        if arguments.trace is not None:
            arguments.trace.parent.mkdir(parents=True, exist_ok=True)
            stream = stack.enter_context(arguments.trace.open("wb", buffering=0))
            writer = TraceWriter(partial(os.write, stream.fileno()))
            if arguments.quiet:
                yield writer, writer.errors
                return
            sinks.append(writer)
        if not arguments.quiet:
            sinks.append(Progress(sys.stdout, colour=colour))

        def observe(event: Event) -> None:
            if event["event"] == "error":
                errors.append(event)
            for sink in sinks:
                sink(event)

        yield observe, errors


def read_scenario_file(path: Path, machine: Machine, report: Report) -> Scenario | None:
    """The scenario of a file; None, with problems in the report, where it is not right."""
    from smachac.frontend.files import read_source
    from smachac.frontend.yaml_tree import parse
    from smachac.interpreter.scenario import read_scenario

    source = read_source(path, report)
    tree = parse(source, report) if source is not None else None
    if tree is None:
        return None
    scenario, found = read_scenario(_plain(tree), machine)
    for message in found:
        report.append(wrong_shape(_place(message, tree), message))
    return None if report else scenario


def _plain(tree: Tree) -> Any:
    from smachac.frontend.yaml_tree import Map, Seq

    if isinstance(tree, Map):
        return {entry.key.value: _plain(entry.value) for entry in tree.entries}
    if isinstance(tree, Seq):
        return [_plain(item) for item in tree.items]
    return tree.value


def _place(message: str, tree: Tree) -> Span:
    """The place in a scenario that a message speaks of: a state by its path, one of its steps."""
    from smachac.frontend.yaml_tree import Map, Seq

    states = tree.get("states") if isinstance(tree, Map) else None
    found = re.match(r"`([^`]*)`|(.*), step (\d+):", message) or re.search(r"`([^`]*)`", message)
    if states is None or found is None or not isinstance(states.value, Map):
        return tree.span
    path = found.group(1) or found.group(2) or ""
    for entry in states.value.entries:
        key = str(entry.key.value)
        if key == path or path.endswith(f"/{key}") or f"`{key}`" in message:
            step = found.group(3) if found.re.groups >= 3 else None
            if step and isinstance(entry.value, Seq):
                return entry.value.items[int(step) - 1].span
            return entry.value.span if step else entry.key.span
    return tree.span
