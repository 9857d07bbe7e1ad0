"""The rules on keys that the code of a state uses and the state does not declare."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Literal

from smachac.analysis.accesses import callback_names, leaves_with_code, scripted_steps
from smachac.analysis.code_slots import CodeSlot, swapped, undeclared_slot_reads
from smachac.analysis.context import Context
from smachac.analysis.error_recovery import undeclared_reads, undeclared_writes
from smachac.analysis.function_slots import named_functions
from smachac.checks.findings.candidate_keys import keys_around
from smachac.checks.findings.edits import listing, with_input, with_key_list, with_output
from smachac.checks.findings.help_text import calls, did_you_mean, other_place
from smachac.checks.findings.types_with_code import first_of_each, leaves_by_type, used_here
from smachac.checks.findings.value_places import place_of_part
from smachac.checks.rule import rule
from smachac.checks.userdata.undeclared_accesses import (
    DICTIONARY_METHODS,
    dropped_writes,
    unknown_reads,
)
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.spelling import guesser, respelt
from smachac.diagnostics.wording import both, listed
from smachac.ir import nodes
from smachac.ir.code_places import key_place
from smachac.ir.function_facts import FunctionFacts
from smachac.ir.leaf import functions, key_names, variable_of
from smachac.ir.nodes import Container, Leaf, Node, StateType, Struct


@rule("SM308", "lossy-write", Severity.ERROR, effect="SMACH discards what the state sets")
def lossy_write(context: Context) -> Iterator[Finding]:
    """A state sets a key that is not one of its output keys.

    SMACH discards the value and only writes a log entry: for example, a counter keeps its value,
    and the loop that it limits never ends.

    Wrong:
        name: sm
        template: Base
        outcomes: [counted]
        userdata: {n: 0}
        states:
          - COUNT:
              template: CallbacksState
              input_keys: [n]
              callbacks: {n: 'lambda ud: ud.n + 1'}
              transitions: {succeeded: counted}

    Right:
        name: sm
        template: Base
        outcomes: [counted]
        userdata: {n: 0}
        states:
          - COUNT:
              template: CallbacksState
              input_keys: [n]
              output_keys: [n]
              callbacks: {n: 'lambda ud: ud.n + 1'}
              transitions: {succeeded: counted}
    """
    yield from context.at_containers(_lossy_writes)
    yield from dropped_writes(context)
    yield from _unlisted(context, "output")


def _lossy_writes(path: str, container: Container) -> Iterator[Finding]:
    for inner, leaf in leaves_with_code(path, container):
        dropped = undeclared_writes(leaf)
        if len(dropped) > 1 and not leaf.outputs:
            yield _without_list(inner, leaf, "output", dropped, _place_of_write(leaf, dropped[0]))
            continue
        for key in dropped:
            only = any(input_.name == key for input_ in leaf.inputs)
            what = "only an input key" if only else "not one of its output keys"
            span = _place_of_write(leaf, key)
            unset = _never_set(leaf) if not only else []
            added = listing([leaf], "output_keys", key)
            if unset:
                added += f"; nothing in `{leaf.name}` sets {listed(unset)}"
            yield Finding(
                span=span,
                message=f"`{leaf.name}` sets `{key}`, which is {what}",
                arguments=(key,),
                help=did_you_mean(guesser(unset)(key)) or added,
                related=calls(leaf, span),
                node=inner,
                # With an edit, a state that reads the key that is not set would fail in the run.
                edits=with_output(leaf, key) if not unset else (),
            )


def _without_list(
    path: str, leaf: Leaf, role: Literal["input", "output"], keys: Sequence[str], span: Span
) -> Finding:
    """The finding on a state without `output_keys` or `input_keys` whose code uses several keys."""
    part, verb = f"{role}_keys", "sets" if role == "output" else "reads"
    who = f"`{leaf.name}`" if role == "output" else f"the code of `{leaf.name}`"
    return Finding(
        span=span,
        message=f"{who} {verb} {both(keys)}, but `{leaf.name}` has no `{part}`",
        arguments=tuple(keys),
        help=f"add `{part}: [{', '.join(keys)}]` to `{leaf.name}`",
        related=calls(leaf, span),
        node=path,
        edits=with_key_list(leaf, part, keys),
    )


def _never_set(leaf: Leaf) -> list[str]:
    """The output keys that nothing in a leaf sets, as far as its code and interface show."""
    set_ = callback_names(leaf).union(*(keys for _, keys in scripted_steps(leaf)))
    set_ = set_.union(*(keys for _, keys in leaf.writes))
    if leaf.class_facts is not None:
        set_ = set_.union(word.text for word in leaf.class_facts.writes)
    return [key.name for key in leaf.outputs if key.name not in set_]


def _place_of_write(leaf: Leaf, key: str) -> Span:
    held = variable_of(leaf, "callbacks")
    code = (functions(leaf, "callbacks") or {}).get(key)
    if held is not None and code is not None:
        place = place_of_part(held.value.span, (key,), key=True)
        return place if place != held.value.span else code.span
    steps = variable_of(leaf, "steps")
    if steps is None:
        return leaf.span
    every = steps.value.data if isinstance(steps.value.data, tuple) else ()
    for at, step in enumerate(every):
        set_ = dict(step.entries).get("set") if isinstance(step, Struct) else None
        if isinstance(set_, Struct) and key in dict(set_.entries):
            return place_of_part(steps.value.span, (at, "set", key), key=True)
    return steps.value.span


@rule(
    "SM310",
    "undeclared-access",
    Severity.ERROR,
    effect="SMACH lets a state read only its input keys: the read stops the machine with an error",
)
def undeclared_access(context: Context) -> Iterator[Finding]:
    """The code of a state reads a userdata key that is not one of its input keys.

    A state can read only its input keys: the read fails, and the machine stops in the middle of
    the task.

    Wrong:
        name: sm
        template: Base
        outcomes: [low, high]
        userdata: {level: 7}
        output_keys: [level]
        states:
          - JUDGE:
              template: ConditionalOutcomeState
              outcomes: [low]
              callbacks: {low: 'lambda ud: ud.level < 10'}
              default_outcome: high
              transitions: {low: low, high: high}

    Right:
        name: sm
        template: Base
        outcomes: [low, high]
        userdata: {level: 7}
        output_keys: [level]
        states:
          - JUDGE:
              template: ConditionalOutcomeState
              input_keys: [level]
              outcomes: [low]
              callbacks: {low: 'lambda ud: ud.level < 10'}
              default_outcome: high
              transitions: {low: low, high: high}
    """
    yield from context.at_containers(_undeclared_accesses, context.machine.state_types)
    yield from unknown_reads(context)
    yield from _unlisted(context, "input")
    yield from unknown_function_reads(context)
    yield from _unknown_key_names(context)


def _unknown_key_names(context: Context) -> Iterator[Finding]:
    """The names in lists of input keys (`role: key_names`) that are no input keys."""
    for path, leaf in context.states:
        if not isinstance(leaf, Leaf):
            continue
        inputs = [input_.name for input_ in leaf.inputs]
        for key in key_names(leaf.inputs, "key_names"):
            cell = context.types.cells.get((path, key))
            flows = [flow for alike in cell.flows.values() for flow in alike] if cell else []
            for flow in flows:
                names = flow.value if flow.how == "value" and isinstance(flow.value, tuple) else ()
                free = [name for name in inputs if name not in names and name != key]
                for at, name in enumerate(names):
                    if isinstance(name, str) and name not in inputs:
                        span = place_of_part(flow.origin.span, (at,))
                        near = guesser(free)(name)
                        is_known = (path.rpartition("/")[0], name) in context.types.cells
                        added = with_input(leaf, name) if is_known else ()
                        yield Finding(
                            span=span,
                            message=f"`{leaf.name}` reads the key `{name}` of the list `{key}`,"
                            " which is not one of its input keys",
                            arguments=(leaf.name, name),
                            help=did_you_mean(near) or listing([leaf], "input_keys", name),
                            related=other_place(cell.span, f"`{leaf.name}` reads the list here")
                            if cell is not None
                            else (),
                            effect=f"`{leaf.name}` cannot read this key: it fails",
                            edits=respelt(Word(name, span), near) if near else added,
                            node=path,
                        )


def _undeclared_accesses(
    path: str, container: Container, types: Mapping[str, StateType]
) -> Iterator[Finding]:
    for inner, leaf in leaves_with_code(path, container):
        read = [*undeclared_reads(leaf), *undeclared_slot_reads(leaf, types)]
        if not read:
            continue
        guess, around = guesser(input_.name for input_ in leaf.inputs), keys_around(container)
        names = [key for key, _ in read]
        if len(read) > 1 and not leaf.inputs and around.issuperset(names):
            place = key_place(read[0][1], names[0])
            yield _without_list(inner, leaf, "input", names, place)
            continue
        for key, code in read:
            if isinstance(container, nodes.Iterator) and key == container.item_key:
                continue
            span = key_place(code, key)
            added, near = listing([leaf], "input_keys", key), None
            if key not in around:
                near = guess.unique_match(key)
                added += f", and set it before, for example in `userdata: {{{key}: ...}}`"
            yield Finding(
                span=span,
                message=f"the code of `{leaf.name}` reads `{key}`, which is not one of its"
                " input keys",
                arguments=(key,),
                help=did_you_mean(near) or added,
                related=calls(leaf, code.span),
                node=inner,
                edits=respelt(Word(key, span), near),
            )


def _unlisted(context: Context, role: Literal["input", "output"]) -> Iterator[Finding]:
    """The keys that the class of a template without an interface uses, although its constructor,
    whose lists are constants, does not pass them to `smach.State`."""
    for path, leaf, facts in leaves_by_type(context, declared=True):
        is_read = role == "input"
        used = {word.text for word in (facts.reads if is_read else facts.writes)}
        names = [key.name for key in (leaf.inputs if is_read else leaf.outputs)]
        unused = guesser(name for name in names if name not in used)
        words = facts.unlisted_reads if is_read else facts.unlisted_writes
        known = DICTIONARY_METHODS if is_read else {word.text for word in facts.unlisted_reads}
        for word in first_of_each(words, known):
            near = unused(word.text) if word.text not in names else None
            verb = "reads" if is_read else "sets"
            yield Finding(
                span=word.span,
                message=f"the code of `{leaf.type}` {verb} `{word.text}`, which its `__init__` does"
                f" not pass to `smach.State` as an {role} key",
                arguments=(word.text,),
                help=did_you_mean(near)
                or f"add `{word.text}` to the `{role}_keys` of `smach.State.__init__`",
                related=used_here(leaf),
                node=path,
            )


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
