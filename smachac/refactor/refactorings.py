"""The refactorings `contain`, `extract`, `inline` and `rename` of an edited script.

Each function changes the texts of the script and proves the change. All raise HasErrorsError,
NotFoundError and RefusedError; after an exception the script is of no use any more.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from types import MappingProxyType

from smachac.diagnostics.diagnostic import Severity
from smachac.diagnostics.source import Source, Span
from smachac.driver import Analysis
from smachac.frontend.loader import Library
from smachac.frontend.types.smacha_meta import keys_in_code
from smachac.ir.nodes import Leaf, Machine, Node, StateMachine, StateType
from smachac.ir.script_paths import plain_paths
from smachac.ir.traversal import walk
from smachac.refactor.contain import contain, equal_after_contain, plan_container, preset_keys
from smachac.refactor.cst import Atom
from smachac.refactor.edited_script import EditedScript
from smachac.refactor.editor import RefusedError, ScriptEditor, variable
from smachac.refactor.equivalence import equal_after_rename, same_machine
from smachac.refactor.extract_inline import extract, inline
from smachac.refactor.field_order import variables_of
from smachac.refactor.locate import (
    NotFoundError,
    different_container_error,
    find_named,
    find_state,
)
from smachac.refactor.open_states import TemplateFacts, with_inferred_interfaces
from smachac.refactor.rename import Renaming, rename_key, rename_outcome, rename_state

RENAME = {"state": rename_state, "outcome": rename_outcome, "key": rename_key}
"""The functions that rename, by what they rename."""


def extract_state(script: EditedScript, state: str, to: Path | None = None) -> None:
    """Move a container into a new sub-script: the file `to` beside the text of the container."""
    path, node = find_state(script.machine, state)
    if path == script.machine.root.name:
        raise RefusedError(node.span, "this is the whole script")
    editor = script.editor(node.span.source)
    name = to or Path(f"{node.name.lower()}.yml")
    target = Path(node.span.source.name).parent / name
    text = extract(editor, node.span, name.stem)
    if target.exists() or script.disk.is_file(target):
        raise RefusedError(node.span, f"{target} exists already", "choose another name with --to")
    script.made[os.path.realpath(target)] = text
    script.proven(node.span, same_machine)


def inline_state(script: EditedScript, state: str) -> None:
    """Replace the call of a sub-script by its content."""
    _, node = find_state(script.machine, state)
    editor = script.editor(node.span.source)
    sub = _called(script, node)
    inline(editor, node.span, ScriptEditor(sub))
    script.proven(node.span, same_machine)


def rename_name(script: EditedScript, path: str, new: str, kind: str | None = None) -> Analysis:
    """Rename the state, outcome or key that a path names, also in the other scripts of the folder
    that share its text. The analysis afterwards."""
    meant, declared, old = find_named(script.machine, path, kind)
    if old == new:
        return script.analysis
    _check_written(script.machine, meant, declared, old)
    work = Renaming(old, new, script.editor)
    rename = RENAME[meant]
    rename(work, script.machine, declared)
    shared = script.editors.keys() - {os.path.realpath(script.path)}
    for _, found in script.others(shared) if shared else ():
        assert found.checked is not None
        rename(work, found.checked, declared)
    return script.proven(declared, lambda one, other: equal_after_rename(one, other, old, new))


def contain_states(
    script: EditedScript,
    name: str,
    type_: str,
    states: Sequence[str],
    outcomes: Mapping[str, str] = MappingProxyType({}),
) -> Analysis:
    """Move states of one container into a new container. `outcomes` are names of its outcomes, by
    the state or outcome outside where each leads. The analysis afterwards."""
    before = script.machine
    path, _ = find_state(before, states[0])
    above = path.rpartition("/")[0]
    if not above:
        raise RefusedError(before.root.span, "this is the whole script")
    parent = dict(walk(before.root))[above]
    assert not isinstance(parent, Leaf)
    if isinstance(parent, StateMachine):
        facts = partial(_facts, before.state_types, script.library())
        parent = with_inferred_interfaces(parent, facts)
    known = {child.name: child for child in parent.children}
    names = [_name_in(before, above, state, known) for state in states]
    for text in names:
        if text not in known:
            around = plain_paths(before.root).get(above, above)
            raise different_container_error(before, around, text, known)
    inside = [child for child in parent.children if child.name in names]
    presets = preset_keys(script.editor(inside[0].span.source), inside)
    made = plan_container(parent, inside, presets, name, type_, outcomes)
    contain(script.editor, made)
    after = script.proven(inside[0].span, lambda one, two: equal_after_contain(one, two, made))
    _no_worse(script.analysis, after, inside[0].span)
    return after


def _check_written(machine: Machine, kind: str, declared: Span, old: str) -> None:
    """Raises RefusedError if a script does not contain the declaration of a name."""
    nodes = [node for _, node in walk(machine.root)]
    texts = {id(node.span.source) for node in nodes}
    mine = next((node for node in nodes
                 if any(outcome.span == declared for outcome in node.outcomes)), None)  # fmt: skip
    if kind == "outcome" and mine is not None and id(declared.source) not in texts:
        message = f"`{old}` is an outcome of the state type `{mine.type}`, not of the script"
        help = f"rename it in the interface of `{mine.type}`, or put the state into a container"
        raise RefusedError(mine.span, message, help)
    if kind != "key" and declared.text.strip("'\"") != old:
        message = (
            f"the script does not contain `{old}` here: it is a default or comes from a look-up"
        )
        raise RefusedError(declared, message)


def _name_in(machine: Machine, above: str, word: str, known: Mapping[str, Node]) -> str:
    """The name of a state of the container at a full path, given by its name or a path."""
    name = word.rpartition("/")[2]
    if name in known:
        return name
    with suppress(NotFoundError):
        path, _ = find_state(machine, word)
        around, _, found = path.rpartition("/")
        return found if around == above else name
    return name


def _facts(types: Mapping[str, StateType], library: Library, leaf: Leaf) -> TemplateFacts:
    """Keys and outcomes of a state without an interface, read from its template."""
    type_ = types.get(leaf.type)
    template = library.template(type_.code.get("python", "")) if type_ is not None else None
    if type_ is None or template is None:
        return TemplateFacts()
    reads, writes = keys_in_code(template)
    listed = any(variable.name == "outcomes" for variable in leaf.written)
    return TemplateFacts(reads=reads, writes=writes, outcomes=listed or bool(type_.outcomes))


def _no_worse(before: Analysis, after: Analysis, span: Span) -> None:
    """Raises RefusedError if the change adds a fault of the data flow."""

    def flaws(analysis: Analysis) -> Counter[str]:
        grave = (
            diagnostic for diagnostic in analysis.report if diagnostic.severity is not Severity.INFO
        )
        return Counter(diagnostic.code for diagnostic in grave if diagnostic.code.startswith("SM3"))

    new = flaws(after) - flaws(before)
    found = next((item for item in after.report if item.code in new), None)
    if found is not None:
        message = f"the script would have a fault: {found.message} ({found.code})"
        raise RefusedError(span, message, found.help)


def _called(script: EditedScript, node: Node) -> Source:
    """The text of the sub-script that a state calls. Raises RefusedError."""
    editor = script.editor(node.span.source)
    body = variables_of(editor.state(node.span).item)
    called = variable(body, "script") if body is not None else None
    if called is None:
        help = "`smachac extract` makes a sub-script of a container"
        raise RefusedError(node.span, f"`{node.name}` calls no sub-script", help)
    words = called.value.text.strip("'\"") if isinstance(called.value, Atom) else ""
    found = script.library().script(words, node.span.source.name)
    if found is None:
        message = "the name of the sub-script comes from a look-up"
        raise RefusedError(node.span, message, "replace the look-up by the name first")
    return found
