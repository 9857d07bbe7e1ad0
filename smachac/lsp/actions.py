"""Code actions: fixes of findings, suppressions, and the refactorings of a state."""

from __future__ import annotations

import difflib
import os
from collections.abc import Callable, Iterator
from pathlib import Path

from smachac.diagnostics.diagnostic import Diagnostic
from smachac.diagnostics.repair import Certainty, Edit, Repair
from smachac.diagnostics.severities import is_firm
from smachac.diagnostics.source import Source, Span
from smachac.frontend.files import BUILT_IN
from smachac.ir.nodes import Machine
from smachac.ir.recursion import deep_recursion
from smachac.lsp.navigation import Named, script_path
from smachac.lsp.place import Body, Place
from smachac.records import dataclass
from smachac.refactor.autofix import UNCLEAR
from smachac.refactor.edited_script import EditedScript, HasErrorsError
from smachac.refactor.editor import RefusedError
from smachac.refactor.locate import NotFoundError
from smachac.refactor.refactorings import (
    contain_states,
    extract_state,
    inline_state,
    rename_name,
)
from smachac.report.repair_words import in_words

Results = dict[str, tuple[Source, str]]
"""New texts by real path, with the sources before; the source of a new file is empty."""


class RefusedActionError(Exception):
    """A refactoring is refused; the message has the reason."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Fix:
    """A correction of a finding: its title, its edits, and whether it is the obvious one."""

    title: str
    finding: Diagnostic
    edits: tuple[Edit, ...]
    preferred: bool = False


def fixes(
    report: list[Diagnostic],
    start: int,
    end: int,
    path: str,
    search: Callable[[Diagnostic], Repair | None],
) -> Iterator[Fix]:
    """The corrections of the findings that touch a range of a text, and their suppressions. For a
    finding without a repair, one is searched."""
    unclear = any(item.code in UNCLEAR for item in report)
    for item in report:
        span = item.span
        if os.path.realpath(span.source.name) != path or span.end < start or span.start > end:
            continue
        repairs = item.finding.all_repairs
        if not repairs and (searched := search(item)) is not None:
            repairs = (searched,)
        for repair in repairs:
            safe = repair.certainty is Certainty.SAFE
            if not (safe and unclear) and not any(map(_is_built_in, repair.edits)):
                title = _title(item, repair)
                yield Fix(title=title, finding=item, edits=repair.edits, preferred=safe)
        if not is_firm(item):
            yield Fix(title=f"Allow {item.code} here", finding=item, edits=(_allowance(item),))


def _is_built_in(edit: Edit) -> bool:
    return any(Path(edit.span.source.name).is_relative_to(folder) for folder in BUILT_IN)


def _title(item: Diagnostic, repair: Repair) -> str:
    edit = repair.edits[0]
    if len(repair.edits) == 1 and "\n" not in edit.text and edit.text.strip():
        old = edit.span.text
        return f"Replace `{old}` by `{edit.text}`" if old else f"Insert `{edit.text.strip()}`"
    words = in_words(repair, item.span)
    return words[0].upper() + words[1:]


def _allowance(item: Diagnostic) -> Edit:
    """The comment that suppresses a finding, at the end of its line."""
    source = item.span.source
    line = source.line(item.span.line)
    end = source.line_starts[item.span.line - 1] + len(line)
    comment = f"  # smachac: allow {item.code} REASON"
    return Edit(span=Span(source, end, end), text=comment)


@dataclass(frozen=True, slots=True, kw_only=True)
class Offer:
    """A refactoring that may be possible: its title, and the data by which it is performed."""

    title: str
    kind: str
    name: str
    states: tuple[str, ...]


NEW_CONTAINER = "NEW_STATE"


def offers(place: Place | None, selected: list[Body], machine: Machine, path: str) -> list[Offer]:
    """The refactorings of the state at a place, and of the states that are selected."""
    found: list[Offer] = []
    body = place.body if place is not None else None
    state = script_path(machine, body, path) if body is not None and body.name else None
    if body is not None and state is not None and body.name is not None:
        name = str(body.name.value)
        if "script" in body.fields:
            title = f"Inline the sub-script of {name}"
            found.append(Offer(title=title, kind="inline", name=name, states=(state,)))
        elif body.states:
            title = f"Extract {name} into {name.lower()}.yml"
            found.append(Offer(title=title, kind="extract", name=name, states=(state,)))
    paths = [script_path(machine, body, path) for body in selected]
    states = tuple(path for path in paths if path is not None)
    if states:
        names = ", ".join(str(body.name.value) for body in selected if body.name is not None)
        for type_ in ("StateMachine", "Concurrence") if len(states) > 1 else ("StateMachine",):
            title = f"Contain {names} in a new {type_}"
            found.append(Offer(title=title, kind=f"contain {type_}", name=NEW_CONTAINER,
                               states=states))  # fmt: skip
    return found


def selected_states(place: Place | None, start: int, end: int) -> list[Body]:
    """The states of the innermost container of a place that a range touches."""
    around = place.around if place is not None else None
    if around is None:
        return []
    return [state for state in around.states if state.start < end and state.end > start]


def perform_offer(
    kind: str, name: str, states: list[str], root: str, texts: dict[str, str]
) -> Results:
    """The texts after a refactoring of the script at `root`. Raises RefusedActionError."""

    def change(script: EditedScript) -> None:
        match kind.split():
            case ["inline"]:
                inline_state(script, states[0])
            case ["extract"]:
                extract_state(script, states[0])
            case ["contain", type_]:
                contain_states(script, name, type_, states)

    return _performed(root, texts, change)


def rename(
    named: Named, new: str, machine: Machine, path: str, root: str, texts: dict[str, str]
) -> Results:
    """The texts after a renaming. Raises RefusedActionError."""
    above = script_path(machine, named.body, path)
    if above is None:
        raise RefusedActionError(f"`{named.name}` is not part of the machine")
    word = above if named.kind == "state" else f"{above}/{named.name}"
    return _performed(root, texts, lambda script: rename_name(script, word, new, named.kind))


def _performed(
    root: str, texts: dict[str, str], change: Callable[[EditedScript], object]
) -> Results:
    try:
        with deep_recursion():
            script = EditedScript(Path(root), texts=texts)
            change(script)
            return script.results()
    except HasErrorsError as error:
        raise RefusedActionError("fix the errors of the script first") from error
    except NotFoundError as error:
        raise RefusedActionError(str(error)) from error
    except RefusedError as error:
        help = f"; {error.help}" if error.help else ""
        raise RefusedActionError(f"{error.message}{help}") from error


def changes(before: str, after: str) -> list[tuple[int, int, str]]:
    """The changed lines between two texts: ranges of the first, and their new texts."""
    old, new = before.splitlines(keepends=True), after.splitlines(keepends=True)
    starts = [0]
    for line in old:
        starts.append(starts[-1] + len(line))
    matcher = difflib.SequenceMatcher(None, old, new, autojunk=False)
    return [
        (starts[i1], starts[i2], "".join(new[j1:j2]))
        for tag, i1, i2, j1, j2 in matcher.get_opcodes()
        if tag != "equal"
    ]
