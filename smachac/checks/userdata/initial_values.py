"""Rules over values of userdata in the script: initial ones, and those of secret keys."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.analysis.context import Context
from smachac.analysis.secret_values import secret_values
from smachac.checks.findings.help_text import calls
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.source import Span
from smachac.diagnostics.wording import MOST_LISTED, both
from smachac.ir.nodes import Given, Preset


@rule(
    "SM313",
    "overruled-value",
    Severity.WARNING,
    effect="all initial values are set before the first state: both states have the last one",
)
def overruled_value(context: Context) -> Iterator[Finding]:
    """Two states of one container give the same userdata key different initial values.

    The `userdata` of a state is set in its container, before the container starts. The last value
    overwrites the others, so an earlier state works with a value that was written for another one.

    Exactly: equal values are allowed.

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
    unused = [other for other in others if not _alike(other, last)]
    if not unused:
        return
    own = path.rpartition("/")[2]
    owners = [own if given.own else given.state.text for given in unused]
    several = len(unused) > 1
    key = preset.key
    yield Finding(
        span=_place(unused[0], last),
        message=f"the initial value{'s' if several else ''} of `{key}` in {both(owners)}"
        f" {'are' if several else 'is'} never used: `{last.state.text}` overwrites"
        f" {'them' if several else 'it'}",
        arguments=(key,),
        help=_renamed(preset, unused) + (f", or set `{key}` only once" if unused[0].own else ""),
        effect="all initial values are set before the first state: all these states have the last"
        " one"
        if several
        else None,
        related=(
            *(Related(span=given.span, message="overwritten too") for given in unused[1:]),
            Related(span=_place(last, unused[0]), message="this value is used"),
        ),
        node=path,
    )


def _renamed(preset: Preset, unused: list[Given]) -> str:
    """How each owner keeps its value: the states whose values are lost get keys of their own; if
    the value of the container is lost, all states do."""
    renamed = preset.given if unused[0].own else unused
    states = [given for given in renamed if not given.own]
    names: dict[str, str] = {}
    shown = []
    for state in states:
        value = repr(state.value.data)
        name = names.setdefault(value, f"{preset.key}_{len(names) + 2}")
        text = state.value.span.text
        text = text if 0 < len(text) <= _LONGEST_VALUE and "\n" not in text else "..."
        shown.append(
            f"`userdata: {{{name}: {text}}}` and `remapping: {{{preset.key}: {name}}}` at"
            f" `{state.state.text}`"
        )
    more = len(shown) - MOST_LISTED
    return (
        "rename the key: write "
        + "; ".join(shown[:MOST_LISTED])
        + (f"; and so on at {more} more" if more > 0 else "")
    )


_LONGEST_VALUE = 40
"""The longest value that the help repeats, in characters."""


def _place(given: Given, other: Given) -> Span:
    """Where a value is given; calls of one sub-script differ only in the names of their states."""
    return given.state.span if given.span == other.span else given.span


def _alike(one: Given, other: Given) -> bool:
    """Whether two values are the same; nan is itself here."""
    a, b = one.value.data, other.value.data
    return a == b or repr(a) == repr(b)


@rule(
    "SM321",
    "secret-in-script",
    Severity.WARNING,
    effect="everybody who can read the script or a program generated from it can read the value",
)
def secret_in_script(context: Context) -> Iterator[Finding]:
    """The script contains the value of a secret key.

    A password or a PIN in a script is copied to version control and to every generated program.
    Traces and pages hide the values of secret keys, programs contain them.

    Exactly: a text or number that reaches a key with `secret: true`, through userdata, params and
    remappings. Code is allowed, and so are null, true, false and the empty text.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        userdata:
          pin: {type: str, value: "4711", secret: true}
        states:
          - UNLOCK:
              template: ScriptedState
              outcomes: [done]
              input_keys: [pin]

    Right:
        name: sm
        template: Base
        outcomes: [done]
        userdata:
          pin: {type: str, value: "`os.environ['PIN']`", secret: true}
        states:
          - UNLOCK:
              template: ScriptedState
              outcomes: [done]
              input_keys: [pin]
    """
    if not context.secret_keys:
        return
    for flow in secret_values(context.types, context.secret_keys):
        cell = flow.cell
        node = cell.node
        yield Finding(
            span=flow.span,
            message=f"the script contains the value of the secret key `{cell.key}`",
            arguments=(cell.key,),
            help="write code that reads it when the program runs, as in"
            f" ``\"`os.environ['{cell.key.upper()}']`\"``; or write null, keep `secret: true`, and"
            f" add `{cell.key}` to the `input_keys`, so that the caller of the machine sets it",
            related=calls(node, flow.span) if node is not None else (),
            node=cell.path,
        )
