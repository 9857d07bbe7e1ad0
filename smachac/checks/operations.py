"""Rules over what the code of a script does with the values it gets."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.checks.clashes import written
from smachac.checks.code import Code, faults_of
from smachac.checks.hints import calls, did_you_mean, guesser, other_place
from smachac.diagnostics import Finding, Related, Severity, rule
from smachac.ir.expression_faults import Fault, FaultKind
from smachac.ir.nodes import Leaf, Machine

MOST_SOURCES = 3
"""So many of the places a value comes from one finding shows."""


@rule("SM311", "impossible-operation", Severity.ERROR)
def impossible_operation(machine: Machine) -> Iterator[Finding]:
    """Code of the script does with a value what its type cannot do.

    It fails in every run that comes to it, with the robot in the middle of its task: a number is
    added to text, a word is asked for an item, a function gets too many arguments. A warning where
    only some runs evaluate that part of the code. Of `any`, and of a `T?`, nothing is said.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        userdata: {limb: left}
        states:
          - NEXT:
              template: CallbacksState
              input_keys: [limb]
              output_keys: [limb]
              callbacks: {limb: 'lambda ud: ud.limb + 1'}
              transitions: {succeeded: done}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        userdata: {limb: left}
        states:
          - NEXT:
              template: CallbacksState
              input_keys: [limb]
              output_keys: [limb]
              callbacks: {limb: 'lambda ud: ud.limb + "_2"'}
              transitions: {succeeded: done}
    """
    for code, fault in _faults(machine, "operation"):
        does = "fails" if fault.always else "can fail"
        severity = None if fault.always else Severity.WARNING
        yield _finding(code, fault, f"{_owner(code)} {does}: {fault.what}", severity)


@rule("SM312", "constant-comparison", Severity.WARNING)
def constant_comparison(machine: Machine) -> Iterator[Finding]:
    """Code of the script compares values of which it is known that they are never equal.

    Python does not complain of it: the condition is never true, or always, and the machine goes on
    the wrong way.

    Wrong:
        name: sm
        template: Base
        outcomes: [shut, other]
        userdata: {gripper: {type: 'one_of[open, closed]', value: open}}
        states:
          - IS_SHUT:
              template: ConditionalOutcomeState
              input_keys: [gripper]
              outcomes: [shut]
              callbacks: {shut: 'lambda ud: ud.gripper == "shut"'}
              default_outcome: other
              transitions: {shut: shut, other: other}

    Right:
        name: sm
        template: Base
        outcomes: [shut, other]
        userdata: {gripper: {type: 'one_of[open, closed]', value: open}}
        states:
          - IS_SHUT:
              template: ConditionalOutcomeState
              input_keys: [gripper]
              outcomes: [shut]
              callbacks: {shut: 'lambda ud: ud.gripper == "closed"'}
              default_outcome: other
              transitions: {shut: shut, other: other}
    """
    for code, fault in _faults(machine, "comparison"):
        yield _finding(code, fault, f"in {_owner(code)}, {fault.what}")


def mixed_units(machine: Machine) -> Iterator[Finding]:
    """The operations over numbers of different units; SM504 says them."""
    for code, fault in _faults(machine, "unit"):
        yield _finding(code, fault, f"in {_owner(code)}, {fault.what}")


def _faults(machine: Machine, kind: FaultKind) -> Iterator[tuple[Code, Fault]]:
    return ((code, fault) for code, fault in faults_of(machine) if fault.kind == kind)


def _owner(code: Code) -> str:
    return f"the {'code' if isinstance(code.node, Leaf) else 'data'} of `{code.node.name}`"


def _finding(code: Code, fault: Fault, message: str, severity: Severity | None = None) -> Finding:
    guess = did_you_mean(guesser(fault.choices)(fault.word)) if fault.choices else None
    choices = f"it is one of {', '.join(f'`{each}`' for each in fault.choices)}"
    span = code.expression.span
    return Finding(
        span=span,
        message=message,
        help=guess or (choices if fault.choices else fault.help),
        related=(*_sources(code, fault), *calls(code.node, span)),
        node=code.path,
        severity=severity,
    )


def _sources(code: Code, fault: Fault) -> Iterator[Related]:
    """Where the types of the keys come from."""
    shown = {code.expression.span}
    for key in fault.keys:
        place = code.places.get(key)
        for alike in place.flows.values() if place is not None else ():
            origin = alike[0].origin
            if not alike[0].judged and origin.span not in shown and len(shown) <= MOST_SOURCES:
                shown.add(origin.span)
                yield from other_place(origin.span, written(origin))
