"""A script that a refactoring changes: its texts, the editors of them, and the proof of the change.

A change is made in memory. The changed script is analysed again and compared with the script
before; only a change that keeps its behaviour passes.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from pathlib import Path

from smachac.diagnostics.diagnostic import Report, Severity
from smachac.diagnostics.source import Source, Span
from smachac.driver import CODES, Analysis, analyse
from smachac.frontend.discovery import scripts_of
from smachac.frontend.files import Disk, disk_library, find_project, has_project
from smachac.frontend.loader import Library
from smachac.frontend.text.yaml_tree import Map, Seq
from smachac.ir.nodes import Machine
from smachac.refactor.cst import UnsupportedYamlError
from smachac.refactor.editor import RefusedError, ScriptEditor
from smachac.refactor.line_ends import with_line_ends


class HasErrorsError(Exception):
    """The script has errors, so its machine is not known."""


class EditedScript:
    """One script with all texts it is read from, before a change, with line feeds as line ends.

    `scripts` and `templates` are more folders; `texts` replace the files at their (real) paths.
    """

    def __init__(
        self,
        path: Path,
        scripts: Sequence[Path] = (),
        templates: Sequence[Path] = (),
        texts: Mapping[str, str] | None = None,
    ) -> None:
        self.path = path
        self.scripts = scripts
        self.templates = templates
        self.unsaved = dict(texts or {})
        self.disk = Disk(self.unsaved, plain=True)
        self.analysis = self.read(self.disk)
        self.editors: dict[str, ScriptEditor] = {}
        self.made: dict[str, str] = {}
        self.companions: dict[Path, tuple[Source, str]] = {}

    def read(self, disk: Disk, path: Path | None = None) -> Analysis:
        """The analysis of the script, or of another one, read from a disk."""
        path = path or self.path
        report: Report = []
        source = disk.read(path, report)
        if source is None:
            return Analysis(report=report)
        library = disk_library(
            path,
            report,
            scripts=self.scripts,
            templates=self.templates,
            disk=disk,
            codes=CODES,
        )
        return analyse(source, library, report)

    def library(self) -> Library:
        """The library of the script before the change."""
        return disk_library(
            self.path, [], scripts=self.scripts, templates=self.templates, disk=self.disk
        )

    @property
    def machine(self) -> Machine:
        """The machine before the change. Raises HasErrorsError."""
        if self.analysis.checked is None:
            raise HasErrorsError
        return self.analysis.checked

    def editor(self, source: Source) -> ScriptEditor:
        """The editable text of a source. Raises RefusedError."""
        name = os.path.realpath(source.name)
        if name not in self.editors:
            try:
                self.editors[name] = ScriptEditor(source)
            except UnsupportedYamlError as error:
                words = f"{source.name} cannot be rewritten: {error}"
                raise RefusedError(Span(source, 0, 0), words) from error
        return self.editors[name]

    def texts(self) -> dict[str, str]:
        """The changed texts and the new ones, by real path."""
        found = {name: editor.result() for name, editor in self.editors.items()}
        changed = {
            name: text for name, text in found.items() if text != self.editors[name].source.text
        }
        return {**changed, **self.made}

    def caller(self) -> Path | None:
        """For a sub-script, the first script in its folder that uses it and has no errors."""
        source = self.disk.read(self.path, [])
        if source is None or not isinstance(self.disk.parse(source, []), Seq):
            return None
        return next((path for path, _ in self.others([os.path.realpath(self.path)])), None)

    def others(self, changed: Container[str]) -> Iterator[tuple[Path, Analysis]]:
        """The analyses of the other scripts in the same folder that use one of these files and have
        no errors."""
        mine = os.path.realpath(self.path)
        for path in scripts_of([self.path.parent], self.disk):
            if os.path.realpath(path) == mine:
                continue
            self.disk.searched.clear()
            source = self.disk.read(path, [])
            if source is None or not isinstance(self.disk.parse(source, []), Map):
                continue
            found = self.read(self.disk, path)
            if found.checked is not None and any(
                name in changed for name in self.disk.searched_files()
            ):
                yield path, found

    def proven(self, span: Span, same: Callable[[Machine, Machine], bool]) -> Analysis:
        """The script after the change. Raises RefusedError unless it and every other script in the
        folder that uses a changed file behave as before."""
        texts = self.texts()
        disk = Disk({**self.unsaved, **texts}, plain=True)
        after = self.read(disk)
        if after.checked is None:
            first = next(item for item in after.report if item.severity is Severity.ERROR)
            message = f"the script would have an error: {first.message}"
            alias = first.code == "SM001" and first.span.text.startswith("*")
            help = "replace the alias by its value" if alias else first.help
            raise RefusedError(span, message, help)
        if not same(self.machine, after.checked):
            raise RefusedError(span, "the machine would behave differently")
        self._follow(self.analysis, after)
        for path, found in self.others(texts.keys() - {os.path.realpath(self.path)}):
            other = self.read(disk, path)
            if found.checked is None or other.checked is None:
                raise RefusedError(span, f"the script {path} would have an error")
            if not same(found.checked, other.checked):
                raise RefusedError(span, f"the machine of {path} would behave differently")
            self._follow(found, other)
        return after

    def _follow(self, before: Analysis, after: Analysis, *, same_behaviour: bool = True) -> None:
        """Change the scenarios, faults and baselines in the folder of the script, or of its
        project, that name states of a machine."""
        from smachac.refactor.companions import changed_baselines, changed_companions

        if before.machine is None or after.machine is None:
            return
        folder = self.path.parent
        found = changed_companions(folder, self.disk, before.machine, after.machine)
        self.companions = {**found, **self.companions}
        top = find_project(self.path, []).folder if has_project(self.path) else folder
        self.companions |= changed_baselines(
            top, self.disk, before, after, self.companions, same_behaviour=same_behaviour
        )

    def changed(self, span: Span, wanted: Callable[[Machine], bool]) -> Analysis:
        """The script after a change of its behaviour; it may have errors. Raises RefusedError
        unless its machine is the wanted one."""
        after = self.read(Disk({**self.unsaved, **self.texts()}, plain=True))
        if after.machine is None:
            first = next(item for item in after.report if item.severity is Severity.ERROR)
            message = f"the script could not be read any more: {first.message}"
            raise RefusedError(span, message, first.help)
        if not wanted(after.machine):
            help = "write its fields out, or format the script: `smachac fmt`"
            raise RefusedError(span, "the text would become another machine than wanted", help)
        self._follow(self.analysis, after, same_behaviour=False)
        return after

    def results(self) -> dict[str, tuple[Source, str]]:
        """The changed texts and the new ones with their line ends, by real path, each with the
        source before the change; that of a new file is empty."""
        found: dict[str, tuple[Source, str]] = {}
        disk = Disk(self.unsaved)
        script = disk.read(self.path, [])
        for name, text in self.texts().items():
            known = self.editors.get(name)
            shown = known.source.name if known is not None else os.path.relpath(name)
            if name in self.made:
                ended = with_line_ends(text, script.text) if script is not None else text
                found[name] = Source(shown, ""), ended
                continue
            before = disk.read(Path(shown), [])
            assert before is not None
            found[name] = before, with_line_ends(text, before.text)
        for path, (_, text) in self.companions.items():
            before = disk.read(path, [])
            assert before is not None
            found[os.path.realpath(path)] = before, with_line_ends(text, before.text)
        return found
