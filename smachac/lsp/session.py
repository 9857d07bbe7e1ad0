"""The session of an editor: the texts that it holds, the files on disk, and their analyses.

A file is parsed once for each content, a script analysed once for each state of its files.
"""

from __future__ import annotations

import gc
import os
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from smachac.analysis.context import Context
from smachac.diagnostics.diagnostic import Diagnostic, Report, identity, in_order
from smachac.diagnostics.repair import Repair
from smachac.diagnostics.source import Source
from smachac.driver import CODES, Analysis, IncrementalState, read_machine
from smachac.driver.batch import Batch, check_scripts
from smachac.frontend.config import PROJECT_FILES
from smachac.frontend.discovery import PYTHON_SUFFIX, NothingFoundError, scripts_of
from smachac.frontend.files import Disk, disk_library, find_project
from smachac.frontend.loader import Library
from smachac.frontend.robots.robots import DataKind, check_data_file
from smachac.frontend.text.file_kinds import FileKind, kind_of_tree
from smachac.frontend.text.yaml_tree import Map, Seq, Tree
from smachac.frontend.types.state_types import find_state_type
from smachac.ir.nodes import Machine
from smachac.ir.recursion import deep_recursion
from smachac.lsp.repair import repaired
from smachac.records import dataclass, replace

TYPE_CHECKING = False  # annotations only: few sessions have Python files
if TYPE_CHECKING:
    from smachac.lsp.python_view import PythonFiles, PythonView


@contextmanager
def collection_paused() -> Iterator[None]:
    """The garbage collector pauses: it would run many times over the growing results."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


def is_python(path: str) -> bool:
    """Whether a file is in Python."""
    return path.endswith(PYTHON_SUFFIX)


def _file_of(item: Diagnostic) -> str:
    return os.path.realpath(item.span.source.name)


@dataclass(frozen=True, kw_only=True)
class View:
    """A text as the answers to questions about it need it, as far as it can be read.

    `source` has the offsets of the present text; its syntax errors are blanked. `context` has the
    facts of the machine that uses the text: its own, or that of a script that calls it. Only
    scripts and interfaces have a tree here; `python` are the machines of a Python file.
    """

    source: Source
    tree: Tree | None
    library: Library
    context: Context | None
    kind: FileKind = "script"
    python: PythonView | None = None

    @property
    def machine(self) -> Machine | None:
        return self.context.machine if self.context is not None else None


class Session:
    """The open texts, and what is known of them. `folders` are those of the workspace.

    All paths are real paths.
    """

    def __init__(self, folders: Iterable[Path] = ()) -> None:
        self.folders = [Path(os.path.realpath(folder)) for folder in folders]
        self.disk = Disk(in_pieces=True)
        self.open: dict[str, None] = {}
        self._uses: dict[str, frozenset[str]] = {}
        self._contexts: dict[str, tuple[Analysis, Context | None]] = {}
        self._previous: dict[str, IncrementalState] = {}
        self._views: dict[str, View] = {}
        self._checked: dict[str, dict[str, Report]] = {}
        self._listed: dict[tuple[Path, ...], list[Path]] = {}
        self._python: PythonFiles | None = None

    @property
    def python(self) -> PythonFiles:
        """The Python files, whose reader is imported with the first of them."""
        if self._python is None:
            from smachac.lsp.python_view import PythonFiles

            self._python = PythonFiles(self.disk)
        return self._python

    def change(self, path: str, text: str) -> None:
        """The editor opens a text, or changes it."""
        if path not in self.open:
            self._listed.clear()
        self.open[path] = None
        if self.disk.texts.get(path) != text:
            self.disk.replace(Path(path), text)
            self._forget([path])

    def close(self, path: str) -> None:
        """The editor closes a text: from now on the file on disk counts."""
        self.open.pop(path, None)
        if is_python(path):
            self.python.close(path)
            self._uses.pop(path, None)
        self.disk.replace(Path(path), None)
        self._forget([path])

    def refresh(self) -> set[str]:
        """Forget the files that have changed on disk; the open texts that use one of them."""
        changed = self.disk.refresh()
        self._forget(changed)
        return {path for path in self.open if self._roots_using(changed | {path})}

    def forget_all(self) -> None:
        """Forget what depends on files on disk: some may be new, changed or gone."""
        self.disk.refresh()
        self._forget([*self._contexts, *self.open])
        self._contexts.clear()
        self._previous.clear()
        self._listed.clear()
        if self._python is not None:
            self._python.list_again()

    def source(self, path: str) -> Source | None:
        """The present text of a file."""
        return self.disk.read(Path(path), [])

    def text(self, path: str) -> str:
        source = self.source(path)
        return source.text if source is not None else ""

    def texts(self) -> list[tuple[Source, Tree | None]]:
        """The scripts of the workspace with their trees."""
        found = []
        for path in self._scripts(self.folders or [Path(path) for path in self.open]):
            source = self.disk.read(path, [])
            if source is not None:
                found.append((source, self.disk.parse(source, [])))
        return found

    def _scripts(self, folders: list[Path]) -> list[Path]:
        """The scripts in folders, listed once until a file is created or deleted."""
        key = tuple(folders)
        if key not in self._listed:
            try:
                found = scripts_of(folders, self.disk)
                self._listed[key] = [Path(os.path.realpath(path)) for path in found]
            except NothingFoundError:
                self._listed[key] = []
        return self._listed[key]

    def machines(self, path: str) -> list[Machine]:
        """The machines that use a text, as far as they can be read."""
        view = self.view(path)
        found = [self._contexts[root][1] for root in self._known_roots(path)]
        mine = [view.context] if view is not None else []
        contexts = {id(context): context for context in [*mine, *found] if context is not None}
        return [context.machine for context in contexts.values()]

    def script_roots(self, path: str) -> list[str]:
        """The scripts, not sub-scripts, by which a text is checked."""
        if is_python(path):
            return []
        return [root for root in self.roots(path) if isinstance(self._tree(root), Map)]

    def _forget(self, changed: Iterable[str]) -> None:
        """Forget what was computed from some files."""
        gone = {*changed}
        for root in [root for root in self._contexts if root in gone or self._uses[root] & gone]:
            del self._contexts[root]
        if gone:
            self._views.clear()
            self._checked.clear()
            if self._python is not None:
                self._python.forget(gone)

    def _roots_using(self, paths: set[str]) -> list[str]:
        return [root for root, used in self._uses.items() if root in paths or used & paths]

    def roots(self, path: str) -> list[str]:
        """The scripts by which a text is checked: itself, if it is not called by others."""
        if not isinstance(self._tree(path), Seq):
            return [path]
        callers = [root for root in self._callers(path) if root != path]
        return callers or [path]

    def _tree(self, path: str) -> Tree | None:
        source = self.disk.read(Path(path), [])
        tree = self.disk.parse(source, []) if source is not None else None
        if tree is None and source is not None:
            text = repaired(source.text)
            tree = self.disk.parse(Source(path, text), []) if text is not None else None
        return tree

    def _callers(self, path: str) -> list[str]:
        """The scripts around a sub-script whose text names it, directly or through another one."""
        folders = [folder for folder in self.folders if Path(path).is_relative_to(folder)]
        texts = {}
        for script in self._scripts([*folders, Path(path).parent]):
            source = self.disk.read(script, [])
            texts[str(script)] = source.text if source is not None else ""
        found = {path: None}
        todo = [path]
        while todo:
            word = Path(todo.pop()).stem
            stem = re.compile(rf"(?<![\w.-]){re.escape(word)}(?![\w-])")
            new = [name for name, text in texts.items()
                   if name not in found and word in text and stem.search(text)]  # fmt: skip
            found.update(dict.fromkeys(new))
            todo += new
        return [name for name in found if not isinstance(self._tree(name), Seq)]

    def check(self, path: str) -> dict[str, Report]:
        """The findings of the scripts by which a text is checked, by file."""
        if path not in self._checked:
            with collection_paused():
                self._checked[path] = self._check(path)
        return self._checked[path]

    def repair(self, path: str, item: Diagnostic) -> Repair | None:
        """The repair of a finding in a script, searched now; None without one."""
        from smachac.repair.search import again, clusters

        is_script = not is_python(path) and self.kind(path) == "script"
        for root in self._known_roots(path) if is_script else ():
            analysis, _ = self._contexts[root]
            mine = [other for other in analysis.report if identity(other) == identity(item)]
            with collection_paused():
                for cluster in clusters(analysis, mine, again(analysis), 1):
                    return cluster.repair
        return None

    def _check(self, path: str) -> dict[str, Report]:
        if is_python(path):
            return self._check_python(path)
        kind = self.kind(path)
        if kind == "interface":
            return self._check_interface(path)
        if kind == "project":
            return self._check_project(path)
        if kind == "robot" or kind == "scene" or kind == "faults":
            return self._check_data(path, kind)
        roots = self.roots(path)
        batch = self._check_scripts(roots)
        if not any(path in (root, *batch.uses[root]) for root in batch.reports):
            batch = self._check_scripts([path])  # its callers do not call it any more
        found: dict[str, Report] = {root: [] for root in batch.reports}
        found |= {path: []}
        for item in in_order(batch.report):
            found.setdefault(os.path.realpath(item.span.source.name), []).append(item)
        return found

    def kind(self, path: str) -> FileKind:
        """The kind of a file, from its name, its folder and its text."""
        if Path(path).name in PROJECT_FILES:
            return "project"
        if self.is_interface(path):
            return "interface"
        return kind_of_tree(self._tree(path))

    def is_interface(self, path: str) -> bool:
        """Whether a file is the interface of a state type: it is in a folder of templates."""
        folder = Path(path).parent
        project = find_project(Path(path), [], self.disk)
        named = [os.path.realpath(template) for template in project.templates]
        return folder.name == "templates" or str(folder) in named

    def _check_interface(self, path: str) -> dict[str, Report]:
        """The findings in an interface, as the scripts that use it have them."""
        report: Report = []
        folder = Path(path).parent
        main = folder.parent / "main.yml" if folder.name == "templates" else folder / "main.yml"
        library = disk_library(main, [], templates=[folder], disk=self.disk)
        with deep_recursion():
            find_state_type(Path(path).stem, library, report)
        found: dict[str, Report] = {path: []}
        for item in in_order(report):
            found.setdefault(os.path.realpath(item.span.source.name), []).append(item)
        return found

    def _check_python(self, path: str) -> dict[str, Report]:
        """The findings about the machines in a Python file, and those in it of other open texts
        that use it."""
        report = self._python_report(path)
        for user in [user for user in self.open if user != path]:
            if path in self._uses.get(user, ()):
                others = (self._python_report(user) if is_python(user)
                          else self.check(user).get(path, []))  # fmt: skip
                report += [item for item in others if _file_of(item) == path]
        found: dict[str, Report] = {path: []}
        known = {identity(item): item for item in report}
        for item in in_order(known.values()):
            found.setdefault(_file_of(item), []).append(item)
        return found

    def _python_report(self, path: str) -> Report:
        """The findings about the machines in a Python file."""
        read = self.python.file(path)
        self._uses[path] = read[1] if read is not None else frozenset()
        return [*read[0].report] if read is not None else []

    def _check_project(self, path: str) -> dict[str, Report]:
        """The findings in a project file."""
        report: Report = []
        find_project(Path(path), report, self.disk, CODES)
        return {path: in_order(item for item in report
                               if os.path.realpath(item.span.source.name) == path)}  # fmt: skip

    def _check_data(self, path: str, kind: DataKind) -> dict[str, Report]:
        """The findings in a file of data: a robot, a scene or faults."""
        report: Report = []
        source = self.disk.read(Path(path), report)
        if source is not None:
            check_data_file(source, kind, self._library(path), report)
        return {path: in_order(item for item in report
                               if os.path.realpath(item.span.source.name) == path)}  # fmt: skip

    def users(self, path: str) -> list[str]:
        """The other open texts whose check uses a file."""
        roots = {*self._roots_using({path})}
        return [text for text in self.open if text != path
                and (text in roots or any(text in self._uses[root] for root in roots))]  # fmt: skip

    def _check_scripts(self, roots: list[str]) -> Batch:
        """Check scripts, and keep their machines with the facts that the rules computed."""
        batch = check_scripts([Path(root) for root in roots], self.disk, previous=self._previous)
        for root, analysis in batch.analyses.items():
            self._uses[root] = batch.uses[root]
            last = self._previous.get(root)
            self._contexts[root] = analysis, last.context if last is not None else None
        self._views.clear()
        return batch

    def view(self, path: str) -> View | None:
        """A text as answers need it; None if there is no such file."""
        if path not in self._views:
            with deep_recursion(), collection_paused():
                made = self._make_view(path)
            if made is None:
                return None
            self._views[path] = made
        return self._views[path]

    def _make_view(self, path: str) -> View | None:
        source = self.disk.read(Path(path), [])
        if source is None:
            return None
        if is_python(path):
            return self._python_view(path)
        kind = self.kind(path)
        if kind not in ("script", "interface"):
            library = self._library(path)
            return View(source=source, tree=None, library=library, context=None, kind=kind)
        tree = self.disk.parse(source, [])
        if tree is None:
            return replace(self._repaired_view(path, source), kind=kind)
        for root in self._known_roots(path):
            analysis, context = self._contexts[root]
            if analysis.library is not None:
                library = analysis.library
                return View(source=source, tree=tree, library=library, context=context, kind=kind)
        library = self._library(path)
        return View(source=source, tree=tree, library=library, context=None, kind=kind)

    def _python_view(self, path: str) -> View | None:
        """The view of a Python file that builds machines; None of another one."""
        found = self.python.view(path)
        if found is None:
            return None
        return View(source=found.source, tree=None, library=self._library(path), context=None,
                    python=found)  # fmt: skip

    def _known_roots(self, path: str) -> list[str]:
        """The analysed scripts that use a text; they are analysed now if there is none."""
        if not any(path in (root, *self._uses[root]) for root in self._contexts):
            self.check(path)
        return [root for root in self._contexts if path in (root, *self._uses[root])]

    def _library(self, path: str) -> Library:
        return disk_library(Path(path), [], disk=self.disk, codes=CODES)

    def _repaired_view(self, path: str, source: Source) -> View:
        """The view of a text with syntax errors."""
        text = repaired(source.text)
        made = Source(source.name, text if text is not None else "")
        tree = self.disk.parse(made, [])
        library = self._library(path)
        machine: Machine | None = None
        if isinstance(tree, Map):
            machine = read_machine(made, library, [])
        elif isinstance(tree, Seq):
            root = next((root for root in self.roots(path) if root != path), None)
            main = self.disk.read(Path(root), []) if root is not None else None
            if main is not None:
                library = self._library(main.name)
                machine = read_machine(main, _with_text(library, made), [])
        context = Context(machine) if machine is not None else None
        return View(source=made, tree=tree, library=library, context=context)


def _with_text(library: Library, text: Source) -> Library:
    """A library in which a text replaces the sub-script of its name."""
    wanted = os.path.realpath(text.name)

    def script(name: str, caller: str) -> Source | None:
        found = library.script(name, caller)
        same = found is not None and os.path.realpath(found.name) == wanted
        return text if same else found

    return replace(library, script=script)
