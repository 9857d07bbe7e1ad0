"""The faults of the comments that allow findings."""

from __future__ import annotations

from collections.abc import Iterable

from smachac.diagnostics import Diagnostic, Finding, Severity, did_you_mean, problem
from smachac.source import Span, Word


@problem("SM021", "unused-allowance", Severity.WARNING)
def unused_allowance(code: Word) -> Finding:
    """A comment allows what is not found on its line.

    The fault it was written for is mended, or never was there; left alone, the comment would hide
    the next fault of that kind from everybody. In a sub-script this is told only when a folder
    is checked, for another script may need it.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK: {template: ScriptedState, outcomes: [ok], transitions: {ok: PLACE}}
          - PLACE: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}  # smachac: allow SM201 the operator starts it

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}
          - PLACE: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}  # smachac: allow SM201 the operator starts it
    """  # noqa: E501 (the comment stands behind its line)
    return Finding(
        span=code.span,
        message=f"{code.text} is allowed here, and not found here",
        help="remove it, or put it behind the line that it is meant for",
    )


@problem("SM022", "bad-allowance", Severity.WARNING)
def bad_allowance(span: Span, message: str, help: str) -> Finding:
    """A comment for smachac lacks its reason, is misspelt, or allows what cannot be allowed.

    A silenced finding without a reason is a riddle to the next reader, who must decide whether
    the robot is safe. Findings that leave no machine to print cannot be allowed.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}
          # smachac: allow SM201
          - PLACE: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}
          # smachac: allow SM201 the operator starts here after a stop
          - PLACE: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}
    """
    return Finding(span=span, message=message, help=help)


def unfounded_allowance(span: Span, *, named: bool) -> Diagnostic:
    """SM022 for a comment without a reason or, where none is `named`, without a code."""
    what = "the reason is missing" if named else "it names no code"
    help = "say why: `# smachac: allow SM201 the operator starts it`"
    return bad_allowance(span, f"this comment allows something, but {what}", help)


def bad_comment(verb: Word) -> Diagnostic:
    """SM022 for a comment with another word than `allow`."""
    help = did_you_mean(verb.text, ["allow"]) or "write `# smachac: allow CODE reason`"
    return bad_allowance(verb.span, f"comments for smachac say `allow`, not `{verb.text}`", help)


def unknown_code(code: Word, known: Iterable[str]) -> Diagnostic:
    """SM022 for a code that there is not."""
    help = did_you_mean(code.text, known) or "docs/rules.md lists the codes"
    return bad_allowance(code.span, f"there is no code `{code.text}`", help)


def vain_allowance(code: Word) -> Diagnostic:
    """SM022 for an allowance of what must be mended."""
    message = f"{code.text} cannot be allowed here: no code could be made of such a machine"
    return bad_allowance(code.span, message, "mend the fault, and remove the comment")
