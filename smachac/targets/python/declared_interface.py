"""The declared interface of a SMACH class, from the facts about it (pysource/class_reader.py)."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.diagnostics.source import NOWHERE, Word
from smachac.diagnostics.spelling import guesser
from smachac.frontend.loader import Library
from smachac.ir.class_facts import STATE_PARAMETERS, ClassFacts, ClassFault, FaultKind, Parameter
from smachac.ir.nodes import StateType
from smachac.pysource.class_reader import NO_OUTCOMES
from smachac.pysource.modules.user_code import Declared
from smachac.targets.python.ros import has_node_parameter

NO_PARAMETER = FaultKind(
    name="no parameter",
    message="`__init__` of `{name}` does not accept `{word}`, a variable of the interface `{type}`",
    help="add the parameter `{word}` to `__init__`",
    near_help="rename the parameter `{near}` to `{word}`, or correct the name in the interface",
    effect="the program passes each variable by its name: the call raises a TypeError",
    stops=True,
)
REQUIRED_PARAMETER = FaultKind(
    name="required parameter",
    message="`__init__` of `{name}` requires `{word}`, which is not a variable of the"
    " interface `{type}`",
    help="give `{word}` a default value, or add it to the `variables` of `{type}.yml`"
    " and set it at the state",
    effect="the program makes the state without this argument: the call raises a TypeError",
    stops=True,
)
OTHER_PARAMETER = FaultKind(
    name="other parameter",
    message="`__init__` of `{name}` requires `{word}`, but the variable of the interface"
    " `{type}` is `{near}`",
    help="rename the parameter `{word}` to `{near}`{more}, or the variable to `{word}`",
    effect="the program passes each variable by its name: the call raises a TypeError",
    stops=True,
)
RENAMED_PARAMETER = FaultKind(
    name="renamed parameter",
    message="`__init__` of `{name}` has the parameter `{word}`, but the variable of the"
    " interface `{type}` is `{near}`",
    help="rename the parameter `{word}` to `{near}`{more}, or the variable to `{word}`",
    effect="the program passes each variable by its name: the call raises a TypeError",
    stops=True,
)


def declared(type_: StateType, facts: ClassFacts, library: Library) -> Declared:
    """The interface that the class of a state type declares, from the facts about it."""
    code = type_.code.get("python", "")
    name = code if ":" in code or facts.name is None else facts.name.text
    node = library.ros == 2 and has_node_parameter(type_)
    faults = (*_certain(type_, facts), *_constructor_faults(type_, facts, node))
    if facts.name is None:
        return Declared(name=name, span=NOWHERE, faults=faults)
    return Declared(
        name=name,
        span=facts.name.span,
        outcomes=facts.outcomes,
        inputs=facts.inputs,
        outputs=facts.outputs,
        faults=faults,
    )


def _certain(type_: StateType, facts: ClassFacts) -> Iterator[ClassFault]:
    """The faults of a class. One without a constructor gets its outcomes only from a script."""
    for fault in facts.faults:
        given = "outcomes" in type_.given or type_.optional or not type_.outcomes
        if fault.kind is not NO_OUTCOMES or not given:
            yield fault


def _constructor_faults(type_: StateType, facts: ClassFacts, node: bool) -> Iterator[ClassFault]:
    """The variables of an interface that the constructor does not accept, and the parameters that
    it requires and never gets. A program passes the variables that a script sets, by their names,
    and the `node` of ROS 2 to a class with this parameter (states.py)."""
    if facts.name is None or facts.parameters is None:
        return
    known = {parameter.word.text for parameter in facts.parameters}
    guess = guesser(sorted(known - type_.variables.keys()))
    passed = {name for name, variable in type_.variables.items() if not variable.called_first}
    if "variables" in type_.given:
        return
    unknown = sorted(passed - known)
    given = passed | type_.given | {"node" if node else "", "outcomes" if type_.optional else ""}
    required = [p for p in facts.parameters if p.required and p.word.text not in given]
    if len(unknown) == len(required) == 1 and guess(unknown[0]) is None:
        yield _renamed(OTHER_PARAMETER, required[0], unknown[0])
        return
    extra = [p for p in facts.parameters if p.word.text not in {*given, *STATE_PARAMETERS, "node"}]
    if len(unknown) == len(extra) == 1 and guess(unknown[0]) is None:
        yield _renamed(RENAMED_PARAMETER, extra[0], unknown[0])
        return
    meant = set()
    for name in unknown:
        near = guess(name)
        meant.add(near)
        place = next((p.word.span for p in facts.parameters if p.word.text == near), None)
        word = Word(name, place or facts.name.span)
        yield ClassFault(kind=NO_PARAMETER, name=word, near=near, variable=name)
    for parameter in required:
        if parameter.word.text not in meant:
            yield ClassFault(kind=REQUIRED_PARAMETER, name=parameter.word)


def _renamed(kind: FaultKind, parameter: Parameter, variable: str) -> ClassFault:
    """The fault that a parameter has another name than a variable of the interface."""
    return ClassFault(kind=kind, name=parameter.word, near=variable, variable=variable,
                      more=_also(parameter))  # fmt: skip


def _also(parameter: Parameter) -> str:
    """The part of a help about a new name of a parameter: the lines that use it."""
    lines = dict.fromkeys(span.line for span in parameter.uses)
    source = parameter.word.span.source
    written = [f"`{source.line(line).strip()}` (line {line})" for line in lines]
    return f", also in {', '.join(written[:3])}" if written else ""
