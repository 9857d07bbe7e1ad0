"""Errors of suppressions, the comments that allow findings."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

from smachac.diagnostics.diagnostic import (
    Diagnostic,
    Finding,
    Problem,
    Severity,
    did_you_mean,
    problem,
)
from smachac.diagnostics.repair import Edit
from smachac.diagnostics.source import Span, Word

_CODE = r"[A-Za-z]{2}\d+"
_COMMENT = re.compile(r"#[^\S\n]*smachac:\s*allow(?P<codes>(?:[^\S\n]+[A-Za-z]{2}\d+\b[,:]?)+)")
_BEHIND = re.compile(r"[,:]?[^\S\n]*")


@problem(
    "SM021",
    "unused-allowance",
    Severity.WARNING,
    effect="the comment would hide the next finding of this code here",
)
def unused_allowance(code: Word, edits: tuple[Edit, ...] = (), instead: str = "") -> Finding:
    """A comment allows a finding that does not occur on its line.

    The fault was corrected or never existed, and the comment would hide the next fault of that
    kind. In a sub-script this is reported only when a folder is checked, because another script may
    need the comment.

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
        message=f"{code.text} is allowed here, but does not occur here",
        arguments=(code.text,),
        help=f"on this line {instead} occurs: correct its fault, or write `allow {instead}`"
        if instead
        else "remove the comment, or move it to the line on which the finding occurs",
        edits=() if instead else edits,
    )


def unused_allowances(
    codes: Iterable[Word], instead: Mapping[Span, str] | None = None
) -> list[Diagnostic]:
    """SM021 for each of these codes. The edits of one remove all unused codes of its comment.
    `instead` are the codes that are probably meant, by the places of those in the comments."""
    lines: dict[tuple[int, int], list[Span]] = {}
    known = [(code, (id(code.span.source), code.span.line)) for code in codes]
    for code, line in known:
        lines.setdefault(line, []).append(code.span)
    cures = {line: _without(spans) for line, spans in lines.items()}
    meant = instead or {}
    return [unused_allowance(code, cures[line], meant.get(code.span, "")) for code, line in known]


def _without(codes: list[Span]) -> tuple[Edit, ...]:
    """The edits that remove codes of one comment; the comment, if that has no other; and the
    line, if that holds nothing else."""
    source = codes[0].source
    text = source.text
    start = text.rfind("\n", 0, codes[0].start) + 1
    end = text.find("\n", codes[0].end)
    end = len(text) if end < 0 else end
    every = _COMMENT.finditer(text, start, end)
    found = next((match_ for match_ in every if codes[0].start < match_.end()), None)
    if found is None:
        return ()
    if len(re.findall(_CODE, found["codes"])) > len(codes):
        behind = [_BEHIND.match(text, code.end, end) for code in codes]
        ends = [match_.end() for match_ in behind if match_ is not None]
        pairs = zip(codes, ends, strict=True)
        return tuple(Edit(span=Span(source, code.start, to), text="") for code, to in pairs)
    begin = start + len(text[start : found.start()].rstrip(" \t"))
    if begin == start:
        return (Edit(span=Span(source, start, min(end + 1, len(text))), text=""),)
    end -= text[end - 1] == "\r"
    return (Edit(span=Span(source, begin, end), text=""),)


@problem("SM022", "bad-allowance", Severity.WARNING)
def bad_allowance(
    span: Span, message: str, help: str, arguments: tuple[str, ...], effect: str = ""
) -> Finding:
    """A comment for smachac has no reason, is misspelt, or allows a finding that it must not allow.

    Without a reason, the next reader cannot decide whether the robot is safe. A finding that makes
    it impossible to generate a program cannot be allowed.

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
    return Finding(span=span, message=message, arguments=arguments, help=help, effect=effect)


VAIN = "the comment allows nothing"


def unfounded_allowance(span: Span, *, named: bool) -> Diagnostic:
    """SM022 for a comment without a reason or, if no code is `named`, without a code."""
    missing = "reason" if named else "code"
    effect = "without a reason, nobody can decide later whether the finding may still be allowed"
    help = f"write the {missing} after `allow`, as in `# smachac: allow SM201 REASON`"
    if named:
        help = f"write your reason after the code: `{span.text.strip()} REASON`"
    message = f"this `allow` comment has no {missing}"
    return bad_allowance(span, message, help, ("missing", missing), effect if named else VAIN)


def bad_comment(verb: Word) -> Diagnostic:
    """SM022 for a comment with another word than `allow`."""
    help = did_you_mean(verb.text, ["allow"]) or "write `# smachac: allow CODE reason`"
    message = f"a comment for smachac must begin with `allow`, not with `{verb.text}`"
    return bad_allowance(verb.span, message, help, ("verb", verb.text), VAIN)


def vain_description(comment: Span) -> Diagnostic:
    """SM022 for a comment about the outcomes or keys of a state that has no effect."""
    message = "this comment describes no state that is unknown"
    help = "remove it, or write it at the call that adds the state, with names: `outcomes a, b`"
    return bad_allowance(comment, message, help, ("state", comment.text), "")


def unknown_code(code: Word, known: Iterable[str]) -> Diagnostic:
    """SM022 for a code that does not exist."""
    help = did_you_mean(code.text, known) or "`smachac explain --all` lists the codes"
    message = f"the code `{code.text}` does not exist"
    return bad_allowance(code.span, message, help, ("code", code.text), VAIN)


def vain_allowance(code: Word) -> Diagnostic:
    """SM022 for an allowance of an unsuppressible finding."""
    message = f"{code.text} cannot be allowed: no program can be generated with this fault"
    help = "correct the fault, and remove the comment"
    return bad_allowance(code.span, message, help, ("firm", code.text))


PROBLEMS: tuple[Problem[...], ...] = (
    unused_allowance,
    bad_allowance,
)
"""The problems of this module, in the order of their codes."""
