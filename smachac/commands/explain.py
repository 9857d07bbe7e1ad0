"""The command `explain`: explain a code, or a state, a key, the failures or the
properties of a script."""

from __future__ import annotations

import argparse
import sys
from argparse import Namespace

from smachac.commands.arguments import colour, machine_name, report_output, search_folders
from smachac.commands.output import FINDINGS, OK, print_report, usage, without_notes
from smachac.commands.python_files import MachineError, is_python, one_analysis

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from smachac.analysis.context import Context

EXAMPLES = """\
examples:
  smachac explain SM201                  a code: what it means, with examples
  smachac explain main.yml grasp_pose    a key: which states set it and read it, where it is unset
  smachac explain main.yml PICK/GRASP    a state, by its path or the end of its path
  smachac explain main.yml --failures    where every failure leads
  smachac explain machine.py PICK        a state of a machine in Python
  smachac explain main.yml --failures --format csv > failures.csv
  smachac explain main.yml --properties  the properties of the script, and which of them hold
  smachac explain main.yml --properties --scenario NAME > fails.yml
                                         a counterexample, for `run main.yml --mock fails.yml`

exit codes: 0 success, 1 the script cannot be read, 2 wrong usage or unknown name,
70 a bug in smachac
"""


def explain_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EXAMPLES
    parser.add_argument("words", nargs="*", metavar="CODE | SCRIPT [NAME]",
                        help="a code, or a script and the name of a state or key")  # fmt: skip
    parser.add_argument("--all", action="store_true", help="explain all codes, as Markdown")
    parser.add_argument("--failures", action="store_true",
                        help="list where every failure of the script leads")  # fmt: skip
    parser.add_argument("--properties", action="store_true",
                        help="list the properties of the script and whether they hold")  # fmt: skip
    parser.add_argument("--scenario", metavar="NAME",
                        help="with --properties: the counterexample of the property with this name"
                        " or number, as a scenario for `run --mock`")  # fmt: skip
    report_output(parser, "text", "json", "md", "csv")  # the last two with --failures only
    machine_name(parser)
    search_folders(parser)
    colour(parser)


def explain_command(arguments: Namespace) -> int:
    """Explain what the words name; the exit code."""
    from pathlib import Path

    from smachac.analysis.context import Context
    from smachac.diagnostics.diagnostic import has_errors
    from smachac.driver import CODES, analyse_script
    from smachac.frontend.files import Disk

    words, form = arguments.words, arguments.format
    if form in ("md", "csv") and not arguments.failures:
        return usage(f"--format {form} needs --failures")
    if arguments.scenario is not None and not arguments.properties:
        return usage("--scenario needs --properties")
    if arguments.failures and arguments.properties:
        return usage("use one of --failures and --properties")
    whole = arguments.failures or arguments.properties
    if arguments.all:
        from smachac.report.explain_code import render_rules

        sys.stdout.write(render_rules(CODES))
        return OK
    if len(words) == 1 and not whole:
        return _explain_code(words[0])
    if len(words) != (1 if whole else 2):
        return usage(
            "name a code such as SM201, or a script with a state, a key, --failures or --properties"
        )
    path = Path(words[0])
    if arguments.machine is not None and not is_python(path):
        return usage("--machine is for Python files")
    try:
        analysis = (
            one_analysis(path, Disk(), arguments.machine)
            if is_python(path)
            else analyse_script(path, arguments.scripts, arguments.templates)
        )
    except MachineError as error:
        return usage(str(error), error.word, error.known)
    if analysis.machine is None:
        print_report(without_notes(analysis.report), arguments, sys.stderr)
        return FINDINGS
    if has_errors(analysis.report) and not arguments.properties:
        what = "file" if is_python(path) else "script"
        print(f"the {what} has errors: the explanation may be incomplete", file=sys.stderr)
    if arguments.properties:
        return _explain_properties(Context(analysis.machine), arguments.scenario, form)
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


def _explain_properties(context: Context, scenario: str | None, form: str) -> int:
    """Print the properties of a script, or the counterexample of one; the exit code."""
    from smachac.report.explain_properties import (
        NoScenarioError,
        render_properties,
        render_scenario,
    )

    machine, found = context.machine, context.judgements
    if scenario is None:
        sys.stdout.write(render_properties(machine, found, form))
        return OK
    try:
        sys.stdout.write(render_scenario(machine, found, scenario))
    except NoScenarioError as error:
        return usage(str(error))
    return OK


def _explain_code(word: str) -> int:
    """Print what a code means; the exit code."""
    from pathlib import Path

    from smachac.driver import CODES
    from smachac.report.explain_code import render_code

    code = CODES.get(word.upper())
    if code is None and Path(word).suffix:
        return usage(f"name a state or a key of {word}, or use --failures")
    if code is None:
        return usage(_no_code(word, list(CODES)))
    print(render_code(code))
    return OK


def _no_code(word: str, codes: list[str]) -> str:
    """The message for a word that is no code: the codes that begin with it, the nearest code, or
    how to name a state."""
    from smachac.diagnostics.diagnostic import did_you_mean

    begun = [code for code in codes if code.startswith(word.upper())]
    if begun:
        found = f"the codes that begin so: {', '.join(begun)}"
    else:
        found = did_you_mean(word.upper(), codes) or (
            f"a state or a key needs its script: smachac explain main.yml {word}\n"
            "`smachac explain --all` lists the codes"
        )
    return f"there is no code `{word}`\n{found}"
