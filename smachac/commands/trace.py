"""The commands `trace` and `stats`: compare recorded traces with a script, and count in them."""

from __future__ import annotations

import argparse
import sys
from argparse import Namespace

from smachac.commands.arguments import (
    SCRIPT,
    as_path,
    colour,
    generated_states,
    names,
    report_output,
    search_folders,
)
from smachac.commands.output import FINDINGS, OK, print_report, usage, without_notes
from smachac.commands.swapped import swapped_arguments

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from pathlib import Path

    from smachac.ir.nodes import Machine
    from smachac.ir.written import Written
    from smachac.verify.coverage import Coverage
    from smachac.verify.trace_report import JudgedTrace
    from smachac.verify.trace_statistics import TraceStatistics

TRACE_EXAMPLES = """\
examples:
  smachac run main.yml --trace run.jsonl           record a run
  smachac trace check main.yml run.jsonl           compare a run with the script
  smachac trace check main.yml runs/*.jsonl        check many runs, list transitions that none takes
  smachac trace check main.yml bags/run_7          check a bag of ROS 2 with the live status
  smachac trace stats main.yml runs/*.jsonl        visits, durations and outcomes of each state

exit codes: 0 every trace is a run that the script allows, 1 one is not, or the script has errors,
2 wrong usage, 70 a bug in smachac, 130 interrupted
"""

STATS_EXAMPLES = """\
examples:
  smachac stats main.yml runs/*.jsonl              outcomes, and the failures that cost most
  smachac stats main.yml runs/*.jsonl --success done,skipped
  smachac stats main.yml sweep.db                  the same from the database of a sweep
  smachac stats main.yml runs/*.jsonl --format dot | dot -Tsvg > main.svg   the graph with figures
  smachac stats main.yml runs/*.jsonl --format html > main.html   the same to explore in a browser
  smachac stats main.yml runs/*.jsonl --format json

exit codes: 0 success, 1 a trace is not a run that the script allows, or the script has errors,
2 wrong usage, 70 a bug in smachac, 130 interrupted
"""

TRACES = "a file that `run --trace` or a C++ program has written"


class UnreadableTraceError(Exception):
    """A trace cannot be read."""

    def __init__(self, path: Path, reason: str) -> None:
        super().__init__(f"the trace {path} cannot be read: {reason}")


def trace_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = TRACE_EXAMPLES
    parser.add_argument("action", choices=("check", "stats"), help="check: compare the traces with"
                        " the script; stats: count visits, durations and outcomes")  # fmt: skip
    generated_states(parser)
    others = "; for `check` also a bag of rosbag2, for `stats` also the database of a sweep"
    _files(parser, TRACES + others, "text", "json")


def stats_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = STATS_EXAMPLES
    parser.add_argument("--success", type=names, metavar="A,B,...",
                        help="outcomes of the machine that count as success (default: those with"
                        " names of success)")  # fmt: skip
    others = ", or the database of a sweep"
    _files(parser, TRACES + others, "text", "json", "dot", "html")


def _files(parser: argparse.ArgumentParser, traces: str, *formats: str) -> None:
    parser.add_argument("script", type=as_path, help=SCRIPT)
    parser.add_argument("traces", type=as_path, nargs="+", metavar="TRACE", help=traces)
    report_output(parser, *formats)
    search_folders(parser)
    colour(parser)


def trace_command(arguments: Namespace) -> int:
    """Judge every trace, or count in them; the exit code."""
    from smachac.ir.written import generated, written
    from smachac.report.terminal import on_one_line
    from smachac.sweep.database import DatabaseError
    from smachac.verify.coverage import script_coverage
    from smachac.verify.statistics_report import statistics_json, statistics_text
    from smachac.verify.trace_report import refusals, trace_json, trace_text, untaken

    if right := swapped_arguments(arguments):
        return usage(right)
    machine = _machine(arguments)
    if machine is None:
        return FINDINGS
    view = (generated if arguments.generated else written)(machine)
    try:
        judged, taken, statistics = _judged(
            arguments.traces, machine, view, conformance=arguments.action == "check"
        )
    except (UnreadableTraceError, DatabaseError) as error:
        return usage(str(error))
    covered = script_coverage(taken.items, taken.covered, view)
    never = untaken(covered)
    bad = refusals(judged)
    if arguments.action == "check":
        render = trace_json if arguments.format == "json" else trace_text
        sys.stdout.write(render(judged, never, len(covered.items)))
    elif not bad:
        show = statistics_json if arguments.format == "json" else statistics_text
        sys.stdout.write(show(machine, statistics, never))
    else:
        print(*map(on_one_line, bad), sep="\n", file=sys.stderr)
    return FINDINGS if bad else OK


def stats_command(arguments: Namespace) -> int:
    """Predict the outcomes of a machine from its traces; the exit code."""
    from smachac.ir.outcome_names import successes
    from smachac.ir.traversal import outcome_names
    from smachac.ir.written import written
    from smachac.report.terminal import on_one_line
    from smachac.sweep.database import DatabaseError
    from smachac.verify.statistics_page import statistics_html
    from smachac.verify.statistics_report import (
        forecast,
        forecast_dot,
        forecast_json,
        forecast_text,
    )
    from smachac.verify.trace_report import refusals

    if right := swapped_arguments(arguments):
        return usage(right)
    machine = _machine(arguments)
    if machine is None:
        return FINDINGS
    if arguments.success and arguments.format == "html":
        return usage("--success has no effect on --format html, which predicts nothing")
    own = outcome_names(machine.root)
    for name in arguments.success or ():
        if name not in own:
            return usage(f"the machine has no outcome `{name}`", name, own)
    try:
        judged, taken, statistics = _judged(arguments.traces, machine, written(machine))
    except (UnreadableTraceError, DatabaseError) as error:
        return usage(str(error))
    bad = refusals(judged)
    if bad:
        print(*map(on_one_line, bad), sep="\n", file=sys.stderr)
        return FINDINGS
    if machine.root.name not in statistics.states:
        return usage("the traces have no run")
    if arguments.format == "html":
        sys.stdout.write(statistics_html(machine, statistics, taken))
        return OK
    good = arguments.success or successes(machine.root)
    renders = {"text": forecast_text, "json": forecast_json, "dot": forecast_dot}
    found = forecast(machine, statistics, good)
    sys.stdout.write(renders[arguments.format](machine, statistics, found))
    return OK


def _machine(arguments: Namespace) -> Machine | None:
    """The checked machine of the script; its findings are printed."""
    from smachac.driver import analyse_script

    analysis = analyse_script(arguments.script, arguments.scripts, arguments.templates)
    print_report(without_notes(analysis.report), arguments, sys.stderr)
    return analysis.checked


def _judged(
    paths: list[Path], machine: Machine, view: Written, *, conformance: bool = False
) -> tuple[list[JudgedTrace], Coverage, TraceStatistics]:
    """Every trace, with what all of them cover and count. The runs of a database have no events,
    and so no `conformance`; those of a bag have no outcomes of states, and so nothing else. Raises
    UnreadableTraceError, and DatabaseError for a database."""
    from functools import partial

    from smachac.commands.bag import is_bag
    from smachac.runtime.tracing.writer import LONGEST_LINE
    from smachac.verify.coverage import Coverage
    from smachac.verify.trace_report import judge_trace
    from smachac.verify.trace_statistics import TraceStatistics

    taken, statistics, judged = Coverage(machine), TraceStatistics(), []

    def record(event: dict[str, object]) -> None:
        taken.record(event)
        statistics.record(event)

    for path in paths:
        try:
            if is_bag(path):
                if not conformance:
                    raise UnreadableTraceError(path, "a bag has no outcomes of states to count")
                judged += _judged_bag(path, machine, taken, view)
                continue
            if not path.is_file() and path.exists():
                raise UnreadableTraceError(path, "it is not a regular file")
            if _is_database(path):
                if conformance:
                    raise UnreadableTraceError(path, "a sweep's database has no events")
                _add_database(path, machine, taken, statistics)
                continue
            with path.open(encoding="utf-8", errors="replace", newline="\n") as stream:
                lines = iter(partial(stream.readline, LONGEST_LINE + 1), "")
                judged.append(judge_trace(machine, str(path), lines, record, view))
        except OSError as error:
            raise UnreadableTraceError(path, error.strerror or str(error)) from None
        statistics.end_trace()
    return judged, taken, statistics


def _judged_bag(path: Path, machine: Machine, taken: Coverage, view: Written) -> list[JudgedTrace]:
    """The runs in a bag, one trace for each node that reports on the machine. Raises
    UnreadableTraceError."""
    from smachac.commands.bag import BagError, read_statuses
    from smachac.diagnostics.wording import listed
    from smachac.verify.status_conformance import judge_statuses

    if not path.exists():
        raise UnreadableTraceError(path, "there is no such file")
    try:
        found, notes = read_statuses(path)
    except BagError as error:
        raise UnreadableTraceError(path, str(error)) from None
    for note in notes:
        print(f"note: {path}: {note}", file=sys.stderr)
    roots = {topic: {status.path.partition("/")[0] for status in found[topic]} for topic in found}
    own = [topic for topic in found if not roots[topic] or machine.root.name in roots[topic]]
    if not own:
        names = listed(f"/{root}" for root in set().union(*roots.values()))
        raise UnreadableTraceError(path, f"it reports on {names}, not on `/{machine.root.name}`")
    names_of = {topic: str(path) if len(own) == 1 else f"{path} ({topic})" for topic in own}
    return [judge_statuses(machine, names_of[topic], found[topic], taken, view) for topic in own]


def _is_database(path: Path) -> bool:
    with path.open("rb") as stream:
        return stream.read(6) == b"SQLite"


def _add_database(
    path: Path, machine: Machine, taken: Coverage, statistics: TraceStatistics
) -> None:
    """Add the runs of a sweep. Raises UnreadableTraceError and DatabaseError."""
    from contextlib import closing

    from smachac.sweep.database import Database
    from smachac.sweep.task import merge_states

    with closing(Database(path, None)) as database:
        if database.inputs().get("script") != machine.digest:
            raise UnreadableTraceError(path, "its runs are those of another script")
        for run in database.runs():
            taken.covered.update(run.covered)
            merge_states(statistics, run.states)
