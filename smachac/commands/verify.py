"""The command `verify`: compare programs with the interpreter, path by path."""

from __future__ import annotations

import argparse
import gc
import sys
from argparse import Namespace

from smachac.commands.arguments import (
    SCRIPT,
    as_path,
    colour,
    count,
    generated_states,
    names,
    report_output,
    search_folders,
    seed,
)
from smachac.commands.interrupts import interrupts_raise
from smachac.commands.output import (
    FINDINGS,
    OK,
    print_report,
    target_options,
    usage,
    without_notes,
)
from smachac.commands.terminal import ProgressLine

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from smachac.diagnostics.diagnostic import Report
    from smachac.diagnostics.source import Source
    from smachac.frontend.loader import Library
    from smachac.ir.nodes import Checked
    from smachac.ir.types import Bounds
    from smachac.verify.test_case import Player

EXAMPLES = """\
examples:
  smachac verify main.yml                        compare the generated Python with the script
  smachac verify main.yml --targets python,cpp   compare the generated C++ too (needs a compiler)
  smachac verify main.yml --targets scxml        compare the SCXML document, on SCION (needs Node)
  smachac verify main.yml --targets yasmin       compare the program for YASMIN (needs YASMIN)
  smachac verify main.yml --targets flexbe       compare the packages for FlexBE (needs FlexBE)
  smachac verify main.yml --program pick.py      compare this file, edited by hand or built before
  smachac verify main.yml --header pick.hpp      compare this C++ header (needs a compiler)
  smachac verify main.yml --targets cpp --option mode=step   compare the stepped C++
  smachac verify main.yml --paths 2000           try more paths
  smachac verify main.yml --seed 7               try other random paths
  smachac verify main.yml --format json          for programs, with every transition not taken

exit codes: 0 success, 1 a program behaves differently, cannot be run, or the script has errors,
2 wrong usage, 70 a bug in smachac, 130 interrupted
"""

TARGETS = ("python", "cpp", "scxml", "yasmin", "flexbe")
"""The targets whose programs `verify` can run."""

SUFFIXES = {
    "program": (".py",),
    "header": (".hpp", ".h", ".hh", ".hxx"),
}
"""The usual suffixes of the files of the two options; a file with another suffix is taken too."""


def verify_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EXAMPLES
    parser.add_argument("script", type=as_path, help=SCRIPT)
    parser.add_argument("--targets", type=names, metavar="A,B,...",
                        help="targets to compare: python, cpp, scxml, yasmin, flexbe (default:"
                        " those of --program and --header, else python)")  # fmt: skip
    parser.add_argument("--program", type=as_path, metavar="FILE",
                        help="compare this Python file, not a newly generated one")  # fmt: skip
    parser.add_argument("--header", type=as_path, metavar="FILE",
                        help="compare this C++ header, not a newly generated one")  # fmt: skip
    parser.add_argument("--paths", type=count, metavar="N",
                        help="try at most N paths (default: 200, or more if needed to take every"
                        " transition)")  # fmt: skip
    parser.add_argument("--option", action="append", default=[], metavar="NAME=VALUE",
                        help="an option of the target cpp, as for `build`")  # fmt: skip
    parser.add_argument(
        "--seed", type=seed, default=0, help="seed of the random paths (default: 0)"
    )
    report_output(parser, "text", "json")
    generated_states(parser)
    search_folders(parser)
    colour(parser)


def verify_command(arguments: Namespace) -> int:
    """Compare each target with the interpreter; the exit code."""
    from smachac.driver import analyse_script
    from smachac.ir.written import generated, written
    from smachac.targets.cpp.project import project
    from smachac.verify import verify
    from smachac.verify.result import render_json, render_text
    from smachac.verify.test_case import UnplayableError

    if (wrong := _wrong_usage(arguments)) is not None:
        return wrong
    options = _options(arguments.option)
    if isinstance(options, int):
        return options
    paths = {"python": arguments.program, "cpp": arguments.header}
    files = {target: path for target, path in paths.items() if path is not None}
    targets = list(dict.fromkeys([*(arguments.targets or ()), *files])) or ["python"]
    analysis = analyse_script(arguments.script, arguments.scripts, arguments.templates)
    machine, library, report = analysis.checked, analysis.library, [*analysis.report]
    sources = _read(files, report)
    players: dict[str, Player] = {}
    if machine is not None and library is not None and len(sources) == len(files):
        bounds = project(options, library.bounds).bounds
        players = _players(arguments.script, targets, sources, machine, library, report, bounds)
    print_report(without_notes(report), arguments, sys.stderr)
    if machine is None or len(players) < len(targets):
        return FINDINGS
    gc.freeze()  # the script stays; each path makes new machines, which are collected
    gc.set_threshold(50_000)
    gc.enable()
    try:
        # Compiled programs and their folder are removed.
        with interrupts_raise(), ProgressLine(sys.stderr) as progress:
            verdict = verify(
                machine,
                players,
                script=machine.source,
                files={target: str(path) for target, path in files.items()},
                most=arguments.paths,
                seed=arguments.seed,
                view=generated if arguments.generated else written,
                progress=progress,
            )
    except UnplayableError as error:
        print(error, file=sys.stderr)
        return FINDINGS
    render = render_json if arguments.format == "json" else render_text
    sys.stdout.write(render(verdict))
    return FINDINGS if verdict.disagreements else OK


def _wrong_usage(arguments: Namespace) -> int | None:
    """The exit code for an unknown target, or for a file with the suffix of the other option."""
    for name in [""] if arguments.targets == [] else arguments.targets or ():
        if name not in TARGETS:
            return usage(f"`verify` cannot run the target `{name}`", name, TARGETS)
    for option, other in (("program", "header"), ("header", "program")):
        path: Path | None = getattr(arguments, option)
        if path is not None and path.suffix.lower() in SUFFIXES[other]:
            return usage(f"--{option} does not play {path}: `--{other} {path}` does")
    return None


def _options(texts: Sequence[str]) -> dict[str, str] | int:
    """The options of the target cpp; the exit code after an error of usage."""
    from smachac.targets import OptionError
    from smachac.targets.cpp import TARGET
    from smachac.targets.cpp.project import project

    options = target_options(texts, TARGET)
    if isinstance(options, int):
        return options
    try:
        project(options)
    except OptionError as error:
        return usage(f"--option {error}")
    return options


def _read(files: Mapping[str, Path], report: Report) -> dict[str, Source]:
    """The files on disk, by target; those that cannot be read are reported."""
    from smachac.frontend.files import read_source

    found = {target: read_source(path, report) for target, path in files.items()}
    return {target: source for target, source in found.items() if source is not None}


def _players(
    script: Path,
    targets: list[str],
    sources: Mapping[str, Source],
    machine: Checked,
    library: Library,
    report: Report,
    bounds: Bounds | None,
) -> dict[str, Player]:
    """The requested targets that can express the whole machine; the others are reported."""
    from smachac.diagnostics.diagnostic import has_errors
    from smachac.driver import merged

    players: dict[str, Player] = {}
    for name in targets:
        found: Report = []
        if name in sources:
            player = _file_player(name, script, sources[name], machine, library, found)
        else:
            player = _generated_player(name, script, machine, library, found, bounds)
        report[:] = merged(report, found)
        if not has_errors(found):
            players[name] = player
    return players


def _generated_player(
    target: str,
    script: Path,
    machine: Checked,
    library: Library,
    report: Report,
    bounds: Bounds | None,
) -> Player:
    """A player of the program that smachac generates now. `bounds` are those of a stepped machine
    in C++."""
    from smachac.driver import build
    from smachac.frontend.files import module_folders
    from smachac.targets import BuildContext
    from smachac.targets import flexbe as flexbe_target
    from smachac.targets import python as python_target
    from smachac.targets import yasmin as yasmin_target
    from smachac.targets.runtime_files import runtime_files
    from smachac.verify.players import cpp, flexbe, python, scxml, yasmin

    if target == "cpp":
        return cpp.player(machine, report, bounds, library)
    if target == "scxml":
        return scxml.player(machine, report, folders=[script.resolve().parent])
    folders = module_folders(script)
    if target == "yasmin":
        files = build(machine, yasmin_target.TARGET, library, report)
        return yasmin.player(files, machine, folders=folders)
    if target == "flexbe":
        files = build(machine, flexbe_target.TARGET, library, report)
        context = BuildContext(library=library)
        files |= runtime_files(flexbe_target.TARGET.runtime(machine, context))
        return flexbe.player(files, machine, folders=folders)
    files = build(machine, python_target.TARGET, library, report)
    ((file, text),) = files.items() or [("", "")]
    return python.player(file, text, machine, folders=folders)


def _file_player(
    target: str, script: Path, source: Source, machine: Checked, library: Library, report: Report
) -> Player:
    """A player of a file on disk, which may use modules or headers beside it and of the project."""
    from pathlib import Path

    from smachac.frontend.files import module_folders
    from smachac.verify.players import cpp_file, python_file

    homes = [Path(source.name).parent, *module_folders(script)]
    if target == "cpp":
        return cpp_file.file_player(source, machine, library, report, folders=homes)
    return python_file.file_player(source, machine, folders=homes)
