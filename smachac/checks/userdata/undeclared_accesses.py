"""Keys that the class of a state type reads or sets without declaring them (SM308, SM310)."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from typing import Literal

from smachac.analysis.context import Context
from smachac.checks.findings import notation
from smachac.checks.findings.help_text import did_you_mean
from smachac.checks.findings.renamed_names import renamed_in_interface
from smachac.checks.findings.types_with_code import (
    declared_here,
    first_of_each,
    leaves_by_type,
    names_by_type,
    own_names,
    used_here,
)
from smachac.diagnostics.diagnostic import Finding
from smachac.diagnostics.source import Word
from smachac.diagnostics.spelling import guesser
from smachac.ir import nodes
from smachac.ir.class_facts import ClassFacts, renamed_name
from smachac.ir.nodes import Leaf
from smachac.ir.traversal import enclosing, outer_outputs, remapping


def _added(
    leaf: Leaf, facts: ClassFacts, field: Literal["input_keys", "output_keys"], key: str
) -> str:
    """The help that adds a key to a list."""
    added = f"add `{key}` to the `{field}` of {notation.declared(leaf)}"
    return added if notation.is_python(leaf) else added + _in_the_class(facts, field, key)


def _in_the_class(facts: ClassFacts, field: Literal["input_keys", "output_keys"], key: str) -> str:
    """The part of a help that adds a key to the list in the constructor, where it has its own."""
    declared = facts.inputs if field == "input_keys" else facts.outputs
    if declared is None or field in dict(facts.passed) or key in {word.text for word in declared}:
        return ""
    return " and of `__init__`"


DICTIONARY_METHODS = frozenset(["copy", "get", "items", "pop", "setdefault", "values"])
"""Methods of a dictionary that userdata does not have (smach.user_data)."""


def _is_called(word: Word) -> bool:
    """Whether an attribute in a text is called."""
    return word.span.source.text.startswith("(", word.span.end)


def _owner(word: Word) -> str:
    """The name before the dot of an attribute in a text."""
    text = word.span.source.text
    start = word.span.start - 1
    while start > 0 and (text[start - 1].isalnum() or text[start - 1] == "_"):
        start -= 1
    return text[start : word.span.start - 1]


def unknown_reads(context: Context) -> Iterator[Finding]:
    """The keys that the code of a type reads without an input in its interface (SM310)."""
    containers = enclosing(context.machine.root)
    names = names_by_type(context)
    for path, leaf, facts in leaves_by_type(context, declared=True):
        _, inputs, outputs = names.get(leaf.type, own_names(leaf))
        above, around = containers[path]
        levels = [around]
        while levels[-1].sugar and above in containers:
            above, container = containers[above]
            levels.append(container)
        known = (*inputs, around.item_key) if isinstance(around, nodes.Iterator) else inputs
        used = {word.text for word in facts.reads}
        old = renamed_in_interface(leaf, "input_keys", facts, facts.inputs, inputs)
        for word in first_of_each(facts.reads, known):
            effect: str | None = None
            declared = notation.own_key(leaf, "input")
            message = f"{notation.code_of(leaf)} reads `{word.text}`, which is not {declared}"
            near = guesser(key for key in inputs if key not in used)(word.text)
            help = did_you_mean(near) or _added(leaf, facts, "input_keys", word.text)
            renamed = [remap.key for remap in leaf.remaps if remap.to == word.text]
            if renamed and renamed[0] in inputs:
                help = f"write `{_owner(word)}.{renamed[0]}`: `{word.text}` is the name of this key"
                help += f" around `{leaf.name}`"
            lone = _lone_input(facts, inputs, known) if word.text not in outputs else None
            if lone is not None and guesser(inputs)(word.text) is None and not renamed:
                message += f", and it never reads its input key `{lone}`"
                help = f"write `{_owner(word)}.{lone}`" if _owner(word) else f"write `{lone}`"
            if word.text in outputs:
                declared = notation.own_key(leaf, "output")
                message = f"{notation.code_of(leaf)} reads `{word.text}`, which is only {declared}"
                if _sets_first(facts, word) or not any(
                    _comes_from_outside(leaf, level, word.text) for level in levels
                ):
                    help = _local_variable(word)
            if word.text in DICTIONARY_METHODS and _is_called(word):
                name = _owner(word)
                message = (
                    f"{notation.code_of(leaf)} calls `{name}.{word.text}`, but the userdata of a"
                    " state has no methods of a dictionary"
                )
                help = f"read a key as `{name}.KEY`; test it with `'KEY' in {name}`"
                effect = f"the userdata has no method `{word.text}`: AttributeError"
            places = declared_here(leaf, leaf.inputs)
            if old is not None and word.text == old.old and word.text not in outputs:
                help, places = old.help, (*old.places, *places)
            yield Finding(
                span=word.span,
                message=message,
                arguments=(word.text,),
                help=help,
                effect=effect,
                related=(*places, *used_here(leaf)),
                node=path,
            )


def _sets_first(facts: ClassFacts, word: Word) -> bool:
    """Whether code sets a key that it reads without reading it there, as `+=` does."""
    places = {read.span for read in facts.reads}
    return any(write.text == word.text and write.span not in places for write in facts.writes)


def _comes_from_outside(leaf: Leaf, around: nodes.Container, key: str) -> bool:
    """Whether a key of a leaf can have a value before the leaf sets it."""
    outer = remapping(leaf)[key]
    known = {preset.key for preset in around.userdata} | {input_.name for input_ in around.inputs}
    return outer in known or any(
        outer in outer_outputs(child) for child in around.children if child is not leaf
    )


def _local_variable(word: Word) -> str:
    """The help for a read of a key that the code itself sets: the way to do without it."""
    after = word.span.source.text[word.span.end :][:60].lstrip(" ]")
    what = "compute the value" if after.startswith(("+=", "-=", "*=", "/=")) else "keep the value"
    key = f"{_owner(word)}.{word.text}" if _owner(word) else word.span.text
    whole = _WHOLE.match(after)
    if whole is not None:
        return f"write `{key} = {whole[1]}`"
    if after.startswith(COLLECTS):
        what = "collect the items"
    return f"{what} in a local variable, and set `{key}` once, before the return"


_WHOLE = re.compile(r"\.(?:extend|update)\((\w+)\)\s*\n")
"""A call that adds all items of a variable."""


COLLECTS = (".append(", ".extend(", ".insert(", ".add(", ".update(")
"""The calls by which code collects items in a list, a set or a dictionary."""


def dropped_writes(context: Context) -> Iterator[Finding]:
    """The keys that the code of a type sets without an output in its interface (SM308). Unknown
    keys that the code also reads are left to SM310."""
    names = names_by_type(context)
    for path, leaf, facts in leaves_by_type(context, declared=True):
        inputs, outputs = names.get(leaf.type, own_names(leaf))[1:]
        unknown = {word.text for word in facts.reads}.difference(inputs)
        written = {word.text for word in facts.writes}
        old = renamed_in_interface(leaf, "output_keys", facts, facts.outputs, outputs)
        for word in first_of_each(facts.writes, [*outputs, *unknown]):
            only = word.text in inputs
            what = "only an input key" if only else f"not {notation.own_key(leaf, 'output')}"
            unset = [key for key in outputs if key not in written and key not in inputs]
            near = guesser(unset if only else outputs)(word.text)
            guess = did_you_mean(near)
            lone = lone_output(facts, inputs, outputs)
            if near is None and lone is not None and lone[0] == word.text:
                near = lone[1]
                guess = f"write `{_owner(word)}.{near}`" if _owner(word) else f"write `{near}`"
            never = f", and `{near}` is never set" if near in unset and facts.closed else ""
            places = declared_here(leaf, leaf.outputs)
            if old is not None and word.text == old.old and not only:
                guess, places = old.help, (*old.places, *places)
            yield Finding(
                span=word.span,
                message=f"{notation.code_of(leaf)} sets `{word.text}`, which is {what}{never}",
                arguments=(word.text,),
                help=guess or _added(leaf, facts, "output_keys", word.text),
                related=(*places, *used_here(leaf)),
                node=path,
            )


def lone_output(
    facts: ClassFacts, inputs: Collection[str], outputs: Collection[str]
) -> tuple[str, str] | None:
    """The only key that a class sets without an output in its interface, and the only output key
    that it never sets: both are one slip. None if that is not certain."""
    listed_ = {word.text for word in facts.outputs or ()}
    local = {key for key, _ in facts.unused}
    written = {word.text for word in facts.writes}
    wrong = written - {*inputs, *outputs, *(word.text for word in facts.reads)}
    unset = [key for key in outputs if key not in written and key not in inputs]
    if not facts.closed or len(wrong) != 1 or len(unset) != 1 or local & {*unset}:
        return None
    renamed = renamed_name(facts.outputs, outputs)
    if listed_ & wrong and (renamed is None or renamed[0].text not in wrong):
        return None
    return min(wrong), unset[0]


def _lone_input(facts: ClassFacts, inputs: Collection[str], known: Collection[str]) -> str | None:
    """The only input key that the code of a class does not read, where it reads exactly one key
    that is none of the `known` ones."""
    read = {word.text for word in facts.reads}
    wrong = read - {*known} - DICTIONARY_METHODS
    unread = [key for key in inputs if key not in read]
    listed_ = {word.text for word in facts.inputs or ()}
    written = {word.text for word in facts.writes}
    return (
        unread[0]
        if facts.closed and len(wrong) == len(unread) == 1 and not wrong & (listed_ | written)
        else None
    )
