"""File access: scripts, templates and project files from disk, each read once."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from smachac.diagnostics.diagnostic import Code, Report, did_you_mean
from smachac.diagnostics.source import Source, Span
from smachac.frontend.config import Project, read_project
from smachac.frontend.errors.script import too_big, unreadable_file
from smachac.frontend.loader import Library
from smachac.frontend.yaml_tree import Tree, parse

PACKAGE = Path(__file__).parent.parent
BUILT_IN = (PACKAGE / "stdlib", PACKAGE / "targets" / "python" / "templates")
"""The folders of the built-in state types and of the templates of containers."""

SUFFIXES = ("", ".yml", ".yaml")
MAX_BYTES = 50_000_000


def read_source(path: Path, report: Report) -> Source | None:
    """A text file as a source, named by the path as given; SM007 if it cannot be read."""
    try:
        if path.stat().st_size > MAX_BYTES:
            place = Span(Source(str(path), ""), 0, 0)
            size = f"{path.stat().st_size:,} bytes; the limit is {MAX_BYTES:,}"
            help = "split it into smaller files"
            report.append(too_big(place, f"the file has {size}", help, arguments=("bytes",)))
            return None
        return Source(str(path), decoded(path.read_bytes()))
    except OSError as error:
        span = Span(Source(str(path), ""), 0, 0)
        words = (error.strerror or str(error)).lower()
        near = did_you_mean(path.name, _names_beside(path))
        message = f"this file cannot be read: {words}"
        report.append(unreadable_file(span, message, near, arguments=("read",)))
    except UnicodeDecodeError as error:
        text = error.object[: error.start].decode("utf-8", "replace")
        span = Span(Source(str(path), text), len(text), len(text))
        byte = error.object[error.start]
        message = f"the byte 0x{byte:02x} is not valid in {error.encoding.upper()}"
        report.append(unreadable_file(span, message, arguments=("byte", f"{byte:02x}")))
    return None


def _names_beside(path: Path) -> list[str]:
    """The names of the files beside a path; none if there is no such folder."""
    with contextlib.suppress(OSError):
        return sorted(other.name for other in path.parent.iterdir() if other.is_file())
    return []


def decoded(data: bytes) -> str:
    """UTF-8 with or without a byte order mark, or UTF-16 with one (YAML 1.2.2, section 5.2)."""
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return data.decode("utf-16")
    return data.decode("utf-8-sig")


class Disk:
    """The files of one run: each file is read once, each text is parsed once.

    `texts` replace the files at their (real) paths. `asked` collects the real paths of all files
    that were searched, found or not; the caller may empty it. `plain`: all line ends become line
    feeds.
    """

    def __init__(self, texts: Mapping[str, str] | None = None, *, plain: bool = False) -> None:
        self.texts = texts or {}
        self.plain = plain
        self.asked: set[str] = set()
        self._sources: dict[str, tuple[Source | None, Report]] = {}
        self._trees: dict[Source, tuple[Tree | None, Report]] = {}

    def read(self, path: Path, report: Report) -> Source | None:
        """As `read_source`."""
        key = os.path.realpath(path)
        self.asked.add(key)
        if key not in self._sources:
            found: Report = []
            text = self.texts.get(key)
            source = read_source(path, found) if text is None else Source(str(path), text)
            if self.plain and source is not None and "\r" in source.text:
                source = Source(source.name, with_line_feeds(source.text))
            self._sources[key] = (source, found)
        source, problems_found = self._sources[key]
        report.extend(problems_found)
        return source

    def parse(self, source: Source, report: Report) -> Tree | None:
        """As `yaml_tree.parse`."""
        if source not in self._trees:
            found: Report = []
            self._trees[source] = (parse(source, found), found)
        tree, problems_found = self._trees[source]
        report.extend(problems_found)
        return tree

    def is_file(self, path: Path) -> bool:
        key = os.path.realpath(path)
        self.asked.add(key)
        return key in self.texts or path.is_file()


def with_line_feeds(text: str) -> str:
    return text.replace("\r\n", "\n").replace("\r", "\n")


def find_project(
    main: Path,
    report: Report,
    disk: Disk | None = None,
    codes: Mapping[str, Code] | None = None,
) -> Project:
    """The settings of the nearest `smachac.toml`, or `[tool.smachac]` of a `pyproject.toml`.

    The search goes from the script's folder upwards to the root of the git repository.
    """
    disk = disk or Disk()
    for folder in (main.parent, *_parents(main.parent)):
        for name in ("smachac.toml", "pyproject.toml"):
            path = folder / name
            if disk.is_file(path):
                source = disk.read(path, report)
                if source is None:
                    return Project()
                project = read_project(source, path, report, codes)
                if project is not None:
                    return project
        if (folder / ".git").exists():
            break
    return Project()


def _parents(folder: Path) -> list[Path]:
    """The parent folders; for a relative path they are relative too, with `..`."""
    if folder.is_absolute():
        return list(folder.parents)
    named = [parent for parent in folder.parents if str(parent) != "."]
    above = Path.cwd().parents
    here = [Path()] if str(folder) != "." else []
    return [*named, *here, *(Path(*[".."] * (n + 1)) for n in range(len(above)))]


def disk_library(
    main: Path,
    report: Report,
    *,
    scripts: Sequence[Path] = (),
    templates: Sequence[Path] = (),
    disk: Disk | None = None,
    codes: Mapping[str, Code] | None = None,
) -> Library:
    """The library of a script on disk.

    Scripts are searched in the folder of the calling file, then in `scripts`, then in the project's
    `scripts`; templates in `templates`, the project's `templates`, `templates/` beside the main
    script, and the built-in folders; modules and headers of the user in the project's `code`, the
    folder of the main script and its `include/`. No file outside these folders is read.
    `codes`: see `read_project`.
    """
    disk = disk or Disk()
    project = find_project(main, report, disk, codes)
    own_scripts = [*scripts, *project.scripts]
    template_folders = [*templates, *project.templates, main.parent / "templates", *BUILT_IN]

    code_folders = [*project.code, main.parent, main.parent / "include"]

    def script_folders(caller: str) -> list[Path]:
        return list(dict.fromkeys([Path(caller).parent, *own_scripts]))

    def script(name: str, caller: str) -> Source | None:
        path = _found(name, script_folders(caller), SUFFIXES, disk)
        return disk.read(path, report) if path else None

    def template(name: str, folders: Sequence[Path] = template_folders) -> Source | None:
        path = _found(name, folders, ("",), disk)
        return disk.read(path, report) if path else None

    return Library(
        script=script,
        template=template,
        own_template=lambda name: template(name, template_folders[: -len(BUILT_IN)]),
        code=lambda name: template(name, code_folders),
        script_folders=lambda caller: [str(folder) for folder in script_folders(caller)],
        template_folders=lambda: [str(folder) for folder in template_folders[: -len(BUILT_IN)]],
        script_names=lambda caller: _stems(script_folders(caller), (".yml", ".yaml")),
        template_names=lambda: _stems(template_folders[:-1], (".tpl.py", ".tpl", ".yml")),
        parse=disk.parse,
        policy=project.policy,
    )


def _found(name: str, folders: Sequence[Path], suffixes: Sequence[str], disk: Disk) -> Path | None:
    """The first file of that name inside one of the folders; no link leads out of them."""
    if "\0" in name:
        return None
    for folder in folders:
        for suffix in suffixes:
            path = folder / f"{name}{suffix}"
            with contextlib.suppress(OSError):  # a name may be too long for the file system
                if disk.is_file(path) and path.resolve().is_relative_to(folder.resolve()):
                    return path
    return None


def _stems(folders: Sequence[Path], suffixes: Sequence[str]) -> list[str]:
    names = []
    for folder in folders:
        with contextlib.suppress(OSError):
            for path in sorted(folder.iterdir()):
                for suffix in suffixes:
                    if path.name.endswith(suffix):
                        names.append(path.name.removesuffix(suffix))
                        break
    return list(dict.fromkeys(names))


def stamps(paths: Iterable[str]) -> dict[str, tuple[int, int] | None]:
    """Time of modification (ns) and size of each file; None if it does not exist."""
    found: dict[str, tuple[int, int] | None] = {}
    for path in paths:
        try:
            status = Path(path).stat()
            found[path] = (status.st_mtime_ns, status.st_size)
        except OSError:
            found[path] = None
    return found
