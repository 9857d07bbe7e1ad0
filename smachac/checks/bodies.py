"""Rules over the Python code of state types (ir/python_body.py): one report for each template."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from smachac.checks.hints import did_you_mean, guesser
from smachac.checks.once import containers
from smachac.diagnostics import Finding, Severity, rule
from smachac.ir import nodes
from smachac.ir.nodes import Body, Leaf, Machine
from smachac.ir.walk import outcome_names
from smachac.problems import listed
from smachac.source import Word


def leaves_by_type(machine: Machine, *, declared: bool) -> Iterator[tuple[str, Leaf, Body]]:
    """A leaf of each type whose code was read, with its path. `declared`: one that sees only the
    keys it declares, unlike the child of an iterator."""
    seen: set[int] = set()
    for path, container in containers(machine):
        if declared and isinstance(container, nodes.Iterator):
            continue
        for child in container.children:
            if isinstance(child, Leaf) and child.body is not None and id(child.body) not in seen:
                seen.add(id(child.body))
                yield f"{path}/{child.name}", child, child.body


@rule("SM309", "undeclared-return", Severity.ERROR)
def undeclared_return(machine: Machine) -> Iterator[Finding]:
    """The Python code of a state type returns what is not one of its outcomes, or nothing.

    SMACH ends the whole machine with an error then. The code is read, never run; what Jinja fills
    in is not judged. A warning where only some ways through `execute` end without `return`: they
    may be ways that nothing ever takes.

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
    for path, leaf, body in leaves_by_type(machine, declared=False):
        yield from _wrong_returns(path, leaf, body)


def _wrong_returns(path: str, leaf: Leaf, body: Body) -> Iterator[Finding]:
    outcomes = outcome_names(leaf)
    guess = guesser(outcomes)
    known = f"its outcomes are {listed(outcomes)}" if outcomes else "it has no outcomes"
    for word in body.returns:
        if word.text not in outcomes:
            yield Finding(
                span=word.span,
                message=f"`{leaf.type}` returns `{word.text}`, which is none of its outcomes",
                help=did_you_mean(guess(word.text)) or known,
                node=path,
            )
    if body.silent is not None:
        does = "never returns" if body.always_silent else "can end without returning"
        yield Finding(
            span=body.silent,
            message=f"`execute` of `{leaf.type}` {does} an outcome",
            help=known,
            severity=None if body.always_silent else Severity.WARNING,
            node=path,
        )


def unknown_reads(machine: Machine) -> Iterator[Finding]:
    """The keys that code of a type reads and its interface does not take; SM310 says them."""
    for path, leaf, body in leaves_by_type(machine, declared=True):
        inputs = [key.name for key in leaf.inputs]
        for word in _first_of_each(body.reads, inputs):
            yield Finding(
                span=word.span,
                message=f"the code of `{leaf.type}` reads `{word.text}`, which is none of the input"
                " keys of its interface",
                help=did_you_mean(guesser(inputs)(word.text))
                or f"add `{word.text}` to the `input_keys` of the interface `{leaf.type}`",
                node=path,
            )


def dropped_writes(machine: Machine) -> Iterator[Finding]:
    """The keys that code of a type writes and its interface does not give; SM308 says them, but
    for those that are read as well and not known at all, which is SM310."""
    for path, leaf, body in leaves_by_type(machine, declared=True):
        inputs = {key.name for key in leaf.inputs}
        outputs = [key.name for key in leaf.outputs]
        unknown = {word.text for word in body.reads} - inputs
        for word in _first_of_each(body.writes, [*outputs, *unknown]):
            only = word.text in inputs
            what = "an input key only" if only else "none of the output keys of its interface"
            guess = None if only else did_you_mean(guesser(outputs)(word.text))
            yield Finding(
                span=word.span,
                message=f"the code of `{leaf.type}` writes `{word.text}`, which is {what}:"
                " the value is dropped",
                help=guess
                or f"add `{word.text}` to the `output_keys` of the interface `{leaf.type}`",
                node=path,
            )


def _first_of_each(words: Iterable[Word], known: Iterable[str]) -> list[Word]:
    """The words that are not known, each where it first stands."""
    found: dict[str, Word] = {}
    for word in words:
        found.setdefault(word.text, word)
    left = found.keys() - set(known)
    return [word for word in found.values() if word.text in left]
