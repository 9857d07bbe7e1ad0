"""An edit of a script as data: the request of a graphical editor, and its result.

An edit is JSON: `{"operation": "transition", "path": "sm/PICK", "arguments": {"outcome": "failed",
"target": "RECOVER"}}`. It is performed in memory; the caller writes the texts, or shows the patch.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.diagnostics.spelling import is_plain
from smachac.diff.comparison import compare
from smachac.driver import Analysis
from smachac.ir.recursion import deep_recursion
from smachac.records import dataclass
from smachac.refactor.autofix import differences
from smachac.refactor.change_states import NewState, add_state, remove_state, set_transition
from smachac.refactor.edited_script import EditedScript
from smachac.refactor.refactorings import contain_states, rename_name

Operation = Literal["rename", "transition", "add", "remove", "contain"]

FIELDS: Mapping[Operation, Mapping[str, tuple[type, ...]]] = {
    "rename": {"new": (str,)},
    "transition": {"outcome": (str,), "target": (str, type(None))},
    "add": {
        "name": (str,),
        "type": (str,),
        "after": (str, type(None)),
        "on": (str, type(None)),
        "transitions": (dict, type(None)),
        "variables": (dict, type(None)),
    },
    "remove": {"to": (str, type(None))},
    "contain": {"name": (str,), "type": (str,), "states": (list,)},
}
"""The arguments of each operation with their types; those that may be None may be left out."""


class BadEditError(ValueError):
    """The data is no edit; the message has the reason."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Edit:
    """A change of a script: the operation, the path of the state that it is about, its arguments
    (FIELDS). `path` is the container for `add`, and has no meaning for `contain`."""

    operation: Operation
    path: str
    arguments: Mapping[str, Any]


@dataclass(frozen=True, slots=True, kw_only=True)
class EditResult:
    """What an edit changes: the new texts by real path and the sources before, which undo it; the
    findings that are new and those that are gone."""

    texts: Mapping[str, str]
    sources: Mapping[str, Source]
    findings_added: Report
    findings_removed: Report

    @property
    def diff(self) -> str:
        """The change as a unified diff."""
        return "".join(differences(self.texts, self.sources))

    @property
    def undo(self) -> dict[str, str]:
        """The texts before, by real path."""
        return {path: self.sources[path].text for path in self.texts}


def edit_of(data: object) -> Edit:
    """An edit from JSON data. Raises BadEditError."""
    if not isinstance(data, dict):
        raise BadEditError("an edit is an object")
    words = data.get("operation")
    operation: Operation | None = next((field for field in FIELDS if field == words), None)
    path, given = data.get("path", ""), data.get("arguments", {})
    if operation is None:
        raise BadEditError(f"`operation` must be one of {', '.join(FIELDS)}")
    if not isinstance(path, str) or not isinstance(given, dict):
        raise BadEditError("`path` must be a text, and `arguments` an object")
    fields = FIELDS[operation]
    for name in given:
        if name not in fields:
            raise BadEditError(f"`{operation}` has no argument `{name}`")
    for name, types in fields.items():
        if not isinstance(given.get(name), types):
            raise BadEditError(f"the argument `{name}` of `{operation}` is missing or wrong")
    texts = [*given.get("states", ()), *(given.get("transitions") or {}).values()]
    if not all(isinstance(text, str) for text in texts):
        raise BadEditError("names must be texts")
    return Edit(operation=operation, path=path, arguments=given)


def perform(script: EditedScript, edit: Edit) -> EditResult:
    """Perform an edit on a script in memory.

    Raises HasErrorsError, NotFoundError, RefusedError and BadEditError; afterwards the script is of
    no use any more.
    """
    with deep_recursion():
        after = _perform(script, edit)
        found = script.results()
        difference = compare(script.analysis, after)
    return EditResult(
        texts={path: text for path, (_, text) in found.items()},
        sources={path: source for path, (source, _) in found.items()},
        findings_added=difference.added,
        findings_removed=difference.removed,
    )


def _perform(script: EditedScript, edit: Edit) -> Analysis:
    """The analysis of the script after an edit."""
    given = edit.arguments
    match edit.operation:
        case "transition":
            return set_transition(script, edit.path, given["outcome"], given.get("target"))
        case "remove":
            return remove_state(script, edit.path, given.get("to"))
        case "add":
            return add_state(
                script,
                edit.path,
                NewState(
                    name=given["name"],
                    type=given["type"],
                    transitions=given.get("transitions") or {},
                    variables=given.get("variables") or {},
                ),
                after=given.get("after"),
                on=given.get("on"),
            )
        case "rename":
            _check_plain(given["new"])
            return rename_name(script, edit.path, given["new"], "state")
    _check_plain(given["name"])
    if given["type"] not in ("StateMachine", "Concurrence") or not given["states"]:
        raise BadEditError("`contain` makes a StateMachine or a Concurrence of some states")
    return contain_states(script, given["name"], given["type"], given["states"])


def _check_plain(name: str) -> None:
    if not is_plain(name):
        raise BadEditError(f"`{name}` needs quotes in YAML: choose another name")
