"""A rule: a function that finds one kind of fault in a machine, with its code."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TypeAlias

from smachac.analysis.context import Context
from smachac.diagnostics.diagnostic import Code, Finding, Severity
from smachac.records import dataclass

RuleFunction: TypeAlias = Callable[[Context], Iterator[Finding]]
"""Finds the faults of one kind in a machine."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Rule:
    """A code, and the function that finds its faults. `about_code`: they are in the code of state
    types."""

    code: Code
    function: RuleFunction
    about_code: bool = False


def rule(
    code: str,
    name: str,
    severity: Severity,
    *,
    unsuppressible: bool = False,
    effect: str = "",
    about_code: bool = False,
) -> Callable[[RuleFunction], Rule]:
    """Make a rule of a function. Its docstring is the explanation of the code."""

    def declare(function: RuleFunction) -> Rule:
        entry = Code(
            code=code,
            name=name,
            severity=severity,
            explanation=function.__doc__ or "",
            unsuppressible=unsuppressible,
            effect=effect,
        )
        return Rule(code=entry, function=function, about_code=about_code)

    return declare
