"""What the commands do."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from smachac import analyse_file
from smachac.streams import print_report, shown, usage, wants_colour

if TYPE_CHECKING:
    from smachac.diagnostics import Report
    from smachac.driver import Analysis
    from smachac.states import Library
    from smachac.targets import Target

OK, FINDINGS = 0, 1
"""Exit codes: clean; findings or a failed run."""


def _load(path: Path, arguments: argparse.Namespace) -> tuple[Analysis, Library | None]:
    return analyse_file(path, arguments.scripts, arguments.templates)


def _check(arguments: argparse.Namespace) -> int:
    from smachac.checkup import check

    return check(arguments)


def _fmt(arguments: argparse.Namespace) -> int:
    from smachac.rewriting import fmt

    return fmt(arguments)


def _states(arguments: argparse.Namespace) -> int:
    from smachac.telling import states

    return states(arguments)


def _new(arguments: argparse.Namespace) -> int:
    from smachac.beginning import new

    return new(arguments)


def _extract(arguments: argparse.Namespace) -> int:
    from smachac.rework import run_extract

    return run_extract(arguments)


def _inline(arguments: argparse.Namespace) -> int:
    from smachac.rework import run_inline

    return run_inline(arguments)


def _rename(arguments: argparse.Namespace) -> int:
    from smachac.rework import run_rename

    return run_rename(arguments)


def _contain(arguments: argparse.Namespace) -> int:
    from smachac.rework import run_contain

    return run_contain(arguments)


def _build(arguments: argparse.Namespace) -> int:
    from smachac.targets import OptionError, load_target, target_names

    target = load_target(arguments.target)
    if target is None:
        return usage(f"there is no target `{arguments.target}`", arguments.target, target_names())
    options: dict[str, str] = {}
    for text in arguments.option:
        name, equals, value = text.partition("=")
        if not equals:
            return usage(f"--option wants NAME=VALUE, not `{text}`")
        if name not in target.options:
            message = f"target `{target.name}` has no option `{name}`"
            return usage(message, name, list(target.options))
        options[name] = value
    try:
        _, files = _compile(arguments, target, options)
    except OptionError as error:
        return usage(f"--option {error}")
    return FINDINGS if files is None else _put(files, target, arguments)


def _compile(
    arguments: argparse.Namespace, target: Target, options: dict[str, str]
) -> tuple[Analysis, dict[str, str] | None]:
    """The files of a target; none, with a report on stderr, where the script has errors."""
    from smachac.diagnostics import has_errors
    from smachac.driver import build, together

    analysis, library = _load(arguments.script, arguments)
    files: dict[str, str] | None = None
    report = analysis.report
    if analysis.checked is not None and library is not None:
        found: Report = []
        files = build(analysis.checked, target, library, found, options)
        report = together(report, found)
        files = None if has_errors(found) else files
    print_report(shown(report), arguments, sys.stderr)
    return analysis, files


def _put(files: dict[str, str], target: Target, arguments: argparse.Namespace) -> int:
    from smachac.files import changed_files, foreign_files, runtime_files, write_files

    folder: Path = arguments.output
    if str(folder) == "-":
        sys.stdout.write(next(iter(files.values())))
        return OK
    files = {**files, **runtime_files(target.runtime(files))}
    if arguments.check:
        changed = changed_files(folder, files)
        for path in changed:
            print(f"{path} is not up to date: run `smachac build` again")
        return FINDINGS if changed else OK
    foreign = [] if arguments.force else foreign_files(folder, files)
    if foreign:
        for path in foreign:
            print(f"{path} was not written by smachac; --force overwrites it", file=sys.stderr)
        return FINDINGS
    try:
        for path in write_files(folder, files):
            print(f"wrote {path}")
    except OSError as error:
        print(f"cannot write to {folder}: {error.strerror or error}", file=sys.stderr)
        return FINDINGS
    return OK


def _run(arguments: argparse.Namespace) -> int:
    """Ends with 0 when the machine ends with an outcome (the one of `--expect`, if given)."""
    from smachac.runs import FailedError, perform, play, play_orders, read_scenario_file, watching
    from smachac.targets import load_target

    if arguments.mock is None and (arguments.schedule or arguments.orders):
        return usage("--schedule and --orders are for --mock: a program's threads run as they do")
    target = load_target("python")
    assert target is not None
    if arguments.mock is not None:
        analysis, files = _load(arguments.script, arguments)[0], {}
        print_report(shown(analysis.report), arguments, sys.stderr)
    else:
        analysis, made = _compile(arguments, target, {})
        files = made or {}
    machine = analysis.checked
    if machine is None or not (files or arguments.mock):
        return FINDINGS
    wrong = _wrong_film(arguments, "".join(files.values()))
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


def _wrong_film(arguments: argparse.Namespace, text: str) -> str:
    """What is wrong with `--record` and `--gui`, if anything."""
    if arguments.record is None and not arguments.gui:
        return ""
    if "from smachac import sim" not in text:
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


def _verify(arguments: argparse.Namespace) -> int:
    from smachac.verify.command import check

    return check(arguments)


def _explain(arguments: argparse.Namespace) -> int:
    words, form = arguments.words, arguments.format
    if form in ("md", "csv") and not arguments.failures:
        return usage(f"--format {form} is for --failures")
    if arguments.all or (len(words) == 1 and not arguments.failures):
        return _explain_code(*words) if not arguments.all else _explain_code()
    if len(words) != (1 if arguments.failures else 2):
        return usage("name a code such as SM201, or a script with a state or key or --failures")
    analysis, _ = _load(Path(words[0]), arguments)
    if analysis.machine is None:
        print_report(shown(analysis.report), arguments, sys.stderr)
        return FINDINGS
    if analysis.checked is None:
        print("the script has errors: this is what can be read of it", file=sys.stderr)
    if arguments.failures:
        from smachac.checks.failures import failures
        from smachac.report.explain_failures import render_failures

        machine = analysis.machine
        sys.stdout.write(render_failures(machine.root.name, list(failures(machine)), form))
        return OK
    from smachac.report.explain_name import UnclearError, explain_name

    try:
        sys.stdout.write(explain_name(analysis.machine, analysis.report, words[1], form))
    except UnclearError as error:
        return usage(str(error))
    return OK


def _explain_code(word: str = "") -> int:
    """What a code means; without a word, all of them."""
    from smachac.report.explain import CODES, render_code, render_rules

    if not word:
        sys.stdout.write(render_rules())
        return OK
    code = CODES.get(word.upper())
    if code is None and Path(word).suffix:
        return usage(f"name a state or a key of {word}, or say --failures")
    if code is None:
        return usage(f"there is no code `{word}`", word.upper(), list(CODES))
    print(render_code(code))
    return OK


def _targets(arguments: argparse.Namespace) -> int:
    from smachac.targets import load_target, target_names

    for name in target_names():
        target = load_target(name)
        assert target is not None
        print(f"{name:<10} {target.description}")
        for option, text in target.options.items():
            print(f"{'':<10}   --option {option}=...  {text}")
    return OK


def _migrate(arguments: argparse.Namespace) -> int:
    from smachac.migrate import migrate

    return migrate(arguments)


VERBS: dict[str, Callable[[argparse.Namespace], int]] = {
    "check": _check,
    "build": _build,
    "run": _run,
    "verify": _verify,
    "explain": _explain,
    "fmt": _fmt,
    "states": _states,
    "new": _new,
    "contain": _contain,
    "extract": _extract,
    "inline": _inline,
    "rename": _rename,
    "migrate": _migrate,
    "targets": _targets,
}
"""Command to function."""
