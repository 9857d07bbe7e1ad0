"""The command `sweep`: run a script many times with other seeds and values, and count."""

from __future__ import annotations

import argparse
import os
import sys
import time
from argparse import Namespace

from smachac.commands.arguments import FORMAT, SCRIPT, as_path, colour, count, search_folders, seed
from smachac.commands.interrupts import end_at_stop_signals
from smachac.commands.output import FINDINGS, OK, print_report, usage, without_notes
from smachac.commands.run import MAX_STEPS_NEEDS, max_steps

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from collections.abc import Callable, Generator
    from pathlib import Path

    from smachac.diagnostics.diagnostic import Report
    from smachac.driver import Analysis
    from smachac.ir.nodes import Checked
    from smachac.sweep.database import Database
    from smachac.sweep.summary import Summary, Totals
    from smachac.sweep.task import Run, Task
    from smachac.sweep.variation import Variation

EXAMPLES = """\
examples:
  smachac sweep main.yml --runs 1000                          seeds 0 to 999, on all cores
  smachac sweep main.yml --runs 1000 --database sweep.db      run it again after Ctrl-C to continue
  smachac sweep main.yml --faults slips.yml --format html -o sweep.html
  smachac sweep main.yml --mock scenario.yml --runs 10000     outcomes with probabilities
  smachac sweep main.yml --vary userdata.speed=0.1..0.5 --vary params.arm=left,right
  smachac sweep main.yml --vary scene.block.x=0.4..0.6        poses in the scene: x, y, z, yaw
  smachac sweep main.yml --expect succeeded --at-least 0.95 --junit sweep.xml    in CI
  smachac sweep main.yml --baseline before.json               compare with an earlier sweep
  smachac run main.yml --seed 17 --set userdata.speed=0.21    repeat one run

exit codes: 0 success, 1 too few runs have the outcome of --expect, or the script has errors,
2 wrong usage, 70 a bug in smachac, 130 after Ctrl-C, 143 after SIGTERM, 129 after SIGHUP
"""

RUN_LIMIT = 300
"""The longest wall time of one run (s), if no other is given."""

REFRESH = 0.2
"""Seconds between two states of the progress line."""

NO_RAY = "the engine `ray` needs the package ray: pip install 'smachac[ray]'"


def sweep_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EXAMPLES
    parser.add_argument("script", type=as_path, help=SCRIPT)
    parser.add_argument("--runs", type=count, default=100, metavar="N",
                        help="number of runs (default: 100)")  # fmt: skip
    parser.add_argument("--seed", type=seed, default=0, metavar="FIRST",
                        help="seed of the first run; each run has the next one (default: 0)"
                        )  # fmt: skip
    parser.add_argument("--vary", action="append", default=[], metavar="NAME=LOW..HIGH",
                        help="draw a value for each run, from a range or from A,B,...:"
                        " userdata.KEY, params.NAME, scene.BODY.x (repeatable)")  # fmt: skip
    parser.add_argument("--faults", type=as_path, metavar="FILE",
                        help="inject the faults in FILE into the simulation")  # fmt: skip
    parser.add_argument("--mock", type=as_path, metavar="FILE",
                        help="play the scenario in FILE, do not run the program")  # fmt: skip
    max_steps(parser)
    parser.add_argument("--jobs", type=count, metavar="N",
                        help="number of worker processes (default: one for each core)"
                        )  # fmt: skip
    parser.add_argument("--engine", choices=("local", "ray"), default="local",
                        help="where the workers are: on this computer, or on a Ray cluster"
                        )  # fmt: skip
    parser.add_argument("--run-limit", type=seconds, default=RUN_LIMIT, metavar="S",
                        help="longest wall time of one run in seconds; 0: no limit"
                        f" (default: {RUN_LIMIT})")  # fmt: skip
    parser.add_argument("--database", type=as_path, metavar="FILE",
                        help="keep each run in FILE (SQLite), so that the same command can"
                        " continue a stopped sweep")  # fmt: skip
    parser.add_argument("--expect", metavar="OUTCOME",
                        help="the outcome that is a success (default: those with names of success)"
                        )  # fmt: skip
    parser.add_argument("--at-least", type=share, metavar="SHARE",
                        help="fail if fewer runs are a success, 0 to 1 (with --expect: 1)"
                        )  # fmt: skip
    parser.add_argument("--baseline", type=as_path, metavar="FILE",
                        help="compare with an earlier sweep, whose --format json is in FILE"
                        )  # fmt: skip
    parser.add_argument("--format", choices=("text", "json", "html"), default="text", help=FORMAT)
    parser.add_argument("-o", "--output", type=as_path, metavar="FILE",
                        help="write the report to FILE")  # fmt: skip
    parser.add_argument("--junit", type=as_path, metavar="FILE",
                        help="write one test for each run to FILE (JUnit XML)")  # fmt: skip
    search_folders(parser)
    colour(parser)


def seconds(text: str) -> float:
    """A time in seconds, or 0."""
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0 <= value < 1e9:
        raise argparse.ArgumentTypeError(f"must be a number of seconds, not `{text[:20]}`")
    return value


def share(text: str) -> float:
    """A share from 0 to 1."""
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0 <= value <= 1:
        raise argparse.ArgumentTypeError(f"must be a number from 0 to 1, not `{text[:20]}`")
    return value


def sweep_command(arguments: Namespace) -> int:
    """Perform the runs that are missing, and report; the exit code."""
    from smachac.sweep.comparison import BaselineError
    from smachac.sweep.database import Database, DatabaseError
    from smachac.sweep.engine import WorkerError

    end_at_stop_signals()
    if arguments.mock is not None and arguments.faults is not None:
        return usage("--faults needs the simulation, --mock plays a scenario: choose one")
    if arguments.mock is None and arguments.max_steps:
        return usage(MAX_STEPS_NEEDS)
    if arguments.engine == "ray" and not _has_ray():
        return usage(NO_RAY)
    for option in ("output", "junit"):
        path: Path | None = getattr(arguments, option)
        if path is not None and (path.is_dir() or not path.parent.is_dir()):
            what = "is a folder" if path.is_dir() else "is in a folder that does not exist"
            return usage(f"--{option} {path} {what}")
    if (twice := _file_with_two_uses(arguments)) is not None:
        return usage(twice)
    try:
        before = _baseline(arguments)
    except BaselineError as error:
        return usage(f"--baseline {arguments.baseline} cannot be used: {error}")
    prepared = _prepared(arguments)
    if isinstance(prepared, int):
        return prepared
    machine, task, inputs = prepared
    try:
        database = Database(arguments.database, inputs)
    except DatabaseError as error:
        return usage(str(error))
    try:
        signals = _perform(arguments, task, database)
        code = _report(arguments, machine, before, database)
        database.check_file()
        if signals:
            print(_interruption(arguments, database), file=sys.stderr)
    except (DatabaseError, WorkerError) as error:
        print(error, file=sys.stderr)
        return FINDINGS
    finally:
        database.close()
    return 128 + signals[0] if signals else code


def _interruption(arguments: Namespace, database: Database) -> str:
    """The sentence on a sweep that a signal ended."""
    first, planned = arguments.seed, arguments.runs
    done = len(database.seeds() & {*range(first, first + planned)})
    runs = f"{done} of {planned} {'run is' if planned == 1 else 'runs are'} done"
    if arguments.database is None:
        advice = "with `--database FILE` the same command continues"
        return f"interrupted: {runs}, and none is kept; {advice}"
    return f"interrupted: {runs} and kept in {arguments.database}; the same command continues"


def _file_with_two_uses(arguments: Namespace) -> str | None:
    """A message if two of the arguments name one file, which the report would overwrite."""
    uses: dict[str, str] = {}
    for name in ("script", "faults", "mock", "baseline", "database", "output", "junit"):
        path: Path | None = getattr(arguments, name)
        if path is None or (path.exists() and not path.is_file()):
            continue
        other = uses.setdefault(os.path.realpath(path), name)
        if other != name:
            what = "the script" if other == "script" else f"the file of --{other}"
            return f"--{name} {path} is {what}"
    return None


def _has_ray() -> bool:
    from importlib.util import find_spec

    return find_spec("ray") is not None


def _prepared(arguments: Namespace) -> tuple[Checked, Task, dict[str, str]] | int:
    """The checked machine, the task of the workers and the digests of the inputs; or the exit code
    after a message."""
    from smachac.commands.run import NO_ARM, read_fault_file, read_scenario_file
    from smachac.commands.swapped import swapped_option
    from smachac.driver import analyse_script, compile_script
    from smachac.frontend.files import module_folders, read_source
    from smachac.interpreter.interpreter import MAX_STEPS
    from smachac.ir.traversal import outcome_names
    from smachac.sweep.inputs import input_digests
    from smachac.sweep.task import Task
    from smachac.targets.python import TARGET
    from smachac.targets.python.ros import is_node

    report: Report = []
    source = read_source(arguments.script, report)
    if source is None:
        print_report(report, arguments, sys.stderr)
        return FINDINGS
    if right := swapped_option(arguments, "mock", "faults"):
        return usage(right)
    analysis = analyse_script(source, arguments.scripts, arguments.templates)
    files, report = compile_script(analysis, TARGET)
    if arguments.mock is not None:
        report = analysis.report
    print_report(without_notes(report), arguments, sys.stderr)
    machine, library = analysis.checked, analysis.library
    if machine is None or library is None or (arguments.mock is None and not files):
        return FINDINGS
    if arguments.faults and not any(type_.simulation for type_ in machine.state_types.values()):
        return usage(NO_ARM)
    if arguments.mock is None and is_node(machine, library, library.ros):
        return usage("this script is a ROS node: --mock plays a scenario")
    known = outcome_names(machine.root)
    if arguments.expect is not None and arguments.expect not in known:
        return usage(f"the machine has no outcome `{arguments.expect}`", arguments.expect, known)
    found: Report = []
    faults = () if arguments.faults is None else read_fault_file(arguments.faults, machine, found)
    scenario = None
    if arguments.mock is not None:
        scenario, _ = read_scenario_file(arguments.mock, machine, found)
    print_report(found, arguments, sys.stderr)
    if found or faults is None:
        return FINDINGS
    folders = module_folders(arguments.script)
    variations = _variations(arguments.vary, analysis, machine, folders, source.text)
    if isinstance(variations, str):
        return usage(variations)
    task = Task(
        source=source,
        scripts=tuple(arguments.scripts),
        templates=tuple(arguments.templates),
        scenario=scenario,
        faults=faults,
        variations=variations,
        max_steps=arguments.max_steps or MAX_STEPS,
    )
    return machine, task, input_digests(task, machine, files, folders)


def _variations(
    given: list[str], analysis: Analysis, machine: Checked, folders: list[Path], text: str
) -> tuple[Variation, ...] | str:
    """The variations of the command line, or what is wrong with them."""
    from smachac.diagnostics.source import Source
    from smachac.frontend.text.yaml_tree import parse
    from smachac.sweep.inputs import scene_bodies
    from smachac.sweep.variation import VariationError, check_values, read_variation

    try:
        variations = tuple(map(read_variation, given))
        tree = parse(Source(analysis.script, text), [])
        check_values(variations, tree, scene_bodies(machine, folders))
    except VariationError as error:
        return f"--vary: {error}"
    return variations


def _perform(arguments: Namespace, task: Task, database: Database) -> list[int]:
    """Perform the runs that the database does not have; the stop signal that ended this, if any."""
    import random
    from contextlib import redirect_stdout

    from smachac.commands.interrupts import interrupts_raise
    from smachac.runtime.signals import received

    first, planned = arguments.seed, arguments.runs
    done = database.seeds()
    missing = [seed for seed in range(first, first + planned) if seed not in done]
    random.Random().shuffle(missing)  # a second sweep with this database does other runs first
    runs = _runs(arguments, task, missing, database.has)
    progress = _Progress(planned - len(missing), planned)
    # Ray prints messages about its workers; the standard output has only the report.
    with interrupts_raise(), redirect_stdout(sys.stderr):
        try:
            for run in runs:
                if database.add(run):
                    progress.add()
                if received:  # the exception was lost in the code that it interrupted
                    break
        except KeyboardInterrupt:
            pass
        finally:
            runs.close()
            progress.end()
    return [*received]


def _runs(
    arguments: Namespace, task: Task, seeds: list[int], is_done: Callable[[int], bool]
) -> Generator[Run, None, None]:
    """The runs with these seeds, in the order in which they end."""
    from functools import partial

    from smachac.sweep.engine import perform_runs

    limit = arguments.run_limit or None
    if arguments.engine == "ray":
        from smachac.sweep import ray_engine

        return ray_engine.runs(task, seeds, jobs=arguments.jobs, limit=limit, is_done=is_done)
    from smachac.sweep.local import LocalWorker, wait

    jobs = arguments.jobs or _cores()
    start = partial(LocalWorker, task)
    return perform_runs(seeds, start, wait, jobs=jobs, limit=limit, is_done=is_done)


def _cores() -> int:
    """The cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


class _Progress:
    """A progress line on the standard error, if that is a terminal."""

    def __init__(self, done: int, planned: int) -> None:
        self._at_start = self._done = done
        self._planned = planned
        self._began = time.monotonic()
        self._shown_at = 0.0
        self._active = sys.stderr.isatty()
        self._show()

    def add(self) -> None:
        """One more run is done."""
        self._done += 1
        if time.monotonic() - self._shown_at >= REFRESH:
            self._show()

    def _show(self) -> None:
        from smachac.sweep.summary import progress_line

        if self._active:
            now = self._shown_at = time.monotonic()
            line = progress_line(self._done, self._planned, self._at_start, now - self._began)
            print(f"\r{line}\x1b[K", end="", file=sys.stderr, flush=True)

    def end(self) -> None:
        """Remove the line."""
        if self._active:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)


def _baseline(arguments: Namespace) -> Summary | None:
    """The summary of the earlier sweep, if one is given. Raises BaselineError."""
    from smachac.sweep.comparison import BaselineError, read_baseline

    path: Path | None = arguments.baseline
    if path is None:
        return None
    try:
        text = path.read_text("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise BaselineError(getattr(error, "strerror", None) or "it is no text") from None
    return read_baseline(text)


def _report(
    arguments: Namespace, machine: Checked, before: Summary | None, database: Database
) -> int:
    """Write the reports; the exit code. `before` is the summary of an earlier sweep."""
    from smachac.ir.outcome_names import successes
    from smachac.sweep.summary import Totals, summarize

    good = {arguments.expect} if arguments.expect is not None else successes(machine.root)
    totals = Totals(machine, good)
    for run in database.runs(arguments.seed, arguments.runs):
        totals.add(run)
    command = _command(arguments)
    summary = summarize(
        machine, totals, planned=arguments.runs, first=arguments.seed, command=command
    )
    try:
        _write(arguments, machine, summary, before, database, totals, command)
    except OSError as error:
        name = f" {error.filename}" if error.filename else ""
        print(f"cannot write the report{name}: {error.strerror or error}", file=sys.stderr)
        return FINDINGS
    return _verdict(arguments, totals)


def _command(arguments: Namespace) -> list[str]:
    """The words of the command that runs the script once, as the sweep does."""
    words = ["smachac", "run", str(arguments.script)]
    for option in ("mock", "faults"):
        if getattr(arguments, option) is not None:
            words += [f"--{option}", str(getattr(arguments, option))]
    for option in ("scripts", "templates"):
        for folder in getattr(arguments, option):
            words += [f"--{option}", str(folder)]
    return words


def _write(
    arguments: Namespace,
    machine: Checked,
    summary: Summary,
    before: Summary | None,
    database: Database,
    totals: Totals,
    command: list[str],
) -> None:
    """Write the report and JUnit. Raises OSError."""
    from smachac.commands.writing import put_all
    from smachac.report.json import json_text
    from smachac.sweep.comparison import compare
    from smachac.sweep.page import summary_html
    from smachac.sweep.summary import replay
    from smachac.sweep.text import junit_text, summary_text

    differences = compare(before, summary) if before is not None and summary["runs"] else []
    match arguments.format:
        case "json":
            more = (
                {"differences": [difference._asdict() for difference in differences]}
                if before
                else {}
            )
            text = json_text({**summary, **more})
        case "html":
            text = summary_html(summary, _graph(machine, totals), differences)
        case _:
            text = summary_text(summary, differences)
    files = {}
    if arguments.output is not None:
        files[arguments.output] = text.encode()
    if arguments.junit is not None:
        rows = (
            (run, totals.is_good(run), replay(command, run.seed, run.values))
            for run in database.runs(arguments.seed, arguments.runs)
        )
        files[arguments.junit] = junit_text(machine.root.name, rows).encode()
    if files:
        put_all(files)
    if arguments.output is None:
        sys.stdout.write(text)


def _graph(machine: Checked, totals: Totals) -> str:
    """The page of the viewer with what the runs visited."""
    from smachac.verify.coverage import Coverage
    from smachac.verify.statistics_page import statistics_html

    taken = Coverage(machine)
    taken.covered = totals.covered
    return statistics_html(machine, totals.statistics, taken)


def _verdict(arguments: Namespace, totals: Totals) -> int:
    """The exit code: whether enough runs are a success."""
    least = arguments.at_least
    if least is None:
        least = 1.0 if arguments.expect is not None else 0.0
    if totals.runs and totals.succeeded / totals.runs < least:
        names = ", ".join(sorted(totals.successes)) or "a success"
        print(f"expected: {names} in at least {100 * least:g} % of the runs", file=sys.stderr)
        return FINDINGS
    return OK
