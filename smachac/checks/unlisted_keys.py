"""Keys that the class of a template without an interface uses although its constructor, whose lists
are constants, does not pass them to `smach.State`."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.analysis.context import Context
from smachac.checks.candidate_keys import meant_input
from smachac.checks.class_code import DICTIONARY_METHODS, first_of_each, leaves_by_type, used_here
from smachac.checks.messages import did_you_mean
from smachac.diagnostics.diagnostic import Finding
from smachac.diagnostics.spelling import guesser
from smachac.ir.nodes import Leaf
from smachac.ir.traversal import enclosing


def unlisted_reads(context: Context) -> Iterator[Finding]:
    """The keys that such a class reads (SM310)."""
    containers = enclosing(context.machine.root)
    for path, leaf, facts in leaves_by_type(context, declared=True):
        guess, used = guesser(key.name for key in leaf.inputs), {each.text for each in facts.reads}
        _, around = containers[path]
        for word in first_of_each(facts.unlisted_reads, DICTIONARY_METHODS):
            near = meant_input(word.text, guess, used, around)
            yield Finding(
                span=word.span,
                message=f"the code of `{leaf.type}` reads `{word.text}`, which its `__init__` does"
                " not pass to `smach.State` as an input key",
                arguments=(word.text,),
                help=_help(leaf, word.text, "input_keys", near),
                related=used_here(leaf),
                node=path,
            )


def unlisted_writes(context: Context) -> Iterator[Finding]:
    """The keys that such a class sets (SM308). Those that it also reads are left to SM310."""
    for path, leaf, facts in leaves_by_type(context, declared=True):
        read = {word.text for word in facts.unlisted_reads}
        guess = guesser(key.name for key in leaf.outputs)
        for word in first_of_each(facts.unlisted_writes, read):
            yield Finding(
                span=word.span,
                message=f"the code of `{leaf.type}` sets `{word.text}`, which its `__init__` does"
                " not pass to `smach.State` as an output key: the value is discarded",
                arguments=(word.text,),
                help=_help(leaf, word.text, "output_keys", guess(word.text)),
                related=used_here(leaf),
                node=path,
            )


def _help(leaf: Leaf, key: str, field: str, near: str | None) -> str:
    """The help for a key that a constructor does not list: the key of the script or of the meta
    block that is meant, or the list."""
    declared = {each.name for each in (leaf.inputs if field == "input_keys" else leaf.outputs)}
    meant = did_you_mean(near) if key not in declared else None
    return meant or f"add `{key}` to the `{field}` of `smach.State.__init__`"
