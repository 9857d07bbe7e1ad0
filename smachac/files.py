"""The disk: the only module of the compiler that reads scripts and templates or writes outputs."""

from __future__ import annotations

import contextlib
import errno
import os
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from smachac import problems
from smachac.diagnostics import Report, did_you_mean
from smachac.project import Project, read_project
from smachac.source import Source, Span
from smachac.states import Library
from smachac.syntax import Tree, parse

_HERE = Path(__file__).parent
BUILT_IN = (_HERE / "states", _HERE / "targets" / "python" / "templates")
"""The folders of the built-in state types, and of the templates of containers."""

SUFFIXES = ("", ".yml", ".yaml")
MAX_BYTES = 50_000_000


def read_source(path: Path, report: Report) -> Source | None:
    """A text file as a source under the path as given; SM007 where it cannot be read."""
    try:
        if path.stat().st_size > MAX_BYTES:
            place = Span(Source(str(path), ""), 0, 0)
            report.append(problems.too_big(place, f"the file has {path.stat().st_size:,} bytes"))
            return None
        return Source(str(path), _decoded(path.read_bytes()))
    except OSError as error:
        span = Span(Source(str(path), ""), 0, 0)
        words = (error.strerror or str(error)).lower()
        near = did_you_mean(path.name, _names_beside(path))
        report.append(problems.unreadable_file(span, f"this file cannot be read: {words}", near))
    except UnicodeDecodeError as error:
        text = error.object[: error.start].decode("utf-8", "replace")
        span = Span(Source(str(path), text), len(text), len(text))
        byte = error.object[error.start]
        report.append(
            problems.unreadable_file(span, f"byte 0x{byte:02x} is not UTF-8: is it a text file?")
        )
    return None


def _names_beside(path: Path) -> list[str]:
    """The names of files in the folder of a path; none where there is no such folder."""
    with contextlib.suppress(OSError):
        return sorted(other.name for other in path.parent.iterdir() if other.is_file())
    return []


def _decoded(data: bytes) -> str:
    """UTF-8 with or without a byte order mark, or UTF-16 with one (YAML 1.2.2, section 5.2)."""
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return data.decode("utf-16")
    return data.decode("utf-8-sig")


class Disk:
    """What one run reads: each file once, each text parsed once, whoever asks for it.

    `texts` stand for the files at their (real) paths. `asked` collects the real paths of all that
    was looked for, whether it was there or not; whoever wants to know empties it before. `plain`:
    lines end with a line feed alone, whatever the files say.
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
        """As `syntax.parse`."""
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


def find_project(main: Path, report: Report, disk: Disk | None = None) -> Project:
    """The settings of the nearest `smachac.toml`, or `[tool.smachac]` of a `pyproject.toml`.

    Looked for from the script's folder upwards, as far as the root of the git repository.
    """
    disk = disk or Disk()
    for folder in (main.parent, *_parents(main.parent)):
        for name in ("smachac.toml", "pyproject.toml"):
            path = folder / name
            if disk.is_file(path):
                source = disk.read(path, report)
                project = read_project(source, path, report) if source is not None else Project()
                if project is not None:
                    return project
        if (folder / ".git").exists():
            break
    return Project()


def _parents(folder: Path) -> list[Path]:
    """The folders above, in the user's terms: `..` where the path is relative."""
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
) -> Library:
    """The library of a script on disk.

    Scripts are looked for in the folder of the calling file, then in `scripts`, then in the
    project file's; templates in `templates`, the project file's, `templates/` beside the main
    script, and the built-in ones; modules and headers of the user in the project file's `code`, in
    the folder of the main script and its `include/`. Nothing outside these folders is read.
    """
    disk = disk or Disk()
    project = find_project(main, report, disk)
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
        template_folders=lambda: [
            *(str(folder) for folder in template_folders[: -len(BUILT_IN)]),
            "the built-in ones",
        ],
        script_names=lambda caller: _stems(script_folders(caller), (".yml", ".yaml")),
        template_names=lambda: _stems(template_folders[:-1], (".tpl.py", ".tpl", ".yml")),
        parse=disk.parse,
        policy=project.policy,
    )


def _found(name: str, folders: Sequence[Path], suffixes: Sequence[str], disk: Disk) -> Path | None:
    """The first file of that name that lies inside one of the folders."""
    if "\0" in name:
        return None
    for folder in folders:
        for suffix in suffixes:
            path = folder / f"{name}{suffix}"
            with contextlib.suppress(OSError):  # a name too long for the file system is not there
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


MARK = "Made by smachac"
"""What every file we write says in its first lines: so we know our own."""


def runtime_files(paths: Mapping[str, str]) -> dict[str, str]:
    """The files that generated code stands on, by the names they get beside it; `paths` gives
    where they are under smachac/runtime."""
    root = _HERE / "runtime"
    return {name: (root / path).read_text("utf-8") for name, path in paths.items()}


def foreign_files(folder: Path, files: Mapping[str, str]) -> list[Path]:
    """Files that are in the way: they exist and were not written by us."""
    found = []
    for name in files:
        path = folder / name
        if path.exists():
            with contextlib.suppress(OSError), path.open(encoding="utf-8", errors="replace") as old:
                if MARK in old.read(2000):
                    continue
            found.append(path)
    return found


def present_files(folder: Path, files: Iterable[str]) -> list[Path]:
    """Those of some files that are there, whoever wrote them."""
    return [folder / name for name in files if (folder / name).exists()]


def changed_files(folder: Path, files: Mapping[str, str]) -> list[Path]:
    """Files whose content on disk is not what would be written."""
    changed = []
    for name, text in files.items():
        path = folder / name
        if not path.is_file() or path.read_bytes() != text.encode("utf-8"):
            changed.append(path)
    return changed


def write_files(folder: Path, files: Mapping[str, str]) -> list[Path]:
    """Write all files or none, each to a temporary file that is then renamed.

    Raises OSError; nothing is left behind then.
    """
    paths = {folder / name: text.encode("utf-8") for name, text in files.items()}
    made: list[Path] = []
    try:
        for path in paths:
            missing = [each for each in path.parents if not each.exists()]
            for each in reversed(missing):
                each.mkdir(exist_ok=True)
                made.append(each)
        _put_all({path: (data, 0o644) for path, data in paths.items()})
    except BaseException:
        for each in reversed(made):
            with contextlib.suppress(OSError):
                each.rmdir()
        raise
    return list(paths)


class ChangedError(Exception):
    """A file is not what it was when it was read; the words name it."""


def rewrite_files(texts: Mapping[str, str], before: Mapping[str, Source]) -> None:
    """Give files, named by real path, new texts: all of them or none, in the encoding and with the
    permissions they have. What `before` does not hold is a new file.

    Raises OSError, also for a file that nobody may write or a new one that is there, and
    ChangedError where somebody else has written since `before` was read.
    """
    contents: dict[Path, tuple[bytes, int]] = {}
    for name, text in texts.items():
        path = Path(name)
        if name not in before:
            if path.exists():
                raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), name)
            contents[path] = (text.encode("utf-8"), 0o644)
            continue
        data = path.read_bytes()
        mode = path.stat().st_mode & 0o7777
        if _decoded(data) != before[name].text:
            raise ChangedError(f"{before[name].name} was changed by somebody else meanwhile")
        if not mode & 0o222:
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), before[name].name)
        contents[path] = (_encoded(text, data), mode)
    _put_all(contents)


def _encoded(text: str, like: bytes) -> bytes:
    """A text in the encoding of other bytes, as `_decoded` reads it."""
    for mark, encoding in ((b"\xff\xfe", "utf-16-le"), (b"\xfe\xff", "utf-16-be"),
                           (b"\xef\xbb\xbf", "utf-8")):  # fmt: skip
        if like.startswith(mark):
            return mark + text.encode(encoding)
    return text.encode("utf-8")


def _put_all(contents: Mapping[Path, tuple[bytes, int]]) -> None:
    """Write bytes, with their permissions, to all paths or to none."""
    written: list[tuple[str, Path]] = []
    try:
        for path, (data, mode) in contents.items():
            handle, temporary = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
            written.append((temporary, path))
            with os.fdopen(handle, "wb") as stream:
                stream.write(data)
            Path(temporary).chmod(mode)
        for _, path in written:
            if path.is_dir():
                raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
        for temporary, path in written:
            Path(temporary).replace(path)
    except BaseException:
        for temporary, _ in written:
            with contextlib.suppress(OSError):
                Path(temporary).unlink()
        raise


def stamps(paths: Iterable[str]) -> dict[str, tuple[int, int] | None]:
    """What tells that files have changed: time of writing (ns) and size; None for what is not."""
    found: dict[str, tuple[int, int] | None] = {}
    for path in paths:
        try:
            status = Path(path).stat()
            found[path] = (status.st_mtime_ns, status.st_size)
        except OSError:
            found[path] = None
    return found
