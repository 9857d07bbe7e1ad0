"""What several rules ask about one machine is found out once."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TypeVar

from smachac.analysis.type_inference import infer
from smachac.ir import traversal
from smachac.ir.nodes import Container, Machine, Node

Answer = TypeVar("Answer")


def once(ask: Callable[[Machine], Answer]) -> Callable[[Machine], Answer]:
    """A question about a machine whose last answer is kept: every rule asks of the same one.

    Nobody may change the answer.
    """
    latest: list[tuple[Machine, Answer]] = []

    @wraps(ask)
    def asked(machine: Machine) -> Answer:
        if not latest or latest[0][0] is not machine:
            latest[:] = [(machine, ask(machine))]
        return latest[0][1]

    return asked


@once
def states(machine: Machine) -> tuple[tuple[str, Node], ...]:
    """All nodes of a machine with their paths, parents before children."""
    return tuple(traversal.walk(machine.root))


@once
def containers(machine: Machine) -> tuple[tuple[str, Container], ...]:
    """The containers among them."""
    return tuple(traversal.containers(machine.root))


types_of = once(infer)
