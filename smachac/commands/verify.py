"""What `smachac verify` does."""

from __future__ import annotations

import argparse
import gc
import sys

from smachac.commands.output import FINDINGS, OK, print_report, shown, usage
from smachac.diagnostics.diagnostic import Report, has_errors
from smachac.driver import analyse_file, build, together
from smachac.frontend.loader import Library
from smachac.ir.nodes import Checked
from smachac.targets import load_target
from smachac.verify import verify
from smachac.verify.players import cpp, python
from smachac.verify.result import render_json, render_text
from smachac.verify.test_case import Player, UnplayableError

PLAYED = ("python", "cpp")
"""The targets whose programs `verify` can play."""


def run_verify(arguments: argparse.Namespace) -> int:
    """Ends with 0 when every target does what the interpreter does."""
    for name in arguments.targets or [""]:
        if name not in PLAYED:
            return usage(f"`verify` cannot play the target `{name}`", name, list(PLAYED))
    analysis, library = analyse_file(arguments.script, arguments.scripts, arguments.templates)
    machine, report = analysis.checked, [*analysis.report]
    players: dict[str, Player] = {}
    if machine is not None and library is not None:
        players = _players(arguments, machine, library, report)
    print_report(shown(report), arguments, sys.stderr)
    if machine is None or len(players) < len(set(arguments.targets)):
        return FINDINGS
    gc.freeze()  # what is there stays; each path makes a machine anew
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
    arguments: argparse.Namespace, machine: Checked, library: Library, report: Report
) -> dict[str, Player]:
    """Those of the targets asked for that can say all of the machine; the others are reported."""
    players: dict[str, Player] = {}
    for name in dict.fromkeys(arguments.targets):
        found: Report = []
        if name == "cpp":
            player = cpp.player(machine, found)
        else:
            target = load_target(name)
            assert target is not None
            files = build(machine, target, library, found)
            ((file, text),) = files.items() or [("", "")]
            player = python.player(file, text, machine, folder=arguments.script.parent)
        report[:] = together(report, found)
        if not has_errors(found):
            players[name] = player
    return players
