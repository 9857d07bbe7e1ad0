"""W3C SCXML: compound states as state machines, parallel states as concurrences, atomic states as
states whose outcomes are the events of their transitions.

What the graph of SMACH has no equivalent for is named and not taken over: executable content,
history, conditions over data, transitions that leave several states at once. Documents that smachac
generates (targets/scxml) are recognized: the states and events of their own are left out.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property

from smachac.diagnostics.source import Source, Span
from smachac.ir.nodes import (
    Concurrence,
    Condition,
    Data,
    Node,
    Outcome,
    OutcomeRule,
    Preset,
    StateMachine,
    Struct,
    Value,
)
from smachac.pysource.machines.constructions import Argument, Construction, Names
from smachac.records import dataclass, field, replace
from smachac.refactor.imports.xml_source import (
    Edges,
    Loader,
    NoLiteralError,
    UnreadableMachineError,
    XmlMachine,
    XmlText,
    inside,
    leaf,
    literal,
    local,
    transitions,
    type_name,
)
from smachac.robots.xml_tree import Element, FormatHelp
from smachac.targets.scxml.document import EVENTS, OWN_DATA
from smachac.targets.scxml.leaves import INVOKED

ROOT = "scxml"
NAMESPACE = "http://www.w3.org/2005/07/scxml"
FORMAT = FormatHelp(
    "name an SCXML file: its first tag is `<scxml ...>`",
    "the first tag of an SCXML file is `<scxml ...>`",
    "split the machine",
)

DONE, BRANCH = "done", "-branch"

_STATES = ("state", "parallel")
_STRUCTURE = frozenset(["state", "parallel", "final", "transition", "initial", "invoke",
                        "datamodel", "donedata"])  # fmt: skip
_EQUAL = re.compile(r"_event\.data(?:\.(\w+))?\s*={2,3}\s*(.+)")
_IN = re.compile(r"In\(\s*(?:'([^']+)'|\"([^\"]+)\")\s*\)")


def read_machine(source: Source, element: Element, load: Loader) -> XmlMachine:
    """The machine of a document. Raises UnreadableMachineError."""
    return _Reader(source, element).read()


id_of = id
"""The identity of an element: two can be equal."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Step:
    """A transition for one event: its condition and target, both empty if it has none."""

    event: str
    condition: str
    target: str
    element: Element


@dataclass(slots=True, kw_only=True)
class _Scope:
    """The container of a transition: the names of its states, and its outcomes by the ids of its
    final states."""

    states: frozenset[str]
    finals: Mapping[str, str] = field(default_factory=dict)

    def target(self, id: str) -> str | None:
        """The name that a target has in the container; None if it is in another one."""
        return id if id in self.states else self.finals.get(id)


class _Reader(XmlText):
    def __init__(self, source: Source, root: Element) -> None:
        super().__init__(source, [])
        self.root = root
        self.states: dict[Names, Construction] = {}
        self.userdata: dict[Names, tuple[Argument, ...]] = {}
        self.ids: dict[int, str] = {}
        self.is_ours = any(
            local(element.tag) == "invoke" and element.attributes.get("type") == INVOKED
            for element in inside(root)
        )
        self.prefix = root.tag.rpartition(":")[0]
        self.data: dict[str, tuple[Data, Span]] = {}

    # --- elements

    def children(self, element: Element, *tags: str) -> list[Element]:
        """The children with some tags, in the namespace of the document."""
        return [child for child in element.children if self.tag(child) in tags]

    def tag(self, element: Element) -> str:
        """The name of an element of SCXML; empty for one of another namespace."""
        prefix, _, name = element.tag.rpartition(":")
        return name if prefix == self.prefix else ""

    def id(self, element: Element) -> str:
        return self.ids[id_of(element)]

    def find_ids(self) -> None:
        """Gives each state its id. Raises UnreadableMachineError for two of one id."""
        taken: dict[str, Element] = {}
        nameless: list[Element] = []
        for element in inside(self.root):
            if self.tag(element) not in (*_STATES, "final", "history"):
                continue
            name = element.attributes.get("id", "").strip()
            if not name:
                nameless.append(element)
                continue
            if name in taken:
                message = f"a second state has the id `{name}`"
                raise UnreadableMachineError(message, self.span(element, "id"), "rename one")
            taken[name] = element
            self.ids[id_of(element)] = name
        for element in nameless:
            name = f"{self.tag(element)}_{element.line}"
            while name in taken:
                name += "_"
            taken[name] = element
            self.ids[id_of(element)] = name

    # --- the document

    def read(self) -> XmlMachine:
        self.find_ids()
        self.find_data()
        top = self.root
        inner = self.children(top, *_STATES)
        name = top.attributes.get("name") or (self.id(inner[0]) if len(inner) == 1 else "sm")
        finals = self.children(top, "final")
        wrapped = inner[0] if len(inner) == 1 else None
        if (
            wrapped is not None
            and self.tag(wrapped) == "state"
            and self.children(wrapped, *_STATES)
            and not self.children(wrapped, "final")
            and not any(self.steps(wrapped))
        ):  # the states are in one state, their ends beside it
            self.lose_others(top)
            root = self.machine(wrapped, (name,), {}, finals)
        else:
            root = self.machine(top, (name,), {}, finals)
        return XmlMachine(root=root, states=self.states, userdata=self.userdata, lost=self.lost)

    def find_data(self) -> None:
        """The values of the data model that are plain."""
        for element in inside(self.root):
            if self.tag(element) != "data":
                continue
            name = element.attributes.get("id", "").strip()
            if self.is_ours and name in OWN_DATA:
                continue
            code = element.attributes.get("expr") or self.content(element)
            span = self.span(element, "expr")
            try:
                if element.children or "src" in element.attributes:
                    raise NoLiteralError
                self.data[name] = literal(code) if code else None, span
            except NoLiteralError:
                self.lose(span, f"the value of `{name}` is no plain value",
                          f"write it into `userdata` as `{name or 'key'}`")  # fmt: skip

    def presets(self, element: Element, names: Names) -> tuple[Preset, ...]:
        """The userdata of a container: that of the root has all data; in documents of smachac, each
        container has its own."""
        if self.is_ours:
            mine, _ = self.data.get(self.id(element) if element is not self.root else names[-1],
                                    (None, None))  # fmt: skip
            span = self.span(element)
            pairs = mine.entries if isinstance(mine, Struct) else ()
            values = {key: (data, span) for key, data in pairs}
        else:
            values = self.data if len(names) == 1 else {}
        found = [Argument(name=key, data=data, span=span) for key, (data, span) in values.items()
                 if key]  # fmt: skip
        if found:
            self.userdata[names] = tuple(found)
        return tuple(
            Preset(key=argument.name, value=Value(data=argument.data, span=argument.span),
                   span=argument.span)
            for argument in found
        )  # fmt: skip

    # --- transitions

    def steps(self, element: Element) -> Iterator[_Step]:
        """The transitions of a state, one for each event; those of documents of smachac for faults
        and requests are left out."""
        for child in self.children(element, "transition"):
            events = child.attributes.get("event", "").split()
            target = child.attributes.get("target", "").strip()
            condition = child.attributes.get("cond", "").strip()
            if self.is_ours and all(self.is_own(event, target) for event in events):
                continue
            for event in events or [""]:
                event = event.removesuffix(".*").rstrip(".")
                yield _Step(event=event, condition=condition, target=target, element=child)

    def is_own(self, event: str, target: str) -> bool:
        """Whether a transition belongs to the run of a document of smachac."""
        first = event.partition(".")[0]
        return first in ("error", "fault", "preempt") or (first in EVENTS and not target)

    def edges(self, element: Element, scope: _Scope, named: Sequence[tuple[str, _Step]]) -> Edges:
        """The edges of a state, of transitions with the outcomes that they stand for."""
        found: dict[str, tuple[str, Span, Span]] = {}
        for outcome, step in named:
            place = self.span(step.element, "event" if step.event else "")
            if len(step.target.split()) > 1:
                self.lose(place, f"the transition to `{step.target}`: it has several targets",
                          "write one target")  # fmt: skip
                continue
            target = scope.target(step.target)
            if not step.target:
                self.lose(place, f"the transition on `{step.event}`: it has no target",
                          "write its meaning into the code of the state")  # fmt: skip
            elif target is None:
                self.lose(place, f"the transition to `{step.target}` of another container",
                          "end the container with an outcome that leads there")  # fmt: skip
            elif outcome in found:
                self.lose(place, f"a second transition on `{outcome}`", "remove one of the two")
            else:
                found[outcome] = target, place, self.span(step.element, "target")
                self.lose_content(step.element)
        return found

    def lose_content(self, element: Element) -> None:
        """Names the executable content of a transition or another element."""
        if self.is_ours:
            return  # it serves the run of the document
        for child in element.children:
            if self.tag(child):
                self.lose(self.span(child), f"`<{child.tag}>`: executable content",
                          "write it into the code of a state")  # fmt: skip

    def lose_others(self, element: Element) -> None:
        """Names what stands in a state and is not taken over."""
        for child in element.children:
            name = self.tag(child)
            if name in _STRUCTURE or not name:
                continue
            if name == "history":
                self.lose(self.span(child), "a history state: SMACH has none",
                          "write a state that selects where to continue")  # fmt: skip
            elif name in ("onentry", "onexit"):
                self.lose_content(child)
            elif not self.is_ours:
                self.lose(self.span(child), f"`<{child.tag}>`", "write it into the code of a state")

    def lose_condition(self, step: _Step) -> None:
        self.lose(self.span(step.element, "cond"),
                  f"the transition with the condition `{step.condition}`",
                  "write a state that selects the outcome")  # fmt: skip

    # --- states

    def machine(
        self, element: Element, names: Names, edges: Edges, finals: Sequence[Element]
    ) -> StateMachine:
        """A compound state. `finals` are its final states."""
        inner = self.children(element, *_STATES)
        self.lose_others(element)
        for invoke in self.children(element, "invoke"):
            self.lose(self.span(invoke), "`<invoke>` of a state with states in it",
                      "add a state beside them, in a concurrence")  # fmt: skip
        outcomes = self.outcomes(element, finals)
        for final in finals:
            self.lose_others(final)
        scope = _Scope(states=frozenset(map(self.id, inner)), finals=outcomes)
        children = tuple(self.state(child, (*names, self.id(child)), scope) for child in inner)
        initial, place = self.initial(element, scope)
        if not initial and children:
            initial = children[0].name
        return StateMachine(
            name=names[-1], type="StateMachine", children=children, initial=initial,
            initial_span=place, outcomes=self.declared(finals, outcomes),
            transitions=transitions(edges), userdata=self.presets(element, names),
            span=self.span(element),
        )  # fmt: skip

    def declared(
        self, finals: Sequence[Element], outcomes: Mapping[str, str]
    ) -> tuple[Outcome, ...]:
        places = {outcomes[self.id(final)]: self.span(final, "id") for final in finals
                  if self.id(final) in outcomes}  # fmt: skip
        return tuple(Outcome(name=name, span=span) for name, span in places.items())

    def outcomes(self, element: Element, finals: Sequence[Element]) -> dict[str, str]:
        """The outcomes of a container by the ids of its final states: the ids, without that of the
        container where it begins them. In documents of smachac, no outcome stands for the end after
        an exception: only transitions for exceptions lead there."""
        taken = {self.id(child) for child in self.children(element, *_STATES)}
        ids = [self.id(final) for final in finals]
        taken |= {*ids}
        own = self.ids.get(id_of(element), "")
        found: dict[str, str] = {}
        for name in ids:
            if self.is_ours and name not in self.ends:
                continue
            short = re.sub(rf"^{re.escape(own)}[-_.]", "", name) if own else name
            found[name] = name if short in taken else short
            taken.add(found[name])
        return found

    @cached_property
    def ends(self) -> frozenset[str]:
        """The targets of all transitions but those for exceptions."""
        return frozenset(
            step.target
            for element in inside(self.root)
            for step in self.steps(element)
            if not _after_exception(step)
        )

    def initial(self, element: Element, scope: _Scope) -> tuple[str, Span]:
        """The first state that a container names; empty if it names none."""
        place, word = self.span(element), ""
        if "initial" in element.attributes:
            word, place = element.attributes["initial"].strip(), self.span(element, "initial")
        for child in self.children(element, "initial"):
            for step in self.children(child, "transition"):
                word = step.attributes.get("target", "").strip()
                place = self.span(step, "target")
                self.lose_content(step)
        if word and word not in scope.states:
            if element is not self.root or len(self.children(element, *_STATES)) != 1:
                self.lose(place, f"the first state `{word}`: it is no state of this container",
                          "name a state of the container")  # fmt: skip
            return "", place
        return word, place

    def state(self, element: Element, names: Names, scope: _Scope) -> Node:
        """A state with its transitions in the container `scope`."""
        if self.tag(element) == "parallel":
            return self.parallel(element, names, scope)
        if self.children(element, *_STATES, "final"):
            finals = self.children(element, "final")
            edges = self.done_edges(element, finals, scope)
            return self.machine(element, names, edges, finals)
        return self.atomic(element, names, scope)

    def done_edges(self, element: Element, finals: Sequence[Element], scope: _Scope) -> Edges:
        """The edges of a compound state: its transitions on the event that it is done."""
        outcomes = self.outcomes(element, finals)
        named: list[tuple[str, _Step]] = []
        left = dict(outcomes)
        for step in self.steps(element):
            if step.event not in (f"done.state.{self.id(element)}", "done.state", "done"):
                self.lose_interrupt(element, step)
                continue
            ended = [final for final in finals if self.ends_with(final, step.condition)]
            if step.condition and not ended:
                self.lose_condition(step)
                continue
            for final in ended if step.condition else finals:
                outcome = left.pop(self.id(final), None)
                if outcome is not None:
                    named.append((outcome, step))
        return self.with_ends(self.edges(element, scope, named), element, outcomes.values(), scope)

    def with_ends(
        self, edges: Edges, element: Element, outcomes: Iterable[str], scope: _Scope
    ) -> Edges:
        """The edges of a container with those that a script implies: an outcome without a
        transition ends the container around it if that has an outcome of the name."""
        found = dict(edges)
        span = self.span(element, "id")
        for outcome in outcomes:
            if outcome not in found and outcome in scope.finals.values():
                text = f"`{self.id(element)}` has no transition after `{outcome}`: the script ends"
                self.lose(span, f"{text} the container around it", "write the transition")
                found[outcome] = outcome, span, span
        return found

    def lose_interrupt(self, element: Element, step: _Step) -> None:
        self.lose(self.span(step.element, "event" if step.event else ""),
                  f"the transition on `{step.event}`: it can leave every state in"
                  f" `{self.id(element)}`",
                  "add the event as an outcome of these states")  # fmt: skip

    def ends_with(self, final: Element, condition: str) -> bool:
        """Whether a condition on a done event is true after a final state, as far as it compares
        the data of this state with a text, or names the state."""
        if not condition:
            return True
        named = _IN.fullmatch(condition)
        if named is not None:
            return (named[1] or named[2]) == self.id(final)
        compared = _EQUAL.fullmatch(condition)
        if compared is None:
            return False
        try:
            return self.done_data(final).get(compared[1] or "") == literal(compared[2])
        except NoLiteralError:
            return False

    def done_data(self, final: Element) -> dict[str, Data]:
        """The plain values in the data of a final state; that without a name is its content."""
        found: dict[str, Data] = {}
        for data in self.children(final, "donedata"):
            for child in data.children:
                name = child.attributes.get("name", "") if self.tag(child) == "param" else ""
                try:
                    found[name] = literal(child.attributes.get("expr") or self.content(child))
                except NoLiteralError:
                    continue
        return found

    def atomic(self, element: Element, names: Names, scope: _Scope) -> Node:
        """A state without states in it: the work of what it invokes."""
        self.lose_others(element)
        invokes = self.children(element, "invoke")
        for invoke in invokes[1:]:
            self.lose(self.span(invoke), "a second `<invoke>` of a state",
                      "add a state beside it, in a concurrence")  # fmt: skip
        named: list[tuple[str, _Step]] = []
        for step in self.steps(element):
            outcome = self.outcome_name(element, invokes, step)
            if outcome is not None:
                named.append((outcome, step))
        edges = self.edges(element, scope, named)
        short, obstacle = "State", "it has no code"
        parameters: tuple[Argument, ...] = ()
        for invoke in invokes[:1]:
            given = invoke.attributes.get("src") or invoke.attributes.get("type", "")
            short = type_name(given, "Service")
            obstacle = f"`{given}` is run by the host" if given else "it is run by the host"
            parameters = self.parameters(invoke)
        if not invokes:
            short = type_name(f"{names[-1]}_work", "State")
        span = self.span(element)
        self.states[names] = Construction(
            span=span, short=short, obstacle=obstacle, parameters=parameters,
            file=self.source.name if invokes else "",
        )  # fmt: skip
        return leaf(names[-1], short, edges, span)

    def outcome_name(self, element: Element, invokes: Sequence[Element], step: _Step) -> str | None:
        """The outcome for a transition of an atomic state; None if an outcome cannot replace it."""
        first = step.event.partition(".")[0]
        if first == "error" or step.event == "*":
            self.lose(self.span(step.element, "event"), f"the transition on `{step.event}`",
                      "name the outcome for exceptions in the state: `catches`")  # fmt: skip
            return None
        ends = [f"done.invoke.{invoke.attributes.get('id', '')}" for invoke in invokes[:1]]
        is_done = not step.event or step.event in (*ends, "done.invoke", DONE)
        compared = _EQUAL.fullmatch(step.condition) if step.event and is_done else None
        if compared is not None:
            try:
                value = literal(compared[2])
            except NoLiteralError:
                value = None
            if isinstance(value, str) and value:
                return value
        if step.condition:
            self.lose_condition(step)
            return None
        if is_done:
            return DONE
        own = {self.id(element), *(invoke.attributes.get("id", "") for invoke in invokes)} - {""}
        for name in sorted(own, key=len, reverse=True):
            if step.event.startswith(f"{name}."):
                return _outcome(step.event[len(name) + 1 :])
            if step.event.endswith(f".{name}"):
                word = step.event[: -len(name) - 1]
                return "preempted" if self.is_ours and word == "stop" else _outcome(word)
        return _outcome(step.event)

    def parameters(self, invoke: Element) -> tuple[Argument, ...]:
        """The parameters of what a state invokes, as far as they are plain values."""
        found: list[Argument] = []
        for child in invoke.children:
            name, span = child.attributes.get("name", ""), self.span(child, "expr")
            if self.tag(child) == "param" and self.is_ours:
                if name == "variables":
                    found += self.variables(child)
            elif self.tag(child) == "param" and name:
                try:
                    data = literal(child.attributes.get("expr", ""))
                except NoLiteralError:
                    self.lose(span, f"the parameter `{name}` is no plain value",
                              "write the value as a variable of the state")  # fmt: skip
                    continue
                found.append(Argument(name=name, data=data, span=span))
            elif self.tag(child) and not self.is_ours:
                self.lose(self.span(child), f"`<{child.tag}>` of `<invoke>`",
                          "write it into the code of the state")  # fmt: skip
        return tuple(found)

    def variables(self, element: Element) -> Iterator[Argument]:
        """The variables of a state in a document of smachac."""
        span = self.span(element, "expr")
        try:
            data = literal(element.attributes.get("expr", ""))
        except NoLiteralError:
            self.lose(span, "the variables of the state are no plain values",
                      "write them as variables of the state")  # fmt: skip
            return
        for name, value in data.entries if isinstance(data, Struct) else ():
            yield Argument(name=name, data=value, span=span)

    # --- concurrences

    def parallel(self, element: Element, names: Names, scope: _Scope) -> Node:
        self.lose_others(element)
        for invoke in self.children(element, "invoke"):
            self.lose(self.span(invoke), "`<invoke>` of a parallel state",
                      "add a branch for it")  # fmt: skip
        ends: dict[str, tuple[str, str]] = {}
        children: list[Node] = []
        for region in self.children(element, *_STATES):
            children.append(self.region(region, names, ends))
        steps = [*self.steps(element)]
        named: list[tuple[str, _Step]] = []
        rules: list[OutcomeRule] = []
        default, default_span = "", self.span(element)
        for step in steps:
            if self.is_ours and step.event.startswith("done.state.") and not step.target:
                continue  # the end of a branch, which the document notes
            if step.event not in (f"done.state.{self.id(element)}", "done.state", "done"):
                self.lose_interrupt(element, step)
                continue
            if self.is_ours and _after_exception(step):
                continue  # after an exception
            when = self.conditions(step, ends)
            if when is None:
                self.lose_condition(step)
                continue
            if default or any(_hides(rule, when) for rule in rules):
                self.lose(self.span(step.element, "cond" if step.condition else ""),
                          "a transition after a more general one: in SMACH, the rule with most"
                          " conditions applies", "add conditions to one of the two")  # fmt: skip
                continue
            number = len(named)
            outcome = DONE if not when else f"{DONE}_{number + 1}"
            named.append((outcome, step))
            if when:
                rules.append(OutcomeRule(outcome=outcome, when=tuple(when),
                                         span=self.span(step.element, "cond")))  # fmt: skip
            else:
                default, default_span = outcome, self.span(step.element)
        edges = self.edges(element, scope, named)
        outcomes = dict.fromkeys([outcome for outcome, _ in named])
        if not default:
            default = DONE
            outcomes[default] = None
            self.lose(self.span(element), "after other outcomes of the branches, the parallel state"
                      " waits for ever", f"add a transition on `{default}`")  # fmt: skip
        edges = self.with_ends(edges, element, outcomes, scope)
        return Concurrence(
            name=names[-1], type="Concurrence", children=tuple(children), default_outcome=default,
            default_span=default_span, rules=tuple(rules), transitions=transitions(edges),
            outcomes=tuple(Outcome(name=name, span=self.span(element)) for name in outcomes),
            userdata=self.presets(element, names), span=self.span(element),
        )  # fmt: skip

    def region(self, region: Element, names: Names, ends: dict[str, tuple[str, str]]) -> Node:
        """A branch. `ends` gets, by the id of each final state, the branch and its outcome."""
        inner = self.children(region, *_STATES)
        finals = self.children(region, "final")
        if self.is_ours and len(inner) == 1 and self.id(region) == f"{self.id(inner[0])}{BRANCH}":
            # a region that smachac makes around a branch: its final states are the outcomes
            child, name = inner[0], self.id(inner[0])
            found = {self.id(final): self.id(final).removeprefix(f"{name}-") for final in finals
                     if self.id(final) in self.ends}  # fmt: skip
            ends.update({id: (name, outcome) for id, outcome in found.items()})
            node = self.state(child, (*names, name), _Scope(states=frozenset(), finals=found))
            places = {edge.target: edge for edge in node.transitions}
            outcomes = node.outcomes
            if self.tag(child) == "state" and not self.children(child, *_STATES, "final"):
                outcomes = tuple(Outcome(name=target, span=edge.span)
                                 for target, edge in places.items())  # fmt: skip
            elif self.tag(child) == "parallel":
                node, outcomes = self.with_targets(node)
            return replace(node, outcomes=outcomes, transitions=())
        name = self.id(region)
        if self.tag(region) == "parallel" or not (inner or finals):
            self.lose(self.span(region), f"the end of the branch `{name}`: it has no final state",
                      "add an outcome that ends the branch")  # fmt: skip
        node = self.state(region, (*names, name), _Scope(states=frozenset()))
        for id, outcome in self.outcomes(region, finals).items():
            ends[id] = name, outcome
        return node

    def with_targets(self, node: Node) -> tuple[Node, tuple[Outcome, ...]]:
        """A concurrence that is a branch, with the names of its region for its outcomes. A script
        has one rule for an outcome."""
        assert isinstance(node, Concurrence)
        names = {edge.outcome: edge.target for edge in node.transitions}
        rules: dict[str, OutcomeRule] = {}
        for rule in node.rules:
            name = names.get(rule.outcome, rule.outcome)
            if name in rules:
                self.lose(rule.span, f"a second rule for the outcome `{name}` of `{node.name}`",
                          "add an outcome for it")  # fmt: skip
            else:
                rules[name] = replace(rule, outcome=name)
        outcomes = {names.get(outcome.name, outcome.name): outcome for outcome in node.outcomes}
        default = names.get(node.default_outcome, node.default_outcome)
        made = replace(node, rules=tuple(rules.values()), default_outcome=default)
        return made, tuple(Outcome(name=name, span=one.span) for name, one in outcomes.items())

    def conditions(
        self, step: _Step, ends: Mapping[str, tuple[str, str]]
    ) -> list[Condition] | None:
        """The conditions of a rule; None if they are others than ends of branches."""
        found: list[Condition] = []
        span = self.span(step.element, "cond")
        for part in filter(None, map(str.strip, step.condition.split("&&"))):
            named = _IN.fullmatch(part)
            end = ends.get(named[1] or named[2]) if named is not None else None
            if end is None:
                return None
            found.append(Condition(child=end[0], outcome=end[1], span=span))
        return found


def _after_exception(step: _Step) -> bool:
    """Whether a document of smachac ends a concurrence there because a branch has failed."""
    return "||" in step.condition


def _hides(rule: OutcomeRule, when: Sequence[Condition]) -> bool:
    """Whether a later rule would be preferred to an earlier one, or as good as it, where both
    match: SMACH counts conditions, SCXML takes the first."""
    known = {part.child: part.outcome for part in rule.when}
    both = all(known.get(part.child, part.outcome) == part.outcome for part in when)
    return both and bool(when) and len(when) >= len(rule.when)


def _outcome(event: str) -> str:
    """An outcome for an event: its words with `_`."""
    return re.sub(r"[^\w-]+", "_", event).strip("_") or DONE
