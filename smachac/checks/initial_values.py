"""The rule over what containers hold before they run."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.analysis.context import Context
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.source import Span
from smachac.ir.nodes import Given, Preset


@rule("SM313", "overruled-value", Severity.WARNING)
def overruled_value(context: Context) -> Iterator[Finding]:
    """Two states of one container give a key of its userdata different values.

    The userdata of a state is that of its container, and all of it is set before the container
    starts: the last value counts, also for the states before. Nothing is said where the values are
    the same.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - NEAR:
              template: PrintUserdataState
              userdata: {speed: 0.1}
              input_keys: [speed]
              transitions: {succeeded: FAR}
          - FAR:
              template: PrintUserdataState
              userdata: {speed: 1.0}
              input_keys: [speed]
              transitions: {succeeded: done}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - NEAR:
              template: PrintUserdataState
              userdata: {slow: 0.1}
              input_keys: [speed]
              remapping: {speed: slow}
              transitions: {succeeded: FAR}
          - FAR:
              template: PrintUserdataState
              userdata: {speed: 1.0}
              input_keys: [speed]
              transitions: {succeeded: done}
    """
    for path, container in context.containers:
        for preset in container.userdata:
            yield from _overruled(path, preset)


def _overruled(path: str, preset: Preset) -> Iterator[Finding]:
    if not preset.given:
        return
    *others, last = preset.given
    vain = [each for each in others if not _alike(each, last)]
    if not vain:
        return
    whose = f"`{path.rpartition('/')[2]}`"
    first = "its own `userdata` gives" if vain[0].own else f"`{vain[0].state.text}` gives"
    yield Finding(
        span=_place(vain[0], last),
        message=f"{whose} never holds the value that {first} `{preset.key}`:"
        f" `{last.state.text}` gives it another one",
        help="let one of them read a key of another name, through its `remapping`"
        if not vain[0].own
        else f"give `{preset.key}` once, or another key through the `remapping` of the state",
        related=(
            *(Related(span=each.span, message="nor this one") for each in vain[1:]),
            Related(span=_place(last, vain[0]), message="the last one counts"),
        ),
        node=path,
    )


def _place(given: Given, other: Given) -> Span:
    """Where a value is given; calls of one sub-script are told apart by their names."""
    return given.state.span if given.span == other.span else given.span


def _alike(one: Given, other: Given) -> bool:
    """Whether two values are the same; nan is itself here."""
    a, b = one.value.data, other.value.data
    return a == b or repr(a) == repr(b)
