"""The command `diff`: the differences of state machines in two files or two git revisions."""

from __future__ import annotations

import argparse
import contextlib
import os
import sys
from argparse import Namespace

from smachac.commands.arguments import as_path, colour, machine_name, report_output, search_folders
from smachac.commands.output import OK, print_report, usage
from smachac.commands.python_files import (
    UNREAD,
    MachineError,
    is_python,
    python_analyses,
    python_finder,
)
from smachac.records import replace

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path
    from typing import TypeAlias

    from smachac.diff.comparison import Comparison
    from smachac.driver import Analysis

    Machines: TypeAlias = Mapping[str, Analysis]
    Pair: TypeAlias = tuple[Analysis | None, Analysis | None]

EXAMPLES = """\
examples:
  smachac diff old.yml new.yml                    two files
  smachac diff main.yml                           what changed since the last commit
  smachac diff main.yml --from v1.0 --to v2.0     two git revisions
  smachac diff --from origin/main --format md > comment.md   all scripts, for a pull request
  smachac diff machine.py --from v1.0            the machines in a Python file
  smachac diff src --python --from origin/main   all scripts, and all Python files with machines
  smachac diff old.yml new.yml --format dot | dot -Tsvg > diff.svg   a picture in red and green
  smachac diff old.yml new.yml --format html > diff.html   the same to explore in a browser

exit codes: 0 equal, 1 different (also with the same behaviour) or a script that
cannot be read, 2 wrong usage, 70 a bug in smachac
"""

FORMATS = ("text", "md", "json", "dot", "html")
DIFFERENT = 1


def diff_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EXAMPLES
    parser.add_argument("script", nargs="*", type=as_path, metavar="SCRIPT",
                        help="two files to compare; or scripts, folders or patterns in git"
                        " (default: the current folder)")  # fmt: skip
    parser.add_argument("--from", dest="old", metavar="REV",
                        help="the git revision before (default: HEAD, unless there are two files)"
                        )  # fmt: skip
    parser.add_argument("--to", dest="new", metavar="REV",
                        help="the git revision after (default: the files as they are)")  # fmt: skip
    report_output(parser, *FORMATS)
    parser.add_argument("--python", action="store_true", help="in folders, also compare Python"
                        " files that build machines for SMACH, YASMIN or FlexBE")  # fmt: skip
    machine_name(parser)
    search_folders(parser)
    colour(parser)


def diff_command(arguments: Namespace) -> int:
    """Compare scripts and print the differences; the exit code."""
    from smachac.commands.git import GitError
    from smachac.frontend.discovery import NothingFoundError

    try:
        pairs = _analyses(arguments)
    except (GitError, NothingFoundError) as error:
        return usage(str(error))
    except MachineError as error:
        return usage(str(error), error.word, error.known)
    for analysis in (analysis for pair in pairs for analysis in pair):
        if analysis is not None and analysis.machine is None:
            print_report(analysis.report, arguments, sys.stderr)
    return _put(arguments, pairs)


def _analyses(arguments: Namespace) -> list[Pair]:
    """Each script, and each machine of a Python file, before and after; None where it does not
    exist. Raises GitError, NothingFoundError and MachineError."""
    from smachac.frontend.discovery import NothingFoundError

    paths = [_from_here(path) for path in arguments.script] or [as_path(".")]
    revisions = (arguments.old, arguments.new)
    if revisions == (None, None) and len(paths) == 2 and not any(map(os.path.isdir, paths)):
        one, other = (_checked([path], None, arguments).get(str(path), {}) for path in paths)
        pairs = [*_pairs(one, other)]
    else:
        before = _at("HEAD" if arguments.old is None else arguments.old, paths, arguments)
        after = _at(arguments.new, paths, arguments)
        if not before and not after:
            raise NothingFoundError(f"there is no script in `{paths[0]}`")
        names = dict.fromkeys([*after, *before])
        pairs = [
            pair for name in names for pair in _pairs(before.get(name, {}), after.get(name, {}))
        ]
    if not pairs:
        raise NothingFoundError(f"there is no state machine in `{paths[0]}`")
    return _named(pairs, arguments.machine)


def _pairs(before: Machines, after: Machines) -> Iterator[tuple[str, Pair]]:
    """The machines of a file before and after, each with its name. Two that are the only ones of
    their files are the same machine; so is one in a file that could not be read."""
    names = dict.fromkeys([*after, *before])
    if UNREAD in names or (len(before) == len(after) == 1):
        name = next(reversed(names)) if UNREAD in names else next(iter(names))
        yield name, (next(iter(before.values()), None), next(iter(after.values()), None))
        return
    for name in names:
        old, new = before.get(name), after.get(name)
        if len(names) > 1:
            old, new = _with_machine(old, name), _with_machine(new, name)
        yield name, (old, new)


def _named(pairs: Sequence[tuple[str, Pair]], name: str | None) -> list[Pair]:
    """All pairs, or those of the machines with a name. Raises MachineError."""
    found = [pair for known, pair in pairs if name is None or known == name]
    if not found and name is not None:
        known = tuple(dict.fromkeys(known for known, _ in pairs if known))
        raise MachineError(f"there is no machine `{name}`", name, known)
    return found


def _with_machine(analysis: Analysis | None, name: str) -> Analysis | None:
    """The analysis of one of several machines, whose name is shown behind that of the file."""
    return None if analysis is None else replace(analysis, script=f"{analysis.script} ({name})")


def _from_here(path: Path) -> Path:
    """A path relative to the current folder, so that it means the same file in a git revision."""
    return as_path(os.path.relpath(path)) if path.is_absolute() else path


def _at(
    revision: str | None, paths: Sequence[Path], arguments: Namespace
) -> Mapping[str, Machines]:
    """The analyses of the scripts in a revision, or on disk, by name. A link that leads out of the
    repository is not followed, also if it is named. Raises GitError."""
    from smachac.commands.git import GitError, checked_out, top_folder

    top = top_folder()
    for path in paths:
        named = path.parent if os.path.islink(path) else path  # noqa: PTH114 (a name too long)
        if not as_path(os.path.realpath(named)).is_relative_to(top):
            raise GitError(f"`{path}` is not in the git repository {top}")
    if revision is None:
        return _checked(paths, top, arguments)
    with checked_out(revision) as folder:
        return _checked(paths, folder, arguments)


def _checked(
    paths: Sequence[Path], top: Path | None, arguments: Namespace
) -> Mapping[str, Machines]:
    """The analyses of the scripts that files, folders and patterns match, by name; none where there
    is no such file. Links that lead out of the folder `top` are not followed."""
    from smachac.driver.batch import check_scripts
    from smachac.frontend.discovery import NothingFoundError, scripts_of
    from smachac.frontend.files import Disk, leads_out, lies_inside

    found: list[Path] = []
    disk = Disk()
    python = python_finder(arguments)
    for path in paths:
        if top is not None and not lies_inside(path, top):
            folder = as_path(os.path.relpath(top))
            disk.refused[str(path)] = leads_out(path, folder, can_be_named=False)
            found += [path] if os.path.lexists(path) else []
        else:
            with contextlib.suppress(NothingFoundError):
                inside = scripts_of([path], disk, python)
                found += [path for path in inside if os.path.lexists(path)]
    found = list(dict.fromkeys(found))
    scripts = [path for path in found if not is_python(path)]
    analyses = check_scripts(scripts, disk, arguments.scripts, arguments.templates).analyses
    machines: dict[str, Machines] = {name: {"": analysis} for name, analysis in analyses.items()}
    return machines | python_analyses(filter(is_python, found), disk)


def _put(arguments: Namespace, pairs: Sequence[Pair]) -> int:
    """Print the comparisons; the exit code."""
    from smachac.diff.comparison import compare
    from smachac.diff.report import render_json, render_markdown, render_text

    found = [compare(before, after) for before, after in pairs]
    different = [comparison for comparison in found if not comparison.equal]
    match arguments.format:
        case "html":
            return _put_page(list(zip(pairs, found, strict=True)))
        case "dot":
            return _put_picture(different or found)
        case "json":
            sys.stdout.write(render_json(found))
        case "md":
            sys.stdout.write(render_markdown(found))
        case _:
            sys.stdout.write(render_text(found))
    return DIFFERENT if different else OK


def _put_picture(found: Sequence[Comparison]) -> int:
    """Print the picture of one script; the exit code."""
    from smachac.diff.picture import render_picture

    if len(found) > 1:
        return usage(
            "--format dot draws one script: name it, and with --machine one of several machines"
        )
    sys.stdout.write(render_picture(found[0]))
    return OK if found[0].equal else DIFFERENT


def _put_page(found: Sequence[tuple[Pair, Comparison]]) -> int:
    """Print the page of one script; the exit code."""
    from smachac.diff.page import render_difference_page

    different = [pair for pair in found if not pair[1].equal] or found
    if len(different) > 1:
        return usage(
            "--format html draws one script: name it, and with --machine one of several machines"
        )
    ((pair, comparison),) = different
    machine = next(
        (analysis.machine for analysis in reversed(pair) if analysis and analysis.machine), None
    )
    if machine is None or comparison.unread:
        return DIFFERENT  # its errors are printed
    sys.stdout.write(render_difference_page(comparison, machine))
    return OK if comparison.equal else DIFFERENT
