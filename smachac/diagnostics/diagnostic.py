"""What the compiler says: codes, findings, and the two decorators that file them.

A *problem* is declared by the phases before the IR, a *rule* judges the IR. Both are functions
whose docstring is the documentation (`smachac explain`, docs/rules.md) and, through its examples,
a test.
"""

from __future__ import annotations

import difflib
import hashlib
import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from enum import Enum
from functools import lru_cache
from pathlib import PurePath
from typing import Any, ParamSpec

from smachac.diagnostics.source import Span

P = ParamSpec("P")


class Severity(Enum):
    """How bad a finding is. Errors stop a build; warnings do so under `--strict`."""

    ERROR = "error"
    WARNING = "warning"
    INFO = "info"


@dataclass(frozen=True, slots=True, kw_only=True)
class Code:
    """A kind of finding: permanent code, name of the fault, usual severity, explanation.

    `firm`: its errors leave no machine that a target could print, so nothing silences them.
    """

    code: str
    name: str
    severity: Severity
    explanation: str
    firm: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Related:
    """Another place that a finding speaks of."""

    span: Span
    message: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Edit:
    """A stretch of a source, and the text that is to stand there instead."""

    span: Span
    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """One fault at one place: what is wrong, where, the other places, what to do.

    `path` is a witness: names of states in the order in which they are entered.
    `severity` overrides that of the code. `node` is the path of the state it is about.
    `edits` mend the fault, all of them together; none where the cure is not certain.
    """

    span: Span
    message: str
    help: str | None = None
    related: tuple[Related, ...] = ()
    path: tuple[str, ...] = ()
    severity: Severity | None = None
    node: str | None = None
    edits: tuple[Edit, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Diagnostic:
    """A finding with its code: what reports print.

    `steps` has one entry for each of the finding's `path`: where that step stands in a text, if
    it is known.
    """

    code: Code
    severity: Severity
    finding: Finding = field()
    steps: tuple[Span | None, ...] = ()

    @property
    def span(self) -> Span:
        return self.finding.span


Report = list[Diagnostic]
RuleFunction = Callable[[Any], Iterator[Finding]]

CODES: dict[str, Code] = {}
"""Every code there is, problems and rules alike."""

RULES: dict[str, RuleFunction] = {}
"""The rules over the IR by code: functions from a machine to findings."""


def _register(
    code: str, name: str, severity: Severity, function: Callable[..., Any], firm: bool
) -> Code:
    if code in CODES:
        raise ValueError(f"{code} is taken by {CODES[code].name}")
    text = function.__doc__ or ""
    CODES[code] = Code(code=code, name=name, severity=severity, explanation=text, firm=firm)
    return CODES[code]


def _diagnostic(code: Code, finding: Finding) -> Diagnostic:
    return Diagnostic(code=code, severity=finding.severity or code.severity, finding=finding)


def problem(
    code: str, name: str, severity: Severity
) -> Callable[[Callable[P, Finding]], Callable[P, Diagnostic]]:
    """Declare a fault that a phase before the IR finds: the function words it.

    As an error it is firm: nobody knows what the script would be without it.
    """

    def declare(function: Callable[P, Finding]) -> Callable[P, Diagnostic]:
        entry = _register(code, name, severity, function, severity is Severity.ERROR)

        def build(*args: P.args, **kwargs: P.kwargs) -> Diagnostic:
            return _diagnostic(entry, function(*args, **kwargs))

        build.__doc__ = function.__doc__
        build.__name__ = function.__name__
        return build

    return declare


def rule(
    code: str, name: str, severity: Severity, *, firm: bool = False
) -> Callable[[RuleFunction], RuleFunction]:
    """Declare a rule over the IR: the function yields its findings."""

    def declare(function: RuleFunction) -> RuleFunction:
        _register(code, name, severity, function, firm)
        RULES[code] = function
        return function

    return declare


def run_rules(machine: object) -> Iterator[Diagnostic]:
    """The findings of every rule over a machine, in the order of the codes."""
    for code in sorted(RULES):
        for finding in RULES[code](machine):
            yield _diagnostic(CODES[code], finding)


def identity(item: Diagnostic) -> tuple[object, ...]:
    """What two findings have in common that say the same, met through different calls: in a
    sub-script all but the names of the states around, which calls give."""
    finding, message = item.finding, item.finding.message
    if any(each.span.source is not finding.span.source for each in finding.related):
        names = set((finding.node or "").split("/"))
        message = _QUOTED.sub(lambda found: "``" if found[1] in names else found[0], message)
    return item.code.code, item.severity, item.span, message


_QUOTED = re.compile("`([^`]*)`")


def in_order(report: Iterable[Diagnostic]) -> Report:
    """A report as users read it: by file as first met, then by place; each fault once.

    A sub-script that is called twice yields the same finding twice; the second is dropped.
    """
    files: dict[int, int] = {}
    unique: dict[tuple[object, ...], Diagnostic] = {}
    for item in report:
        files.setdefault(id(item.span.source), len(files))
        unique.setdefault(identity(item), item)
    return sorted(
        unique.values(),
        key=lambda item: (
            files[id(item.span.source)],
            item.span.start,
            item.code.code,
            item.finding.message,
        ),
    )


def fingerprint(item: Diagnostic) -> str:
    """What stays of a finding when the lines around it move: 16 hexadecimal digits.

    Taken over its code and message, the name of its file and that of its state; not over the
    path of the state, which depends on the caller.
    """
    file = PurePath(item.span.source.name).name
    state = (item.finding.node or "").rpartition("/")[2]
    text = "\0".join((item.code.code, file, state, item.finding.message))
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()[:16]


def has_errors(report: Iterable[Diagnostic]) -> bool:
    return any(item.severity is Severity.ERROR for item in report)


MOST_CANDIDATES = 1000
LONGEST_WORD = 100
"""Beyond so many names, and for longer ones than this, only a difference in case is looked for, so
that no run is quadratic."""


def did_you_mean(word: str, candidates: Iterable[str]) -> str | None:
    """The help line for a misspelt name, or None when nothing is near."""
    return _nearest(word, tuple(dict.fromkeys(candidates)))


@lru_cache(maxsize=1000)
def _nearest(word: str, names: tuple[str, ...]) -> str | None:
    folded = word.casefold()
    nearest = [name for name in names if name.casefold() == folded and name != word]
    if not nearest and len(names) <= MOST_CANDIDATES and len(word) <= LONGEST_WORD:
        nearest = difflib.get_close_matches(word, names, n=1, cutoff=0.6)
    return f"did you mean `{nearest[0]}`?" if nearest else None
