"""The command `explain`: a code, a state, a key, or the failures of a script."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from smachac.analysis.context import Context
from smachac.commands.output import FINDINGS, OK, print_report, shown, usage
from smachac.driver import CODES, analyse_file


def explain(arguments: argparse.Namespace) -> int:
    words, form = arguments.words, arguments.format
    if form in ("md", "csv") and not arguments.failures:
        return usage(f"--format {form} is for --failures")
    if arguments.all or (len(words) == 1 and not arguments.failures):
        return explain_code(*words) if not arguments.all else explain_code()
    if len(words) != (1 if arguments.failures else 2):
        return usage("name a code such as SM201, or a script with a state or key or --failures")
    analysis, _ = analyse_file(Path(words[0]), arguments.scripts, arguments.templates)
    if analysis.machine is None:
        print_report(shown(analysis.report), arguments, sys.stderr)
        return FINDINGS
    if analysis.checked is None:
        print("the script has errors: this is what can be read of it", file=sys.stderr)
    if arguments.failures:
        from smachac.report.explain_failures import render_failures

        name = analysis.machine.root.name
        sys.stdout.write(render_failures(name, Context(analysis.machine).failures, form))
        return OK
    from smachac.report.explain_name import UnclearError, explain_name

    try:
        sys.stdout.write(explain_name(Context(analysis.machine), analysis.report, words[1], form))
    except UnclearError as error:
        return usage(str(error))
    return OK


def explain_code(word: str = "") -> int:
    """What a code means; without a word, all of them."""
    from smachac.report.explain_code import render_code, render_rules

    if not word:
        sys.stdout.write(render_rules(CODES))
        return OK
    code = CODES.get(word.upper())
    if code is None and Path(word).suffix:
        return usage(f"name a state or a key of {word}, or say --failures")
    if code is None:
        return usage(f"there is no code `{word}`", word.upper(), list(CODES))
    print(render_code(code))
    return OK
