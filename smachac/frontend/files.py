"""File access: scripts, templates and project files from disk, each read once."""

from __future__ import annotations

import contextlib
import errno
import os
import stat
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TypeAlias

from smachac.diagnostics.diagnostic import (
    Code,
    Diagnostic,
    Report,
    Severity,
    did_you_mean,
    did_you_mean_file,
)
from smachac.diagnostics.source import Source, Span, Word
from smachac.frontend.config import (
    FOLDERS,
    PROJECT_FILES,
    Project,
    folder_places,
    read_project,
)
from smachac.frontend.errors.script import too_big, unreadable_file
from smachac.frontend.loader import ROBOT_FILES, SUFFIXES, Library
from smachac.frontend.text.recovering_parser import parse_with_recovery
from smachac.frontend.text.yaml_tree import Tree
from smachac.pysource.modules.ros_names import Ros
from smachac.records import replace
from smachac.robots.encodings import EncodingError, decoded

TYPE_CHECKING = False  # annotations only: few scripts have a robot file or are parsed in pieces
if TYPE_CHECKING:
    from smachac.frontend.text.pieces import PieceTree
    from smachac.robots.files import Packages

PACKAGE = Path(__file__).parent.parent
BUILT_IN = (PACKAGE / "stdlib", PACKAGE / "targets" / "python" / "templates")
"""The folders of the built-in state types and of the templates of containers."""

ROBOTS = PACKAGE / "robots"
"""The folder of the descriptions of built-in robots."""

MAX_BYTES = 50_000_000


def read_source(path: Path, report: Report) -> Source | None:
    """A text file as a source, named by the path as given; SM007 if it cannot be read."""
    place = Span(Source(str(path), ""), 0, 0)
    if not _is_text(str(path)):
        message, help = "the name of this file is not UTF-8", "rename the file"
        report.append(unreadable_file(place, message, help, arguments=("name",)))
        return None
    try:
        return source_of(path, decoded(read_bytes(path), path.name))
    except TooBigError as error:
        help = "split it into smaller files"
        report.append(too_big(place, str(error), help, arguments=("bytes",)))
    except UnicodeDecodeError as error:
        report.append(_not_text(path, error))
    except EncodingError as error:
        place = Span(place.source, 0, 0)
        help = "save the file as UTF-8, and declare `utf-8`"
        arguments = ("encoding", error.declared)
        report.append(unreadable_file(place, str(error), help, arguments=arguments))
    except (OSError, ValueError) as error:
        words = (getattr(error, "strerror", None) or str(error)).lower()
        near = None
        if isinstance(error, IsADirectoryError):
            near = _script_inside(path)
        elif isinstance(error, FileNotFoundError):
            near = did_you_mean_file(path.name, _names_beside(path))
        message = f"this file cannot be read: {words}"
        report.append(unreadable_file(place, message, near, arguments=("read",)))
    return None


def source_of(path: Path, text: str) -> Source:
    """The text of a file as a source."""
    return Source(str(path), text, "python" if path.suffix == ".py" else "yaml")


def _is_text(name: str) -> bool:
    """Whether a file name is UTF-8: bytes that are not become lone surrogates."""
    try:
        name.encode("utf-8")
    except UnicodeEncodeError:
        return False
    return True


def _not_text(path: Path, error: UnicodeDecodeError) -> Diagnostic:
    text = error.object[: error.start].decode("utf-8", "replace")
    span = Span(Source(str(path), text), len(text), len(text))
    byte = error.object[error.start]
    message = f"the byte 0x{byte:02x} is not valid in {error.encoding.upper()}"
    help = "save the file as UTF-8"
    if error.object[:2] in (b"\xff\xfe", b"\xfe\xff"):
        help = f"{help}: it seems to be UTF-16"
    elif byte >= 0xA0:
        help = f"{help}: it seems to be Latin-1, with `{chr(byte)}` here"
    return unreadable_file(span, message, help, arguments=("byte", f"{byte:02x}"))


class TooBigError(Exception):
    """A file is larger than MAX_BYTES; the message has the size."""


def read_bytes(path: Path) -> bytes:
    """The content of a regular file; a pipe or a device is not opened for waiting.

    Raises OSError, ValueError (a path with a NUL) and TooBigError.
    """
    handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    with open(handle, "rb") as stream:  # noqa: PTH123 (a file descriptor)
        status = os.fstat(handle)
        if stat.S_ISDIR(status.st_mode):
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
        if not stat.S_ISREG(status.st_mode):
            raise OSError(errno.EINVAL, "not a regular file", str(path))
        size = status.st_size
        data = stream.read(MAX_BYTES + 1) if size <= MAX_BYTES else b""
        if max(size, len(data)) > MAX_BYTES:
            size = max(size, len(data))
            raise TooBigError(f"the file has {size:,} bytes; the limit is {MAX_BYTES:,}")
    return data


def lies_inside(path: Path, folder: Path) -> bool:
    """Whether a path lies inside a folder after all links are followed."""
    try:
        plain = path.parent == folder and path.name != ".." and "\0" not in path.name
        if plain and not path.is_symlink():
            return True
        return Path(os.path.realpath(path)).is_relative_to(os.path.realpath(folder))
    except (OSError, ValueError):  # a NUL in the name
        return False


def leads_out(path: Path, folder: Path, *, can_be_named: bool = True) -> Diagnostic:
    """SM007: a link in a folder that is searched leads out of it. `can_be_named`: a link that is
    named on the command line is followed."""
    message = f"this link leads out of the folder `{folder}`: it is not followed"
    help = "copy the file into the folder"
    if can_be_named:
        help = f"{help}, or name it or its folder on the command line"
    return unreadable_file(Span(Source(str(path), ""), 0, 0), message, help, arguments=("link",))


def _names_beside(path: Path) -> list[str]:
    """The names of the files beside a path; none if there is no such folder."""
    with contextlib.suppress(OSError):
        return sorted(other.name for other in path.parent.iterdir() if other.is_file())
    return []


def _script_inside(path: Path) -> str:
    """The help for a folder in place of a script: a script in it, `main.yml` first."""
    names = sorted(_names_beside(path / "main.yml"), key=lambda name: (name != "main.yml", name))
    scripts = [name for name in names if name.endswith((".yml", ".yaml"))]
    example = f", such as `{path / scripts[0]}`" if scripts else ""
    return f"name a script{example}; `smachac check` also accepts folders"


LONG_TEXT = 100_000
"""In characters: the tree of a longer text is not kept after the text was read."""


class Disk:
    """The files of one or several runs: each file is read once, each text is parsed once, until
    `replace` or `refresh` forgets it.

    `texts` replace the files at their (real) paths. `searched` collects the paths, as given, of
    all files that were searched, found or not; the caller may empty it. `plain`: all line ends
    become line feeds. `refused`: the paths that are not read, as given, and why. `in_pieces`: the
    states of a file that is replaced keep their trees where they did not change (pieces.py).
    """

    def __init__(
        self,
        texts: Mapping[str, str] | None = None,
        *,
        plain: bool = False,
        refused: Mapping[str, Diagnostic] | None = None,
        in_pieces: bool = False,
    ) -> None:
        self.texts = dict(texts or {})
        self.refused = dict(refused or {})
        self.plain = plain
        self._pieces: dict[str, tuple[PieceTree, ...]] | None = {} if in_pieces else None
        self.searched: set[str] = set()
        self._sources: dict[str, tuple[Source | None, Report]] = {}
        self._stamps: dict[str, Stamp] = {}
        self._trees: dict[Source, tuple[Tree | None, Report]] = {}
        self._expanded: dict[object, str] = {}

    def read(self, path: Path, report: Report) -> Source | None:
        """As `read_source`."""
        if str(path) in self.refused:
            report.append(self.refused[str(path)])
            return None
        self.searched.add(str(path))
        key = os.path.realpath(path)
        if key not in self._sources:
            found: Report = []
            text = self.texts.get(key)
            if text is None:  # before the text: a change while it is read is noticed
                self._stamps |= stamps([key])
            source = read_source(path, found) if text is None else source_of(path, text)
            if self.plain and source is not None and "\r" in source.text:
                source = replace(source, text=with_line_feeds(source.text))
            self._sources[key] = (source, found)
        source, problems_found = self._sources[key]
        report.extend(problems_found)
        return source

    def known(self, path: str) -> Source | None:
        """The text of a file that was read, by its real path."""
        return self._sources.get(path, (None, []))[0]

    def parse(self, source: Source, report: Report) -> Tree | None:
        """As `parse_with_recovery`."""
        if source not in self._trees:
            found: Report = []
            tree = self._parse_in_pieces(source) or parse_with_recovery(source, found)
            self._trees[source] = (tree, found)
        tree, problems_found = self._trees[source]
        report.extend(problems_found)
        return tree

    def release(self, source: Source) -> None:
        """Forget the tree of a long text, unless an editor needs it: it takes half of the memory of
        a check. Of a short text the search for repairs uses it."""
        if self._pieces is None and len(source.text) > LONG_TEXT:
            self._trees.pop(source, None)

    def _parse_in_pieces(self, source: Source) -> Tree | None:
        """As `pieces.parse_in_pieces`, for the texts of files."""
        path = os.path.realpath(source.name)
        if self._pieces is None or self.known(path) is not source:
            return None
        from smachac.frontend.text.pieces import parse_in_pieces

        found = parse_in_pieces(source, self._pieces.get(path, ()))
        if found is None:
            return None
        tree, self._pieces[path] = found
        return tree

    def expand(self, file: str, arguments: Mapping[str, str], packages: Packages) -> str:
        """The URDF text of a xacro file on disk. Raises XacroError."""
        from smachac.robots import xacro_files

        key = (file, *sorted(arguments.items()), *sorted(packages.items()))
        if key not in self._expanded:
            expanded = xacro_files.expand(Path(file), arguments, packages)
            for path in expanded.files:
                self.read(path, [])  # a change of one of them is noticed
            self._expanded[key] = expanded.text
        return self._expanded[key]

    def replace(self, path: Path, text: str | None) -> None:
        """Set the text of a file from now on; with None, its text is that on disk again."""
        key = os.path.realpath(path)
        if text is None:
            self.texts.pop(key, None)
        else:
            self.texts[key] = text
        self._forget([key])

    def refresh(self) -> set[str]:
        """Forget the files that have changed on disk since they were read; their real paths."""
        now = stamps(key for key in self._sources if key not in self.texts)
        changed = {key for key, stamp in now.items() if stamp != self._stamps.get(key)}
        self._forget(changed)
        return changed

    def _forget(self, keys: Iterable[str]) -> None:
        """Forget some files, and the trees of all texts that are no file or none any more."""
        keys = [*keys]
        if keys:
            self._expanded.clear()
        for key in keys:
            self._sources.pop(key, None)
        held = {source for source, _ in self._sources.values()}
        self._trees = {source: tree for source, tree in self._trees.items() if source in held}

    def is_file(self, path: Path) -> bool:
        self.searched.add(str(path))
        return path.is_file() or (bool(self.texts) and os.path.realpath(path) in self.texts)

    def searched_files(self) -> frozenset[str]:
        """The real paths of the files in `searched`."""
        found = set()
        for path in self.searched:
            with contextlib.suppress(ValueError):  # a NUL in the name
                found.add(os.path.realpath(path))
        return frozenset(found)


def with_line_feeds(text: str) -> str:
    return text.replace("\r\n", "\n").replace("\r", "\n")


def module_folders(main: Path) -> list[Path]:
    """The folders from which a program may import modules of the user: that of the script, and the
    `code` of its project."""
    return list(dict.fromkeys([main.parent, *find_project(main, []).code]))


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
        for name in PROJECT_FILES:
            path = folder / name
            if disk.is_file(path):
                if not lies_inside(path, folder):
                    report.append(leads_out(path, folder))
                    return Project(readable=False)
                source = disk.read(path, report)
                if source is None:
                    return Project(readable=False)
                project = read_project(source, path, report, codes)
                if project is not None:
                    return _inside_repository(project, source, report)
        if (folder / ".git").exists():
            break
    return Project()


def has_project(main: Path) -> bool:
    """Whether `find_project` finds a project file for a script."""
    report: Report = []
    return find_project(main, report) != Project() or bool(report)


def _inside_repository(project: Project, source: Source, report: Report) -> Project:
    """The project without the search folders outside its git repository, or outside its own folder
    if there is none. A folder that does not exist is reported too."""
    above = (project.folder, *_parents(project.folder))
    root = next((path for path in above if (path / ".git").exists()), project.folder)
    kept: dict[str, list[Path]] = {setting: [] for setting in FOLDERS}
    for setting, folders in kept.items():
        written = folder_places(source, setting, project.folder)
        for folder in getattr(project, setting):
            if lies_inside(folder, root):
                folders.append(folder)
                if not folder.is_dir():
                    report.append(_no_folder(setting, written(folder), folder))
                continue
            message = f"`{setting}` names a folder outside the project: `{folder}`"
            help = "move it into the project; `--scripts` and `--templates` may name any folder"
            place = Span(source, 0, 0)
            report.append(unreadable_file(place, message, help, arguments=("link",)))
    return replace(
        project,
        scripts=tuple(kept["scripts"]),
        templates=tuple(kept["templates"]),
        code=tuple(kept["code"]),
    )


def _no_folder(setting: str, written: Word, folder: Path) -> Diagnostic:
    """SM007, as a warning: a search folder does not exist."""
    names: list[str] = []
    with contextlib.suppress(OSError):
        names = sorted(path.name for path in folder.parent.iterdir() if path.is_dir())
    before = written.text.rstrip("/").removesuffix(folder.name)
    near = did_you_mean(f"{before}{folder.name}", [f"{before}{name}" for name in names])
    return unreadable_file(
        written.span,
        f"the folder `{written.text}` of `{setting}` does not exist",
        near or "create it, or remove it from the setting",
        arguments=("folder", setting, written.text),
        severity=Severity.WARNING,
    )


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
    ros: Ros | None = None,
    disk: Disk | None = None,
    codes: Mapping[str, Code] | None = None,
) -> Library:
    """The library of a script on disk.

    Scripts are searched in the folder of the calling file, then in `scripts`, then in the project's
    `scripts`; templates in `templates`, the project's `templates`, `templates/` beside the main
    script, and the built-in folders; modules and headers of the user in the project's `code`, the
    folder of the main script and its `include/`; definitions of ROS as `definitions` describes. No
    other file is read. `ros` replaces that of the project; for `codes` see `read_project`.
    """
    disk = disk or Disk()
    project = find_project(main, report, disk, codes)
    refused: set[Path] = set()

    def refuse(path: Path, folder: Path) -> None:
        if path not in refused:
            refused.add(path)
            report.append(leads_out(path, folder))

    own_templates, include = main.parent / "templates", main.parent / "include"
    for folder in (own_templates, include):
        if folder.is_dir() and not lies_inside(folder, main.parent):
            refuse(folder, main.parent)
    own_types = [*templates, *project.templates, own_templates]
    template_folders = [type_ for type_ in (*own_types, *BUILT_IN) if type_ not in refused]
    code_folders = [path for path in (*project.code, main.parent, include) if path not in refused]

    def script_folders(caller: str) -> list[Path]:
        return list(dict.fromkeys([Path(caller).parent, *scripts, *project.scripts]))

    def script(name: str, caller: str) -> Source | None:
        path = _found(name, script_folders(caller), SUFFIXES, disk, refuse)
        return disk.read(path, report) if path else None

    def template(name: str, folders: Sequence[Path] = template_folders) -> Source | None:
        path = _found(name, folders, ("",), disk, refuse)
        return disk.read(path, report) if path else None

    def message_folders() -> list[Path]:
        return [*project.code, *_package_folders(main)]

    return Library(
        script=script,
        template=template,
        own_template=lambda name: template(name, template_folders[: -len(BUILT_IN)]),
        code=lambda name: template(name, code_folders),
        code_names=lambda name: _names_in(name, code_folders),
        definitions=lambda path, report: definitions(path, message_folders(), disk, report),
        definition_names=lambda folder: definition_names(folder, message_folders()),
        folders_with=lambda files: _folders_with(files, main.parent),
        script_folders=lambda caller: _searched(script_folders(caller), project),
        template_folders=lambda: _searched(template_folders[: -len(BUILT_IN)], project),
        script_names=lambda caller: _stems(script_folders(caller), (".yml", ".yaml")),
        robot_names=lambda caller: _with_ending(script_folders(caller), ROBOT_FILES),
        template_names=lambda: _stems(template_folders[:-1], (".tpl.py", ".tpl", ".yml")),
        parse=disk.parse,
        release=disk.release,
        ros=project.ros if ros is None else ros,
        bounds=project.bounds,
        types=project.types,
        cpp_types=project.cpp_types,
        policy=project.policy,
        settings_read=project.readable,
        robot=lambda name: _robot_file(name, disk, report),
        mesh=_mesh,
        expand=disk.expand,
    )


def _searched(folders: Sequence[Path], project: Project) -> list[str]:
    """The folders for messages, without those of the project that do not exist."""
    own = (*project.scripts, *project.templates)
    return [str(folder) for folder in folders if folder not in own or folder.is_dir()]


def definitions(path: str, folders: Sequence[Path], disk: Disk, report: Report) -> list[Source]:
    """All files with the definition of a message, `package/msg/Name.msg`; none if one of them
    cannot be read.

    They are searched in packages of the user, which are in `folders` or are one of them; then in
    the packages that are installed (`installed_packages`).
    """
    found: dict[str, Source | None] = {}
    for file in _definition_places(path, folders):
        with contextlib.suppress(OSError, ValueError):
            if disk.is_file(file):
                found.setdefault(os.path.realpath(file), disk.read(file, report))
    sources = [source for source in found.values() if source is not None]
    return sources if len(sources) == len(found) else []


def definition_names(path: str, folders: Sequence[Path]) -> list[str]:
    """The names of the files in all folders `package/msg` of a package, searched as
    `definitions` describes."""
    names: set[str] = set()
    for place in _definition_places(path, folders):
        with contextlib.suppress(OSError, ValueError):
            names.update(path.name for path in place.iterdir())
    return sorted(names)


def _definition_places(path: str, folders: Sequence[Path]) -> list[Path]:
    """The places where a file or folder of message definitions can be."""
    package, _, inner = path.partition("/")
    from smachac.robots.files import installed_packages

    own = [
        file
        for folder in folders
        for file in (folder / path, folder / inner)
        if (file != folder / inner or _real_name(folder) == package) and lies_inside(file, folder)
    ]
    installed = [file / inner for file in installed_packages(package, os.environ)]
    return [*own, *installed]


def _package_folders(main: Path) -> list[Path]:
    """The folder of a script and those above it, up to the root of its git repository; without
    one, the folder of the script and the one above it."""
    folders = [main.parent, *_parents(main.parent)]
    root = next((at for at, folder in enumerate(folders) if (folder / ".git").exists()), 1)
    return folders[: root + 1]


def _real_name(folder: Path) -> str:
    return Path(os.path.realpath(folder)).name


def _mesh(name: str, urdf: str, packages: Packages) -> Path | None:
    """The path of a mesh that a URDF file names."""
    from smachac.robots.files import find_mesh

    return find_mesh(name, Path(urdf), packages)


def _robot_file(name: str, disk: Disk, report: Report) -> Source | None:
    """A file of the built-in robots, or of PyBullet's data where that is installed."""
    for folder in (ROBOTS, *_robot_data()):
        path = _found(name, [folder], ("",), disk, lambda path, folder: None)
        if path is not None:
            return disk.read(path, report)
    return None


def _robot_data() -> Iterator[Path]:
    """The folder of PyBullet's data, found without an import of PyBullet."""
    from importlib.util import find_spec

    spec = find_spec("pybullet_data")
    if spec is not None and spec.origin:
        yield Path(spec.origin).parent


def _found(
    name: str,
    folders: Sequence[Path],
    suffixes: Sequence[str],
    disk: Disk,
    refuse: Callable[[Path, Path], None],
) -> Path | None:
    """The first file of that name inside one of the folders. `refuse` is called for a link that
    leads out of its folder."""
    below = ".." not in Path(name).parts and not Path(name).is_absolute()
    for folder in folders:
        for suffix in suffixes:
            path = folder / f"{name}{suffix}"
            # A name may be too long for the file system, or have characters that it cannot encode.
            with contextlib.suppress(OSError, ValueError):
                if disk.is_file(path):
                    if lies_inside(path, folder):
                        return path
                    if below:
                        refuse(path, folder)
    return None


def _names_in(name: str, folders: Sequence[Path]) -> list[str]:
    """The names of the files and folders in a folder that lies inside some folders."""
    names: set[str] = set()
    for folder in folders:
        with contextlib.suppress(OSError, ValueError):
            if lies_inside(folder / name, folder):
                names.update(path.name for path in (folder / name).iterdir())
    return sorted(names)


def _folders_with(files: Collection[str], top: Path) -> list[str]:
    """The folders up to two levels below a folder that have one of the files."""
    found, wanted = [], frozenset(files)
    for folder, inner, names in os.walk(top):
        depth = len(Path(folder).relative_to(top).parts)
        inner[:] = sorted(name for name in inner if not name.startswith("."))[:_MOST_FOLDERS]
        if depth == _DEEPEST:
            inner.clear()
        if depth and not wanted.isdisjoint(names):
            found.append(str(Path(folder)))
    return found


_DEEPEST, _MOST_FOLDERS = 2, 30
"""The levels of folders, and the folders of one level, that are searched for a help."""


def _stems(folders: Sequence[Path], suffixes: Sequence[str]) -> list[str]:
    names = []
    for folder in folders:
        with contextlib.suppress(OSError):
            for name in sorted(path.name for path in folder.iterdir()):
                suffix = next((suffix for suffix in suffixes if name.endswith(suffix)), None)
                if suffix is not None:
                    names.append(name.removesuffix(suffix))
    return list(dict.fromkeys(names))


def _with_ending(folders: Sequence[Path], endings: tuple[str, ...]) -> list[str]:
    """The names of the files in folders that have one of some endings."""
    names: dict[str, None] = {}
    for folder in folders:
        with contextlib.suppress(OSError):
            found = (path.name for path in sorted(folder.iterdir()))
            names |= dict.fromkeys(name for name in found if name.lower().endswith(endings))
    return [*names]


Stamp: TypeAlias = "tuple[int, int] | None"
"""Time of modification (ns) and size of a file; None if it does not exist."""


def stamps(paths: Iterable[str]) -> dict[str, Stamp]:
    """The stamp of each file."""
    found: dict[str, Stamp] = {}
    for path in paths:
        try:
            status = Path(path).stat()
            found[path] = (status.st_mtime_ns, status.st_size)
        except OSError:
            found[path] = None
    return found
