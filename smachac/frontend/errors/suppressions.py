"""The faults of the comments that allow findings."""

from __future__ import annotations

import re
from collections.abc import Iterable

from smachac.diagnostics.diagnostic import (
    Diagnostic,
    Edit,
    Finding,
    Problem,
    Severity,
    did_you_mean,
    problem,
)
from smachac.diagnostics.source import Span, Word

_CODE = re.compile(r"[A-Za-z]{2}\d+")
_COMMENT = re.compile(r"#[^\S\n]*smachac:\s*allow(?P<codes>(?:[^\S\n]+[A-Za-z]{2}\d+\b[,:]?)+)")
_BEHIND = re.compile(r"[,:]?[^\S\n]*")


@problem("SM021", "unused-allowance", Severity.WARNING)
def unused_allowance(code: Word, edits: tuple[Edit, ...] = ()) -> Finding:
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
        edits=edits,
    )


def unused_allowances(codes: Iterable[Word]) -> list[Diagnostic]:
    """SM021 for each of these, with the edits that remove all of its comment's."""
    lines: dict[tuple[int, int], list[Span]] = {}
    known = [(code, (id(code.span.source), code.span.line)) for code in codes]
    for code, line in known:
        lines.setdefault(line, []).append(code.span)
    cures = {line: _without(spans) for line, spans in lines.items()}
    return [unused_allowance(code, cures[line]) for code, line in known]


def _without(codes: list[Span]) -> tuple[Edit, ...]:
    """The edits that remove codes of one comment; the comment, if that has no other; and the
    line, if that holds nothing else."""
    source = codes[0].source
    text = source.text
    start = text.rfind("\n", 0, codes[0].start) + 1
    end = text.find("\n", codes[0].end)
    end = len(text) if end < 0 else end
    every = _COMMENT.finditer(text, start, end)
    found = next((each for each in every if codes[0].start < each.end()), None)
    if found is None:
        return ()
    if len(_CODE.findall(found["codes"])) > len(codes):
        behind = [_BEHIND.match(text, code.end, end) for code in codes]
        ends = [each.end() for each in behind if each is not None]
        pairs = zip(codes, ends, strict=True)
        return tuple(Edit(span=Span(source, code.start, to), text="") for code, to in pairs)
    begin = start + len(text[start : found.start()].rstrip(" \t"))
    if begin == start:
        return (Edit(span=Span(source, start, min(end + 1, len(text))), text=""),)
    end -= text[end - 1] == "\r"
    return (Edit(span=Span(source, begin, end), text=""),)


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


PROBLEMS: tuple[Problem[...], ...] = (
    unused_allowance,
    bad_allowance,
)
"""The problems of this module, in the order of their codes."""
