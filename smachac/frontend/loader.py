"""The library of a script: functions that find sub-scripts, templates and the user's code."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from smachac.diagnostics.diagnostic import (
    Report,
)
from smachac.diagnostics.severities import Policy
from smachac.diagnostics.source import Source
from smachac.frontend.text.type_names import Aliases
from smachac.frontend.text.yaml_tree import Tree, parse
from smachac.ir.types import Bounds, CppClass
from smachac.pysource.modules.user_code import UserCode
from smachac.records import dataclass, field

TYPE_CHECKING = False  # annotations only: few scripts have a robot file
if TYPE_CHECKING:
    from smachac.robots.files import Packages

SUFFIXES = ("", ".yml", ".yaml")
"""What a script may leave out at the end of the name of a sub-script, in the order of search."""


def no_xacro(file: str, arguments: Mapping[str, str], packages: Packages) -> str:
    """Raise XacroError: texts in memory are not expanded."""
    from smachac.robots.xacro_files import EXPAND, XacroError

    raise XacroError("a xacro file is expanded only on disk", EXPAND, Path(file))


ROBOT_FILES = (".urdf", ".xacro")
"""The endings of robot files."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Library(UserCode):
    """Access to files by functions, so that resolving works without a disk.

    `script(name, caller)` returns the text of a sub-script that the source `caller` names;
    `definitions(path, report)` all message definitions of ROS with a path, such as
    `std_srvs/srv/Trigger.srv`, in the order of the searched folders; `definition_names(folder)` the
    names of the files in all folders with a path, such as `std_srvs/srv`; `folders_with(files)` the
    folders below that of the main script that have one of these files. The lists of folders and
    names are for messages. `policy` are the severities of the project, `bounds` the bounds of texts
    and lists, `types` the types that have names there, `cpp_types` the classes of C++ for some.
    `parse` may return one tree for all scripts that share a text; `release(source)` is
    called where that of a script is not needed again, and may forget it. `robot(file)` returns a
    description or URDF file of a built-in robot, or a file of PyBullet's data. `mesh(name, urdf,
    packages)` returns the path of a mesh that a URDF file names (`find_mesh`); no mesh is opened.
    `expand(file, arguments, packages)` returns the URDF text of a xacro file; it raises XacroError.
    `settings_read` is False
    if the project file or its search folders could not be read.
    """

    script: Callable[[str, str], Source | None]
    definitions: Callable[[str, Report], Sequence[Source]] = lambda path, report: ()
    definition_names: Callable[[str], Sequence[str]] = lambda folder: ()
    folders_with: Callable[[Collection[str]], Sequence[str]] = lambda files: ()
    script_folders: Callable[[str], Sequence[str]] = lambda caller: ()
    template_folders: Callable[[], Sequence[str]] = lambda: ()
    script_names: Callable[[str], Sequence[str]] = lambda caller: ()
    robot_names: Callable[[str], Sequence[str]] = lambda caller: ()
    parse: Callable[[Source, Report], Tree | None] = parse
    release: Callable[[Source], None] = lambda source: None
    policy: Policy = field(default_factory=Policy)
    bounds: Bounds = Bounds()
    types: Aliases = field(default_factory=dict)
    cpp_types: Mapping[str, CppClass] = field(default_factory=dict)
    robot: Callable[[str], Source | None] = lambda file: None
    mesh: Callable[[str, str, Packages], Path | None] = lambda name, urdf, packages: Path(name)
    expand: Callable[[str, Mapping[str, str], Packages], str] = no_xacro
    settings_read: bool = True

    def folder_with(self, name: str, suffixes: Iterable[str], searched: Collection[str]) -> str:
        """A folder that has a file of a name and is not among those that were searched; empty
        without one."""
        folders = self.folders_with([f"{name}{suffix}" for suffix in suffixes])
        return next((folder for folder in folders if folder not in searched), "")


def memory_library(files: Mapping[str, str], built_in: Library) -> Library:
    """A library of texts in memory; other templates come from `built_in`.

    `files` are texts by path. Scripts are searched in the folder of the calling file, templates in
    `templates/`.
    """
    sources = {name: Source(name, text) for name, text in files.items()}

    def script(name: str, caller: str) -> Source | None:
        paths = (_beside(caller, f"{name}{suffix}") for suffix in SUFFIXES)
        return next((sources[path] for path in paths if path in sources), None)

    def own_template(name: str) -> Source | None:
        return sources.get(f"templates/{name}") or built_in.own_template(name)

    return Library(
        script=script,
        template=lambda name: own_template(name) or built_in.template(name),
        own_template=own_template,
        code=lambda name: sources.get(name) or built_in.code(name),
        code_names=lambda folder: [*_inside(folder, sources), *built_in.code_names(folder)],
        definitions=lambda path, report: (
            [sources[path]] if path in sources else built_in.definitions(path, report)
        ),
        definition_names=lambda folder: [
            *_inside(folder, sources),
            *built_in.definition_names(folder),
        ],
        folders_with=lambda files: sorted(
            {
                folder
                for folder, _, file in (path.rpartition("/") for path in sources)
                if file in files
            }
        ),
        script_folders=lambda caller: [caller.rpartition("/")[0] or "."],
        template_folders=lambda: ["templates", *built_in.template_folders()],
        script_names=lambda caller: _stems(_inside(caller.rpartition("/")[0], sources)),
        robot_names=lambda caller: [
            name
            for name in _inside(caller.rpartition("/")[0], sources)
            if name.lower().endswith(ROBOT_FILES)
        ],
        template_names=lambda: [
            *(name.partition(".")[0] for name in _inside("templates", sources)),
            *built_in.template_names(),
        ],
        robot=built_in.robot,
        ros=built_in.ros,
        bounds=built_in.bounds,
        types=built_in.types,
        cpp_types=built_in.cpp_types,
    )


def _beside(caller: str, name: str) -> str:
    """The path of a file in the folder of the file `caller`."""
    return f"{caller.rpartition('/')[0]}/{name}".removeprefix("/")


def _stems(names: Iterable[str]) -> list[str]:
    """The names under which files can be called as sub-scripts."""
    return [name.removesuffix(".yml").removesuffix(".yaml") for name in names if "." in name]


def _inside(folder: str, files: Iterable[str]) -> Iterator[str]:
    """The names of files and folders in a folder."""
    start = f"{folder}/" if folder else ""
    for file in files:
        if file.startswith(start):
            yield file.removeprefix(start).partition("/")[0]
