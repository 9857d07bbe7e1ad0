"""The findings of the rules in a machine that a test has built."""

from __future__ import annotations

from dataclasses import replace

from smachac.checks import check_machine
from smachac.diagnostics.diagnostic import Diagnostic, Severity
from smachac.ir.nodes import Leaf, Machine, StateMachine


def report(root: StateMachine) -> list[Diagnostic]:
    return check_machine(Machine(root=root))


def found(root: StateMachine, code: str = "SM") -> list[str]:
    """Codes and states of what is found above an info, of one code or of all."""
    loud = [item for item in report(root) if item.severity is not Severity.INFO]
    lines = [f"{item.code} {item.finding.node}" for item in loud]
    return [line for line in lines if line.startswith(code)]


def one(root: StateMachine, code: str) -> Diagnostic:
    """The only finding of a code."""
    (item,) = [item for item in report(root) if item.code == code]
    return item


def looping(root: StateMachine) -> StateMachine:
    return replace(root, forever=True)


def blocking(node: Leaf) -> Leaf:
    return replace(node, blocking=True)
