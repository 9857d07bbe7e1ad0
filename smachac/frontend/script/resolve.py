"""Resolving: from a tree to one self-contained script.

Short field names are expanded, sub-scripts are included, look-ups are replaced by their values, and
every state gets its typed fields and its state type. Lowering needs no tree and no library.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from functools import cache
from pathlib import PurePath
from typing import Literal

from smachac.diagnostics.diagnostic import Diagnostic, Related, Report, has_errors
from smachac.diagnostics.source import Source, Span, Word
from smachac.diagnostics.spelling import MOST_EXPLAINED, guesser_of
from smachac.frontend import schema
from smachac.frontend.errors.references import (
    bad_sub_script,
    recursive_include,
    script_not_found,
    template_not_found,
    unresolved_look_up,
)
from smachac.frontend.errors.script import Owner, too_big, unknown_variable, wrong_shape
from smachac.frontend.loader import SUFFIXES, Library
from smachac.frontend.messages.message_definitions import (
    definitions_of,
    missing_definitions_of,
    other_types_of,
    with_values,
)
from smachac.frontend.resolved_script import TIMER, Script, State, Sugar, no_states, unknown_state
from smachac.frontend.schema import FieldOwner
from smachac.frontend.script.params import (
    MAX_FILLED,
    MAX_FILLED_BY_STATE,
    MAX_LEVELS,
    Call,
    Scope,
    child_scope,
    fill_in,
    fixed_params,
    is_flat,
    is_too_deep,
    look_up_word,
    look_ups,
    params_of,
    recovered_look_up,
    size_up_to,
)
from smachac.frontend.script.resolve_cache import CachedCall, ResolveCache, same_objects
from smachac.frontend.script.state_fields import (
    NAME_WORDS,
    Entries,
    FieldTable,
    another_state,
    field_table,
    has_unknown_outcomes,
    has_wrong_transitions,
    is_field,
    name_as_field,
    read_fields,
    recovered_params,
    second_key,
    with_further_states,
    with_recovered_fields,
)
from smachac.frontend.script.sub_scripts import (
    SUB_SCRIPT_HELP,
    overridden,
    sub_script_state,
)
from smachac.frontend.script.unknown_templates import (
    Searched,
    missing_template,
    missing_template_help,
    suggested_container,
    unknown_template,
)
from smachac.frontend.script.unused import Mark, Uses
from smachac.frontend.text.fields import (
    as_name,
    expanded,
    kind_of,
    name_of,
    pairs_of,
    usual_name,
    wrong,
)
from smachac.frontend.text.file_kinds import OTHER_FILES, kind_of_tree
from smachac.frontend.text.type_names import Aliases
from smachac.frontend.text.yaml_tree import (
    Entry,
    Map,
    Scalar,
    Seq,
    Tree,
    known_wrong,
)
from smachac.frontend.types.state_types import find_state_type
from smachac.frontend.types.type_annotations import (
    TYPED,
    explain_aliases,
    read_aliases,
    typed,
)
from smachac.ir.nodes import FixedParam, Preset, StateType
from smachac.pysource.templates.template_sources import TEMPLATE_FILES
from smachac.records import dataclass, field, replace

TYPE_CHECKING = False  # annotations only: most scripts have no functions or robot
if TYPE_CHECKING:
    from smachac.ir.function_facts import FunctionFacts
    from smachac.ir.properties import Property
    from smachac.ir.robot import Robot

MAX_STATES = 1_000_000
"""The most states of a script with its sub-scripts."""

MAX_NESTED = 1_000
"""The most levels of containers in containers."""

MAX_KEYS, MAX_KEYS_BY_STATE = 20_000, 10
"""The most userdata values of a script: a fixed part and a part for each state. One takes 3 kB of
memory in the checks."""


SCRIPT_HELP = "write a mapping with `name:`, `outcomes:` and `states:`"


@dataclass(frozen=True, slots=True)
class _Environment:
    """The surroundings of a state: the source of its text and the params in scope. They are equal
    if only the texts of other states differ.

    `calls`: the sub-scripts that are called around it, with the spans of the calls, outermost
    first. `depth`: the number of containers around it. `inner`: if the state calls a sub-script,
    the name of the state in that. `iterated`: it is the state of an Iterator.
    """

    source: Source = field(compare=False)
    scope: Scope = field(default_factory=Scope, compare=False)
    calls: tuple[tuple[str, Span], ...] = ()
    depth: int = 0
    inner: Word | None = None
    iterated: bool = False

    @property
    def via(self) -> tuple[Span, ...]:
        """The spans of the calls."""
        return tuple([span for _, span in self.calls]) if self.calls else ()


def resolve(
    source: Source,
    tree: Tree | None,
    library: Library,
    report: Report,
    kept: ResolveCache | None = None,
) -> Script | None:
    """The script that a tree describes, without its wrong parts; None if it is no script. `kept`
    are the results of the last reading, which become those of this one."""
    if tree is None:
        if not report:
            span = Span(source, 0, 0)
            report.append(
                wrong_shape(span, "the script is empty", SCRIPT_HELP, arguments=("empty",))
            )
        return None
    if not isinstance(tree, Map):
        span = Span(source, tree.span.start, tree.span.start + 1)
        message, help = f"a script must be a mapping, not {kind_of(tree)}", SCRIPT_HELP
        if isinstance(tree, Seq):
            message = "a script must be a mapping; this list is a sub-script"
            help = "check or build the script that calls it"
        report.append(wrong_shape(span, message, help, arguments=("script", kind_of(tree))))
        return None
    kind = kind_of_tree(tree)
    if kind in OTHER_FILES:
        what, help = OTHER_FILES[kind]
        help = help.replace("FILE", source.file_name)
        message = f"a script is expected; this is {what}"
        report.append(wrong_shape(tree.entries[0].key.span, message, help, arguments=(kind,)))
        return None
    resolver = _Resolver(library, report, kept)
    script = resolver.script(source, tree)
    if kept is not None:
        kept.calls = resolver.calls
    return None if resolver.has_too_many_keys() else script


def refuse_python(source: Source, report: Report) -> None:
    """Report that a Python file is no script."""
    message = "a script is expected; this is a Python file"
    help = "`smachac check`, `view`, `explain`, `diff` and pictures of `build` read it"
    report.append(wrong_shape(Span(source, 0, 0), message, help, arguments=("python",)))


class _Resolver:
    """One run of `resolve`: the library, the report, and what was read so far.

    `found_types` and `found_texts` are the library's answers, `types` and `texts` those that the
    part which is being read uses. `count` is the number of states, `looked_up` the number of nodes
    that look-ups have added.
    """

    def __init__(self, library: Library, report: Report, kept: ResolveCache | None) -> None:
        self.library = library
        self.report = report
        self.kept = kept
        self.main = ""
        self.aliases: Aliases = {}
        self.sources: dict[Source, None] = {}
        self.found_types: dict[str, StateType | None] = {}
        self.types: dict[str, StateType | None] = {}
        self.found_texts: dict[tuple[str, str], Source | None] = {}
        self.texts: dict[tuple[str, str], Source] = {}
        self.tables: dict[tuple[FieldOwner, str, tuple[str, ...]], FieldTable] = {}
        self.parsed: dict[tuple[str, str], tuple[Tree | None, bool]] = {}
        self.templates: tuple[Sequence[str], Sequence[str]] | None = None
        self.calls: dict[Span, CachedCall] = {}
        self.others: dict[str, StateType | None] = {}  # types that the script need not use
        self.unknown: set[str] = set()  # the templates that were not found
        self.unread: set[str] = set()  # the sub-scripts and templates whose fault is reported
        self.count = self.looked_up = self.keys = 0
        self.most_keys: tuple[Preset, ...] = ()
        self.uses = Uses()
        self.fixed_params: list[FixedParam] = []

    def script(self, source: Source, tree: Map) -> Script:
        """The script of a tree: its outermost state machine, with the robot and the types."""
        self.sources[source] = None
        self.uses.trees[source] = tree
        self.main = source.name
        begin = self.uses.mark(self.report)
        entries = expanded(tree.entries, self.report)
        self.aliases = self.library.types
        if "types" in entries:
            self.aliases = read_aliases(entries["types"].value, self.aliases, self.report)
        if self.kept is not None:
            self.kept.use_aliases(self.aliases)
        start = tree.entries[0].key.span if tree.entries else tree.span
        base = self.state(Word("sm", start), entries, _Environment(source), "base", begin)
        self.report[:] = one_for_each_name(self.report)
        # A `robot` of a wrong shape was reported; the default robot must not replace it.
        is_wrong = base.robot is None and "robot" in entries
        robot = None if is_wrong else self._robot(base, source)
        outer = self.library.types
        self.uses.types |= explain_aliases(self.aliases, outer, source, self.report)
        if "types" in entries:
            self.uses.aliases(entries["types"].value, self.report)
        known = [type_ for type_ in self.types.values() if type_ is not None]
        classes = [type_.class_facts for type_ in known if type_.class_facts is not None]
        library = replace(self.library, definition_names=cache(self.library.definition_names))
        states = with_values(base)
        definitions = definitions_of(base, states, classes, library, self.report)
        return Script(
            base=base,
            sources=tuple(self.sources),
            robot=robot,
            definitions=definitions,
            missing_definitions=missing_definitions_of(states, classes, definitions, library),
            other_types=other_types_of(states, definitions, library),
            unused=self.uses.unused(self.report),
            properties=self._properties(entries.get("properties"), source),
            params=params_of(entries.get("params")),
            fixed_params=tuple(self.fixed_params),
            functions=self._functions(base),
            state_types={name: type_ for name, type_ in self.types.items() if type_ is not None},
            aliases=self.aliases,
        )

    def _robot(self, base: State, source: Source) -> Robot | None:
        """The robot of a script. Scripts without one do not load what reads descriptions."""
        if base.robot is None and base.scene is None and "robot" not in base.type.variables:
            return None
        from smachac.frontend.robots.robots import robot_of

        return robot_of(base, source, self.library, self.report)

    def _properties(self, entry: Entry | None, source: Source) -> tuple[Property, ...]:
        if entry is None:
            return ()
        from smachac.frontend.script.properties import properties_of

        return properties_of(entry, source, self.library, self.report)

    def _functions(self, base: State) -> Mapping[str, FunctionFacts]:
        """The functions of the user that the states name. Scripts without state types of the user
        do not load what reads Python."""
        if all(type_ is None or type_.built_in for type_ in self.types.values()):
            return {}
        from smachac.frontend.script.script_functions import functions_of

        return functions_of(base, self.types, self.library)

    def has_too_many_keys(self) -> bool:
        """Whether the script has too much userdata, which is reported where most of it is."""
        limit = MAX_KEYS + MAX_KEYS_BY_STATE * self.count
        if self.keys <= limit:
            return False
        message = f"the script sets {self.keys:,} userdata keys; the limit is {limit:,}"
        help = "use a list or a mapping as the value of one key"
        span = self.most_keys[0].span
        self.report.append(too_big(span, message, help, arguments=("keys",)))
        return True

    def state(
        self,
        name: Word,
        own: dict[str, Entry],
        around: _Environment,
        role: Literal["", "base"] = "",
        begin: Mark | None = None,
    ) -> State:
        """The state with these fields. `role` is "base" for the script itself; `begin` is the mark
        of the call, if the state is that of a sub-script."""
        if "params" in own:
            own["params"] = self.limit_depth(own["params"])
        params = own.get("params") or recovered_params(own)
        begin = begin or self.uses.mark(self.report)
        scope = child_scope(around.scope, params.value, self.report) if params else around.scope
        entries = own.copy()
        for key, entry in own.items():
            if key == "states":
                continue
            flat = is_flat(entry.value)
            if flat and key not in TYPED:
                if scope and isinstance(entry.value, Seq):
                    entries[key] = self.fill(key, entry, scope, flat=True)
                continue
            self.uses.value(key, entry.value, flat=flat)
            if key != "params":
                entries[key] = self.fill(key, entry, scope, flat=flat)
        type_, owner = self.type_of(name, entries, role, around)
        if type_.variables:
            entries |= self.lists(own, scope, type_)
        table = self.table(entries, owner, type_)
        if table.others:
            entries = with_recovered_fields(entries, owner, type_, self.report)
            table = self.table(entries, owner, type_)
        self.uses.type(type_)
        if scope:
            self.fixed_params += fixed_params(own, type_, scope)
        if role != "base":
            self.count += 1
        via = around.via
        fields = read_fields(
            name, entries, type_, table, self.report, scope=scope, inner=around.inner
        )
        presets: tuple[Preset, ...] = fields.get("userdata", ())
        self.keys += len(presets)
        if len(presets) > len(self.most_keys):
            self.most_keys = presets
        sugar: Sugar | None = fields.get("sugar")
        if sugar is not None and (sugar.timeout is not None or sugar.retry is not None):
            self.state_type(TIMER)
        if owner != "base" and has_wrong_transitions(entries, fields):
            return unknown_state(name, (), via)
        if owner == "state" and has_unknown_outcomes(entries, fields):
            return unknown_state(name, fields.get("transitions", ()), via)
        children: tuple[State, ...] = ()
        if "states" in entries and around.depth >= MAX_NESTED:
            self.report.append(_nested_too_deep(entries["states"].key.span))
            return unknown_state(name, fields.get("transitions", ()), via)
        if "states" in entries and owner != "state":
            inside = _Environment(around.source, scope, around.calls, around.depth + 1)
            children = self.children(name, entries["states"].value, owner, inside)
            if not children and fields.get("initial") is None:
                fields["initial"] = Word("", entries["states"].value.span)
        elif owner != "state":
            children = (no_states(name, via),)  # SM005 or SM003 was reported
        self.uses.params(params, begin, self.report, via)
        if around.iterated and "remapping" in entries:
            self.report.append(_remapping_in_iterator(entries["remapping"].key.span))
        return State(owner=owner, type=type_, via=via, states=children, **fields)

    def table(self, entries: Entries, owner: FieldOwner, type_: StateType) -> FieldTable:
        """The table for states with these fields, which is made once."""
        which = owner, type_.name, tuple(entries)
        if which not in self.tables:
            self.tables[which] = field_table(entries, owner, type_)
        return self.tables[which]

    def fill(self, key: str, entry: Entry, scope: Scope, *, flat: bool) -> Entry:
        """The field with values in place of its look-ups and aliases of types. `flat`: see
        `is_flat`."""
        if flat:
            meant = recovered_look_up(entry.value, scope, self.report) if scope else None
            entry = entry if meant is None else Entry(entry.key, meant)
            return typed(key, entry, self.aliases, self.report)
        row = schema.VARIABLES.get(key)
        names = row is not None and row.shape in ("names", "outcomes", "keys")
        entry = self.limit_depth(entry)
        new = fill_in(entry.value, scope, self.report, names=names)
        filled = entry if new is entry.value else self.limit_depth(self.limit_size(entry, new))
        return typed(key, filled, self.aliases, self.report)

    def lists(self, own: dict[str, Entry], scope: Scope, type_: StateType) -> dict[str, Entry]:
        """The variables of a state type that are lists, such as `goal_slots`, with one item for
        each look-up: their items are not joined to one string. Faults in them are reported by
        `fill`."""
        found: dict[str, Entry] = {}
        for key, held in type_.variables.items():
            entry = own.get(key)
            if entry is None or not (held.keys or held.type.name in ("list", "array")):
                continue
            if isinstance(entry.value, Seq) and not is_flat(entry.value):
                entry = self.limit_depth(entry)
                new = fill_in(entry.value, scope, [], names=True)
                found[key] = typed(key, self.limit_size(entry, new), self.aliases, [])
        return found

    def limit_size(self, entry: Entry, new: Tree) -> Entry:
        """The field with its value after the look-ups; too many added nodes are reported and
        dropped."""
        limit = MAX_FILLED + MAX_FILLED_BY_STATE * self.count
        room = limit - self.looked_up
        own = size_up_to(entry.value, room)
        grown = size_up_to(new, room + own) - own
        if grown > room:
            message = f"the look-ups of this script add more than {limit:,} values"
            help = "use smaller params"
            self.report.append(too_big(entry.value.span, message, help, arguments=("look-ups",)))
            return Entry(entry.key, known_wrong(entry.value.span))
        self.looked_up += max(0, grown)
        return Entry(entry.key, new)

    def limit_depth(self, entry: Entry) -> Entry:
        """The field; a value that is nested too deeply is reported and dropped."""
        if not is_too_deep(entry.value):
            return entry
        span = Span(entry.value.span.source, entry.value.span.start, entry.value.span.start + 1)
        message = f"this value is nested deeper than {MAX_LEVELS} levels"
        help = "use fewer levels of lists and mappings"
        self.report.append(too_big(span, message, help, arguments=("levels",)))
        return Entry(entry.key, known_wrong(span))

    def children(
        self, name: Word, tree: Tree, owner: FieldOwner, around: _Environment
    ) -> tuple[State, ...]:
        """The states of a list. An Iterator has one, which uses the keys of the Iterator. A value
        that is no list of states is reported; in its place is an unknown state."""
        items = tree.items if isinstance(tree, Seq) else ()
        if look_up_word(tree) is not None:
            help = "write the states here, or call a sub-script: `- NAME: {script: ...}`"
            message, arguments = "`states` cannot be a look-up", ("states", "look-up")
            self.report.append(wrong_shape(tree.span, message, help, arguments=arguments))
            return (no_states(name, around.via),)
        if not isinstance(tree, Seq):
            wrong(tree, "states", self.report)
            if not isinstance(tree, Map) or not tree.entries:
                return (no_states(name, around.via),)
        if isinstance(tree, Map):
            items = tuple(Map((entry,), entry.key.span) for entry in tree.entries)
        found: list[State] = []
        for item in items if owner == "Iterator" else with_further_states(items):
            if self.count >= MAX_STATES:
                message = f"the script has more than {MAX_STATES:,} states"
                help = "split the task into several scripts"
                self.report.append(too_big(item.span, message, help, arguments=("states",)))
                break
            iterated = owner == "Iterator" and not found
            state = self.item(item, replace(around, iterated=True) if iterated else around)
            if state is None:
                continue
            if owner == "Iterator" and found:
                self.report.append(another_state(name.text, found[0].name.text, state.name))
                continue
            found.append(state)
        return tuple(found)

    def item(self, tree: Tree, around: _Environment) -> State | None:
        """The state of one item of a list: `- NAME: {...}`, or `- NAME:` with its fields as further
        keys of the item, as in SMACHA."""
        if not isinstance(tree, Map) or not tree.entries:
            wrong(tree, "state", self.report)
            word = name_of(tree)
            return unknown_state(word, (), around.via) if word is not None and word.text else None
        first, rest = tree.entries[0], tree.entries[1:]
        name = as_name(first.key, self.report)
        if name is None:
            return None
        nothing = isinstance(first.value, Scalar) and first.value.value is None
        if nothing and rest:
            return self.read(name, expanded(rest, self.report), around)
        if rest and is_field(rest[0]) and name.text in NAME_WORDS:
            inner = name_of(first.value)
            if inner is not None and inner.text:
                self.report.append(name_as_field(first, inner))
                return self.read(inner, expanded(rest, self.report), around)
        if nothing or not isinstance(first.value, Map):
            found = kind_of(first.value)
            fault = "is empty" if nothing else f"must be a mapping of variables, not {found}"
            message = f"the state `{name.text}` {fault}"
            help = f"write `- {name.text}: {{template: ...}}`"
            arguments = ("variables", name.text, found)
            self.report.append(wrong_shape(name.span, message, help, arguments=arguments))
            return unknown_state(name, (), around.via)
        if rest:
            self.report.append(second_key(name, first.value, rest[0]))
        own = tuple(entry for entry in rest if is_field(entry)) if rest else ()
        return self.read(name, expanded(first.value.entries + own, self.report), around)

    def read(self, name: Word, own: dict[str, Entry], around: _Environment) -> State:
        """The state with these fields, which can be a call of a sub-script."""
        if "template" in own and "script" not in own and (self.kept is None or around.depth > 1):
            return self.state(name, own, around)
        return self.call(name, own, around)

    def call(self, name: Word, own: dict[str, Entry], around: _Environment) -> State:
        """As `called`; for the call of a sub-script, and for a state that is in no container of the
        script, the state of the last reading if it is still the same."""
        if self.kept is None or ("script" not in own and around.depth > 1):
            return self.called(name, own, around)
        kept = self.kept.calls.get(name.span)
        if kept is not None and self.is_current(kept, own, around):
            self.count += kept.states
            self.keys += kept.keys
            self.add(kept)
            self.fixed_params += kept.fixed_params
            self.calls[name.span] = kept
            return kept.state
        before = len(self.report), self.looked_up, self.count, self.keys
        fixed = len(self.fixed_params)
        outer = self.texts, self.sources, self.types, self.calls, self.uses, self.most_keys
        self.texts, self.sources, self.types, self.calls = {}, {}, {}, {}
        self.uses, self.most_keys = Uses(), ()
        new = CachedCall(
            own=dict(own),
            around=around,
            scope=around.scope,
            state=self.called(name, own, around),
            texts=self.texts,
            sources=self.sources,
            types=self.types,
            calls=self.calls,
            uses=self.uses,
            states=self.count - before[2],
            keys=self.keys - before[3],
            most_keys=self.most_keys,
            fixed_params=tuple(self.fixed_params[fixed:]),
        )
        self.texts, self.sources, self.types, self.calls, self.uses, self.most_keys = outer
        self.add(new)
        if (len(self.report), self.looked_up) == before[:2]:
            self.calls[name.span] = new
        return new.state

    def is_current(self, kept: CachedCall, own: dict[str, Entry], around: _Environment) -> bool:
        """Whether reading a call would give the same state again."""
        return (
            same_objects(kept.own, own)
            and kept.around == around
            and same_objects(kept.scope, around.scope)
            and self.count + kept.states < MAX_STATES
            and all(self.text(*name) is source for name, source in kept.texts.items())
            and all(self.state_type(name) is type_ for name, type_ in kept.types.items())
        )

    def add(self, call: CachedCall) -> None:
        """Add what the reading of a call has found to the part around it."""
        self.texts |= call.texts
        self.sources |= call.sources
        self.types |= call.types
        self.calls |= call.calls
        self.uses.add(call.uses)
        self.most_keys = max(self.most_keys, call.most_keys, key=len)

    def called(self, name: Word, own: dict[str, Entry], around: _Environment) -> State:
        """The state or, if it calls a sub-script, the state of that sub-script with the fields of
        the call."""
        begin = self.uses.mark(self.report)
        while "script" in own:
            entry = own.pop("script")
            params = own["params"].value if "params" in own else None
            scope = child_scope(around.scope, params, [])
            self.uses.value("script", entry.value, flat=is_flat(entry.value))
            word = as_name(fill_in(entry.value, scope, self.report), self.report)
            found = self.sub_script(word, around) if word is not None and word.text else None
            if word is None or found is None:
                child_scope(around.scope, params, self.report)
                transitions = own.get("transitions")
                pairs = pairs_of(transitions.value) if transitions is not None else ()
                return unknown_state(name, pairs, around.via)
            tree, inner, entries = found
            source = tree.span.source
            call = Span(around.source, entry.key.span.start, entry.value.span.end)
            calls = (*around.calls, (source.name, call))
            around = replace(around, source=source, calls=calls, inner=inner)
            fields = expanded(entries, self.report)
            self.uses.replaced(fields, own)
            given = tuple(
                Word(str(entry.key.value), entry.key.span) for entry in _entries_of(params)
            )
            scope = Scope(around.scope)
            scope.call = Call(name.text, Word(word.text, call), tree, given, around.scope.call)
            around = replace(around, scope=scope)
            own = overridden(fields, own)
        if around.inner is not None:
            own = self.with_params_beside(own, around)
        return self.state(name, own, around, begin=begin)

    def with_params_beside(self, own: dict[str, Entry], around: _Environment) -> dict[str, Entry]:
        """The fields of a called sub-script, with those that are params of it inside `params`: they
        were written beside it, which is reported (SM003)."""
        beside = [key for key, entry in own.items() if entry.key.span.source is not around.source
                  and key not in schema.VARIABLES and key not in around.scope]  # fmt: skip
        params = _entries_of(own["params"].value if "params" in own else None)
        known = {param.key.value for param in params}
        values = [entry.value for entry in own.values()] if beside else []
        read = {word.text for value in values for word in look_ups(value)}
        found = {key: own[key] for key in beside if key in read and key not in known}
        if not found:
            return own
        for entry in found.values():
            word = Word(str(entry.key.value), entry.key.span)
            help = f"`{word.text}` is a param of the sub-script: write it inside `params:`"
            self.report.append(unknown_variable(word, Owner("state", "a state"), (), help=help))
        span = next(iter(found.values())).key.span
        name = own["params"].key if "params" in own else Scalar("params", True, *span)
        own = {key: entry for key, entry in own.items() if key not in found}
        return own | {"params": Entry(name, Map((*params, *found.values()), span))}

    def not_found(self, name: str, item: Diagnostic) -> None:
        """Reports a file that was not found, except as a consequence: it is there, but could not be
        read, or its folder may be in settings that could not be read, which are reported."""
        settings_read = self.library.settings_read or not has_errors(self.report)
        if settings_read and name not in self.unread:
            self.report.append(item)

    def sub_script(
        self, word: Word, around: _Environment
    ) -> tuple[Tree, Word, tuple[Entry, ...]] | None:
        """The tree of a sub-script, the name of its state, and that state's fields."""
        caller = around.source.name
        source = self.text(word.text, caller)
        if source is None:
            searched = self.library.script_folders(caller)
            known = self.library.script_names(caller)
            other = self.library.folder_with(word.text, SUFFIXES[1:], searched)
            template = word.text in self.known_templates()[1]
            missing = script_not_found(word, searched, known, other, template=template)
            self.not_found(word.text, missing)
            return None
        self.texts[word.text, caller] = source
        if (word.text, caller) not in self.parsed:
            before = len(self.report)
            tree = self.library.parse(source, self.report)
            self.parsed[word.text, caller] = tree, len(self.report) > before
        tree, broken = self.parsed[word.text, caller]
        chain = [*around.calls, (source.name, word.span)]
        if source.name == self.main or source.name in [name for name, _ in around.calls]:
            self.report.append(recursive_include(chain))
            return None
        self.sources.setdefault(source)
        if tree is None:
            if not broken:
                start, message = Span(source, 0, 0), "the sub-script is empty"
                self.report.append(
                    bad_sub_script(start, message, word.span, SUB_SCRIPT_HELP, arguments=("empty",))
                )
            return None
        self.uses.trees[source] = tree
        state = sub_script_state(tree, word, self.report)
        return None if state is None else (tree, *state)

    def text(self, name: str, caller: str) -> Source | None:
        """The text of a sub-script, from the library at its first use."""
        if (name, caller) not in self.found_texts:
            before = len(self.report)
            self.found_texts[name, caller] = self.library.script(name, caller)
            if len(self.report) > before:
                self.unread.add(name)
        return self.found_texts[name, caller]

    def known_templates(self) -> tuple[Sequence[str], Sequence[str]]:
        """The folders of templates and the names in them, for messages."""
        if self.templates is None:
            self.templates = self.library.template_folders(), self.library.template_names()
        return self.templates

    def state_type(self, name: str) -> StateType | None:
        """The state type of that name, read from the library at its first use."""
        if name not in self.found_types:
            find = self.kept.state_type if self.kept is not None else find_state_type
            before = len(self.report)
            self.found_types[name] = find(name, self.library, self.report)
            if len(self.report) > before:
                self.unread.add(name)
        self.types[name] = self.found_types[name]
        return self.types[name]

    def other_type(self, name: str, words: Collection[str]) -> StateType | None:
        """A type that the script need not use; its faults are not reported. None for a built-in one
        whose interface does not have all these words, or that has no interface."""
        library = self.library
        if not any(library.own_template(file.format(name)) for file in ("{}.yml", *TEMPLATE_FILES)):
            interface = library.template(f"{name}.yml")
            if interface is None or not all(word in interface.text for word in words):
                return None
        if name not in self.others:
            self.others[name] = find_state_type(name, library, [])
        return self.found_types.get(name) or self.others[name]

    def type_of(
        self, name: Word, entries: Entries, role: Literal["", "base"], around: _Environment
    ) -> tuple[StateType, FieldOwner]:
        """The state type of a state, and its owner in the schema."""
        entry = entries.get("template")
        usual = usual_name(entry.value) if entry is not None else None
        if usual is not None and not role:  # most states
            kind, type_ = schema.CONTAINERS.get(usual), self.types.get(usual)
            if kind is not None:
                return schema.CONTAINER_TYPES[kind], kind
            if type_ is not None and type_.kind != "container":
                return type_, "StateMachine" if "states" in entries else "state"
        word = as_name(entry.value, self.report) if entry else None
        if entry is None and role == "base":
            word = Word("Base", name.span)
        if entry is None and role != "base":
            caller = around.source.name
            open_ = {PurePath(text).stem for text in (caller, *(name for name, _ in around.calls))}
            scripts = [n for n in self.library.script_names(caller) if n not in open_]
            types = self.known_templates()[1]
            shown, calls = around.inner or name, around.via if around.inner is not None else ()
            help = missing_template_help(shown.text, entries, scripts, types, self.other_type)
            self.report.append(missing_template(shown, calls, entries, help))
        nested: FieldOwner = "StateMachine" if "states" in entries else "state"
        if word is None or not word.text:
            return StateType(name="", open=True), role or nested
        kind = schema.CONTAINERS.get(word.text)
        if not role and kind is not None:
            return schema.CONTAINER_TYPES[kind], kind
        found = self.state_type(word.text)
        if found is None:
            searched, names = self.known_templates()
            known = [*names, *([] if role else schema.CONTAINERS)]
            near = guesser_of(tuple(known)).unique_match(word.text)
            is_known = word.text in self.unknown or len(self.unknown) >= MOST_EXPLAINED
            other = (
                ""
                if is_known
                else self.library.folder_with(word.text, (".yml", ".tpl.py"), searched)
            )
            read = {} if role or is_known else entries
            self.unknown.add(word.text)
            called = [] if role or is_known else self.library.script_names(around.source.name)
            found_in = Searched(searched, names, known, called, other)
            self.not_found(word.text, unknown_template(word, read, found_in, self.other_type))
            kind = schema.CONTAINERS.get(near or suggested_container(word.text, entries))
            if kind is not None:
                return schema.CONTAINER_TYPES[kind], kind
            return StateType(name=word.text, open=True), role or nested
        # Some meta blocks of SMACHA name the kind `container` for a state.
        is_container = found.kind == "container" and not found.prints_itself
        return found, role or ("StateMachine" if is_container else nested)


MOST_PLACES = 5
"""The most further places that a finding shows."""


def one_for_each_name(found: Report) -> Report:
    """The findings, with one for all look-ups of a param, and for all states of a template, that
    fail for the same reason: at the first place, with the others."""
    kinds = (template_not_found.code, unresolved_look_up.code)
    groups: dict[tuple[object, ...], list[Diagnostic]] = {}
    for item in found:
        key: tuple[object, ...] = (id(item),)
        if item.kind in kinds:
            is_look_up = item.kind is kinds[1] and len(item.finding.arguments) == 1
            key = (item.kind, item.finding.arguments[0], is_look_up and item.span.source)
        groups.setdefault(key, []).append(item)
    kept: Report = []
    for first, *others in groups.values():
        places = dict.fromkeys(other.span for other in others if other.span != first.span)
        more = [Related(span=span, message="the same here") for span in places][:MOST_PLACES]
        finding = replace(first.finding, related=(*first.finding.related, *more))
        kept.append(replace(first, finding=finding) if more else first)
    return kept


def _entries_of(tree: Tree | None) -> tuple[Entry, ...]:
    return tree.entries if isinstance(tree, Map) else ()


def _remapping_in_iterator(span: Span) -> Diagnostic:
    """SM004 for a remapping of the state of an Iterator."""
    message = "the state of an Iterator cannot have a remapping: it uses the Iterator's keys"
    help = "rename the keys, or put the state into a StateMachine and remap there"
    return wrong_shape(span, message, help, arguments=("remapping",))


def _nested_too_deep(span: Span) -> Diagnostic:
    """SM006 for the `states` of a container below too many others."""
    message = f"containers are nested deeper than {MAX_NESTED:,} levels"
    return too_big(span, message, "use fewer levels of containers", arguments=("containers",))
