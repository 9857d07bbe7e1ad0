"""The command `verify`: compare generated programs with the interpreter, path by path."""

from __future__ import annotations

import argparse
import gc
import sys
from argparse import Namespace

from smachac.commands.arguments import FORMAT, SCRIPT, as_path, colour, count, names, search_folders
from smachac.commands.output import FINDINGS, OK, print_report, usage, without_notes

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from smachac.diagnostics.diagnostic import Report
    from smachac.frontend.loader import Library
    from smachac.ir.nodes import Checked
    from smachac.verify.test_case import Player

EXAMPLES = """\
examples:
  smachac verify main.yml                        compare the generated Python with the script
  smachac verify main.yml --targets python,cpp   compare the generated C++ too (needs a compiler)
  smachac verify main.yml --paths 2000           try more paths
  smachac verify main.yml --seed 7               try other random paths
  smachac verify main.yml --format json          for programs, with every transition not taken

exit codes: 0 success, 1 a program behaves differently, cannot be run, or the script has errors,
2 wrong usage, 70 a bug in smachac, 130 interrupted
"""

TARGETS = ("python", "cpp")
"""The targets whose programs `verify` can run."""


def verify_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EXAMPLES
    parser.add_argument("script", type=as_path, help=SCRIPT)
    parser.add_argument("--targets", type=names, default=["python"], metavar="A,B,...",
                        help="targets to compare: python, cpp (default: python)")  # fmt: skip
    parser.add_argument("--paths", type=count, metavar="N",
                        help="try at most N paths (default: 200, or more if needed to take every"
                        " transition)")  # fmt: skip
    parser.add_argument("--seed", type=int, default=0, help="seed of the random paths (default: 0)")
    parser.add_argument("--format", choices=("text", "json"), default="text", help=FORMAT)
    search_folders(parser)
    colour(parser)


def verify_command(arguments: Namespace) -> int:
    """Compare each target with the interpreter; the exit code."""
    from smachac.driver import analyse_script
    from smachac.verify import verify
    from smachac.verify.result import render_json, render_text
    from smachac.verify.test_case import UnplayableError

    for name in arguments.targets or [""]:
        if name not in TARGETS:
            return usage(f"`verify` cannot run the target `{name}`", name, TARGETS)
    analysis = analyse_script(arguments.script, arguments.scripts, arguments.templates)
    machine, library, report = analysis.checked, analysis.library, [*analysis.report]
    players: dict[str, Player] = {}
    if machine is not None and library is not None:
        players = _players(arguments, machine, library, report)
    print_report(without_notes(report), arguments, sys.stderr)
    if machine is None or len(players) < len(set(arguments.targets)):
        return FINDINGS
    gc.freeze()  # the script stays; each path makes new machines, which are collected
    gc.set_threshold(50_000)
    gc.enable()
    try:
        verdict = verify(
            machine, players, script=machine.source, most=arguments.paths, seed=arguments.seed
        )
    except UnplayableError as error:
        print(error, file=sys.stderr)
        return FINDINGS
    render = render_json if arguments.format == "json" else render_text
    sys.stdout.write(render(verdict))
    return FINDINGS if verdict.disagreements else OK


def _players(
    arguments: Namespace, machine: Checked, library: Library, report: Report
) -> dict[str, Player]:
    """The requested targets that can express the whole machine; the others are reported."""
    from smachac.diagnostics.diagnostic import has_errors
    from smachac.driver import build, merged
    from smachac.targets.python import TARGET
    from smachac.verify.players import cpp, python

    players: dict[str, Player] = {}
    for name in dict.fromkeys(arguments.targets):
        found: Report = []
        if name == "cpp":
            player = cpp.player(machine, found)
        else:
            files = build(machine, TARGET, library, found)
            ((file, text),) = files.items() or [("", "")]
            player = python.player(file, text, machine, folder=arguments.script.parent)
        report[:] = merged(report, found)
        if not has_errors(found):
            players[name] = player
    return players
