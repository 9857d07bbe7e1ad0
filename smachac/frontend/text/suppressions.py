"""Suppressions: comments `# smachac: allow SM201 reason`, and the findings that they silence."""

from __future__ import annotations

import contextlib
import io
import re
from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from smachac.diagnostics.diagnostic import Code, Report
from smachac.diagnostics.severities import is_firm
from smachac.diagnostics.source import Source, Span, Word
from smachac.frontend.errors.suppressions import (
    bad_comment,
    unfounded_allowance,
    unknown_code,
    unused_allowances,
    vain_allowance,
)
from smachac.frontend.text.yaml_tree import Map, Scalar, Seq, Tree, parse


class Suppression(NamedTuple):
    """One code of a comment `# smachac: allow SM201 reason`, and the line that it applies to."""

    code: str
    span: Span
    line: int


Parser = Callable[[Source, Report], "Tree | None"]
"""`yaml_tree.parse`, or a function that returns a tree it made before."""

MARK = "smachac:"
_COMMENT = r"(?:^|(?<=\s))#[^\S\n]*smachac:[^\S\n]*(?P<verb>[^\s]*)(?P<rest>[^\n]*)"
_CODE = re.compile(r"[^\S\n]*(?P<code>[A-Za-z]{2}\d+)\b[,:]?")


def suppressions_in(
    source: Source, report: Report, codes: Mapping[str, Code], parse: Parser = parse
) -> list[Suppression]:
    """The suppressions of a text, in its order. SM022 for a comment that is incomplete or names a
    code that is not in `codes`.

    A comment at the end of a line applies to that line, a comment on a line of its own to the next
    line that has more than a comment.
    """
    if MARK not in source.text:
        return []
    hidden = _scalars(source, parse)
    applied = _lines_applied_to(source)
    found: list[Suppression] = []
    for comment in re.finditer(_COMMENT, source.text, re.M):
        before = bisect_right(hidden, (comment.start(), len(source.text)))
        if before and comment.start() < hidden[before - 1][1]:
            continue
        span = Span(source, comment.start(), comment.start() + len(comment.group().rstrip()))
        if source.name.endswith(".py") and _is_about_a_state(comment["verb"]):
            continue
        if comment["verb"] != "allow":
            word = Word(comment["verb"], Span(source, *comment.span("verb")))
            report.append(bad_comment(word))
            continue
        found += _codes(source, comment, span, applied, report, codes)
    return found


def _is_about_a_state(verb: str) -> bool:
    """Whether a comment in Python describes a state, and allows nothing."""
    from smachac.pysource.machines.state_comments import VERBS

    return verb in VERBS


def _scalars(source: Source, parse: Parser) -> list[tuple[int, int]]:
    """The ranges of a text, in order, that are values of YAML or strings of Python: `#` starts no
    comment in them."""
    if source.name.endswith(".py"):
        return [*_strings(source)]
    tree = parse(source, [])
    return sorted((span.start, span.end) for span in _spans(tree)) if tree is not None else []


def _strings(source: Source) -> Iterator[tuple[int, int]]:
    """The ranges of the strings of a Python text, in order, as far as it can be read."""
    starts = source.line_starts
    import tokenize

    with contextlib.suppress(tokenize.TokenError, SyntaxError):
        for token in tokenize.generate_tokens(io.StringIO(source.text, newline="\n").readline):
            if MARK in token.string and token.type != tokenize.COMMENT:
                (first, column), (last, end) = token.start, token.end
                yield starts[first - 1] + column, starts[last - 1] + end


def _spans(tree: Tree) -> Iterator[Span]:
    todo: list[Tree] = [tree]
    seen: set[tuple[type, Span]] = set()
    while todo:
        here = todo.pop()
        if (type(here), here.span) in seen:  # an alias is the tree of its anchor
            continue
        seen.add((type(here), here.span))
        match here:
            case Scalar():
                if MARK in here.span.text:
                    yield here.span
            case Seq():
                todo.extend(here.items)
            case Map():
                todo.extend(part for entry in here.entries for part in (entry.key, entry.value))


def _codes(
    source: Source,
    comment: re.Match[str],
    span: Span,
    applied: Sequence[int],
    report: Report,
    known: Mapping[str, Code],
) -> Iterator[Suppression]:
    line, column = source.position(comment.start())
    if not source.line(line)[: column - 1].strip():
        line = applied[line]
    at, end = comment.start("rest"), comment.end("rest")
    words = []
    while (word := _CODE.match(source.text, at, end)) is not None:
        words.append(Word(word["code"].upper(), Span(source, *word.span("code"))))
        at = word.end()
    for code in words:
        if code.text not in known:
            report.append(unknown_code(code, known))
        else:
            yield Suppression(code.text, code.span, line)
    if not words or not source.text[at:end].strip(" \t\r:,-"):
        report.append(unfounded_allowance(span, named=bool(words)))


def _lines_applied_to(source: Source) -> list[int]:
    """For each line, counted from 1, the next line that has more than a comment."""
    last = len(source.line_starts)
    applied = [last] * (last + 1)
    for number in range(last - 1, 0, -1):
        text = source.line(number + 1).strip()
        applied[number] = number + 1 if text and text[0] != "#" else applied[number + 1]
    return applied


class Suppressed(NamedTuple):
    """A report after suppressions: what is left, every suppression, and those in other texts than
    the main script that suppressed nothing."""

    rest: Report
    given: tuple[Suppression, ...]
    unused: tuple[Suppression, ...]


def suppress(
    report: Report,
    main: Source,
    sources: Iterable[Source],
    codes: Mapping[str, Code],
    parse: Parser = parse,
    *,
    complete: bool = True,
) -> Suppressed:
    """Apply the suppressions of all texts of a script and of the texts that have findings.

    SM021 for a suppression of the main script that suppressed nothing, if the report is `complete`:
    no rule judges a script that cannot be read.
    """
    texts = dict.fromkeys((*sources, *(item.span.source for item in report)))
    given = [fit for text in texts for fit in suppressions_in(text, report, codes, parse)]
    rest, used = apply_suppressions(report, given)
    unused = [fit for fit in given if complete and fit not in used]
    own = [fit for fit in unused if fit.span.source is main]
    words = [Word(fit.code, fit.span) for fit in own]
    rest += unused_allowances(words, _codes_instead(own, rest) if own else {})
    others = tuple(fit for fit in unused if fit.span.source is not main)
    return Suppressed(rest, tuple(given), others)


def _codes_instead(unused: Iterable[Suppression], report: Report) -> dict[Span, str]:
    """The code of the only finding on the line that a suppression without effect applies to, which
    is probably meant, by the place of the suppression."""
    codes: dict[tuple[Source, int], set[str]] = {}
    for item in report:
        codes.setdefault((item.span.source, item.span.line), set()).add(item.code)
    found = ((fit, codes.get((fit.span.source, fit.line), set())) for fit in unused)
    return {fit.span: next(iter(here)) for fit, here in found if len(here) == 1}


def apply_suppressions(
    report: Report, given: Sequence[Suppression]
) -> tuple[Report, set[Suppression]]:
    """Apply suppressions: the findings that are left, and the suppressions that were used.

    An unsuppressible finding cannot be suppressed; a suppression of one is reported (SM022).
    """
    if not given:
        return report, set()
    by_line: dict[tuple[Source, int, str], Suppression] = {}
    for suppression in given:
        by_line.setdefault(
            (suppression.span.source, suppression.line, suppression.code), suppression
        )
    kept, used = [], set()
    for item in report:
        fit = by_line.get((item.span.source, item.span.line, item.code))
        if fit is not None and fit not in used and is_firm(item):
            kept.append(vain_allowance(Word(fit.code, fit.span)))
        if fit is not None:
            used.add(fit)
        if fit is None or is_firm(item):
            kept.append(item)
    return kept, used
