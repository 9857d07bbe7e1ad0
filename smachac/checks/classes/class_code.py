"""Rules on the code of state types: the Python class of a type against its interface.

The facts about a class are read from its text (pysource/class_reader.py); it is never run. A fault
of a class is reported once, with the first state of its type as a related place.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator

from smachac.analysis.context import Context
from smachac.checks.findings import notation
from smachac.checks.findings.help_text import did_you_mean, other_place
from smachac.checks.findings.renamed_names import renamed_in_interface
from smachac.checks.findings.types_with_code import (
    declared_here,
    leaves_by_type,
    names_by_type,
    own_names,
    own_types,
    used_here,
)
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.negation import is_negation
from smachac.diagnostics.source import Span
from smachac.diagnostics.spelling import Guesser, guesser
from smachac.diagnostics.wording import listed
from smachac.ir import nodes
from smachac.ir.class_facts import ANY, ClassFacts, Ending
from smachac.ir.code_slips import texts_of
from smachac.ir.nodes import Leaf
from smachac.ir.outcome_names import PREEMPTED, fails, is_failure
from smachac.ir.script_code import script_code
from smachac.ir.traversal import outcome_names


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
    names = names_by_type(context)
    silent: set[Span] = set()
    for path, leaf, facts in leaves_by_type(context, declared=False):
        outcomes = names.get(leaf.type, own_names(leaf)).outcomes
        yield from _wrong_returns(path, leaf, facts, outcomes)
        lost = not facts.always_silent and any(fault.outcomes for fault in facts.faults)  # SM609
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
            near = near or did_you_mean(_suggested(leaf, word.text, guess))
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
        message=f"{_code_of(leaf)} {does} an outcome",
        arguments=(leaf.type,),
        help=f"write `return {' '.join(alone.text.split())}`"
        if alone
        else f"{_after_loop(facts)}{_missing_return(leaf, facts, known)}{_hooks(facts)}",
        related=(*_open_end(facts), *used_here(leaf)),
        severity=None if facts.always_silent else Severity.WARNING,
        node=path,
    )


def _code_of(leaf: Leaf) -> str:
    """The function that SMACH runs for a state."""
    return f"`{leaf.type}`" if notation.is_function(leaf) else f"`execute` of `{leaf.type}`"


def _known(leaf: Leaf, outcomes: tuple[str, ...]) -> str:
    """The help that names the outcomes which `execute` can return."""
    if not outcomes and notation.is_python(leaf):
        return f"add the names that it returns to the outcomes of {notation.declared(leaf)}"
    if not outcomes:
        return f"add outcomes to {notation.declared(leaf)}"
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
    lost = {name for fault in facts.faults for name in fault.outcomes}
    names = outcome_names(leaf) if facts.silent and ANY not in lost else ()
    return [name for name in names if name not in returned | lost]


def _hooks(facts: ClassFacts) -> str:
    """The part of a help about methods of FlexBE's states, which SMACH does not have."""
    if not facts.hooks:
        return ""
    return f"; SMACH calls `execute` once and never `{facts.hooks[0]}`: wait in `execute`"


def _text_alone(facts: ClassFacts, outcomes: Collection[str]) -> tuple[str, ...]:
    """The outcomes that the last line of `execute` has without `return`: one, or a choice."""
    end = facts.open_end
    tree = script_code(end.span.text).tree if end is not None and end.text == "text" else None
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
    if notation.is_python(leaf) and not leaf.outcomes:
        return ""
    if notation.is_python(leaf):
        return f", or add `{word.text}` to the outcomes of {notation.declared(leaf)}"
    where = "its interface" if ending.defined else "its interface and `__init__`"
    return f", or add `{word.text}` to the outcomes of `{leaf.type}` in {where}"


def _suggested(leaf: Leaf, word: str, guess: Guesser) -> str | None:
    """The outcome that was probably meant: a failure for the name of a failure."""
    near = guess.unique_match(word)
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
    name = next((outcome for outcome in outcomes if text.startswith(f"('{outcome}',")), None)
    return f'write `return "{name}"`: a comma makes a tuple' if name is not None else None


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
        known = known and not any(ANY in fault.outcomes for fault in facts.faults)  # SM609
        if not known or facts.stub or type_.optional:
            continue
        returned = {word.text for word in facts.returns}
        alone = _text_alone(facts, outcome_names(leaf))
        returned.update(alone, lost_with_return(leaf, facts))  # SM309
        returned.update(name for fault in facts.faults for name in fault.outcomes)  # SM609
        names = [outcome.name for outcome in type_.outcomes]
        declared = names if facts.outcomes is None else [word.text for word in facts.outcomes]
        wrong = returned.difference(names)  # SM309: probably one of the others was meant
        guess = guesser(names)
        returned.update(
            near for word in wrong if (near := _suggested(leaf, word, guess)) == PREEMPTED
        )
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
    message = f"{_code_of(leaf)} never returns `{outcome}`"
    init = "" if notation.is_python(leaf) else ", from `__init__`,"
    help = (
        f"return `{outcome}` where it is meant, or remove it from {notation.declared(leaf)}{init}"
        f" and from the transitions of `{leaf.name}`"
    )
    if outcome == PREEMPTED:
        help = "add where it waits: `if self.preempt_requested(): self.service_preempt(); return"
        help += " 'preempted'`"
        if not facts.checks_stop:
            message += ": a time limit or a stop cannot end it"
    place = next((result.span for result in leaf.outcomes if result.name == outcome), leaf.span)
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
