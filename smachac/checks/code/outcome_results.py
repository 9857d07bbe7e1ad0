"""Functions in a script that return the outcome of their state: results that are no outcome of
it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from smachac.analysis.code_slots import CodeSlot
from smachac.analysis.context import Context
from smachac.analysis.message_code import MessageCode, content_of, message_code, slot_results
from smachac.checks.findings.code_findings import slot_owner
from smachac.checks.findings.help_text import calls, did_you_mean, ends_of, other_place
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import listed
from smachac.ir.function_facts import FunctionFacts, Result
from smachac.ir.message_types import TEXTS, Definitions, FieldType
from smachac.ir.nodes import Leaf
from smachac.ir.traversal import outcome_names

OUTCOME_EFFECT = "no other outcome is accepted: the state ends with `aborted`, or the machine stops"


class _Fault(NamedTuple):
    """What a function returns, and the help."""

    result: Result
    what: str
    help: str


def wrong_outcomes(context: Context) -> Iterator[Finding]:
    """The results of functions that their states accept as no outcome (SM318)."""
    functions, found = context.machine.functions, context.machine.definitions
    for path, node, slot in context.code_slots:
        if not isinstance(node, Leaf) or slot.returns != "outcome" or slot.quoted:
            continue
        names, every = outcome_names(node), slot_results(slot, functions)
        if not names or not every:
            continue
        code = message_code(slot, node, found, functions)
        judged = [_fault(node, names, result, code, found) for result in every]
        faults = [fault for fault in judged if fault is not None]
        help = _truth_help(names, every)
        if help is not None:
            faults = [fault._replace(help=help) if isinstance(fault.result.value, bool) else fault
                      for fault in faults]  # fmt: skip
        certain = len(faults) == len(every)
        for fault in _first_of_each(faults):
            yield _finding(path, node, slot, functions.get(slot.code.text), fault, certain)


def _finding(
    path: str, leaf: Leaf, slot: CodeSlot, facts: FunctionFacts | None, fault: _Fault, certain: bool
) -> Finding:
    what, related = f"the function of {slot_owner(slot, leaf)}", calls(leaf, slot.code.span)
    if facts is not None:
        what = f"`{facts.word.text}`, {what},"
        related = (*other_place(slot.code.span, "its result is used here"), *related)
    return Finding(
        span=fault.result.span,
        message=f"{what} returns {fault.what}",
        arguments=(slot.name, fault.result.text),
        help=fault.help,
        effect=OUTCOME_EFFECT,
        related=related,
        node=path,
        severity=None if certain else Severity.WARNING,
    )


def _first_of_each(faults: Sequence[_Fault]) -> list[_Fault]:
    """The first fault of each value; the two truth values are one."""
    first: dict[object, _Fault] = {}
    for fault in faults:
        truth = fault.result.kind == "truth" or isinstance(fault.result.value, bool)
        first.setdefault("truth" if truth else (fault.result.text,), fault)
    return list(first.values())


def _truth_help(names: Sequence[str], results: Sequence[Result]) -> str | None:
    """The outcomes to return in place of the constant truth values of a function."""
    given = {result.value for result in results if isinstance(result.value, bool)}
    if len(names) < 2 or not given:
        return None
    outcomes = [(True, names[0]), (False, names[1])]
    parts = [f"`'{name}'` in place of `{truth}`" for truth, name in outcomes if truth in given]
    return f"return {', '.join(parts)}"


def _fault(
    leaf: Leaf,
    names: Sequence[str],
    result: Result,
    code: MessageCode | None,
    found: Definitions,
) -> _Fault | None:
    """The fault of a result that must be an outcome; None counts as one."""
    help = f"return one of its outcomes: {listed(names)}"
    no_outcome = f"which is not an outcome of `{leaf.name}`"
    if result.kind == "constant":
        if result.value is None or result.value in names:
            return None
        guess = guesser(names)(result.value) if isinstance(result.value, str) else None
        help = did_you_mean(guess) or ends_of(leaf) or help
        return _Fault(result, f"`{result.value!r}`, {no_outcome}", help)
    type_ = "bool" if result.kind == "truth" else _part_type(result, code, found)
    if not type_:
        return None
    if type_ == "bool" and len(names) > 1:
        help = f"write `'{names[0]}' if {result.text} else '{names[1]}'`"
    return _Fault(result, f"`{result.text}`, a `{type_}`, {no_outcome}", help)


def _part_type(result: Result, code: MessageCode | None, found: Definitions) -> str:
    """The type of a result that is a message, or a field of one and no text; else empty."""
    if result.part is None or code is None:
        return ""
    content = content_of(result.part, code, found)
    texts = [type_ for type_ in content if isinstance(type_, FieldType) and _is_text(type_)]
    if not content or texts:
        return ""
    first = content[0]
    return str(first) if isinstance(first, FieldType) else first.name


def _is_text(field: FieldType) -> bool:
    return field.name in TEXTS and not field.array
