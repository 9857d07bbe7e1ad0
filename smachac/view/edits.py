"""Edits of the script of a view: shown as a patch, written, undone."""

from __future__ import annotations

import gc
import threading
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from smachac.diagnostics.diagnostic import Severity
from smachac.diagnostics.source import Source
from smachac.frontend.files import disk_library
from smachac.ir.recursion import deep_recursion
from smachac.refactor.autofix import differences
from smachac.refactor.edited_script import EditedScript, HasErrorsError
from smachac.refactor.editor import RefusedError
from smachac.refactor.locate import NotFoundError
from smachac.report.state_types import usable_types
from smachac.targets.html.model import finding_data
from smachac.view.graphical_edit import BadEditError, Edit, EditResult, Operation, edit_of, perform
from smachac.view.server import ActionError

Texts = Mapping[str, str]
Write = Callable[[Texts, Mapping[str, Source]], Mapping[str, Any]]
"""Writes texts, named by real path, over the sources that were read: to all files or to none.
Returns the model of the machine that is shown afterwards. Raises ActionError, also if a file no
longer has the text of its source."""

MOST_UNDONE = 200
"""The most edits that can be undone."""

PROJECT, BUILT_IN = "of this project", "built-in"
"""The groups of state types."""

PROOFS: Mapping[Operation, str] = {
    "rename": "Proven: apart from the name, the machine is the same.",
    "transition": "Proven: this transition alone changes.",
    "add": "Proven: apart from the new state, the machine is the same.",
    "remove": "Proven: apart from the state and what led to it, the machine is the same.",
    "contain": "Proven: apart from the new container, the machine is the same.",
}
"""What is proven of the texts after each operation, before they are shown or written."""


class Edits:
    """The edits of one script: a preview, the writing, and what can be undone.

    The answer to an edit that is written has the `model` of the machine: a page shows it at once,
    and what is typed next belongs to it.
    """

    def __init__(
        self,
        script: Path,
        scripts: Sequence[Path],
        templates: Sequence[Path],
        write: Write,
    ) -> None:
        self._script, self._scripts, self._templates = script, scripts, templates
        self._write = write
        self._lock = threading.Lock()
        self._done: deque[tuple[Texts, Mapping[str, Source]]] = deque(maxlen=MOST_UNDONE)

    def edit(self, body: Mapping[str, Any]) -> object:
        """Show what an edit changes; with `apply`, write it.

        `diff` is the patch that the user has seen: if the edit has another one by now, nothing is
        written.
        """
        with self._lock, deep_recursion():
            edit, result = self._performed(body)
            gc.collect()  # automatic collection is off
            answer = {
                "diff": result.diff,
                "files": sorted(source.name for source in result.sources.values()),
                "added": [finding_data(diagnostic) for diagnostic in result.findings_added],
                "removed": [finding_data(diagnostic) for diagnostic in result.findings_removed],
                "proof": PROOFS[edit.operation],
                "applied": False,
            }
            if body.get("apply") is not True:
                return answer
            if body.get("diff", result.diff) != result.diff:
                raise ActionError("the script has changed since the preview: look at it again")
            answer["applied"] = True
            if result.texts:
                answer["model"] = self._write(result.texts, result.sources)
                self._done.append((dict(result.texts), dict(result.sources)))
            return answer

    def undo(self, body: Mapping[str, Any]) -> object:
        """Restore the texts before the last edit that is not undone."""
        with self._lock:
            if not self._done:
                raise ActionError("there is nothing to undo")
            written, sources = self._done[-1]
            before = {path: source.text for path, source in sources.items()}
            after = {path: Source(sources[path].name, text) for path, text in written.items()}
            model = self._write(before, after)
            self._done.pop()
            files = sorted(source.name for source in sources.values())
            return {"diff": "".join(differences(before, after)), "files": files, "model": model}

    def types(self, body: Mapping[str, Any]) -> object:
        """The state types that a new state can have."""
        library = disk_library(self._script, [], scripts=self._scripts, templates=self._templates)
        return {
            "types": [
                {
                    "name": type_.name,
                    "doc": type_.doc,
                    "group": PROJECT if own else BUILT_IN,
                }
                for type_, own in usable_types(library)
                if type_.kind == "state"
            ]
        }

    def _performed(self, body: Mapping[str, Any]) -> tuple[Edit, EditResult]:
        """The edit of a request and its result. Raises ActionError."""
        script = EditedScript(self._script, self._scripts, self._templates)
        try:
            edit = edit_of(body)
            return edit, perform(script, edit)
        except HasErrorsError:
            raise ActionError(_first_error(script)) from None
        except RefusedError as error:
            help = f"\nhelp: {error.help}" if error.help else ""
            raise ActionError(f"{error.message}{help}") from None
        except (BadEditError, NotFoundError) as error:
            raise ActionError(str(error)) from None


def _first_error(script: EditedScript) -> str:
    errors = [
        diagnostic for diagnostic in script.analysis.report if diagnostic.severity is Severity.ERROR
    ]
    found = f": {errors[0].span}: {errors[0].message}" if errors else ""
    return f"the script has errors, which must be fixed first{found}"
