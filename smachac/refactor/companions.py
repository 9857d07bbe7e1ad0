"""Files beside a script that name its states: scenarios, faults of the simulation, and baselines.
A refactoring changes them as it changes the script.

A scenario is one of a machine if it has no fault with it.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from smachac.diagnostics.baseline import BaselineError, followed, read, successors
from smachac.diagnostics.source import Source, Span
from smachac.diagnostics.spelling import is_plain
from smachac.driver import Analysis
from smachac.frontend.discovery import yaml_files
from smachac.frontend.files import Disk
from smachac.frontend.text.data_files import plain
from smachac.frontend.text.yaml_tree import Entry, Map, Scalar, Seq, Tree
from smachac.interpreter.scenario import leaves_named, read_scenario
from smachac.ir.nodes import Leaf, Machine, Node
from smachac.ir.script_paths import ScriptPath, walk_script
from smachac.ir.traversal import outcome_names

LARGEST = 1_000_000
"""The length of a file that is looked at, in characters."""

Edits = Iterator[tuple[Span, str]]
"""Words to replace, each with the new one."""


def changed_companions(
    folder: Path, disk: Disk, before: Machine, after: Machine
) -> dict[Path, tuple[Source, str]]:
    """The scenarios and faults in a folder that name states of a machine, with their texts after a
    change of it; only those that differ."""
    changes = Changes(before, after)
    found: dict[Path, tuple[Source, str]] = {}
    for path in yaml_files([folder]):
        source = disk.read(path, [])
        if source is None or len(source.text) > LARGEST or "state" not in source.text:
            continue
        tree = disk.parse(source, [])
        if not isinstance(tree, Map):
            continue
        edits = [*_scenario_edits(tree, changes), *_fault_edits(tree, changes)]
        if edits:
            found[path] = source, _edited(source.text, edits)
    return found


def changed_baselines(
    folder: Path,
    disk: Disk,
    before: Analysis,
    after: Analysis,
    known: Mapping[Path, tuple[Source, str]],
    *,
    same_behaviour: bool,
) -> dict[Path, tuple[Source, str]]:
    """The baselines in a folder that hold findings of a script, with their texts after a change of
    it; only those that differ. `known` are texts that were changed before."""
    if before.machine is None or after.machine is None:
        return {}
    words = Changes(before.machine, after.machine).words

    def renamed(text: str) -> str:
        return re.sub(r"\w+", lambda word: words.get(word[0], word[0]), text)

    found: dict[Path, tuple[Source, str]] = {}
    later = None
    for path in yaml_files([folder], (".json",)):
        source = disk.read(path, [])
        if source is None or '"fingerprint"' not in source.text:
            continue
        text = known[path][1] if path in known else source.text
        try:
            read(text)
        except BaselineError:
            continue
        if later is None:
            later = successors(before.report, after.report, renamed, same_behaviour=same_behaviour)
        new = followed(text, later)
        if new != text:
            found[path] = source, new
    return found


class Moved(NamedTuple):
    """A state with its paths before and after a change."""

    before: ScriptPath
    after: ScriptPath

    def outcome(self, name: str) -> str:
        """The name of an outcome after the change."""
        before, after = outcome_names(self.before.node), outcome_names(self.after.node)
        return _renamed(name, before, after)

    def key(self, name: str) -> str:
        """The name of an output key after the change."""
        before, after = ([key.name for key in path.node.outputs] for path in self)
        return _renamed(name, before, after)


def _renamed(name: str, before: Sequence[str], after: Sequence[str]) -> str:
    """The name at the place of another one, if there are as many names as before."""
    return after[before.index(name)] if name in before and len(before) == len(after) else name


class Changes:
    """What a change made of the states of a machine."""

    def __init__(self, before: Machine, after: Machine) -> None:
        self.before, self.after = before, after
        starts, ends = (
            {id(path.node): path for path in walk_script(machine.root)}
            for machine in (before, after)
        )
        pairs = (
            Moved(starts[id(old)], ends[id(new)]) for old, new in _pairs(before.root, after.root)
        )
        self._moved = {pair.before.full: pair for pair in pairs}

    @property
    def words(self) -> dict[str, str]:
        """The new names of states, outcomes and keys by the old ones, where each has one."""
        found: dict[str, set[str]] = {}
        for pair in self._moved.values():
            old, new = pair.before.node, pair.after.node
            columns = [((old.name,), (new.name,)), (outcome_names(old), outcome_names(new))]
            for one, other in ((old.inputs, new.inputs), (old.outputs, new.outputs)):
                columns.append((tuple(key.name for key in one), tuple(key.name for key in other)))
            for names, others in columns:
                if len(names) == len(others):
                    for name, other_name in zip(names, others, strict=True):
                        found.setdefault(name, set()).add(other_name)
        return {name: min(others) for name, others in found.items() if len(others) == 1}

    def moved(self, name: str) -> Moved | None:
        """The state that a path or the end of one names; None where it names none or several, and
        where the state was removed."""
        paths, problem = leaves_named(name, self.before)
        return self._moved.get(paths[0]) if len(paths) == 1 and problem is None else None

    def path(self, name: str, moved: Moved) -> str:
        """A path, or the end of one, as it names the same state after the change: as long as
        before, or longer if other states have that end."""
        if self._names(name, moved):
            return name
        if name in (moved.before.plain, moved.before.shown, moved.before.full):
            return moved.after.plain if self._names(moved.after.plain, moved) else moved.after.full
        steps = moved.after.plain.split("/")
        ends = ("/".join(steps[-count:]) for count in range(name.count("/") + 1, len(steps) + 1))
        return next((end for end in ends if self._names(end, moved)), moved.after.full)

    def _names(self, name: str, moved: Moved) -> bool:
        return leaves_named(name, self.after)[0] == [moved.after.full]


def _pairs(before: Node, after: Node) -> Iterator[tuple[Node, Node]]:
    """The states that are the same before and after a change: those of one name; if others are
    left, those at the same place, or those that were moved into a new container."""
    yield before, after
    if isinstance(before, Leaf) or isinstance(after, Leaf):
        return
    new = {child.name: child for child in after.children}
    alone = []
    for child in before.children:
        if child.name in new:
            yield from _pairs(child, new.pop(child.name))
        else:
            alone.append(child)
    if len(alone) == len(new) == 1:
        yield from _pairs(alone[0], next(iter(new.values())))
        return
    for around in new.values():
        inside = {} if isinstance(around, Leaf) else {each.name: each for each in around.children}
        for child in alone:
            if child.name in inside:
                yield from _pairs(child, inside[child.name])


def _edited(text: str, edits: list[tuple[Span, str]]) -> str:
    """The text with words replaced; a word keeps its quotes."""
    for span, word in sorted(edits, key=lambda edit: edit[0].start, reverse=True):
        quote = span.text[:1] if span.text[:1] in ("'", '"') else ""
        new = word
        if quote == '"' or (word and not quote and not is_plain(word)):
            new = json.dumps(word, ensure_ascii=False)
        if quote == "'":
            new = "'" + word.replace("'", "''") + "'"
        text = text[: span.start] + new + text[span.end :]
    return text


def _scenario_edits(tree: Map, changes: Changes) -> Edits:
    """The words of a scenario that change; none if the text is no scenario of the machine."""
    states = tree.get("states")
    if states is None or not isinstance(states.value, Map):
        return
    if read_scenario(plain(tree), changes.before)[1]:
        return
    entries = states.value.entries
    for number, entry in enumerate(entries, 1):
        name = str(entry.key.value)
        moved = changes.moved(name)
        if moved is None:  # removed; its lines too, if they are its own
            after = entries[number].key.span.start if number < len(entries) else None
            span = _own_lines(entry, after) if len(entries) > 1 else None
            if span is not None:
                yield span, ""
            continue
        new = changes.path(name, moved)
        if new != name:
            yield entry.key.span, new
        steps = entry.value.items if isinstance(entry.value, Seq) else (entry.value,)
        for step in steps:
            yield from _step_edits(step, moved)


def _own_lines(entry: Entry, after: int | None) -> Span | None:
    """The lines of an entry of a mapping; None if others share them. The next entry begins at
    `after`."""
    source, start = entry.key.span.source, entry.key.span.start
    line = source.text.rfind("\n", 0, start) + 1
    next_line = source.text.find("\n", entry.value.span.end) + 1 or len(source.text)
    if source.text[line:start].strip() or (after is not None and after < next_line):
        return None
    return Span(source, line, next_line)


def _step_edits(step: Tree, moved: Moved) -> Edits:
    """The names of outcomes and keys in a step that change."""
    outcome: Tree | None = step
    if isinstance(step, Map):
        entry, sets = step.get("outcome"), step.get("set")
        outcome = entry.value if entry is not None else None
        if sets is not None and isinstance(sets.value, Map):
            yield from _words([item.key for item in sets.value.entries], moved.key)
    if isinstance(outcome, Scalar):
        yield from _words([outcome], moved.outcome)
    elif isinstance(outcome, Map):
        yield from _words([item.key for item in outcome.entries], moved.outcome)


def _fault_edits(tree: Map, changes: Changes) -> Edits:
    """The paths of states in faults of the simulation that change."""
    faults = tree.get("faults")
    for fault in faults.value.items if faults is not None and isinstance(faults.value, Seq) else ():
        state = fault.get("state") if isinstance(fault, Map) else None
        if state is not None and isinstance(state.value, Scalar):
            name = str(state.value.value)
            moved = changes.moved(name)
            new = changes.path(name, moved) if moved is not None else name
            if new != name:
                yield state.value.span, new


def _words(scalars: Iterable[Scalar], renamed: Callable[[str], str]) -> Edits:
    """The words that have another name after the change."""
    for scalar in scalars:
        if isinstance(scalar.value, str) and (new := renamed(scalar.value)) != scalar.value:
            yield scalar.span, new
