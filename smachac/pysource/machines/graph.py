"""The state graph of containers that were evaluated: a machine whose spans lie in Python files.

What is not known must cause no false finding. A container with a part that is not known gets one
more state, ELSEWHERE: it is open, can be reached, and leads to every state and outcome. An outcome
with several possible targets leads to a state of its own that leads to each of them.
"""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import PurePath
from typing import Any, Literal, NamedTuple, Protocol, TypeVar

from smachac.diagnostics.source import NOWHERE, Span
from smachac.ir import nodes, types
from smachac.ir.class_facts import ClassFacts
from smachac.ir.nodes import (
    Autonomy,
    Concurrence,
    Condition,
    Container,
    Data,
    Expression,
    Key,
    Leaf,
    Machine,
    Node,
    Outcome,
    OutcomeRule,
    Preset,
    Remap,
    StateMachine,
    StateType,
    Transition,
)
from smachac.ir.traversal import outcome_names, outer_inputs, outer_outputs
from smachac.pysource.machines.dead_code import contains
from smachac.pysource.machines.evaluator import Evaluator
from smachac.pysource.machines.framework import Framework, userdata_of
from smachac.pysource.machines.heap import Added, Children
from smachac.pysource.machines.libraries import framework_of
from smachac.pysource.machines.proven_reads import doubtful_in
from smachac.pysource.machines.roots import Roots
from smachac.pysource.machines.state_comments import StateComments
from smachac.pysource.machines.values import (
    NONE,
    UNKNOWN,
    Arguments,
    Class,
    Const,
    DictValue,
    Function,
    Instance,
    LibraryClass,
    Method,
    OneOf,
    OpenText,
    TupleValue,
    Unknown,
    Value,
    alternatives,
    one_of,
    sequence,
    text_of,
    truth,
)
from smachac.records import replace

AnyContainer = TypeVar("AnyContainer", bound=Container)

ELSEWHERE = "?"
"""The name of the state in place of all that is not known of a container."""

_DEFINITIONS = ast.FunctionDef | ast.AsyncFunctionDef

_SEVERAL = LibraryClass("smach.State")

MOST_LEVELS, MOST_NODES = 60, 10_000
"""The deepest nesting of containers, and the most states of a machine: a container can be added at
several places, and each of them is a state."""


class FactReader(Protocol):
    """Reads what the code of a state does. `comments` are those about states."""

    @property
    def comments(self) -> StateComments: ...
    def of_class(self, cls: Class) -> ClassFacts | None: ...
    def of_instance(self, instance: Instance, classes: Sequence[Value]) -> ClassFacts | None: ...
    def of_callback(
        self, function: Function, *, bound: bool, given: frozenset[str] = frozenset()
    ) -> ClassFacts | None: ...
    def doubtful(self, instance: Instance, classes: Sequence[Value]) -> tuple[Span, ...]: ...


class Coverage(NamedTuple):
    """How much of a machine is known: the number of states, and those that are not known exactly,
    each with its place and the reason."""

    states: int
    unknown: tuple[tuple[Span, str], ...]


class Graph(NamedTuple):
    """A machine read from Python. `objects` are those that are its states, by the path of names."""

    machine: Machine
    coverage: Coverage
    framework: Framework
    objects: Mapping[tuple[str, ...], Instance] = {}


def graphs(roots: Roots, evaluator: Evaluator, reader: FactReader) -> Iterator[Graph]:
    """The machine of each root."""
    for container in roots.containers:
        yield _Builder(roots, evaluator, reader).graph(container)


def _text(value: Value | None) -> str | None:
    return text_of(value) if value is not None else None


class _Builder:
    def __init__(self, roots: Roots, evaluator: Evaluator, reader: FactReader) -> None:
        self.roots = roots
        self.evaluator = evaluator
        self.reader = reader
        self.types: dict[str, StateType] = {}
        self.type_names: dict[tuple[Any, ...], str] = {}
        self.first_types: dict[str, tuple[Any, ...]] = {}
        self.variants: dict[str, int] = {}
        self.unknown: list[tuple[Span, str]] = []
        self.states = 0
        self.nodes = 0
        self.path: list[Instance] = []
        self.in_rules: list[Mapping[str, Sequence[str]]] = []
        self.names_above: list[str] = []
        self.objects: dict[tuple[str, ...], Instance] = {}

    def graph(self, container: Instance) -> Graph:
        span = container.span or NOWHERE
        name = self._name(container)
        node = self.container(container, name, span, 0)
        objects = self.objects
        if not isinstance(node, StateMachine):
            node = _wrapped(node, span)
            objects = {(node.name, *path): made for path, made in objects.items()}
        closed = self.roots.closed or "$executed" in container.slots
        exposed = "$exposed" in container.slots or not closed
        if exposed:
            node = _with_inputs(node)
        machine = Machine(
            root=node,
            source=span.source.name.rpartition("/")[2],
            digest="",
            state_types=self.types,
        )
        coverage = Coverage(self.states, tuple(self.unknown))
        return Graph(machine, coverage, self.framework(container), objects)

    def framework(self, made: Instance) -> Framework:
        return framework_of(self.evaluator.classes(made.cls))

    def _name(self, container: Instance) -> str:
        if isinstance(container.cls, Class):
            return container.cls.name
        return _text(container.slots.get("$name")) or "sm"

    # --- containers

    def container(
        self, made: Instance, name: str, span: Span, depth: int, assumed: Sequence[str] = ()
    ) -> Container:
        """A container with its states. `assumed` are its outcomes if they are not known."""
        children = made.slots.get("$children")
        added = children.added if isinstance(children, Children) else ()
        complete = isinstance(children, Children) and children.complete and self.roots.complete
        known = _userdata(made) is not None
        self.nodes += len(added)
        inside = made in self.path or depth > MOST_LEVELS or self.nodes > MOST_NODES
        if not complete or not known or inside or self._overrides(made):
            self.unknown.append((span, "not all of its states are known"))
            complete = False
        if inside:
            added = ()
        self.path.append(made)
        self.in_rules.append(_outcomes_in_rules(made))
        self.names_above.append(name)
        self.objects[tuple(self.names_above)] = made
        node = self._built(made, name, span, depth, added, assumed, complete=complete)
        if self.names(made.slots.get("$inputs"), span) is None:
            node = _with_inputs(node, outside=False)
        if self.names(made.slots.get("$outputs"), span) is None:
            node = _with_outputs(node)
        self.names_above.pop()
        self.in_rules.pop()
        self.path.pop()
        return node

    def _built(
        self, made: Instance, name: str, span: Span, depth: int, added: Sequence[Added],
        assumed: Sequence[str], *, complete: bool,
    ) -> Container:  # fmt: skip
        kind = _text(made.slots.get("$kind")) or "StateMachine"
        outcomes = self.names(made.slots.get("$outcomes"), span)
        builder = _Children(self, made, kind, outcomes, complete=complete)
        built = builder.build(added, depth)
        known = outcomes
        if known is None:
            named = dict.fromkeys([*assumed, *_selected_outcomes(made)], span)
            known = [*{**named, **dict(builder.targets_outside())}.items()]
        ends = builder.exits(built)
        common: dict[str, Any] = {
            "name": name,
            "type": kind,
            "outcomes": tuple(Outcome(name=text, span=place) for text, place in (*known, *ends)),
            "inputs": self.keys(made.slots.get("$inputs"), span, required=True),
            "outputs": self.keys(made.slots.get("$outputs"), span, required=True),
            "userdata": tuple(_presets(_userdata(made), span)),
            "span": span,
        }
        initial = builder.initial(added)
        match kind:
            case "Concurrence":
                return self._concurrence(made, common, built, builder, span)
            case "Sequence":
                connector = made.slots.get("$connector_outcome")
                return nodes.Sequence(
                    **common, children=built, initial=initial,
                    connector_outcome=_text(connector) or "",
                    connector_span=_place(connector, span), initial_span=span,
                )  # fmt: skip
            case "Iterator":
                return self._iterator(made, common, built, added, span)
        return StateMachine(**common, children=built, initial=initial, initial_span=span)

    def _runs_as_state(self, made: Instance) -> bool:
        """Whether a container has no states, but a method `execute` of its own."""
        children = made.slots.get("$children")
        return children == Children() and any(
            isinstance(cls, Class) and "execute" in cls.slots
            for cls in self.evaluator.classes(made.cls)
        )

    def _overrides(self, made: Instance) -> bool:
        """Whether a class changes how states are added or run."""
        if made.opaque:
            return True
        overridden = self.framework(made).overridden
        return any(
            isinstance(cls, Class) and not overridden.isdisjoint(cls.slots)
            for cls in self.evaluator.classes(made.cls)
        )

    def _concurrence(
        self, made: Instance, common: dict[str, Any], built: tuple[Node, ...],
        builder: _Children, span: Span,
    ) -> Concurrence:  # fmt: skip
        rules: list[OutcomeRule] = []
        rules += _preemptions(built, self.framework(made))
        pairs = _rules_of(made)
        unknown = pairs is None
        known = {child.name for child in built}
        for key, value in pairs or ():
            conditions = _conditions(value)
            name = _text(key)
            if name is None or conditions is None:
                unknown = True
            elif builder.incomplete and not known.issuperset(one.child for one in conditions):
                continue  # about a state that is not known
            else:
                place = _place(key, span)
                rules.append(OutcomeRule(outcome=name, when=tuple(conditions), span=place))
        default = made.slots.get("$default_outcome")
        join = self._join(made)
        outcomes: tuple[Outcome, ...] = common["outcomes"]
        decided: list[Leaf] = []
        if unknown or builder.incomplete:
            decided.append(_decider(ELSEWHERE, outcomes, span))
        callback = made.slots.get("$outcome_cb")
        if callback is not None and not _is_none(callback):
            decided.append(self._callback(callback, outcomes, span))
        if decided:
            built = (*(child for child in built if child.name != ELSEWHERE), *decided)
            rules += [
                OutcomeRule(outcome=outcome.name, span=span,
                            when=(Condition(child=leaf.name, outcome=outcome.name, span=span),))
                for leaf in decided
                for outcome in leaf.outcomes
            ]  # fmt: skip
        return Concurrence(
            **common, children=built, rules=tuple(rules), join=join,
            default_outcome=_text(default) or "", default_span=_place(default, span),
        )  # fmt: skip

    def _callback(self, callback: Value, outcomes: tuple[Outcome, ...], span: Span) -> Leaf:
        """The state in place of `outcome_cb`, a function that selects the outcome: those of the
        container that it returns."""
        bound = isinstance(callback, Method)
        function = callback.function if isinstance(callback, Method) else callback
        if not isinstance(function, Function):
            return _decider(ELSEWHERE, outcomes, span)
        facts = self.reader.of_callback(function, bound=bound)
        if facts is not None and facts.complete:
            names = {ending.outcome.text for ending in facts.endings}
            outcomes = tuple(outcome for outcome in outcomes if outcome.name in names) or outcomes
        return _decider(f"{function.name}()", outcomes, span)

    def _join(self, made: Instance) -> Literal["all", "any", "rule"]:
        """Whether the first branch that ends stops the others, or the first rule that holds."""
        if "$conditions" in made.slots:
            return "rule"
        callback = made.slots.get("$child_termination_cb")
        function = callback.function if isinstance(callback, Method) else callback
        if callback is None or _is_none(callback):
            return "all"
        found = self.evaluator.tried(callback, Arguments((UNKNOWN,))) or UNKNOWN
        if truth(found) is not None:
            return "any" if truth(found) else "all"
        is_short = isinstance(function, Function) and not isinstance(function.node, _DEFINITIONS)
        return "all" if is_short else "any"

    def _iterator(
        self, made: Instance, common: dict[str, Any], built: tuple[Node, ...],
        added: Sequence[Added], span: Span,
    ) -> nodes.Iterator:  # fmt: skip
        items, label = made.slots.get("$it"), made.slots.get("$it_label")
        known = sequence(items)
        data: Data = Expression(text=_place(items, span).text, span=_place(items, span))
        if known is not None and all(isinstance(item, Const) for item in known):
            data = tuple(_data(item, span) for item in known)
        loop = self._loop_outcomes(added[0], built[0].outcomes) if added and built else ()
        final = added[0].final if added else None
        pairs = final.items if isinstance(final, DictValue) else {}
        exhausted = made.slots.get("$exhausted_outcome")
        return nodes.Iterator(
            **common, children=built[:1],
            items=nodes.Value(data=data, span=_place(items, span)), items_span=_place(items, span),
            item_key=_text(label) or "it_data", item_span=_place(label, span),
            exhausted_outcome=_text(exhausted) or "exhausted",
            exhausted_span=_place(exhausted, span),
            loop_outcomes=tuple(name for name, _ in loop or ()),
            loop_spans=tuple(place for _, place in loop or ()),
            final_map=tuple((str(key), _text(pair[1]) or "") for key, pair in pairs.items())
            if isinstance(pairs, Mapping) else (),
        )  # fmt: skip

    def _loop_outcomes(
        self, added: Added, outcomes: Sequence[Outcome]
    ) -> list[tuple[str, Span]] | None:
        """The outcomes after which the next item follows. With `break_outcomes` these are all
        others, whatever `loop_outcomes` are."""
        breaks = self.names(added.breaks, added.span)
        if not breaks:
            return self.names(added.loop, added.span)
        ends = {name for name, _ in breaks}
        return [(item.name, added.span) for item in outcomes if item.name not in ends]

    # --- states

    def state(self, value: Value, added: Added, name: str, depth: int) -> Node:
        span: Span = added.span
        is_container = isinstance(value, Instance) and "$children" in value.slots
        if isinstance(value, Instance) and is_container and not self._runs_as_state(value):
            return self.container(value, name, span, depth + 1, _outcomes_of(added))
        self.states += 1
        if isinstance(value, Instance):
            self.objects[(*self.names_above, name)] = value
        if not isinstance(value, Instance) or "$outcomes" not in value.slots:
            reason = self._missing(value, added)
            return self.open_leaf(name, span, added, reason, self._faults(value))
        outcomes = self._outcomes(value, added)
        inputs = sequence(value.slots.get("$inputs"))
        outputs = sequence(value.slots.get("$outputs"))
        if outcomes is None or inputs is None or outputs is None or value.opaque:
            what = "outcomes" if outcomes is None else "keys"
            reason = self._missing(value, added) if value.opaque else f"its {what} are not known"
            return self.open_leaf(name, span, added, reason)
        facts = self._facts(value)
        declared = dict(outcomes)
        named = [name for name in _outcomes_of(added) if name not in declared]
        if named and facts is not None and self.framework(value).undeclared_outcomes:
            returned = {word.text for word in facts.returns}
            outcomes = [*((name, span) for name in named if name in returned), *outcomes]
        required = sequence(value.slots.get("$required")) or ()
        names = {text for item in required if (text := _text(item)) is not None}
        if facts is not None:
            names |= _read_first(facts, self._doubtful(value))
        in_keys = tuple(
            key if key.name in names else _optional(key)
            for key in self.keys(value.slots.get("$inputs"), span, required=True)
        )
        out_keys = self.keys(value.slots.get("$outputs"), span, required=True)
        type_ = self._type(value, outcomes, in_keys, out_keys, facts)
        return Leaf(
            name=name, type=type_, outcomes=tuple(Outcome(name=t, span=p) for t, p in outcomes),
            inputs=in_keys, outputs=out_keys, span=span, class_facts=facts,
        )  # fmt: skip

    def _outcomes(self, value: Instance, added: Added) -> list[tuple[str, Span]] | None:
        """The outcomes of a state with those optional ones that transitions name; in a concurrence
        with all, as its rules can name them. None: not known."""
        outcomes = self.names(value.slots.get("$outcomes"), added.span)
        named = None if added.kind == "concurrence" else _outcomes_of(added)
        optional = self.names(value.slots.get("$optional", TupleValue(())), added.span) or []
        more = [pair for pair in optional if named is None or pair[0] in named]
        return None if outcomes is None else [*{**dict(more), **dict(outcomes)}.items()]

    def _missing(self, value: Value, added: Added) -> str:
        """Why the type of a state is not known."""
        if len(alternatives(added.state)) > 1:
            return "a condition that is not known selects its class"
        bases = self.evaluator.classes(value.cls) if isinstance(value, Instance) else [value]
        for base in bases:
            if isinstance(base, Unknown) and base.reason:
                if base.reason.endswith(".py"):
                    return f"{base.reason} cannot be read"
                return f"package {base.reason.partition('.')[0]} not found"
        return "its class is not known"

    def _facts(self, value: Instance) -> ClassFacts | None:
        """What the code of a state does; None if it is not known, or if the version of the
        framework decides which outcomes it has."""
        if "$optional" in value.slots:
            return None
        if isinstance(value.cls, Class):
            return self.reader.of_instance(value, self.evaluator.classes(value.cls))
        function = self._callback_of(value)
        if function is None:
            return None
        bound = isinstance(value.slots.get("$callback"), Method)
        given = value.slots.get("$callback_values")
        pairs = given.items if isinstance(given, DictValue) else {}
        if not isinstance(pairs, Mapping):
            return None
        return self.reader.of_callback(function, bound=bound, given=frozenset(map(str, pairs)))

    def _callback_of(self, value: Instance) -> Function | None:
        """The function that a CBState calls."""
        callback = value.slots.get("$callback")
        function = callback.function if isinstance(callback, Method) else callback
        return function if isinstance(function, Function) else None

    def _doubtful(self, value: Instance) -> tuple[Span, ...]:
        """The places in the code of a state at which reads of userdata need not happen."""
        if isinstance(value.cls, Class):
            return self.reader.doubtful(value, self.evaluator.classes(value.cls))
        function = self._callback_of(value)
        return doubtful_in(function) if function is not None else ()

    def _faults(self, value: Value) -> ClassFacts | None:
        """The faults of a class whose constructor does not set the outcomes of the state."""
        if not isinstance(value, Instance) or value.opaque or not isinstance(value.cls, Class):
            return None
        facts = self.reader.of_class(value.cls)
        return ClassFacts(name=facts.name, faults=facts.faults) if facts is not None else None

    def open_leaf(
        self, name: str, span: Span, added: Added, reason: str, facts: ClassFacts | None = None
    ) -> Leaf:
        """A state of an unknown type: its outcomes are those of a comment, or of its transitions
        and the rules of its concurrence."""
        note = self.reader.comments.at(span)
        if note.outcomes is None:
            self.unknown.append((span, reason))
            in_rules = self.in_rules[-1].get(name, ()) if self.in_rules else ()
            named = dict.fromkeys([*_outcomes_of(added), *in_rules])
            outcomes = tuple(Outcome(name=text, span=span) for text in named)
        else:
            outcomes = tuple(Outcome(name=word.text, span=word.span) for word in note.outcomes)
        type_ = facts.name.text if facts is not None and facts.name is not None else ELSEWHERE
        return Leaf(
            name=name, type=type_, outcomes=outcomes, span=span, class_facts=facts,
            open=note.input_keys is None and note.output_keys is None,
            inputs=tuple(Key(name=word.text, span=word.span) for word in note.input_keys or ()),
            outputs=tuple(Key(name=word.text, span=word.span) for word in note.output_keys or ()),
        )  # fmt: skip

    def _type(
        self, value: Instance, outcomes: Sequence[tuple[str, Span]], inputs: Sequence[Key],
        outputs: Sequence[Key], facts: ClassFacts | None,
    ) -> str:  # fmt: skip
        cls = value.cls
        short = cls.name if isinstance(cls, Class) else cls.short
        if facts is not None and facts.name is not None:
            short = facts.name.text
        which: tuple[Any, ...] = (
            id(cls) if isinstance(cls, Class) else f"{cls.name} {short}",
            tuple(name for name, _ in outcomes),
            tuple(key.name for key in inputs),
            tuple(key.name for key in outputs),
            facts and (facts.reads, facts.writes, facts.returns),
        )
        known = self.type_names.get(which)
        if known is not None:
            return known
        first = self.first_types.setdefault(short, which)
        own = short if first is which else f"{short} ({self._difference(cls, first, which)})"
        number = self.variants[own] = self.variants.get(own, 0) + 1
        name = own if number == 1 else f"{own} {number}"
        self.type_names[which] = name
        self.types[name] = StateType(
            name=name, outcomes=tuple(Outcome(name=t, span=p) for t, p in outcomes),
            input_keys=tuple(inputs), output_keys=tuple(outputs), class_facts=facts,
        )  # fmt: skip
        return name

    def _difference(
        self, cls: Class | LibraryClass, first: tuple[Any, ...], other: tuple[Any, ...]
    ) -> str:
        """What a state type has that the first one of its name has not: its module, its outcomes or
        its keys."""
        if first[0] != other[0] and isinstance(cls, Class):
            return PurePath(cls.frame.module.file).stem
        for names, more in zip(first[1:4], other[1:4], strict=True):
            if names != more:
                return ", ".join([*more[:3], *(["..."] if len(more) > 3 else [])]) or "none"
        return "other values"

    def names(self, value: Value | None, span: Span) -> list[tuple[str, Span]] | None:
        """The names in a list, each with its place; None: not known."""
        items = sequence(value) if value is not None else ()
        if items is None or not all(isinstance(item, Const) for item in items):
            return None
        found: dict[str, Span] = {}
        for item in items:
            if isinstance(item, Const) and isinstance(item.value, str):
                found.setdefault(item.value, item.span or span)
        return [*found.items()]

    def keys(self, value: Value | None, span: Span, *, required: bool) -> tuple[Key, ...]:
        names = self.names(value, span) or []
        return tuple(Key(name=name, span=place) for name, place in names)


class _Children:
    """The states of one container with their transitions."""

    def __init__(
        self, builder: _Builder, made: Instance, kind: str,
        outcomes: list[tuple[str, Span]] | None, *, complete: bool,
    ) -> None:  # fmt: skip
        self.builder = builder
        self.made = made
        self.kind = kind
        self.outcomes = outcomes
        self.framework = builder.framework(made)
        self.incomplete = not complete
        self.labels: set[str] = set()
        self.open_starts: frozenset[str] = frozenset()
        self.outside: dict[str, Span] = {}
        self.choices: list[Leaf] = []

    def build(self, added: Sequence[Added], depth: int) -> tuple[Node, ...]:
        known = [one for one in added if _text(one.label) is not None]
        self.labels = {text for one in known if (text := _text(one.label)) is not None}
        labels = (one.label for one in known)
        self.open_starts = frozenset(one.start for one in labels if isinstance(one, OpenText))
        known = _one_for_each_name(known)
        for one in (*(one for one in added if _text(one.label) is None), *known):
            if _text(one.label) is None:
                self.builder.unknown.append((one.span, "its name is not known"))
            elif isinstance(one.label, OpenText):
                self.builder.unknown.append((one.span, "a part of its name is not known"))
            elif one.possible:
                self.builder.unknown.append((one.span, "a condition that is not known adds it"))
        if any(_text(one.label) is None for one in added) or (added and added[0].possible):
            self.incomplete = True
        initial = self.made.slots.get("$initial", NONE)
        first = (sequence(initial) or (UNKNOWN,))[0]
        if self.outcomes is None or not (_is_none(initial) or _text(first) is not None):
            self.incomplete = True
        found: list[Node] = []
        for at, one in enumerate(known):
            name = _text(one.label) or ""
            state = _alike(alternatives(one.state))
            node = self.builder.state(state, one, name, depth)
            following = _text(known[at + 1].label) if at + 1 < len(known) else None
            transitions: tuple[Transition, ...] = ()
            if self.kind in ("StateMachine", "Sequence"):
                transitions = tuple(self._transitions(node, one, following))
            found.append(_connected(node, transitions, tuple(self._remaps(node, one)), one))
        found += self.choices
        if self.incomplete and self.kind != "Iterator":
            names = {*(node.name for node in found), *(name for name, _ in self.outcomes or ())}
            if self.outcomes is not None:
                found = [_without_targets(node, names) for node in found]
            found.append(self._elsewhere(found))
        return tuple(found)

    def exits(self, built: Sequence[Node]) -> Iterator[tuple[str, Span]]:
        """The outcomes that each container has, as far as states lead to them."""
        declared = {name for name, _ in self.outcomes or ()}
        for name in self.framework.exits:
            for node in built:
                is_left = any(transition.target == name for transition in node.transitions)
                if name not in declared and (is_left or name in outcome_names(node)):
                    yield name, node.span
                    break

    def targets_outside(self) -> list[tuple[str, Span]]:
        """The targets that are no states: outcomes of a container whose outcomes are not known."""
        return [*self.outside.items()]

    def initial(self, added: Sequence[Added]) -> str:
        """The first state. Of a container that is not known as a whole it is ELSEWHERE: each state
        can be reached, and each key can have a value."""
        if self.incomplete:
            return ELSEWHERE
        name = _text((sequence(self.made.slots.get("$initial")) or (None,))[0])
        if name is not None and name in self.labels:
            return name
        return _text(added[0].label) or "" if added else ""

    def _transitions(self, node: Node, added: Added, following: str | None) -> Iterator[Transition]:
        span: Span = added.span
        names = [outcome.name for outcome in node.outcomes]
        ends = {name for name, _ in self.outcomes or ()}
        given = added.transitions
        items = given.items if isinstance(given, DictValue) else {}
        unknown = given is not None and not isinstance(given, DictValue) and not _is_none(given)
        if not isinstance(items, Mapping) or unknown:
            self.incomplete = True
            self.builder.unknown.append((span, "its transitions are not known"))
            yield from (Transition(outcome=name, target=ELSEWHERE, span=span,
                                   target_span=span) for name in names)  # fmt: skip
            return
        done: set[str] = set()
        is_spare = self.framework.undeclared_outcomes and items.keys() >= {*names}
        for key, value in items.values():
            outcome = _text(key)
            if outcome is None:
                self.incomplete = True
                continue
            if _is_none(value) or _text(value) == "" or (is_spare and outcome not in names):
                continue
            done.add(outcome)
            target = self._target(value, added, outcome)
            yield Transition(outcome=outcome, target=target, span=_place(key, span),
                             target_span=_place(value, span))  # fmt: skip
        for name, place in self._connectors(added, following):
            if name not in done and following is not None:
                done.add(name)
                yield Transition(outcome=name, target=following, origin="connector", span=place)
        for name in names:
            if name in done:
                continue
            if name in self.framework.exits or (name in ends and self.framework.same_name_exits):
                yield Transition(outcome=name, target=name, origin="implicit", span=span)
            elif self.framework.jumps and name in self.labels:
                yield Transition(outcome=name, target=name, origin="connector", span=span)
            elif self.outcomes is None:
                yield Transition(outcome=name, target=ELSEWHERE, span=span, target_span=span)

    def _connectors(self, added: Added, following: str | None) -> list[tuple[str, Span]]:
        """The outcomes that lead to the state that is added next."""
        if added.kind == "add_auto":
            return self.builder.names(added.connector, added.span) or []
        if self.kind == "Sequence":
            name = _text(self.made.slots.get("$connector_outcome"))
            return [(name, added.span)] if name is not None else []
        return []

    def _target(self, value: Value, added: Added, outcome: str) -> str:
        """The target of a transition: its name, that of a state for several, or ELSEWHERE."""
        parts = alternatives(value)
        names = [_text(part) for part in parts]
        if None in names or not all(self._is_sure(part) for part in parts):
            self.incomplete = True
            self.builder.unknown.append((added.span, f"the target of `{outcome}` is not known"))
            return ELSEWHERE
        targets = [name for name in names if name]
        for name, part in zip(names, parts, strict=True):
            if name and name not in self.labels and self.outcomes is None:
                self.outside.setdefault(name, _place(part, added.span))
        if len(targets) == 1 and len(names) == 1:
            return targets[0]
        label = f"{_text(added.label)} {outcome}{ELSEWHERE}"
        span: Span = added.span
        self.choices.append(
            Leaf(
                name=label, type=ELSEWHERE, synthetic=True, span=span,
                outcomes=tuple(Outcome(name=name, span=span) for name in targets),
                transitions=tuple(
                    Transition(outcome=name, target=name, span=span,
                               target_span=span) for name in targets
                ),
            )
        )  # fmt: skip
        return label

    def _is_sure(self, target: Value) -> bool:
        """Whether a target can be no other state or outcome than that of its name: of a text with
        an open part, and of states with such names, another one can be meant."""
        if _text(target) in self.labels:
            return True
        if isinstance(target, OpenText):
            return False
        name = _text(target) or ""
        known = name in {outcome for outcome, _ in self.outcomes or ()}
        starts = (name[:end] for end in range(len(name) + 1))
        return not name or known or self.open_starts.isdisjoint(starts)

    def _remaps(self, node: Node, added: Added) -> Iterator[Remap]:
        given = added.remapping
        items = given.items if isinstance(given, DictValue) else {}
        if (given is not None and not isinstance(given, DictValue) and not _is_none(given)) or (
            not isinstance(items, Mapping)
        ):
            self.incomplete = True
            return
        is_spare = self.framework.undeclared_keys and not (isinstance(node, Leaf) and node.open)
        for key, value in items.values():
            name, other = _text(key), _text(value)
            if name is None or other is None:
                self.incomplete = True
            elif not is_spare or name in {key.name for key in (*node.inputs, *node.outputs)}:
                yield Remap(key=name, to=other, span=_place(key, added.span),
                            to_span=_place(value, added.span))  # fmt: skip

    def _elsewhere(self, found: Sequence[Node]) -> Leaf:
        span = self.made.span or NOWHERE
        targets = [*dict.fromkeys(node.name for node in found)]
        targets += [name for name, _ in self.outcomes or self.targets_outside()
                    if name not in targets]  # fmt: skip
        return Leaf(
            name=ELSEWHERE, type=ELSEWHERE, open=True, synthetic=True, span=span,
            outcomes=tuple(Outcome(name=name, span=span) for name in targets),
            transitions=tuple(
                Transition(outcome=name, target=name, span=span, target_span=span)
                for name in targets
            ),
        )  # fmt: skip


def _selected_outcomes(made: Instance) -> Iterator[str]:
    """The outcomes that the rules of a container name."""
    for slot in ("$default_outcome", "$exhausted_outcome", "$connector_outcome"):
        if (name := _text(made.slots.get(slot))) is not None:
            yield name
    for key, _ in _rules_of(made) or ():
        if (name := _text(key)) is not None:
            yield name


def _preemptions(built: Sequence[Node], framework: Framework) -> Iterator[OutcomeRule]:
    """The rules by which a branch that ends with an outcome of each container ends a concurrence
    too."""
    for child in built:
        for name in framework.exits:
            if name in outcome_names(child):
                when = Condition(child=child.name, outcome=name, span=child.span)
                yield OutcomeRule(outcome=name, when=(when,), span=child.span)


def _rules_of(made: Instance) -> list[tuple[Value, Value]] | None:
    """The rules of a concurrence, each with its outcome and its conditions; None: not known."""
    if "$conditions" in made.slots:
        given = made.slots["$conditions"]
        return [] if _is_none(given) else _pairs(given)
    mapping = made.slots.get("$outcome_map")
    items = mapping.items if isinstance(mapping, DictValue) else {}
    if isinstance(mapping, Unknown | OneOf) or not isinstance(items, Mapping):
        return None
    return [*items.values()]


def _outcomes_of(added: Added) -> list[str]:
    """The outcomes that the transitions of a state name."""
    items = added.transitions.items if isinstance(added.transitions, DictValue) else {}
    return [str(key) for key in items] if isinstance(items, Mapping) else []


def _outcomes_in_rules(made: Instance) -> dict[str, list[str]]:
    """The outcomes that the rules of a concurrence name, by state."""
    found: dict[str, list[str]] = {}
    mapping = made.slots.get("$outcome_map")
    items = mapping.items if isinstance(mapping, DictValue) else {}
    for _, value in items.values() if isinstance(items, Mapping) else ():
        for one in _conditions(value) or ():
            found.setdefault(one.child, []).append(one.outcome)
    return found


def _one_for_each_name(added: Sequence[Added]) -> list[Added]:
    """The states of a container. Those of one name that unknown conditions add are one state: it
    is one of several, and leads to one of several targets."""
    found: dict[str, list[Added]] = {}
    order: list[Added] = []
    for one in added:
        name = _text(one.label) or ""
        same = found.setdefault(name, [])
        if same and (one.possible or same[-1].possible):
            same.append(one)
        else:
            found[name] = [one]
            order.append(one)
    return [_together(found.get(_text(one.label) or "", [one]), one) for one in order]


def _together(same: Sequence[Added], first: Added) -> Added:
    if len(same) == 1 or same[0] is not first:
        return first
    pairs: dict[Any, list[tuple[Value, Value]]] = {}
    for one in same:
        items = one.transitions.items if isinstance(one.transitions, DictValue) else {}
        if not isinstance(items, Mapping):
            return replace(first, state=UNKNOWN, transitions=UNKNOWN)
        for key, pair in items.items():
            pairs.setdefault(key, []).append(pair)
    joined = {key: (some[0][0], one_of(pair[1] for pair in some)) for key, some in pairs.items()}
    return replace(
        first, state=one_of(one.state for one in same), transitions=DictValue({"items": joined}),
        possible=False,
    )  # fmt: skip


def _alike(states: Sequence[Value]) -> Value:
    """The state that is one of several with the same outcomes: it can have the keys of each, and
    what it reads is not known."""
    if len(states) == 1:
        return states[0]
    outcomes = {
        _names_of(state.slots.get("$outcomes"))
        if isinstance(state, Instance) and _is_leaf(state)
        else None
        for state in states
    }
    first = states[0]
    if len(outcomes) > 1 or None in outcomes or not isinstance(first, Instance):
        return UNKNOWN
    slots = {"$outcomes": first.slots["$outcomes"]}
    for name in ("$inputs", "$outputs", "$optional"):
        lists = [sequence(state.slots.get(name, TupleValue(())))
                 for state in states if isinstance(state, Instance)]  # fmt: skip
        known = [items for items in lists if items is not None]
        whole = TupleValue(tuple(item for items in known for item in items))
        slots[name] = whole if len(known) == len(lists) else UNKNOWN
    return Instance(_SEVERAL, slots, first.span)


def _is_leaf(state: Instance) -> bool:
    """Whether a value is a state with known outcomes, and no container."""
    return "$outcomes" in state.slots and "$children" not in state.slots and not state.opaque


def _names_of(value: Value | None) -> frozenset[str] | None:
    items = sequence(value) if value is not None else ()
    return None if items is None else frozenset(text for item in items if (text := _text(item)))


def _without_targets(node: Node, known: Collection[str]) -> Node:
    """A state whose transitions to unknown names lead to ELSEWHERE: to a state that is not known,
    perhaps."""
    if all(transition.target in known for transition in node.transitions):
        return node
    transitions = (
        transition if transition.target in known else replace(transition, target=ELSEWHERE)
        for transition in node.transitions
    )
    return replace(node, transitions=tuple(transitions))


def _connected(
    node: Node, transitions: tuple[Transition, ...], remaps: tuple[Remap, ...], added: Added
) -> Node:
    """A state with its connections in its container. Levels of autonomy for other outcomes than its
    own have no effect."""
    names = outcome_names(node)
    levels = (Autonomy(outcome=outcome, level=level, span=added.span)
              for outcome, level in added.autonomy if outcome in names)  # fmt: skip
    return replace(node, transitions=transitions, remaps=remaps, autonomy=tuple(levels))


def _read_first(facts: ClassFacts, doubtful: Sequence[Span]) -> set[str]:
    """The keys that code reads in no line after one that sets them, at no place of `doubtful`."""
    set_in: dict[str, int] = {}
    for word in facts.writes:
        set_in[word.text] = min(word.span.line, set_in.get(word.text, word.span.line))
    return {
        word.text
        for word in facts.reads
        if word.span.line <= set_in.get(word.text, word.span.line)
        and not any(contains(place, word.span) for place in doubtful)
    }


def _is_none(value: Value | None) -> bool:
    return isinstance(value, Const) and value.value is None


def _place(value: Value | None, span: Span) -> Span:
    """The place of a value; if it has none in the same file, another one."""
    found = getattr(value, "span", None)
    near = isinstance(found, Span) and (span is NOWHERE or found.source is span.source)
    return found if isinstance(found, Span) and near else span


def _decider(name: str, outcomes: tuple[Outcome, ...], span: Span) -> Leaf:
    """A state in place of what selects the outcome of a concurrence."""
    return Leaf(name=name, type=name, open=True, synthetic=True, span=span, outcomes=outcomes)


def _optional(key: Key) -> Key:
    return replace(key, type=types.Type("optional", (types.ANY,)))


def _conditions(value: Value) -> list[Condition] | None:
    """The conditions of a rule of an outcome map; None: not known."""
    items = value.items if isinstance(value, DictValue) else None
    pairs = [*items.values()] if isinstance(items, Mapping) else _pairs(value)
    if pairs is None:
        return None
    found: list[Condition] = []
    for key, part in pairs:
        child, outcome = _text(key), _text(part)
        if child is None or outcome is None:
            return None
        place = _place(part, _place(key, NOWHERE))
        found.append(Condition(child=child, outcome=outcome, span=place))
    return found


def _pairs(value: Value) -> list[tuple[Value, Value]] | None:
    """The items of a list of pairs; None: not known."""
    items = sequence(value)
    if items and isinstance(value, DictValue):
        return None
    pairs = [sequence(item) for item in items or ()]
    if items is None or any(pair is None or len(pair) != 2 for pair in pairs):
        return None
    return [(pair[0], pair[1]) for pair in pairs if pair is not None]


def _userdata(made: Instance) -> Mapping[Any, tuple[Value, Value]] | None:
    """The keys that the userdata of a container has: those of each, if an unknown condition selects
    how the container is made. None: not known."""
    found: dict[Any, tuple[Value, Value]] = {}
    for part in alternatives(userdata_of(made) or UNKNOWN):
        items = part.items if isinstance(part, DictValue) else None
        if not isinstance(items, Mapping):
            return None
        for key, (name, value) in items.items():
            found[key] = name, one_of([found[key][1], value]) if key in found else value
    return found


def _presets(userdata: Mapping[Any, tuple[Value, Value]] | None, span: Span) -> Iterator[Preset]:
    for key, part in (userdata or {}).values():
        name = _text(key)
        if name is not None:
            place = _place(part, span)
            yield Preset(key=name, value=nodes.Value(data=_data(part, place), span=place),
                         span=place)  # fmt: skip


def _data(value: Value, span: Span) -> Data:
    match value:
        case Const(value=bool() | int() | float() | str() as known):
            return known
    return Expression(text=span.text or "?", span=span)


def _wrapped(node: Container, span: Span) -> StateMachine:
    """A state machine around a container of another kind, with its outcomes."""
    transitions = tuple(
        Transition(outcome=outcome.name, target=outcome.name, origin="implicit", span=span)
        for outcome in node.outcomes
    )
    return StateMachine(
        name="sm", type="StateMachine", outcomes=node.outcomes, inputs=node.inputs,
        children=(replace(node, transitions=transitions),), initial=node.name, span=span,
        initial_span=span,
    )  # fmt: skip


def _with_inputs(node: AnyContainer, *, outside: bool = True) -> AnyContainer:
    """A container that gets the userdata which its states read; `outside`: other code sets it."""
    before = {key.name for key in node.inputs} | {preset.key for preset in node.userdata}
    found: dict[str, Key] = {}
    for child in node.children:
        for key, name in zip(child.inputs, outer_inputs(child), strict=True):
            if name not in before:
                kind = types.ANY if outside else key.type
                found.setdefault(name, Key(name=name, span=child.span, type=kind))
    return replace(node, inputs=(*node.inputs, *found.values()))


def _with_outputs(node: AnyContainer) -> AnyContainer:
    """A container that gives what its states write to the container around it."""
    before = {key.name for key in node.outputs}
    found = {name: child.span for child in node.children for name in outer_outputs(child)}
    more = (Key(name=name, span=place) for name, place in found.items() if name not in before)
    return replace(node, outputs=(*node.outputs, *more))
