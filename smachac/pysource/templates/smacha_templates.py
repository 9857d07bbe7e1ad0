"""Faults of templates of SMACHA's kind: guards of classes, and the call of the constructor.

SMACHA's templates print a class once, under a name that they add to `defined_headers`
(`{% if 'class_Move' not in defined_headers %}`). Where two templates use one name for two classes,
the program contains only the first class. A template that extends `State.tpl.py` and has no block
`body` makes the state with the call in that template.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from smachac.diagnostics.diagnostic import Related
from smachac.diagnostics.source import Source, Span, Word
from smachac.ir.class_facts import ClassFault, FaultKind, StateCall
from smachac.ir.nodes import Leaf, Machine, StateType
from smachac.ir.traversal import walk
from smachac.pysource.modules.user_code import StateFault, UserCode

NOT_PASSED = FaultKind(
    name="not passed",
    message="`State.tpl.py` does not pass `{word}`, which `__init__` of `{name}` requires",
    help="remove the line `{{% extends ... %}}`: the program then passes the variables"
    " of the state; or write a block `body`",
    effect="the program makes the state without this argument: the call raises a TypeError",
    stops=True,
)
NOT_ACCEPTED = FaultKind(
    name="not accepted",
    message="`State.tpl.py` passes `{word}`, which `__init__` of `{name}` does not accept",
    help="remove the line `{{% extends ... %}}`, or add the parameter `{word}=None` to `__init__`",
    effect="the call raises a TypeError when the program makes the state",
    stops=True,
)
OTHER_GUARD = FaultKind(
    name="other guard",
    message="the program does not contain the class `{name}`: its template uses the name"
    " `{word}` of another class",
    help="write `{near}` here, and where the template adds the name to `defined_headers`",
    effect="the program stops with a NameError when it makes the state",
    stops=True,
)

_GUARD = re.compile(
    r"\{%[-+]?\s*if\s+(['\"])(?P<guard>\w+)\1\s+not\s+in\s+defined_headers\s*[-+]?%\}"
    r"(?P<inside>[^{]*)"
)
_CLASS = re.compile(r"^\s*class\s+(\w+)", re.M)


class _Guard(NamedTuple):
    """The name under which a template prints a class once, and that class."""

    word: Word
    class_name: str
    leaf: Leaf
    type: StateType


def guard_faults(machine: Machine, library: UserCode) -> Iterator[StateFault]:
    """The classes that a program lacks because another template has printed its class under the
    same name. The fault is in the template whose class has another name than the guard."""
    first: dict[str, _Guard] = {}
    for guard in _guards(machine, library):
        name = guard.word.text
        other = first.setdefault(name, guard)
        if other.class_name == guard.class_name:
            continue
        wrong, right = (other, guard) if name.endswith(guard.class_name) else (guard, other)
        first[name] = right
        near = name.replace(right.class_name, wrong.class_name)
        fault = ClassFault(
            kind=OTHER_GUARD,
            name=wrong.word,
            near=near if near != name else f"class_{wrong.class_name}",
        )
        places = (
            Related(span=right.word.span, message=f"`{right.class_name}` has this name too"),
            Related(span=wrong.leaf.span, message=f"`{wrong.leaf.name}` is of this type"),
        )
        yield StateFault(fault, "python", wrong.type.name, wrong.class_name, places)


def _guards(machine: Machine, library: UserCode) -> Iterator[_Guard]:
    """The guards of classes in the user's templates, at the first state of each type."""
    left: dict[str, tuple[StateType, Source]] = {}
    for name, type_ in machine.state_types.items():
        file = type_.code.get("python", "")
        template = library.own_template(file) if file and ":" not in file else None
        if template is not None:
            left[name] = type_, template
    for _, leaf in walk(machine.root) if len(left) > 1 else ():
        found = left.pop(leaf.type, None) if isinstance(leaf, Leaf) else None
        if found is not None and isinstance(leaf, Leaf):
            yield from _in_template(found[1], leaf, found[0])


def _in_template(template: Source, leaf: Leaf, type_: StateType) -> Iterator[_Guard]:
    for found in _GUARD.finditer(template.text):
        inside = _CLASS.search(found["inside"])
        if inside is not None:
            word = Word(found["guard"], Span(template, *found.span("guard")))
            yield _Guard(word, inside[1], leaf, type_)


CALL_ARGUMENTS = ("outcomes", "input_keys", "output_keys", "callbacks")
"""The fields of a state that `State.tpl.py` passes to its class, if the script has them."""


def call_faults(machine: Machine) -> Iterator[StateFault]:
    """The constructors that the call in `State.tpl.py` does not fit, at the first state of a type
    for which it does not."""
    left = {
        name: type_
        for name, type_ in machine.state_types.items()
        if type_.class_facts is not None and type_.class_facts.state_call is not None
    }
    for _, leaf in walk(machine.root) if left else ():
        type_ = left.get(leaf.type) if isinstance(leaf, Leaf) else None
        facts = type_.class_facts if type_ is not None else None
        if facts is None or facts.state_call is None or not isinstance(leaf, Leaf):
            continue
        given = {variable.name for variable in leaf.written}.intersection(CALL_ARGUMENTS)
        fault = _call_fault(facts.state_call, given)
        if fault is not None:
            del left[leaf.type]
            used = Related(span=leaf.span, message=f"`{leaf.name}` is of the type `{leaf.type}`")
            name = facts.name.text if facts.name is not None else leaf.type
            yield StateFault(fault, "python", leaf.type, name, (used,))


def _call_fault(call: StateCall, given: set[str]) -> ClassFault | None:
    """What is wrong with a call that passes these arguments by their names."""
    known = {parameter.word.text for parameter in call.parameters}
    for parameter in call.parameters:
        if parameter.required and parameter.word.text not in given:
            return ClassFault(kind=NOT_PASSED, name=Word(parameter.word.text, call.place))
    for name in CALL_ARGUMENTS:
        if name in given and name not in known:
            return ClassFault(kind=NOT_ACCEPTED, name=Word(name, call.place))
    return None
