"""The findings on declarations of outcomes and states that lack or misspell a name (SM101,
SM102)."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import takewhile

from smachac.analysis.context import Context
from smachac.checks.messages import CALLED_HERE, other_place
from smachac.diagnostics.diagnostic import Finding, Related
from smachac.diagnostics.spelling import guesser, respelt
from smachac.diagnostics.wording import both
from smachac.ir.nodes import DeclarationKind, Misdeclared

MOST_USES = 3
"""The most places of a name that a finding shows."""


def misdeclared(context: Context, *kinds: DeclarationKind) -> Iterator[Finding]:
    """The findings on declarations of some kinds."""
    for each in context.machine.misdeclared:
        if each.kind in kinds:
            yield _finding(each)


def _places(each: Misdeclared) -> str:
    """The places that use a name, as a part of a sentence."""
    lines = sorted({use.span.line for use in each.uses})
    if any(use.span.source is not each.word.span.source for use in each.uses):
        return "where that name is used"
    if len(lines) == 1:
        return f"in line {lines[0]}"
    return f"in the lines {', '.join(map(str, lines[:-1]))} and {lines[-1]}"


def _finding(each: Misdeclared) -> Finding:
    word, what = each.word, "state" if each.kind == "child" else "outcome"
    users = " and ".join(each.users)
    use = "use" if len(each.users) > 1 or users.endswith("s") else "uses"
    names = both(each.meant)
    near = guesser(each.meant)
    if word.text:
        message = f"`{each.owner}` has the {what} `{word.text}`, but {users} {use} {names}"
        help = f"write {names} in place of `{word.text}`"
        if near(word.text) is not None:
            help = f"did you mean {names}?"
        if each.kind == "child" and near.sure(word.text) is None:
            help = f"write {names}, or write `{word.text}` {_places(each)}"
    else:
        more = "s" if len(each.meant) > 1 else ""
        message = f"`{each.owner}` lacks the {what}{more} {names}, which {users} {use}"
        help = f"write `{each.text}`"
        if word.span.text == each.owner:
            help = f"add `{each.text}` to `{each.owner}`"
    outside = (*takewhile(lambda call: call.source is not word.span.source, each.via),)
    shown = each.uses[:MOST_USES]
    return Finding(
        span=word.span,
        message=message,
        arguments=("" if outside else each.owner, word.text, *each.meant),
        help=help,
        effect="the program stops with an error: SMACH accepts only declared names",
        related=(
            *(part for use in shown for part in other_place(use.span, f"`{use.text}` is used")),
            *(Related(span=call, message=CALLED_HERE) for call in outside),
        ),
        node=each.path,
        edits=respelt(word, near.sure(word.text)) if word.text else (),
    )
