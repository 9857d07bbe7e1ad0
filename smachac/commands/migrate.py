"""The command `migrate`: report what to change in SMACHA scripts and templates."""

from __future__ import annotations

import argparse
import os
import re
import sys
from argparse import Namespace

from smachac.commands.arguments import as_path, report_output, search_folders
from smachac.commands.output import FINDINGS, OK, shown, usage

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from pathlib import Path

    from smachac.diagnostics.diagnostic import Diagnostic, Report
    from smachac.diagnostics.source import Source, Span
    from smachac.frontend.files import Disk
    from smachac.frontend.text.yaml_tree import Tree
    from smachac.refactor.smacha.report import File, MigrationItem
    from smachac.refactor.smacha.script_differences import SmachaDifference

TEMPLATE = re.compile(r"[^.].*\.tpl(\.py)?$")
"""File names of templates."""


EXAMPLES = """\
examples:
  smachac migrate .                      all scripts and templates below the current folder
  smachac migrate scripts templates      the files of two folders
  smachac migrate . --format json > left.json   for programs; md for a page

kinds of places in the report:
  edit      SMACHA ignored an error here; correct it, smachac generates no code with it
  changed   SMACHA and smachac behave differently here, or SMACHA failed here
  note      works as before; a finding of `smachac check`, or a difference without effect

It changes no script and no template. In one folder that has no project file it creates one:
smachac.toml, with `ros = 1`.

exit codes: 0 nothing to edit, 1 something to edit, 2 wrong usage, 70 a bug in smachac
"""


def migrate_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EXAMPLES
    parser.add_argument(
        "folder", nargs="*", type=as_path, help="folders (default: the current one)"
    )
    search_folders(parser)
    report_output(parser, "text", "json", "md")


def migrate_command(arguments: Namespace) -> int:
    """Report on folders; the exit code: 1 if something has to be edited."""
    from pathlib import Path

    from smachac.frontend.discovery import NothingFoundError, scripts_of
    from smachac.frontend.files import Disk
    from smachac.refactor.smacha.report import render_migration

    disk = Disk()
    folders: list[Path] = arguments.folder or [Path()]
    for folder in folders:
        if not folder.is_dir():
            what = "is a file: name its folder" if folder.exists() else "is not a folder"
            return usage(f"`{folder}` {what}")
    templates = [path for folder in folders for path in template_files(folder)]
    try:
        scripts = scripts_of(folders, disk)
    except NothingFoundError as error:
        if not templates:
            return usage(str(error))
        scripts = []
    files = list(_files(scripts, templates, disk, arguments))
    sys.stdout.write(render_migration(files, arguments.format))
    sys.stdout.flush()
    if len(folders) == 1:
        _write_settings(folders[0])
    return FINDINGS if any(file.fails for file in files) else OK


SETTINGS = """\
# Scripts of SMACHA are for ROS 1; docs/migrating.md tells how to cross to ROS 2.
ros = 1
"""


def _write_settings(folder: Path) -> None:
    """Create the project file of a SMACHA project, which has none."""
    from smachac.commands.files import present_files, write_files
    from smachac.commands.writing import PartlyWrittenError
    from smachac.frontend.files import has_project

    files = {"smachac.toml": SETTINGS}
    try:
        if present_files(folder, files) or has_project(folder / "main.yml"):
            return
        (path,) = write_files(folder, files)
    except (OSError, PartlyWrittenError) as error:
        words = getattr(error, "strerror", None) or error
        print(f"cannot create {shown(folder)}/smachac.toml: {words}", file=sys.stderr)
        return
    print(f"created {shown(path)} (ros = 1)", file=sys.stderr)


def template_files(folder: Path) -> Iterator[Path]:
    """The templates below a folder, sorted."""
    from pathlib import Path

    for top, inner, names in os.walk(folder):
        inner[:] = sorted(name for name in inner if not name.startswith("."))
        yield from (Path(top, name) for name in sorted(names) if TEMPLATE.match(name))


def _files(
    scripts: Sequence[Path], templates: Sequence[Path], disk: Disk, arguments: Namespace
) -> Iterator[File]:
    """The report on each file, scripts first."""
    from pathlib import Path

    from smachac.diagnostics.diagnostic import Severity, in_order
    from smachac.frontend.files import disk_library
    from smachac.frontend.text.yaml_tree import Seq
    from smachac.refactor.smacha.report import File
    from smachac.refactor.smacha.template_differences import template_differences, top_level_sets

    texts = [(path, disk.read(path, [])) for path in scripts]
    alone = {path for path, text in texts if text and isinstance(disk.parse(text, []), Seq)}
    reports: dict[Path, Report] = {}
    used: set[str] = set()
    for path, text in texts:
        if path not in alone:
            disk.searched.clear()
            reports[path] = _report(path, text, scripts, templates, disk, arguments)
            used |= disk.searched_files()
    for path, text in texts:
        if path in alone:
            called = os.path.realpath(path) in used
            around = [] if called else [path]
            reports[path] = [
                item
                for path in around
                for item in _report(path, text, scripts, templates, disk, arguments, alone=True)
            ]
    found = in_order(item for report in reports.values() for item in report)
    for path, text in texts:
        kind = "sub-script" if path in alone else "script"
        faults = any(item.severity is Severity.ERROR for item in reports[path])
        yield File(
            name=str(path),
            kind=kind,
            fails=faults or _has_errors(found, path),
            items=tuple(_items(found, path, text, disk)),
        )
    trees = [disk.parse(text, []) for _, text in texts if text is not None]
    types = frozenset(name for tree in trees if tree is not None for name in _types(tree))
    given = frozenset(name for tree in trees if tree is not None for name in _keys(tree))
    sources = [source for path in templates if (source := disk.read(path, [])) is not None]
    sets = {"sm_name": "Base.tpl.py"} | {
        name: source.file_name for source in sources for name in top_level_sets(source)
    }
    for source in sources:
        path = Path(source.name)
        library = disk_library(path, [], templates=_near(path, templates), disk=disk)
        known = [item for item in found if _is_at(item.span, path)]
        fault = _syntax_fault(source)
        if fault is not None and not any(item.code == "SM605" for item in known):
            known.append(fault)
        used_by_scripts = path.name.partition(".")[0] in types
        differences = (
            ()
            if fault
            else template_differences(source, library.template, given, sets, used=used_by_scripts)
        )
        items = [*map(_item, known), *map(_difference, _unreported(differences, known))]
        yield File(
            name=str(path),
            kind="template",
            fails=any(item.what == "edit" for item in items),
            items=tuple(sorted(items, key=lambda item: (item.line, item.column, item.name))),
        )


def _report(
    path: Path,
    source: Source | None,
    scripts: Sequence[Path],
    templates: Sequence[Path],
    disk: Disk,
    arguments: Namespace,
    *,
    alone: bool = False,
) -> Report:
    """The findings of checking a script and of generating Python from it."""
    from smachac.driver import CODES, analyse, compile_script
    from smachac.driver.batch import analyse_alone
    from smachac.frontend.files import disk_library
    from smachac.targets.python import TARGET

    report: Report = []
    if source is None:
        disk.read(path, report)
        return report
    library = disk_library(
        path,
        report,
        ros=1,  # as all of SMACHA
        scripts=[*arguments.scripts, *_near(path, scripts)],
        templates=[*arguments.templates, *_near(path, templates)],
        disk=disk,
        codes=CODES,
    )
    if alone:
        return analyse_alone(source, library, report).report
    return compile_script(analyse(source, library, report), TARGET).report


def _near(path: Path, files: Iterable[Path]) -> list[Path]:
    """The folders of files; first those whose paths have most parts in common with a script."""
    own = set(path.parent.parts)
    folders = dict.fromkeys(file.parent for file in files)
    return sorted(folders, key=lambda folder: (-len(own & set(folder.parts)), str(folder)))


def _keys(tree: Tree) -> Iterator[str]:
    """The names of all variables in a script, in their long form."""
    from smachac.frontend.schema import LONG
    from smachac.frontend.text.yaml_tree import Map, Seq

    todo = [tree]
    while todo:
        each = todo.pop()
        if isinstance(each, Map):
            yield from (LONG.get(name, name) for name in (str(e.key.value) for e in each.entries))
            todo += [entry.value for entry in each.entries]
        elif isinstance(each, Seq):
            todo += each.items


def _types(tree: Tree) -> Iterator[str]:
    """The templates that a script names."""
    from smachac.frontend.text.yaml_tree import Map, Scalar, Seq

    todo = [tree]
    while todo:
        each = todo.pop()
        if isinstance(each, Map):
            for entry in each.entries:
                if str(entry.key.value) in ("template", "T") and isinstance(entry.value, Scalar):
                    yield str(entry.value.value)
                todo.append(entry.value)
        elif isinstance(each, Seq):
            todo += each.items


def _unreported(found: Iterable[SmachaDifference], known: Report) -> Iterator[SmachaDifference]:
    """The differences of a template that no finding reports: SM606 for a line of Python 2, SM605
    for an undefined variable."""
    old_python = {item.span.line for item in known if item.code == "SM606"}
    undefined = {item.finding.arguments for item in known if item.code == "SM605"}
    for difference in found:
        is_old = difference.name == "python-2" and difference.what == "note"
        if is_old and difference.span.line in old_python:
            continue
        if difference.variable and ("undefined", difference.variable) in undefined:
            continue
        yield difference


def _difference(difference: SmachaDifference) -> MigrationItem:
    from smachac.refactor.smacha.report import MigrationItem

    return MigrationItem(
        line=difference.span.line,
        column=difference.span.column,
        what=difference.what,
        name=difference.name,
        message=difference.message,
    )


def _syntax_fault(source: Source) -> Diagnostic | None:
    """The error of a template that cannot be parsed."""

    from smachac.targets.templates.engine import BlockError, Blocks

    name = source.file_name
    try:
        Blocks({name: source}.get).check_syntax(name)
    except BlockError as error:
        return error.diagnostic
    return None


def _is_at(span: Span, path: Path) -> bool:
    return os.path.realpath(span.source.name) == os.path.realpath(path)


def _has_errors(found: Report, path: Path) -> bool:
    from smachac.diagnostics.diagnostic import Severity

    return any(item.severity is Severity.ERROR and _is_at(item.span, path) for item in found)


def _items(found: Report, path: Path, source: Source | None, disk: Disk) -> Iterator[MigrationItem]:
    """The findings in one script and its differences from SMACHA."""
    from smachac.ir.recursion import deep_recursion
    from smachac.refactor.smacha.script_differences import script_differences

    items = [_item(item) for item in found if _is_at(item.span, path)]
    with deep_recursion():
        tree = disk.parse(source, []) if source is not None else None
        items += map(_difference, script_differences(tree))
    yield from sorted(items, key=lambda item: (item.line, item.column, item.name))


def _item(item: Diagnostic) -> MigrationItem:
    from smachac.diagnostics.diagnostic import Severity
    from smachac.refactor.smacha.report import MigrationItem

    return MigrationItem(
        line=item.span.line,
        column=item.span.column,
        what="edit" if item.severity is Severity.ERROR else "note",
        name=item.code,
        message=item.message,
        help=item.help or "",
    )
