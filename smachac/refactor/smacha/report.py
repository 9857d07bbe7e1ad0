"""The migration report: a table, JSON, or Markdown."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict

from smachac.records import dataclass
from smachac.refactor.smacha.script_differences import What
from smachac.report.json import json_text
from smachac.report.terminal import on_one_line, visible

FORMATS = ("text", "json", "md")


@dataclass(frozen=True, slots=True, kw_only=True)
class MigrationItem:
    """One note about a file. `name` is a code of smachac or the name of a difference."""

    line: int
    column: int
    what: What
    name: str
    message: str
    help: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class File:
    """A script, sub-script or template. `fails`: it does not work without edits."""

    name: str
    kind: str
    fails: bool
    items: tuple[MigrationItem, ...]

    def count(self, what: What) -> int:
        return sum(item.what == what for item in self.items)


def render_migration(files: Sequence[File], form: str) -> str:
    """The report in one of FORMATS."""
    match form:
        case "json":
            return _json(files)
        case "md":
            return _markdown(files)
    return _text(files)


def _state(file: File) -> str:
    return "edit" if file.fails else "works"


def _counts(file: File) -> str:
    words = (("edit", "to edit"), ("changed", "changed"), ("note", "noted"))
    found = [(file.count(what), word) for what, word in words]  # type: ignore[arg-type]
    return ", ".join(f"{number} {word}" for number, word in found if number)


def _summary(files: Sequence[File]) -> str:
    failing = sum(file.fails for file in files)
    changed = sum(file.count("changed") for file in files)
    good = len(files) - failing
    return (
        f"{good} of {len(files)} files work as they are, {failing} have to be edited; "
        f"{changed} places mean something else here"
    )


def _text(files: Sequence[File]) -> str:
    names = [on_one_line(file.name) for file in files]
    width = max(map(len, names), default=0)
    lines = []
    for file, name in zip(files, names, strict=True):
        counts = _counts(file)
        lines.append(f"{name:<{width}}  {file.kind:<10}  {_state(file):<5}  {counts}".rstrip())
    for file, item in _reported(files):
        lines.append("")
        place = f"{file.name}:{item.line}:{item.column}"
        lines.append(on_one_line(f"{place}: {item.what}: {item.message} [{item.name}]"))
        if item.help and item.what != "changed":
            lines.append(f"  help: {on_one_line(item.help)}")
    return "\n".join([*lines, "", _summary(files), ""])


def _reported(files: Sequence[File]) -> Iterator[tuple[File, MigrationItem]]:
    """All items: first all edits, then all changes, then all notes."""
    for what in ("edit", "changed", "note"):
        for file in files:
            yield from ((file, item) for item in file.items if item.what == what)


def _markdown(files: Sequence[File]) -> str:
    lines = [
        "| file | kind | works | to edit | changed | noted |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    for file in files:
        counts = " | ".join(str(file.count(what)) for what in ("edit", "changed", "note"))
        lines.append(
            f"| {_cell(file.name)} | {file.kind} | {'no' if file.fails else 'yes'} | {counts} |"
        )
    reported = list(_reported(files))
    if reported:
        lines += ["", "| place | what | name | message |", "| --- | --- | --- | --- |"]
    for file, item in reported:
        place = f"{file.name}:{item.line}"
        lines.append(f"| {_cell(place)} | {item.what} | {item.name} | {_cell(item.message)} |")
    return "\n".join([*lines, "", f"{_summary(files)}.", ""])


def _cell(text: str) -> str:
    return visible(text.replace("|", "\\|").replace("\n", " "))


def _json(files: Sequence[File]) -> str:
    data = {
        "files": [{**asdict(file), "state": _state(file)} for file in files],
        "works": sum(not file.fails for file in files),
        "edit": sum(file.fails for file in files),
        "changed": sum(file.count("changed") for file in files),
    }
    return json_text(data)
