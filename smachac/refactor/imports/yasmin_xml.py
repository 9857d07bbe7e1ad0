"""The XML of YASMIN (its factory and editor): state machines, concurrences, states in other code.

A state ends with the outcomes that its transitions name: the file declares no others. It reads and
writes any key of the one blackboard. A class of Python stays where it is, and the script names it;
for a state in C++ the script has a class whose `execute` is to be written.
"""

from __future__ import annotations

import json
import re
from collections.abc import Container, Iterable, Mapping
from typing import TypeAlias

from smachac.diagnostics.source import Source, Span
from smachac.frontend.text.unquoted import is_name
from smachac.ir.nodes import (
    Concurrence,
    Condition,
    Data,
    Leaf,
    Node,
    Outcome,
    OutcomeRule,
    Preset,
    Remap,
    StateMachine,
    Transition,
    Value,
)
from smachac.pysource.machines.constructions import (
    Argument,
    ClassPlace,
    Construction,
    Names,
)
from smachac.records import replace
from smachac.refactor.imports.xml_source import (
    Edges,
    Loader,
    UnreadableMachineError,
    XmlMachine,
    XmlText,
    as_data,
    leaf,
    transitions,
    type_name,
)
from smachac.robots.xml_tree import Element, FormatHelp
from smachac.targets.python.formatter import flat, literal

ROOT = "StateMachine"
FORMAT = FormatHelp(
    "name a file of YASMIN: its first tag is `<StateMachine outcomes=...>`",
    "the first tag of a file of YASMIN is `<StateMachine outcomes=...>`",
    "split the file",
)

MOST_FILES, MOST_STATES = 20, 10_000
"""The most files that include one another, and the most states of a machine that includes more."""

_CONCURRENCES = ("Concurrence", "OrthogonalState")
_STATES = ("State", "StateMachine", "Concurrence", "OrthogonalState", "JoinState")
_KNOWN = ("Transition", "Remap", "Param", "ParamRemap", "Key", "Default", "FinalOutcome",
          "OutcomeMap", "Region", *_STATES)  # fmt: skip


Parameters: TypeAlias = "Mapping[str, Argument]"
"""The values of the parameters of a container, by name."""


def read_machine(source: Source, element: Element, load: Loader) -> XmlMachine:
    """The machine of a file. Raises UnreadableMachineError."""
    name = element.attributes.get("name") or "sm"
    root = StateMachine(name=name, type=ROOT, span=Span(source, 0, 0))
    made = XmlMachine(root=root, one_rule=True)
    reader = _Reader(source, load, made, (source.name,))
    node = reader.machine(element, (name,), {}, {})
    assert isinstance(node, StateMachine)
    made.root = node
    return made


class _Reader(XmlText):
    """Reads one file into `made`; `files` are it and those that include it."""

    def __init__(
        self, source: Source, load: Loader, made: XmlMachine, files: tuple[str, ...]
    ) -> None:
        super().__init__(source, made.lost)
        self.load = load
        self.result = made
        self.files = files

    def required(self, element: Element, attribute: str) -> str:
        value = element.attributes.get(attribute, "").strip()
        if not value:
            message = f"`<{element.tag}>` has no `{attribute}`"
            raise UnreadableMachineError(message, self.span(element), f'write `{attribute}="..."`')
        return value

    # --- containers

    def machine(self, element: Element, names: Names, edges: Edges, given: Parameters) -> Node:
        """A state machine, or a region of an orthogonal state. `given` are the parameters of the
        container around it."""
        file = element.attributes.get("file_name") or element.attributes.get("file_path")
        if file or element.attributes.get("type") == "xml":
            return self.other_file(element, file or "", names, edges, given)
        outcomes = self.outcomes(element)
        own = self.parameters(element, given)
        children = self.children(element, names, outcomes, own)
        first = children[0].name if children else ""
        initial = element.attributes.get("start_state", first)
        at = "start_state" if "start_state" in element.attributes else ""
        return StateMachine(
            name=names[-1], type=ROOT, outcomes=outcomes, children=children, initial=initial,
            initial_span=self.span(element, at), transitions=transitions(edges),
            remaps=self.remaps(element), userdata=self.presets(element, names),
            doc="", span=self.span(element),
        )  # fmt: skip

    def other_file(
        self, element: Element, file: str, names: Names, edges: Edges, given: Parameters
    ) -> Node:
        """The machine of another file, beside this one; a state if there is no such file."""
        found = self.load(self.source.name, file) if file else None
        if found is None or found[1].tag != ROOT:
            short = type_name(file.removesuffix(".xml"), "Machine")
            return self.made(element, names, edges, given, short, f"{file or 'a file'} not found")
        source, root = found
        if source.name in self.files:
            message = f"`{file}` includes itself"
            raise UnreadableMachineError(message, self.span(element), "include another file")
        if len(self.files) > MOST_FILES or len(self.result.states) > MOST_STATES:
            message = "the files include each other too often"
            raise UnreadableMachineError(message, self.span(element), "include fewer files")
        reader = _Reader(source, self.load, self.result, (*self.files, source.name))
        node = reader.machine(root, names, edges, self.parameters(element, given))
        return replace(node, remaps=(*self.remaps(element), *node.remaps), span=self.span(element))

    def outcomes(self, element: Element) -> tuple[Outcome, ...]:
        """The outcomes of a container; of a concurrence without a list, those of its rules."""
        span = self.span(element, "outcomes")
        if (
            element.tag in ("Concurrence", "OrthogonalState")
            and "outcomes" not in element.attributes
        ):
            named = [self.required(rule, "outcome") for rule in element.all("OutcomeMap")]
            named += [element.attributes.get("default_outcome", "")]
            return tuple(Outcome(name=name, span=span) for name in dict.fromkeys(named) if name)
        words = self.required(element, "outcomes").split()
        return tuple(Outcome(name=name, span=span) for name in dict.fromkeys(words))

    def children(
        self, element: Element, names: Names, outcomes: tuple[Outcome, ...], given: Parameters
    ) -> tuple[Node, ...]:
        """The states of a state machine."""
        self.lose_others(element)
        ends = {outcome.name for outcome in outcomes}
        found: dict[str, Node] = {}
        for child in element.children:
            if child.tag not in _STATES:
                continue
            name = self.required(child, "name")
            if name in ends:
                message = f"the state `{name}` has the name of an outcome"
                help = "rename one of them: YASMIN refuses it"
                raise UnreadableMachineError(message, self.span(child, "name"), help)
            if name in found:
                message = f"a second state has the name `{name}`"
                raise UnreadableMachineError(message, self.span(child, "name"), "rename one")
            found[name] = self.state(child, (*names, name), given)
        return tuple(_with_jumps(node, ends, found.keys()) for node in found.values())

    def state(
        self, element: Element, names: Names, given: Parameters, *, connected: bool = True
    ) -> Node:
        edges = self.edges(element) if connected else {}
        match element.tag:
            case "StateMachine" | "Region":
                return self.machine(element, names, edges, given)
            case tag if tag in _CONCURRENCES:
                return self.concurrence(element, names, edges, given)
            case "JoinState":
                return self.made(element, names, edges, given, "JoinState",
                                 "a state that waits for another region")  # fmt: skip
        cls = self.required(element, "class")
        where = element.attributes.get("module", "")
        what = f"{where}.{cls}" if where else cls
        self.lose_others(element)
        short = type_name(cls, "State")
        is_python = bool(where) and element.attributes.get("type") != "cpp"
        if is_python and all(map(is_name, (*where.split("."), cls))):
            place = ClassPlace(module=where, name=cls)
            return self.made(element, names, edges, given, short, place=place)
        return self.made(element, names, edges, given, short, f"`{what}` is no class of Python")

    def made(
        self, element: Element, names: Names, edges: Edges, given: Parameters, short: str,
        obstacle: str = "", place: ClassPlace | None = None,
    ) -> Node:  # fmt: skip
        """A state of a class of Python, or one whose code is not taken over."""
        span = self.span(element)
        parameters = self.parameters(element, given)
        calls = (f"set_parameter({name!r}, {flat(literal(argument.data))})"
                 for name, argument in parameters.items())  # fmt: skip
        self.result.states[names] = Construction(
            span=span, cls=place, short=short, obstacle=obstacle, code="yasmin",
            calls=tuple(calls) if place is not None else (),
            parameters=tuple(parameters.values()), file=self.source.name,
        )  # fmt: skip
        return leaf(names[-1], short, edges, span, remaps=self.remaps(element), is_open=True)

    def edges(self, element: Element) -> Edges:
        """The transitions of a state. A second one of an outcome replaces the first."""
        found: dict[str, tuple[str, Span, Span]] = {}
        for child in element.all("Transition"):
            outcome, target = self.required(child, "from"), self.required(child, "to")
            if outcome in found:
                self.lose(self.span(child, "from"), f"a second transition on `{outcome}`",
                          "remove one of the two: YASMIN uses the last one")  # fmt: skip
            found[outcome] = target, self.span(child, "from"), self.span(child, "to")
        return found

    def remaps(self, element: Element) -> tuple[Remap, ...]:
        return tuple(
            Remap(key=self.required(child, "old"), to=self.required(child, "new"),
                  span=self.span(child, "old"), to_span=self.span(child, "new"))
            for child in element.all("Remap")
        )  # fmt: skip

    # --- concurrences

    def concurrence(self, element: Element, names: Names, edges: Edges, given: Parameters) -> Node:
        outcomes = self.outcomes(element)
        own = self.parameters(element, given)
        regions = [child for child in element.children if child.tag in (*_STATES, "Region")]
        self.lose_others(element)
        children = tuple(
            self.state(child, (*names, self.required(child, "name")), own, connected=False)
            for child in regions
        )
        children = tuple(self.with_outcomes(element, child, names) for child in children)
        rules = []
        for mapping in element.all("OutcomeMap"):
            when = [
                Condition(child=self.required(item, "state"),
                          outcome=self.required(item, "outcome"), span=self.span(item))
                for item in mapping.all("Item")
            ]  # fmt: skip
            rules.append(OutcomeRule(outcome=self.required(mapping, "outcome"), when=tuple(when),
                                     span=self.span(mapping)))  # fmt: skip
        at = "default_outcome" if "default_outcome" in element.attributes else ""
        return Concurrence(
            name=names[-1], type="Concurrence", outcomes=outcomes, children=children,
            default_outcome=element.attributes.get("default_outcome", ""), rules=tuple(rules),
            default_span=self.span(element, at), transitions=transitions(edges),
            remaps=self.remaps(element), userdata=self.presets(element, names),
            span=self.span(element),
        )  # fmt: skip

    def with_outcomes(self, element: Element, child: Node, names: Names) -> Node:
        """A branch with the outcomes that the rules name: it has no transitions to name them."""
        if (*names, child.name) not in self.result.states:
            return child
        named = {
            item.attributes.get("outcome", ""): (self.span(item, "outcome"))
            for mapping in element.all("OutcomeMap")
            for item in mapping.all("Item")
            if item.attributes.get("state") == child.name
        }
        outcomes = tuple(Outcome(name=name, span=span) for name, span in named.items() if name)
        return replace(child, outcomes=outcomes)

    # --- values

    def presets(self, element: Element, names: Names) -> tuple[Preset, ...]:
        """The default values of keys."""
        found: dict[str, Argument] = {}
        for child in (*element.all("Key"), *element.all("Default")):
            is_default = child.tag == "Default"
            attribute = "value" if is_default else "default_value"
            if attribute not in child.attributes:
                continue
            key = self.required(child, "key" if is_default else "name")
            type_ = child.attributes.get("type" if is_default else "default_type", "str")
            argument = self.value(child, attribute, type_, key)
            if argument is not None:
                found[key] = argument
        if found:
            self.result.userdata[names] = tuple(found.values())
        return tuple(
            Preset(key=key, value=Value(data=argument.data, span=argument.span), span=argument.span)
            for key, argument in found.items()
        )

    def parameters(self, element: Element, given: Parameters) -> dict[str, Argument]:
        """The parameters of a state that have a value: their own ones, and those that the container
        passes."""
        found: dict[str, Argument] = {}
        for child in element.all("Param"):
            name = self.required(child, "name")
            if "default_value" in child.attributes:
                type_ = child.attributes.get("default_type", "str")
                argument = self.value(child, "default_value", type_, name)
                if argument is not None:
                    found[name] = argument
        for child in element.all("ParamRemap"):
            old, new = self.required(child, "old"), self.required(child, "new")
            if new in given:
                found[old] = replace(given[new], name=old)
            else:
                self.lose(self.span(child), f"the parameter `{old}`: `{new}` has no value",
                          "write the value as a variable of the state")  # fmt: skip
        return found

    def value(self, element: Element, attribute: str, type: str, name: str) -> Argument | None:
        """A value with a type of YASMIN, as its factory reads it; None if it is none."""
        text, span = element.attributes[attribute], self.span(element, attribute)
        data = typed(text, type)
        if data is None:
            self.lose(span, f"the value of `{name}`: `{text}` is no {type}",
                      f"write a value of type {type}")  # fmt: skip
            return None
        return Argument(name=name, data=data, text=text, span=span)

    def lose_others(self, element: Element) -> None:
        """Names what stands in an element and is not taken over."""
        for child in element.children:
            if child.tag not in _KNOWN:
                self.lose(self.span(child), f"`<{child.tag}>`", "write its meaning into the script")


def _with_jumps(node: Node, ends: Container[str], siblings: Iterable[str]) -> Node:
    """A container with the transitions that YASMIN adds: an outcome without one ends the container
    around it if that has the outcome, or leads to the state of its name."""
    if isinstance(node, Leaf):
        return node
    known = {edge.outcome for edge in node.transitions}
    names = {*siblings}
    added = tuple(
        Transition(outcome=outcome.name, target=outcome.name, span=outcome.span,
                   target_span=outcome.span)
        for outcome in node.outcomes
        if outcome.name not in known and (outcome.name in ends or outcome.name in names)
    )  # fmt: skip
    return replace(node, transitions=(*node.transitions, *added))


def typed(text: str, type: str) -> Data:
    """A value of YASMIN's XML; None for one that its type does not have."""
    kind = re.sub(r"\s", "", type)
    try:
        if kind == "str":
            return text
        if kind == "bool":
            return {"true": True, "false": False, "1": True, "0": False}[text.strip().lower()]
        if kind == "int":
            return int(text)
        if kind == "float":
            return float(text)
        if kind.startswith(("list[", "dict[")):
            found = json.loads(text)
            return as_data(found) if isinstance(found, list | dict) else None
    except (ValueError, KeyError, RecursionError):
        pass
    return None
