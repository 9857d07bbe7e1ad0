"""Outputs of a concurrence that nothing in it sets, while two branches set another one: the key of
one of the two was probably meant."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from smachac.analysis.accesses import Accesses
from smachac.diagnostics.spelling import words_of
from smachac.ir.nodes import Concurrence, Node


class RacedOutput(NamedTuple):
    """A key that two branches write, the branch that was probably meant to write another one, and
    that output."""

    key: str
    child: Node
    meant: str


def raced_output(
    path: str, container: Concurrence, accesses: Mapping[str, Accesses]
) -> RacedOutput | None:
    """The pair of an output that two branches write and an output that none writes, if there is
    one of each. The branch that has a word of the name of the second one was meant to write it;
    otherwise the last one."""
    writers: dict[str, list[Node]] = {}
    for child in container.children:
        own = accesses.get(f"{path}/{child.name}")
        for key in own.writes if own is not None else ():
            writers.setdefault(key, []).append(child)
    inputs = {input_.name for input_ in container.inputs}
    unset = [output.name for output in container.outputs if output.name not in {*writers, *inputs}]
    raced = [(key, nodes) for key, nodes in writers.items() if len(nodes) == 2]
    if len(unset) != 1 or len(raced) != 1:
        return None
    ((key, nodes),) = raced
    (meant,) = unset
    words = words_of(meant) - words_of(key)
    named = [node for node in nodes if words & words_of(node.name)]
    return RacedOutput(key, named[0] if len(named) == 1 else nodes[-1], meant)
