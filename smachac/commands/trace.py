"""The command `trace`: compare recorded traces with a script."""

from __future__ import annotations

import argparse
import sys
from argparse import Namespace

from smachac.commands.arguments import FORMAT, SCRIPT, as_path, colour, search_folders
from smachac.commands.output import FINDINGS, OK, print_report, usage, without_notes

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from pathlib import Path

EXAMPLES = """\
examples:
  smachac run main.yml --trace run.jsonl           record a run
  smachac trace check main.yml run.jsonl           is it a run that the script allows?
  smachac trace check main.yml runs/*.jsonl        many runs, and the transitions that none takes
  smachac trace check main.yml run.jsonl --format json

exit codes: 0 every trace is a run that the script allows, 1 one is not, or the script has errors,
2 wrong usage, 70 a bug in smachac, 130 interrupted
"""


def trace_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EXAMPLES
    parser.add_argument("action", choices=("check",), help="what to do with the traces")
    parser.add_argument("script", type=as_path, help=SCRIPT)
    parser.add_argument("traces", type=as_path, nargs="+", metavar="TRACE",
                        help="file that `run --trace` or a robot has written")  # fmt: skip
    parser.add_argument("--format", choices=("text", "json"), default="text", help=FORMAT)
    search_folders(parser)
    colour(parser)


def trace_command(arguments: Namespace) -> int:
    """Judge every trace; the exit code."""
    from smachac.driver import analyse_script
    from smachac.verify.coverage import Coverage
    from smachac.verify.trace_report import judge_trace, trace_json, trace_text, untaken

    analysis = analyse_script(arguments.script, arguments.scripts, arguments.templates)
    print_report(without_notes(analysis.report), arguments, sys.stderr)
    machine = analysis.checked
    if machine is None:
        return FINDINGS
    taken = Coverage(machine)
    judged = []
    for path in arguments.traces:
        name = _not_regular(path)
        if name is not None:
            return usage(f"the trace {path} cannot be read: {name}")
        try:
            with path.open(encoding="utf-8", errors="replace", newline="\n") as lines:
                judged.append(judge_trace(machine, str(path), lines, taken))
        except OSError as error:
            return usage(f"the trace {path} cannot be read: {error.strerror or error}")
    render = trace_json if arguments.format == "json" else trace_text
    sys.stdout.write(render(judged, untaken(machine, taken), len(taken.items)))
    return FINDINGS if any(each.fault is not None for each in judged) else OK


def _not_regular(path: Path) -> str | None:
    """The reason why a path is not read: a device or a pipe may have no end."""
    if not path.exists():
        return "no such file"
    return None if path.is_file() else "it is not a regular file"
