"""The XML of YASMIN (its factory and editor): state machines, concurrences, states in Python and C++.

A state ends with the outcomes that its transitions name: the file declares no others. It reads and
writes any key of the one blackboard. The code of a state stays where it is; it is for YASMIN, so the
script has a class for it whose `execute` is to be written.
"""

from __future__ import annotations

import json
import re

from smachac.diagnostics.source import Source
from smachac.ir.nodes import (
    Concurrence,
    Condition,
    Data,
    Node,
    Outcome,
    OutcomeRule,
    Preset,
    Remap,
    StateMachine,
    Value,
)
from smachac.pysource.machines.constructions import Argument, Construction, Names
from smachac.refactor.imports.xml_source import (
    Edges,
    XmlFault,
    XmlMachine,
    XmlText,
    as_data,
    leaf,
    transitions,
    type_name,
)
from smachac.robots.xml_tree import Element, FormatHelp

ROOT = "StateMachine"
FORMAT = FormatHelp(
    "name a file of YASMIN: its first tag is `<StateMachine outcomes=...>`",
    "the first tag of a file of YASMIN is `<StateMachine outcomes=...>`",
    "split the file",
)

_STATES = ("State", "StateMachine", "Concurrence", "OrthogonalState", "JoinState")
_KNOWN = ("Transition", "Remap", "Param", "ParamRemap", "Key", "Default", "FinalOutcome",
          "OutcomeMap", "Region", *_STATES)  # fmt: skip


def read_machine(source: Source, element: Element) -> XmlMachine:
    """The machine of a file. Raises XmlFault."""
    return _Reader(source).read(element)


class _Reader(XmlText):
    def __init__(self, source: Source) -> None:
        super().__init__(source)
        self.states: dict[Names, Construction] = {}
        self.userdata: dict[Names, tuple[Argument, ...]] = {}

    def read(self, element: Element) -> XmlMachine:
        name = element.attributes.get("name") or "sm"
        root = self.machine(element, (name,), {})
        assert isinstance(root, StateMachine)
        return XmlMachine(root=root, states=self.states, userdata=self.userdata, lost=self.lost)

    def required(self, element: Element, attribute: str) -> str:
        value = element.attributes.get(attribute, "").strip()
        if not value:
            message = f"`<{element.tag}>` has no `{attribute}`"
            raise XmlFault(message, self.span(element), f'write `{attribute}="..."`')
        return value

    # --- containers

    def machine(self, element: Element, names: Names, edges: Edges) -> Node:
        """A state machine, or a region of an orthogonal state."""
        if element.attributes.get("file_name") or element.attributes.get("type") == "xml":
            return self.other_file(element, names, edges)
        outcomes = self.outcomes(element)
        children = self.children(element, names, outcomes)
        first = children[0].name if children else ""
        initial = element.attributes.get("start_state", first)
        at = "start_state" if "start_state" in element.attributes else ""
        return StateMachine(
            name=names[-1], type=ROOT, outcomes=outcomes, children=children, initial=initial,
            initial_span=self.span(element, at), transitions=transitions(edges),
            remaps=self.remaps(element), userdata=self.presets(element, names),
            doc="", span=self.span(element),
        )  # fmt: skip

    def other_file(self, element: Element, names: Names, edges: Edges) -> Node:
        """A machine in another file, which is a state here."""
        file = element.attributes.get("file_name") or element.attributes.get("file_path", "")
        return self.made(element, names, edges, type_name(file.removesuffix(".xml"), "Machine"),
                         f"the machine of {file or 'another file'}")  # fmt: skip

    def outcomes(self, element: Element) -> tuple[Outcome, ...]:
        span = self.span(element, "outcomes")
        words = self.required(element, "outcomes").split()
        return tuple(Outcome(name=name, span=span) for name in dict.fromkeys(words))

    def children(
        self, element: Element, names: Names, outcomes: tuple[Outcome, ...]
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
                raise XmlFault(f"the state `{name}` has the name of an outcome",
                               self.span(child, "name"), "YASMIN refuses it: rename one of them")  # fmt: skip
            if name in found:
                raise XmlFault(f"a second state has the name `{name}`", self.span(child, "name"),
                               "rename one of them")  # fmt: skip
            found[name] = self.state(child, (*names, name))
        return tuple(found.values())

    def state(self, element: Element, names: Names, *, connected: bool = True) -> Node:
        edges = self.edges(element) if connected else {}
        match element.tag:
            case "StateMachine" | "Region":
                return self.machine(element, names, edges)
            case "Concurrence" | "OrthogonalState":
                return self.concurrence(element, names, edges)
            case "JoinState":
                return self.made(element, names, edges, "JoinState",
                                 "a state that waits for another region")  # fmt: skip
        cls = self.required(element, "class")
        where = element.attributes.get("module", "")
        what = f"{where}.{cls}" if where else cls
        self.lose_others(element)
        return self.made(element, names, edges, type_name(cls, "State"), f"`{what}` is for YASMIN")

    def made(
        self, element: Element, names: Names, edges: Edges, short: str, obstacle: str
    ) -> Node:
        """A state whose code is not taken over."""
        span = self.span(element)
        self.states[names] = Construction(
            span=span, short=short, obstacle=obstacle, parameters=self.parameters(element),
            file=self.source.name,
        )  # fmt: skip
        return leaf(names[-1], short, edges, span, remaps=self.remaps(element), is_open=True)

    def edges(self, element: Element) -> Edges:
        """The transitions of a state. A second one of an outcome replaces the first."""
        found: dict[str, tuple[str, object, object]] = {}
        for child in element.all("Transition"):
            outcome, target = self.required(child, "from"), self.required(child, "to")
            if outcome in found:
                self.lose(self.span(child, "from"), f"a second transition on `{outcome}`",
                          "remove one of the two: YASMIN uses the last one")  # fmt: skip
            found[outcome] = target, self.span(child, "from"), self.span(child, "to")
        return found  # type: ignore[return-value]

    def remaps(self, element: Element) -> tuple[Remap, ...]:
        return tuple(
            Remap(key=self.required(child, "old"), to=self.required(child, "new"),
                  span=self.span(child, "old"), to_span=self.span(child, "new"))
            for child in element.all("Remap")
        )  # fmt: skip

    # --- concurrences

    def concurrence(self, element: Element, names: Names, edges: Edges) -> Node:
        outcomes = self.outcomes(element)
        regions = [child for child in element.children if child.tag in (*_STATES, "Region")]
        self.lose_others(element)
        children = tuple(
            self.state(child, (*names, self.required(child, "name")), connected=False)
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
        if (*names, child.name) not in self.states:
            return child
        named = {
            item.attributes.get("outcome", ""): (self.span(item, "outcome"))
            for mapping in element.all("OutcomeMap")
            for item in mapping.all("Item")
            if item.attributes.get("state") == child.name
        }
        from dataclasses import replace

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
            self.userdata[names] = tuple(found.values())
        return tuple(
            Preset(key=key, value=Value(data=argument.data, span=argument.span), span=argument.span)
            for key, argument in found.items()
        )

    def parameters(self, element: Element) -> tuple[Argument, ...]:
        """The parameters of a state that have a value. Those that the container passes are named."""
        found: dict[str, Argument] = {}
        for child in element.all("Param"):
            name = self.required(child, "name")
            if "default_value" in child.attributes:
                type_ = child.attributes.get("default_type", "str")
                argument = self.value(child, "default_value", type_, name)
                if argument is not None:
                    found[name] = argument
        for child in element.all("ParamRemap"):
            old, new = child.attributes.get("old", ""), child.attributes.get("new", "")
            self.lose(self.span(child), f"the parameter `{old}` gets the value of `{new}`",
                      "write the value as a variable of the state")  # fmt: skip
        return tuple(found.values())

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
        if element.tag != "State":
            for child in (*element.all("Param"), *element.all("ParamRemap")):
                name = child.attributes.get("name") or child.attributes.get("old", "")
                self.lose(self.span(child), f"the parameter `{name}` of a container",
                          "write its value as a variable of the states that use it")  # fmt: skip


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
