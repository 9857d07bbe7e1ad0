"""Rules on the code of state types: the Python class of a type against its interface.

The facts about a class are read from its text (pysource/class_reader.py); it is never run. A fault
of a class is reported once, with the first state of its type as a related place.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import Literal, NamedTuple

from smachac.analysis.context import Context
from smachac.checks.classes.renamed_names import renamed_in_interface
from smachac.checks.help_text import did_you_mean, other_place
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.negation import is_negation
from smachac.diagnostics.source import NOWHERE, Span, Word
from smachac.diagnostics.spelling import Guesser, guesser
from smachac.diagnostics.wording import listed
from smachac.ir import nodes
from smachac.ir.class_facts import ANY, ClassFacts, Ending, renamed_name
from smachac.ir.code_places import python_tree
from smachac.ir.code_slips import texts_of
from smachac.ir.nodes import Key, Leaf, Outcome, StateType
from smachac.ir.outcome_names import PREEMPTED, fails, is_failure
from smachac.ir.traversal import enclosing, outcome_names, outer_outputs, remapping


def leaves_by_type(context: Context, *, declared: bool) -> Iterator[tuple[str, Leaf, ClassFacts]]:
    """A leaf of each type whose code was read, with its path. `declared`: one that can use only
    the keys it declares, unlike the child of an iterator. The iterator of `retry` and `for_each`
    has the keys that the state declares."""
    seen: set[str] = set()
    for path, leaf, facts, container in context.leaves_with_class:
        if declared and isinstance(container, nodes.Iterator) and not container.sugar:
            continue
        if leaf.type not in seen:
            seen.add(leaf.type)
            yield path, leaf, facts


def own_types(
    context: Context, *, declared: bool
) -> Iterator[tuple[str, Leaf, StateType, ClassFacts]]:
    """As `leaves_by_type`, for the types of the user."""
    for path, leaf, facts in leaves_by_type(context, declared=declared):
        type_ = context.machine.state_types.get(leaf.type)
        if type_ is not None and not type_.built_in and not type_.open:
            yield path, leaf, type_, facts


class TypeNames(NamedTuple):
    """The names of outcomes, input keys and output keys that some state of a type declares, or a
    default value of its constructor."""

    outcomes: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]


def _names_by_type(context: Context) -> Mapping[str, TypeNames]:
    """The names of the types whose constructors get lists from the script. States of one type can
    declare different names, so a name is wrong only if none of them declares it."""
    found: dict[str, TypeNames] = {}
    for _, leaf, facts, _ in context.leaves_with_class:
        if facts.passed:
            given = dict(facts.passed)
            known = found.get(leaf.type) or TypeNames(
                given.get("outcomes", ()), given.get("input_keys", ()), given.get("output_keys", ())
            )
            pairs = zip(_own_names(leaf), known, strict=True)
            joined = (tuple(dict.fromkeys((*own, *others))) for own, others in pairs)
            found[leaf.type] = TypeNames(*joined)
    return found


def _own_names(leaf: Leaf) -> TypeNames:
    return TypeNames(
        outcome_names(leaf),
        tuple(key.name for key in leaf.inputs),
        tuple(key.name for key in leaf.outputs),
    )


def used_here(leaf: Leaf) -> tuple[Related, ...]:
    """The first state of a type, as a related place."""
    return other_place(leaf.span, f"`{leaf.name}` is of the type `{leaf.type}`")


def declared_here(leaf: Leaf, names: Sequence[Outcome | Key]) -> tuple[Related, ...]:
    """The place of the first of some names of a state in its interface, or of its outcomes."""
    spans = [each.span for each in (*names, *leaf.outcomes)]
    span = next((span for span in spans if span.source is not leaf.span.source), NOWHERE)
    return other_place(span, f"the interface of `{leaf.type}`")


@rule(
    "SM309",
    "undeclared-return",
    Severity.ERROR,
    effect="SMACH raises InvalidTransitionError for an undeclared outcome: the machine stops",
)
def undeclared_return(context: Context) -> Iterator[Finding]:
    """The Python code of a state type returns a value that is not one of its outcomes, or no value.

    Then SMACH stops the whole machine with an error, and the robot stops in the middle of its task.

    Exactly: the code is read, never run, and parts that Jinja fills in are not checked. It is a
    warning if only some paths through `execute` end without `return`, because such a path may be
    impossible.

    Wrong:
        name: sm
        template: Base
        outcomes: [pressed, late]
        states:
          - WAIT:
              template: WaitForButton
              transitions: {pressed: pressed, timed_out: late}
        == templates/WaitForButton.yml ==
        name: WaitForButton
        outcomes: {pressed: {}, timed_out: {}}
        code: {python: WaitForButton.tpl.py}
        == templates/WaitForButton.tpl.py ==
        {% block class_defs %}
        class WaitForButton(smach.State):
            def __init__(self):
                super().__init__(outcomes=["pressed", "timed_out"])

            def execute(self, userdata):
                return "pressed" if button.wait(10) else "timeout"
        {% endblock %}

    Right:
        name: sm
        template: Base
        outcomes: [pressed, late]
        states:
          - WAIT:
              template: WaitForButton
              transitions: {pressed: pressed, timed_out: late}
        == templates/WaitForButton.yml ==
        name: WaitForButton
        outcomes: {pressed: {}, timed_out: {}}
        code: {python: WaitForButton.tpl.py}
        == templates/WaitForButton.tpl.py ==
        {% block class_defs %}
        class WaitForButton(smach.State):
            def __init__(self):
                super().__init__(outcomes=["pressed", "timed_out"])

            def execute(self, userdata):
                return "pressed" if button.wait(10) else "timed_out"
        {% endblock %}
    """
    names = _names_by_type(context)
    silent: set[Span] = set()
    for path, leaf, facts in leaves_by_type(context, declared=False):
        outcomes = names.get(leaf.type, _own_names(leaf)).outcomes
        yield from _wrong_returns(path, leaf, facts, outcomes)
        lost = not facts.always_silent and any(each.outcomes for each in facts.faults)  # SM609
        if facts.silent and not lost and facts.execute and facts.execute not in silent:
            silent.add(facts.execute)  # several types can share the code of their base class
            yield _without_return(path, leaf, facts, outcomes)


def _wrong_returns(
    path: str, leaf: Leaf, facts: ClassFacts, outcomes: tuple[str, ...]
) -> Iterator[Finding]:
    guess = guesser(outcomes)
    known, alone = _known(leaf, outcomes), _only_left(leaf, facts, outcomes)
    renamed = renamed_in_interface(leaf, "outcomes", facts, facts.outcomes, outcomes)
    for ending in facts.endings:
        word = ending.outcome
        again = renamed is not None and word.text == renamed.old and word not in renamed.first
        if word.text not in outcomes and not again:
            does = "can return" if ending.possible else "returns"
            near = f"write `{ending.meant}`" if ending.meant is not None else None
            near = near or did_you_mean(_meant(leaf, word.text, guess))
            near = near or _without_tuple(word.text, outcomes)
            if ending.silent:
                near = f"end each path of `{ending.silent}` with a `return`; {known}"
            elif near is None and alone is not None:
                text = f'"{alone}"' if ending.defined else f'return "{alone}"'
                near = f"write `{text}`, as no path returns `{alone}`"
                near += "" if ending.possible else _or_declare(ending, leaf)
            places = declared_here(leaf, leaf.outcomes)
            if renamed is not None and word.text == renamed.old:
                near, places = renamed.help, (*renamed.places, *places)
            returned = other_place(word.span, f"`{leaf.type}` returns it here")
            yield Finding(
                span=ending.defined or word.span,
                message=f"`{leaf.type}` {does} `{word.text}`, which is not one of its outcomes",
                arguments=(leaf.type, word.text),
                help=near or f"{known}{'' if ending.possible else _or_declare(ending, leaf)}",
                related=(*(returned if ending.defined else ()), *places, *used_here(leaf)),
                severity=Severity.WARNING if ending.possible else None,
                node=path,
            )


def _only_left(leaf: Leaf, facts: ClassFacts, outcomes: Collection[str]) -> str | None:
    """The only outcome but `preempted` that `execute` does not return, if it returns one unknown
    outcome; else None."""
    returned = {word.text for word in facts.returns}
    known = {PREEMPTED, leaf.catches, *returned}
    left = [name for name in outcomes if name not in known]
    wrong = [*returned.difference(outcomes)]
    if not facts.complete or facts.silent or len(wrong) != 1 or len(left) != 1:
        return None
    return None if is_negation(wrong[0], left[0]) else left[0]


def _without_return(path: str, leaf: Leaf, facts: ClassFacts, outcomes: tuple[str, ...]) -> Finding:
    """The finding for an `execute` that can end without `return`."""
    assert facts.execute is not None
    does = "never returns" if facts.always_silent else "can end without returning"
    alone = _alone(facts, outcomes)
    known = _known(leaf, outcomes)
    return Finding(
        span=alone or facts.execute,
        message=f"`execute` of `{leaf.type}` {does} an outcome",
        arguments=(leaf.type,),
        help=f"write `return {' '.join(alone.text.split())}`"
        if alone
        else f"{_after_loop(facts)}{_missing_return(leaf, facts, known)}{_hooks(facts)}",
        related=(*_open_end(facts), *used_here(leaf)),
        severity=None if facts.always_silent else Severity.WARNING,
        node=path,
    )


def _known(leaf: Leaf, outcomes: tuple[str, ...]) -> str:
    """The help that names the outcomes which `execute` can return."""
    if not outcomes:
        return f"add outcomes to the interface `{leaf.type}`"
    return f"return one of its outcomes: {listed([n for n in outcomes if n != leaf.catches])}"


def _alone(facts: ClassFacts, outcomes: Collection[str]) -> Span | None:
    """The place of a value that is the last line of `execute` without `return`."""
    end = facts.open_end
    if end is None or not (end.text == "value" or _text_alone(facts, outcomes)):
        return None
    return end.span


def _missing_return(leaf: Leaf, facts: ClassFacts, known: str) -> str:
    """The part of a help about a path without `return`, with the outcomes that no path returns."""
    never = [] if facts.always_silent or not facts.complete else lost_with_return(leaf, facts)
    if len(never) == 1:
        return f'end this path with `return "{never[0]}"`, which no other path returns'
    if never:
        return f"end each path with a `return`; no path returns {listed(never)}"
    return f"end each path with a `return`; {known}"


def lost_with_return(leaf: Leaf, facts: ClassFacts) -> list[str]:
    """The outcomes but `preempted` that `execute` does not return where it can end without one."""
    returned = {PREEMPTED, leaf.catches, *(word.text for word in facts.returns)}
    lost = {name for each in facts.faults for name in each.outcomes}
    names = outcome_names(leaf) if facts.silent and ANY not in lost else ()
    return [name for name in names if name not in returned | lost]


def _hooks(facts: ClassFacts) -> str:
    """The part of a help about methods of FlexBE's states, which SMACH does not have."""
    if not facts.hooks:
        return ""
    return f"; SMACH calls `execute` once and never `{facts.hooks[0]}`: wait in `execute`"


def _in_the_class(facts: ClassFacts, field: Literal["input_keys", "output_keys"], key: str) -> str:
    """The part of a help that adds a key to the list in the constructor, where it has its own."""
    declared = facts.inputs if field == "input_keys" else facts.outputs
    if declared is None or field in dict(facts.passed) or key in {word.text for word in declared}:
        return ""
    return " and of `__init__`"


def _text_alone(facts: ClassFacts, outcomes: Collection[str]) -> tuple[str, ...]:
    """The outcomes that the last line of `execute` has without `return`: one, or a choice."""
    end = facts.open_end
    tree = python_tree(end.span.text) if end is not None and end.text == "text" else None
    found = texts_of(tree) if tree is not None else ()
    return found if {*found} <= {*outcomes} else ()


def _after_loop(facts: ClassFacts) -> str:
    """The part of a help about a `return` at the end of a loop behind which there is none."""
    if facts.in_loop is None or facts.always_silent:
        return ""
    return f"move `{facts.in_loop.span.text}` behind the loop if it is meant there; otherwise "


END_OF_EXECUTE = {
    "if": "if this is false, nothing is returned",
    "match": "if no `case` matches, nothing is returned",
    "except": "after this exception, nothing is returned",
    "loop": "after this loop, nothing is returned",
}
"""The place from which `execute` gets to its end without `return`, by its kind."""


def _open_end(facts: ClassFacts) -> tuple[Related, ...]:
    """The place from which `execute` gets to its end without `return`."""
    end = facts.open_end
    if end is None or facts.always_silent or end.text not in END_OF_EXECUTE:
        return ()
    return other_place(end.span, END_OF_EXECUTE[end.text])


def _or_declare(ending: Ending, leaf: Leaf) -> str:
    """The part of a help that adds a returned word to the outcomes of its type. A constant that has
    a name is usually in `__init__` too."""
    word = ending.outcome
    if not word.text.isidentifier() or word.text in ("None", "True", "False"):
        return ""
    where = "its interface" if ending.defined else "its interface and `__init__`"
    return f", or add `{word.text}` to the outcomes of `{leaf.type}` in {where}"


def _meant(leaf: Leaf, word: str, guess: Guesser) -> str | None:
    """The outcome that was probably meant: a failure for the name of a failure."""
    near = guess.sure(word)
    if near is not None:
        return near
    near = guess(word)
    if (
        near is not None and len(word) > 3 and near.startswith(word)
    ):  # a form of the same word: slip, slipped
        return near
    if not is_failure(word):
        return near if near is None or not fails(leaf, near) else None
    if near is not None and fails(leaf, near):
        return near
    words = set(word.split("_"))
    alike = [name for name in outcome_names(leaf)
             if fails(leaf, name) and not words.isdisjoint(name.split("_"))]  # fmt: skip
    return alike[0] if len(alike) == 1 else None


def _without_tuple(text: str, outcomes: Collection[str]) -> str | None:
    """The help for a tuple that begins with an outcome: `return "found", 1`."""
    name = next((each for each in outcomes if text.startswith(f"('{each}',")), None)
    return f'write `return "{name}"`: a comma makes a tuple' if name is not None else None


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
    names = _names_by_type(context)
    for path, leaf, facts in leaves_by_type(context, declared=True):
        _, inputs, outputs = names.get(leaf.type, _own_names(leaf))
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
            message = (
                f"the code of `{leaf.type}` reads `{word.text}`, which is not an input"
                " key of its interface"
            )
            near = guesser(key for key in inputs if key not in used)(word.text)
            help = did_you_mean(near) or (
                f"add `{word.text}` to the `input_keys` of the interface `{leaf.type}`"
                + _in_the_class(facts, "input_keys", word.text)
            )
            renamed = [each.key for each in leaf.remaps if each.to == word.text]
            if renamed and renamed[0] in inputs:
                help = f"write `{_owner(word)}.{renamed[0]}`: `{word.text}` is the name of this key"
                help += f" around `{leaf.name}`"
            lone = _lone_input(facts, inputs, known) if word.text not in outputs else None
            if lone is not None and guesser(inputs)(word.text) is None and not renamed:
                message += f", and it never reads its input key `{lone}`"
                help = f"write `{_owner(word)}.{lone}`" if _owner(word) else f"write `{lone}`"
            if word.text in outputs:
                message = f"the code of `{leaf.type}` reads `{word.text}`, which is only an output"
                message += " key of its interface"
                if _sets_first(facts, word) or not any(
                    _comes_from_outside(leaf, each, word.text) for each in levels
                ):
                    help = _local_variable(word)
            if word.text in DICTIONARY_METHODS and _is_called(word):
                name = _owner(word)
                message = (
                    f"the code of `{leaf.type}` calls `{name}.{word.text}`, but the userdata of a"
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
    places = {each.span for each in facts.reads}
    return any(each.text == word.text and each.span not in places for each in facts.writes)


def _comes_from_outside(leaf: Leaf, around: nodes.Container, key: str) -> bool:
    """Whether a key of a leaf can have a value before the leaf sets it."""
    outer = remapping(leaf)[key]
    known = {each.key for each in around.userdata} | {each.name for each in around.inputs}
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
    names = _names_by_type(context)
    for path, leaf, facts in leaves_by_type(context, declared=True):
        inputs, outputs = names.get(leaf.type, _own_names(leaf))[1:]
        unknown = {word.text for word in facts.reads}.difference(inputs)
        written = {word.text for word in facts.writes}
        old = renamed_in_interface(leaf, "output_keys", facts, facts.outputs, outputs)
        for word in first_of_each(facts.writes, [*outputs, *unknown]):
            only = word.text in inputs
            what = "only an input key" if only else "not an output key of its interface"
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
                message=f"the code of `{leaf.type}` sets `{word.text}`, which is {what}: the value"
                f" is discarded{never}",
                arguments=(word.text,),
                help=guess
                or f"add `{word.text}` to the `output_keys` of the interface `{leaf.type}`"
                + _in_the_class(facts, "output_keys", word.text),
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


def first_of_each(words: Iterable[Word], known: Iterable[str]) -> list[Word]:
    """The first occurrence of each unknown word."""
    found: dict[str, Word] = {}
    for word in words:
        found.setdefault(word.text, word)
    left = found.keys() - set(known)
    return [word for word in found.values() if word.text in left]


@rule(
    "SM315",
    "never-returned",
    Severity.WARNING,
    effect="a transition for this outcome is never taken",
)
def never_returned(context: Context) -> Iterator[Finding]:
    """The class of a state type never returns an outcome that its interface declares.

    What the script does after that outcome never happens. If the outcome is `preempted`, neither a
    time limit nor a stop of the machine can end the state: the robot continues.

    Exactly: the class is read, never run. There is no finding if `execute` returns a value that is
    not a constant, or if it only returns one constant, because then it is not written yet. Of a
    template of SMACHA's kind, which has a block `body`, only `preempted` is checked.

    Wrong:
        name: sm
        template: Base
        outcomes: [ready, stopped]
        states:
          - WAIT:
              template: WaitForPart
              transitions: {arrived: ready, preempted: stopped}
        == templates/WaitForPart.yml ==
        name: WaitForPart
        outcomes: {arrived: {}, preempted: {}}
        blocking: true
        code: {python: "cell.wait:WaitForPart"}
        == cell/wait.py ==
        import smach

        from cell_drivers import belt


        class WaitForPart(smach.State):
            def __init__(self):
                super().__init__(outcomes=["arrived", "preempted"])

            def execute(self, userdata):
                while not belt.has_part():
                    belt.wait(0.1)
                return "arrived"

    Right:
        name: sm
        template: Base
        outcomes: [ready, stopped]
        states:
          - WAIT:
              template: WaitForPart
              transitions: {arrived: ready, preempted: stopped}
        == templates/WaitForPart.yml ==
        name: WaitForPart
        outcomes: {arrived: {}, preempted: {}}
        blocking: true
        code: {python: "cell.wait:WaitForPart"}
        == cell/wait.py ==
        import smach

        from cell_drivers import belt


        class WaitForPart(smach.State):
            def __init__(self):
                super().__init__(outcomes=["arrived", "preempted"])

            def execute(self, userdata):
                while not belt.has_part():
                    if self.preempt_requested():
                        self.service_preempt()
                        return "preempted"
                    belt.wait(0.1)
                return "arrived"
    """
    for path, leaf, type_, facts in own_types(context, declared=False):
        known = facts.complete and facts.returns and facts.execute is not None
        known = known and not any(ANY in each.outcomes for each in facts.faults)  # SM609
        if not known or facts.stub or type_.optional:
            continue
        returned = {word.text for word in facts.returns}
        alone = _text_alone(facts, outcome_names(leaf))
        returned.update(alone, lost_with_return(leaf, facts))  # SM309
        returned.update(name for each in facts.faults for name in each.outcomes)  # SM609
        names = [each.name for each in type_.outcomes]
        declared = names if facts.outcomes is None else [word.text for word in facts.outcomes]
        wrong = returned.difference(names)  # SM309: probably one of the others was meant
        guess = guesser(names)
        returned.update(near for word in wrong if (near := _meant(leaf, word, guess)) == PREEMPTED)
        only_stops = type_.prints_itself or wrong
        for name in names:
            checked = name == PREEMPTED or not only_stops
            if checked and name in declared and name not in returned:
                limits = _limits(context, leaf.type) if name == PREEMPTED else ()
                yield _never(path, leaf, facts, name, limits)


def _limits(context: Context, type_: str) -> tuple[Related, ...]:
    """The first time limit of a state of a type, which cannot end it."""
    for _, leaf, _, container in context.leaves_with_class:
        if leaf.type != type_ or not isinstance(container, nodes.Concurrence):
            continue
        if container.sugar == "timeout":
            message = f"this time limit cannot end `{leaf.name}`"
            return other_place(container.default_span, message)
    return ()


def _never(
    path: str, leaf: Leaf, facts: ClassFacts, outcome: str, limits: tuple[Related, ...]
) -> Finding:
    assert facts.execute is not None
    message = f"`execute` of `{leaf.type}` never returns `{outcome}`"
    help = (
        f"return `{outcome}` where it is meant, or remove it from the interface `{leaf.type}`, from"
        f" `__init__`, and from the transitions of `{leaf.name}`"
    )
    if outcome == PREEMPTED:
        help = "add where it waits: `if self.preempt_requested(): self.service_preempt(); return"
        help += " 'preempted'`"
        if not facts.checks_stop:
            message += ": a time limit or a stop cannot end it"
    place = next((each.span for each in leaf.outcomes if each.name == outcome), leaf.span)
    return Finding(
        span=facts.execute,
        message=message,
        arguments=(leaf.type, outcome),
        help=help,
        related=(
            *limits,
            *other_place(place, f"`{outcome}` is declared here"),
            *used_here(leaf),
        ),
        effect="the robot goes on until the state ends by itself" if outcome == PREEMPTED else None,
        node=path,
    )
