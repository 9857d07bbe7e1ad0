"""Keys that functions of the user read, and that no state has as an input (SM310)."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.analysis.code_slots import CodeSlot, swapped
from smachac.analysis.context import Context
from smachac.analysis.function_slots import named_functions
from smachac.checks.edits import listing
from smachac.checks.help_text import did_you_mean, other_place
from smachac.diagnostics.diagnostic import Finding
from smachac.diagnostics.spelling import guesser
from smachac.ir.function_facts import FunctionFacts
from smachac.ir.nodes import Node


def unknown_function_reads(context: Context) -> Iterator[Finding]:
    """The keys that a function of the user reads, and that no state which calls it has as an input
    (SM310)."""
    calls_of: dict[str, list[tuple[str, Node, CodeSlot, FunctionFacts]]] = {}
    for call in named_functions(context):
        _, node, slot, facts = call
        if slot.arguments is None or slot.arguments[:1] != ("userdata",):
            continue
        if facts.reads and not swapped(facts.parameters, slot.arguments):  # SM317
            calls_of.setdefault(slot.code.text, []).append(call)
    for places in calls_of.values():
        known = {key.name for _, node, _, _ in places for key in (*node.inputs, *node.outputs)}
        path, node, slot, facts = places[0]
        around = path.rpartition("/")[0]
        used = {word.text for word in facts.reads}
        unread = [key.name for key in node.inputs if key.name not in used]
        guess = guesser(unread)
        inside = context.types.cells.keys()
        for word in {read.text: read for read in reversed(facts.reads)}.values():
            if word.text not in known:
                yield Finding(
                    span=word.span,
                    message=f"`{facts.word.text}` reads `{word.text}`, which is not an input key of"
                    f" `{node.name}`",
                    arguments=(word.text,),
                    help=did_you_mean(guess(word.text))
                    or did_you_mean(
                        unread[0]
                        if len(unread) == 1 and (around, word.text) not in inside
                        else None
                    )
                    or listing([node], "input_keys", word.text),
                    related=other_place(slot.code.span, f"`{node.name}` calls it here"),
                    node=path,
                )
