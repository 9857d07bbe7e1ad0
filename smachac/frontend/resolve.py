"""A script as its author meant it: shorthand expanded, sub-scripts called, look-ups filled in,
every state with its type; one self-contained tree that lowering only has to read.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from smachac.diagnostics.diagnostic import Related, Report
from smachac.diagnostics.source import Source, Span, Word
from smachac.frontend import field_shapes, schema
from smachac.frontend.check_fields import check_variables
from smachac.frontend.errors.references import (
    bad_sub_script,
    recursive_include,
    script_not_found,
    template_not_found,
)
from smachac.frontend.errors.script import duplicate_key, missing_variable, too_big, wrong_shape
from smachac.frontend.loader import Library
from smachac.frontend.params import (
    MAX_FILLED,
    MAX_FILLED_BY_STATE,
    MAX_LEVELS,
    Scope,
    child_scope,
    fill_in,
    is_flat,
    is_too_deep,
    size_up_to,
)
from smachac.frontend.robots import robot_of
from smachac.frontend.state_types import StateType, find_state_type
from smachac.frontend.type_annotations import Aliases, read_aliases, typed
from smachac.frontend.unused import Mark, Uses
from smachac.frontend.yaml_tree import Entry, Map, Scalar, Seq, Tree, known_wrong
from smachac.ir.nodes import Unused
from smachac.ir.robot import Robot

MAX_STATES = 1_000_000
MAX_NESTED = 1_000
"""The most states a script may have once its sub-scripts are called, and the most containers
inside one another."""

CALLED_HERE = "in the sub-script called here"

Fields = Mapping[str, Entry]
"""Variables by long name; the entry's key is where the name stands."""


@dataclass(frozen=True, slots=True, kw_only=True)
class State:
    """A state or container of a script, or the script's base.

    `owner` says which variables of the schema it may have: "base", a container type or "state".
    `via`: the calls of sub-scripts that led here, outermost first. `params`: those in scope.
    `read`: what some of its fields say, names or pairs of names.
    """

    name: Word
    owner: str
    type: StateType
    fields: Fields
    states: tuple[State, ...] = ()
    via: tuple[Span, ...] = ()
    params: Scope = field(default_factory=dict)
    read: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True)
class Script:
    """A whole script. `sources`: its text and those of its sub-scripts, in the order of use."""

    base: State
    sources: tuple[Source, ...]
    robot: Robot | None = None
    unused: tuple[Unused, ...] = ()


@dataclass(frozen=True, slots=True)
class _Place:
    """Where resolving stands: the source, the params in scope, the calls that led there."""

    source: Source
    scope: Scope = field(default_factory=dict)
    calls: tuple[tuple[str, Span], ...] = ()
    depth: int = 0
    inner: Word | None = None
    """The state of the sub-script, where one is called."""

    @property
    def via(self) -> tuple[Span, ...]:
        return tuple(span for _, span in self.calls)


def resolve(source: Source, tree: Tree | None, library: Library, report: Report) -> Script | None:
    """The script that a tree holds, as far as it can be read; None where it holds none."""
    if tree is None:
        if not report:
            span = Span(source, 0, 0)
            report.append(
                wrong_shape(
                    span, "the script is empty", "a script begins with `name:` and has `states:`"
                )
            )
        return None
    if not isinstance(tree, Map):
        sub_script = isinstance(tree, Seq)
        report.append(
            wrong_shape(
                Span(source, tree.span.start, tree.span.start + 1),
                "a script is a mapping; this is a sub-script"
                if sub_script
                else f"a script is a mapping, not {field_shapes.kind_of(tree)}",
                "check or build the script that calls it" if sub_script else None,
            )
        )
        return None
    return _Resolver(library, report).script(source, tree)


class _Resolver:
    """What the functions of one run share: the library, the report, what was read before."""

    def __init__(self, library: Library, report: Report) -> None:
        self.library = library
        self.report = report
        self.main = ""
        self.aliases: Aliases = {}
        self.sources: dict[int, Source] = {}
        self.types: dict[str, StateType | None] = {}
        self.sub_scripts: dict[tuple[str, str], tuple[Source, Tree | None, bool] | None] = {}
        self.templates: tuple[Sequence[str], Sequence[str]] | None = None
        self.count = self.looked_up = 0
        self.uses = Uses()

    def script(self, source: Source, tree: Map) -> Script:
        self.sources[id(source)] = source
        self.main = source.name
        fields = self.expand(tree.entries)
        if "types" in fields:
            self.aliases = read_aliases(fields["types"].value, self.report)
        name = field_shapes.as_name(fields["name"].value, []) if "name" in fields else None
        start = tree.entries[0].key.span if tree.entries else tree.span
        base = self.state(name or Word("sm", start), fields, _Place(source), "base")
        robot = robot_of(base.fields, base.type, source, self.library, self.report)
        if "types" in fields:
            self.uses.aliases(fields["types"].value, self.report)
        return Script(
            base=base,
            sources=tuple(self.sources.values()),
            robot=robot,
            unused=self.uses.judged(self.report),
        )

    def expand(self, entries: tuple[Entry, ...]) -> dict[str, Entry]:
        """Entries by long name."""
        fields: dict[str, Entry] = {}
        for entry in entries:
            word = field_shapes.as_name(entry.key, self.report)
            if word is None:
                continue
            name = schema.LONG.get(word.text, word.text)
            first = fields.setdefault(name, entry)
            if first is not entry and first.key.value != entry.key.value:
                self.report.append(duplicate_key(word, first.key.span))
        return fields

    def state(
        self,
        name: Word,
        own: dict[str, Entry],
        place: _Place,
        role: str = "",
        begin: Mark | None = None,
    ) -> State:
        """A state from its variables; `role` is "base" for the script itself, `begin` where a
        call of it was met."""
        if "params" in own:
            own["params"] = self.shallow(own["params"])
        params = own.get("params")
        begin = begin or self.uses.mark(self.report)
        for key, entry in own.items():
            if key != "states":
                self.uses.value(key, entry.value)
        scope = child_scope(place.scope, params.value if params else None, self.report)
        called = place
        place = _Place(place.source, scope, place.calls, place.depth + 1)
        fields = {
            key: entry if key in ("params", "states") else self.filled(key, entry, scope)
            for key, entry in own.items()
        }
        type_, owner = self.type_of(name, fields, role, called)
        self.uses.type(type_)
        if role != "base":
            self.count += 1
        read = check_variables(name, fields, owner, type_, called.inner, self.report)
        children: tuple[State, ...] = ()
        if "states" in fields and place.depth > MAX_NESTED:
            message = f"more than {MAX_NESTED} containers stand inside one another here"
            self.report.append(too_big(fields["states"].key.span, message))
            return _unknown(name, fields, place)
        if "states" in fields and owner != "state":
            children = self.children(fields["states"].value, place)
            if owner == "Iterator":
                self.check_iterated(children)
        self.uses.params(params, begin, self.report, place.via)
        return State(
            name=name, owner=owner, type=type_, fields=fields, states=children, via=place.via,
            params=scope, read=read,
        )  # fmt: skip

    def filled(self, key: str, entry: Entry, scope: Scope) -> Entry:
        if is_flat(entry.value):
            return typed(key, entry, self.aliases, self.report)
        row = schema.VARIABLES.get(key)
        names = row is not None and row.shape in ("names", "keys")
        entry = self.shallow(entry)
        new = fill_in(entry.value, scope, self.report, names=names)
        filled = entry if new is entry.value else self.shallow(self.small(entry, new))
        return typed(key, filled, self.aliases, self.report)

    def small(self, entry: Entry, new: Tree) -> Entry:
        """The entry with its look-ups filled in, unless all of them have become too much."""
        room = MAX_FILLED + MAX_FILLED_BY_STATE * self.count - self.looked_up
        own = size_up_to(entry.value, room)
        grown = size_up_to(new, room + own) - own
        if grown > room:
            message = "the look-ups of this script stand for more than the limit of nodes"
            self.report.append(too_big(entry.value.span, message, None))
            return Entry(entry.key, known_wrong(entry.value.span))
        self.looked_up += max(0, grown)
        return Entry(entry.key, new)

    def shallow(self, entry: Entry) -> Entry:
        """The entry, without a value that is nested too deep."""
        if not is_too_deep(entry.value):
            return entry
        span = Span(entry.value.span.source, entry.value.span.start, entry.value.span.start + 1)
        message = f"a value is nested deeper than {MAX_LEVELS} levels"
        self.report.append(too_big(span, message))
        return Entry(entry.key, known_wrong(span))

    def children(self, tree: Tree, place: _Place) -> tuple[State, ...]:
        if not isinstance(tree, Seq):
            field_shapes.wrong(
                tree, "a list of states", self.report, "write each as `- NAME: {...}`"
            )
            return ()
        found = []
        for item in tree.items:
            if self.count >= MAX_STATES:
                message = f"the script has more than {MAX_STATES:,} states"
                self.report.append(too_big(item.span, message))
                break
            state = self.item(item, place)
            if state is not None:
                found.append(state)
        return tuple(found)

    def check_iterated(self, children: tuple[State, ...]) -> None:
        """SMACH's Iterator has one state, which sees its userdata as it is."""
        for child in children[1:]:
            message = "an Iterator holds one state; this is one more"
            help = "put them into a StateMachine, and iterate over that"
            self.report.append(wrong_shape(child.name.span, message, help))
        for child in children[:1]:
            if "remapping" in child.fields:
                span = child.fields["remapping"].key.span
                message = "the state of an Iterator has no remapping: it sees the Iterator's keys"
                help = "rename the keys, or put it into a StateMachine and remap there"
                self.report.append(wrong_shape(span, message, help))

    def item(self, tree: Tree, place: _Place) -> State | None:
        """The state of one item of a list of states, in either layout."""
        if not isinstance(tree, Map) or not tree.entries:
            field_shapes.wrong(
                tree, "a state", self.report, "write it as `- NAME: {template: ...}`"
            )
            return None
        first, rest = tree.entries[0], tree.entries[1:]
        name = field_shapes.as_name(first.key, self.report)
        if name is None:
            return None
        nothing = isinstance(first.value, Scalar) and first.value.value is None
        if nothing and rest:
            return self.called(name, self.expand(rest), place)
        if nothing or not isinstance(first.value, Map):
            message = f"`{name.text}` must be followed by the variables of the state"
            if not nothing:
                message += f", not by {field_shapes.kind_of(first.value)}"
            help = f"write `- {name.text}: {{template: ...}}`"
            self.report.append(wrong_shape(name.span, message, help))
            return _unknown(name, {}, place)
        if rest:
            other = rest[0].key
            self.report.append(
                wrong_shape(
                    other.span,
                    f"this item holds `{name.text}` and `{other.value}`; a state item has one key",
                    f"begin another item with `- {other.value}:`, or indent it below"
                    f" `{name.text}:`",
                    (Related(span=name.span, message="the first key"),),
                )
            )
        return self.called(name, self.expand(first.value.entries), place)

    def called(self, name: Word, own: dict[str, Entry], place: _Place) -> State:
        """The state itself or, when it calls a sub-script, what the sub-script makes of it."""
        begin = self.uses.mark(self.report)
        while "script" in own:
            entry = own.pop("script")
            scope = child_scope(place.scope, own["params"].value if "params" in own else None, [])
            self.uses.value("script", entry.value)
            word = field_shapes.as_name(fill_in(entry.value, scope, self.report), self.report)
            found = self.sub_script(word, place) if word is not None and word.text else None
            if found is None:
                return _unknown(name, own, place)
            source, inner, entries = found
            call = Span(place.source, entry.key.span.start, entry.value.span.end)
            calls = (*place.calls, (source.name, call))
            place = _Place(source, place.scope, calls, place.depth, inner)
            own = overridden(self.expand(entries), own)
        return self.state(name, own, place, begin=begin)

    def sub_script(
        self, word: Word, place: _Place
    ) -> tuple[Source, Word, tuple[Entry, ...]] | None:
        """The file of a sub-script, the name of its state, and the variables of that."""
        key = (word.text, place.source.name)
        if key not in self.sub_scripts:
            source = self.library.script(word.text, place.source.name)
            told = len(self.report)
            tree = self.library.parse(source, self.report) if source else None
            broken = len(self.report) > told
            self.sub_scripts[key] = (source, tree, broken) if source else None
        found = self.sub_scripts[key]
        if found is None:
            caller = place.source.name
            searched = self.library.script_folders(caller)
            known = self.library.script_names(caller)
            self.report.append(script_not_found(word, searched, known))
            return None
        source, tree, broken = found
        chain = [*place.calls, (source.name, word.span)]
        if source.name == self.main or source.name in [name for name, _ in place.calls]:
            self.report.append(recursive_include(chain))
            return None
        self.sources.setdefault(id(source), source)
        if tree is None:
            if not broken:
                message = "the sub-script is empty"
                report_at = Span(source, 0, 0)
                self.report.append(bad_sub_script(report_at, message, word.span))
            return None
        found_state = sub_script_state(tree, word, self.report)
        return None if found_state is None else (source, *found_state)

    def known_templates(self) -> tuple[Sequence[str], Sequence[str]]:
        """Where templates are searched, and the names that are there; looked up once."""
        if self.templates is None:
            self.templates = self.library.template_folders(), self.library.template_names()
        return self.templates

    def type_of(
        self, name: Word, fields: Fields, role: str, place: _Place
    ) -> tuple[StateType, str]:
        """The state type a state names, and which variables of the schema are its own."""
        entry = fields.get("template")
        word = field_shapes.as_name(entry.value, self.report) if entry else None
        if entry is None and role == "base":
            word = Word("Base", name.span)
        if entry is None and role != "base":
            held = place.inner or name
            calls = place.via if place.inner is not None else ()
            related = tuple(Related(span=each, message=CALLED_HERE) for each in calls)
            whose = f"`{held.text}`"
            self.report.append(missing_variable(held.span, "template", whose, related))
        nested = "StateMachine" if "states" in fields else "state"
        if word is None or not word.text:
            return StateType(name="", open=True), role or nested
        if not role and word.text in schema.CONTAINERS:
            return StateType(name=word.text, kind="container"), word.text
        if word.text not in self.types:
            self.types[word.text] = find_state_type(word.text, self.library, self.report)
        found = self.types[word.text]
        if found is None:
            searched, names = self.known_templates()
            known = [*names, *([] if role else schema.CONTAINERS)]
            self.report.append(template_not_found(word, searched, known))
            return StateType(name=word.text, open=True), role or nested
        # Some meta blocks call a state a container.
        is_container = found.kind == "container" and not found.prints_itself
        return found, role or ("StateMachine" if is_container else nested)


def _unknown(name: Word, fields: Fields, place: _Place) -> State:
    """What stands for a state that cannot be read: its name is a target, no more is known."""
    kept = {key: entry for key, entry in fields.items() if key == "transitions"}
    return State(
        name=name, owner="state", type=StateType(name="", open=True), fields=kept, via=place.via
    )


def sub_script_state(
    tree: Tree, call: Word, report: Report
) -> tuple[Word, tuple[Entry, ...]] | None:
    """The name and the variables of the one state that a sub-script holds, as written (SM014)."""
    start = Span(tree.span.source, tree.span.start, tree.span.start + 1)
    if isinstance(tree, Map):
        message = "a sub-script is a list with one state; this is a mapping"
        report.append(bad_sub_script(start, message, call.span))
        return None
    if not isinstance(tree, Seq) or len(tree.items) != 1:
        count = f"{len(tree.items)} states" if isinstance(tree, Seq) else field_shapes.kind_of(tree)
        message = f"a sub-script is a list with one state; this is {count}"
        report.append(bad_sub_script(start, message, call.span))
        return None
    item = tree.items[0]
    if not isinstance(item, Map) or not item.entries:
        report.append(bad_sub_script(start, "the sub-script's item is no state", call.span))
        return None
    first, rest = item.entries[0], item.entries[1:]
    name = Word(str(first.key.value), first.key.span)
    if isinstance(first.value, Map) and not rest:
        return name, first.value.entries
    if isinstance(first.value, Scalar) and first.value.value is None and rest:
        return name, rest
    message = "a sub-script is a list with one state that has one key: its name"
    report.append(bad_sub_script(first.key.span, message, call.span))
    return None


def overridden(inner: dict[str, Entry], call: dict[str, Entry]) -> dict[str, Entry]:
    """The variables of a sub-script under those of its call: mappings merge, the rest replaces."""
    merged = dict(inner)
    for key, entry in call.items():
        below = merged.get(key)
        if below is None or not isinstance(below.value, Map) or not isinstance(entry.value, Map):
            merged[key] = entry
            continue
        own = {item.key.value: item for item in entry.value.entries}
        entries = [own.pop(item.key.value, item) for item in below.value.entries]
        merged[key] = Entry(entry.key, Map((*entries, *own.values()), entry.value.span))
    return merged
