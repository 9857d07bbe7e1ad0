"""Functions of the user in the code slots of a machine, and the keys that they read."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from smachac.analysis.code_slots import CodeSlot
from smachac.analysis.context import Context
from smachac.ir.function_facts import FunctionFacts
from smachac.ir.nodes import Node
from smachac.ir.traversal import remapping


def named_functions(context: Context) -> Iterator[tuple[str, Node, CodeSlot, FunctionFacts]]:
    """The code slots of a machine that name a function of the user, with the facts about it."""
    known = context.machine.functions
    for path, node, slot in context.code_slots if known else ():
        facts = known.get(slot.code.text)
        if facts is not None and slot.arguments is not None and not slot.quoted:
            yield path, node, slot, facts


def function_reads(context: Context) -> Mapping[str, set[str]]:
    """The keys that functions of the user read in the states of each container, by its path: also
    those that are not input keys of the state (SM310)."""
    found: dict[str, set[str]] = {}
    for path, node, slot, facts in named_functions(context):
        if slot.arguments is not None and slot.arguments[:1] == ("userdata",):
            names = remapping(node)
            keys = found.setdefault(path.rpartition("/")[0], set())
            keys.update(names[word.text] for word in facts.reads)
    return found
