"""The rule over counters that keep their old value when their loop runs again."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from smachac.analysis.context import Context
from smachac.analysis.stale_counters import Kind, StaleCounter, stale_counters
from smachac.checks.findings.help_text import calls, other_place
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, PathStep, Severity, ended, entered
from smachac.diagnostics.wording import listed
from smachac.ir.graph import Event

MOST_STEPS = 60
"""The most steps of a witness path: a longer one is left out."""


@rule(
    "SM319",
    "stale-key",
    Severity.WARNING,
    effect="the next time the loop begins with the old count, and ends too early",
)
def stale_key(context: Context) -> Iterator[Finding]:
    """Nothing sets a counter back before its loop runs again.

    A container keeps its userdata from one visit to the next, and sets its initial values only once
    (docs/semantics.md, Userdata). A counter of tries that has come to its limit is still there the
    next time: the robot gives up after one try.

    Exactly: a container gives a key a number, one state adds a constant to it, and a state with
    conditions compares it with a constant, to repeat or to end the loop of both. On a path from the
    end of the loop back to the test nothing else can set the key. On this path either the container
    runs again, or the one state through which a loop around this loop is entered. If the test ended
    the loop, a state of the loop must come before the test, or the loop must be a retry: a state in
    it repeats it after a failure and leaves it after another outcome. A loop of another kind that
    is tested first can be meant for the first visit only. If another state ended the loop, it must
    be a retry in a container that runs again, and nothing else reads the counter: an index can be
    continued after an interruption. A key that the caller sets on each entry (`input_keys`) is not
    reported, nor is a value that a state leaves as it was when it fails, such as the pose of a
    search without a result: it can be meant as a substitute.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - GRASP:
              template: StateMachine
              outcomes: [held, lost]
              userdata: {tries: 0}
              states:
                - CLOSE:
                    template: ScriptedState
                    outcomes: [held, slipped]
                    transitions: {held: held, slipped: COUNT}
                - COUNT:
                    template: CallbacksState
                    input_keys: [tries]
                    output_keys: [tries]
                    callbacks: {tries: 'lambda ud: ud.tries + 1'}
                    transitions: {succeeded: AGAIN}
                - AGAIN:
                    template: ConditionalOutcomeState
                    input_keys: [tries]
                    outcomes: [again]
                    callbacks: {again: 'lambda ud: ud.tries < 3'}
                    default_outcome: enough
                    transitions: {again: CLOSE, enough: lost}
              transitions: {held: done, lost: LOOK}
          - LOOK: {template: ScriptedState, outcomes: [seen], transitions: {seen: GRASP}}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - GRASP:
              template: StateMachine
              outcomes: [held, lost]
              states:
                - SET_TRIES:
                    template: CallbacksState
                    output_keys: [tries]
                    callbacks: {tries: 'lambda ud: 0'}
                    transitions: {succeeded: CLOSE}
                - CLOSE:
                    template: ScriptedState
                    outcomes: [held, slipped]
                    transitions: {held: held, slipped: COUNT}
                - COUNT:
                    template: CallbacksState
                    input_keys: [tries]
                    output_keys: [tries]
                    callbacks: {tries: 'lambda ud: ud.tries + 1'}
                    transitions: {succeeded: AGAIN}
                - AGAIN:
                    template: ConditionalOutcomeState
                    input_keys: [tries]
                    outcomes: [again]
                    callbacks: {again: 'lambda ud: ud.tries < 3'}
                    default_outcome: enough
                    transitions: {again: CLOSE, enough: lost}
              transitions: {held: done, lost: LOOK}
          - LOOK: {template: ScriptedState, outcomes: [seen], transitions: {seen: GRASP}}
    """
    reported: set[tuple[str, str]] = set()
    for found in stale_counters(context.absorbed_flow, lambda: context.routes):
        if (found.path, found.preset.key) not in reported:
            reported.add((found.path, found.preset.key))
            yield _stale(found)


def _stale(found: StaleCounter) -> Finding:
    container, preset = found.container, found.preset
    key, value = preset.key, preset.value.data
    begins = f"when `{container.name}` runs again"
    if found.before is not None:
        begins = f"before the loop of {listed(found.loop)} begins again"
    path = tuple(_steps(found.events))
    return Finding(
        span=preset.span,
        message=f"nothing sets `{key}` back to {value} {begins}: its initial value is set only"
        " once",
        arguments=(key,),
        help=_help(found),
        effect=_effect(found.kind, found.test.name, key),
        related=(
            *other_place(found.counter.span, f"`{found.counter.name}` changes it in the loop"),
            *other_place(found.test.span, f"`{found.test.name}` ends the loop by it"),
            *calls(container, preset.span),
        ),
        path=path if len(path) <= MOST_STEPS else (),
        node=found.path,
    )


def _effect(kind: Kind, test: str, key: str) -> str:
    match kind:
        case "spent":
            return f"from the second time on `{test}` ends the loop in its first round"
        case "endless":
            return f"the second time `{test}` never ends the loop: `{key}` has passed its limit"
        case "fewer":
            return "the next time the loop has fewer rounds: those of the last time count too"


def _help(found: StaleCounter) -> str:
    """The state that sets the counter, and where it belongs."""
    key, container = found.preset.key, found.container
    taken = {child.name for child in container.children}
    name = f"SET_{key.upper()}"
    while name in taken:
        name += "_2"
    state = (
        f"`- {name}: {{template: CallbacksState, output_keys: [{key}], callbacks:"
        f" {{{key}: 'lambda ud: {found.preset.value.data}'}}, transitions:"
        f" {{succeeded: {found.entry}}}}}`"
    )
    if found.before is not None:
        before, outcome = found.before
        return f"add {state}, and lead `{outcome}` of `{before}` to it"
    if container.initial == container.children[0].name:
        return f"add {state} as the first state of `{container.name}`"
    return f"add {state} to `{container.name}`, and write `initial: {name}`"


def _steps(events: Iterable[Event]) -> Iterator[PathStep]:
    """The steps of a path. Where containers end together with a state, the outcome is that of the
    state."""
    after = True
    for path, outcome in events:
        if not outcome:
            yield entered(path.rpartition("/")[2], path)
        elif not after:
            yield ended(outcome)
        after = bool(outcome)
