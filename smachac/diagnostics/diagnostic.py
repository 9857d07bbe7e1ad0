"""Codes, findings, diagnostics, and problems: the faults that are found outside the rules.

A *problem* is a function that makes the finding of one code. Its docstring is the explanation of
the code (`smachac explain`, docs/rules.md), and the examples in it are a test, as for the rules
(smachac/checks).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from enum import Enum
from functools import lru_cache
from typing import Generic, ParamSpec

from smachac.diagnostics.negation import are_unlike
from smachac.diagnostics.repair import Certainty, Edit, Repair
from smachac.diagnostics.source import Source, Span
from smachac.diagnostics.wording import listed
from smachac.records import dataclass, field, replace

P = ParamSpec("P")


class Severity(Enum):
    """How bad a finding is. Errors stop a build; warnings do so under `--strict`."""

    ERROR = "error"
    WARNING = "warning"
    INFO = "info"


@dataclass(frozen=True, slots=True, kw_only=True)
class Code:
    """A kind of finding: permanent code, name of the fault, usual severity, explanation.

    `unsuppressible`: its errors leave no machine that a target could print, so no setting hides
    them.
    `effect`: what happens if the fault is left; empty if the messages contain it.
    """

    code: str
    name: str
    severity: Severity
    explanation: str
    unsuppressible: bool = False
    effect: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Related:
    """Another place of a finding, with a message of its own."""

    span: Span
    message: str


@dataclass(frozen=True, slots=True)
class PathStep:
    """One step of a witness path: a state that is entered, or an outcome that it ends with.

    `label` is what is printed, `node` the path of the state; an outcome has none.
    """

    label: str
    node: str | None = None
    is_outcome: bool = False


def entered(name: str, path: str | None) -> PathStep:
    """The state of a name is entered; `path` is its path."""
    return PathStep(name, path)


def ended(outcome: str) -> PathStep:
    """The state of the step before ends with an outcome."""
    return PathStep(f"({outcome})", is_outcome=True)


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """One fault at one place: what is wrong, where, the other places, what to do.

    `arguments` are the names that the finding is about, in an order fixed for its code, as written
    where it stands: they do not depend on who calls a sub-script. Identity, fingerprints and
    baselines use them instead of the message.
    `effect` is what happens if the fault is left; it overrides that of the code, and an empty one
    leaves it out, for a message that contains it.
    `path` is a witness: the states that are entered, in order, and the outcomes between them.
    `severity` overrides that of the code. `node` is the path of the state that it is about.
    `edits` are the safe repair of the fault, all of them together; empty without one. `repairs` are
    others, the best first.
    Findings of one code with the same `group` in one container are shown as one (`grouped`).
    """

    span: Span
    message: str
    arguments: tuple[str, ...] = ()
    help: str | None = None
    effect: str | None = None
    related: tuple[Related, ...] = ()
    path: tuple[PathStep, ...] = ()
    severity: Severity | None = None
    node: str | None = None
    edits: tuple[Edit, ...] = ()
    group: tuple[str, ...] = ()
    repairs: tuple[Repair, ...] = ()

    @property
    def all_repairs(self) -> tuple[Repair, ...]:
        """The repairs, the safe one first."""
        if not self.edits:
            return self.repairs
        safe = Repair(edits=self.edits, certainty=Certainty.SAFE, operator="correct")
        return (safe, *self.repairs)

    @property
    def path_labels(self) -> tuple[str, ...]:
        """The steps of the witness path as they are printed."""
        return tuple([step.label for step in self.path])


@dataclass(frozen=True, slots=True, kw_only=True)
class Diagnostic:
    """A finding with its kind: what reports print.

    `steps` has one entry for each step of the finding's `path`: the span of its state, if known.
    """

    kind: Code
    severity: Severity
    finding: Finding = field()
    steps: tuple[Span | None, ...] = ()

    @property
    def code(self) -> str:
        """The permanent code, such as `SM201`."""
        return self.kind.code

    @property
    def message(self) -> str:
        """What is wrong."""
        return self.finding.message

    @property
    def span(self) -> Span:
        """Where it is wrong."""
        return self.finding.span

    @property
    def help(self) -> str | None:
        """What to do, if that is known."""
        return self.finding.help

    @property
    def effect(self) -> str:
        """What happens if the fault is left; empty if the message contains it."""
        return self.kind.effect if self.finding.effect is None else self.finding.effect

    @property
    def related(self) -> tuple[Related, ...]:
        """Other places, each with a message."""
        return self.finding.related


Report = list[Diagnostic]


def diagnostic(code: Code, finding: Finding, steps: tuple[Span | None, ...] = ()) -> Diagnostic:
    """The diagnostic of a finding: its own severity, or else that of the code."""
    severity = finding.severity or code.severity
    return Diagnostic(kind=code, severity=severity, finding=finding, steps=steps)


@dataclass(frozen=True, slots=True)
class Problem(Generic[P]):
    """A code, and the function that makes its finding; a call returns the diagnostic."""

    code: Code
    function: Callable[P, Finding]

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> Diagnostic:
        return diagnostic(self.code, self.function(*args, **kwargs))


def problem(
    code: str, name: str, severity: Severity, *, effect: str = "", unsuppressible: bool = True
) -> Callable[[Callable[P, Finding]], Problem[P]]:
    """Make a problem of the function that makes its finding.

    An error is unsuppressible, if nothing else is said: a script with such a fault has no meaning.
    """

    def declare(function: Callable[P, Finding]) -> Problem[P]:
        entry = Code(
            code=code,
            name=name,
            severity=severity,
            explanation=function.__doc__ or "",
            unsuppressible=unsuppressible and severity is Severity.ERROR,
            effect=effect,
        )
        return Problem(entry, function)

    return declare


def identity(item: Diagnostic) -> tuple[object, ...]:
    """What makes a finding one fault: equal for a fault of a sub-script that is found through each
    of its calls."""
    return item.code, item.severity, item.span, item.finding.arguments


def in_order(report: Iterable[Diagnostic]) -> Report:
    """A report as users read it: by file as first met, then by place; each fault once.

    A sub-script that is called twice yields the same finding twice; the second is dropped.
    """
    files: dict[Source, int] = {}
    unique: dict[tuple[object, ...], Diagnostic] = {}
    for item in report:
        files.setdefault(item.span.source, len(files))
        unique.setdefault(identity(item), item)
    return sorted(
        unique.values(),
        key=lambda item: (
            files[item.span.source],
            item.span.start,
            item.code,
            item.finding.arguments,
        ),
    )


MOST_RELATED = 5
"""The most places of a group that are shown beside the first one."""


def grouped(report: Report) -> Report:
    """A report in order, in which the findings of a group are one at the place of the first, with
    the group as arguments. Suppressions apply before, each to its own state."""
    groups: dict[tuple[object, ...], Report] = {}
    for at, item in enumerate(report):
        found = item.finding
        around = (found.node or "").rpartition("/")[0]
        key = (item.code, item.severity, item.span.source, around, found.group)
        groups.setdefault(key if found.group else (at,), []).append(item)
    return [items[0] if len(items) == 1 else _as_one(items) for items in groups.values()]


def _as_one(items: Report) -> Diagnostic:
    first, others = items[0].finding, [item.finding for item in items[1:]]
    around, _, _ = (first.node or "").rpartition("/")
    names = listed((other.node or "").rpartition("/")[2] for other in others)
    shown = (Related(span=other.span, message="the same here") for other in others[:MOST_RELATED])
    finding = replace(
        first,
        message=f"{first.message}; the same holds for {names}",
        arguments=first.group,
        related=(*first.related, *shown),
        node=around,
    )
    return replace(items[0], finding=finding)


def fingerprint(item: Diagnostic) -> str:
    """What stays of a finding when the lines around it move or its message is reworded: 16
    hexadecimal digits.

    Taken over its code and arguments, the name of its file and that of its state; not over the
    path of the state, which depends on the caller.
    """
    import hashlib

    file = item.span.source.file_name
    state = (item.finding.node or "").rpartition("/")[2]
    text = "\0".join((item.code, file, state, *item.finding.arguments))
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()[:16]


def has_errors(report: Iterable[Diagnostic]) -> bool:
    return any(item.severity is Severity.ERROR for item in report)


MOST_CANDIDATES = 1000
LONGEST_WORD = 100
"""With more names, and for longer ones, only a difference in case is considered: a comparison takes
quadratic time."""


def did_you_mean(word: str, candidates: Iterable[str]) -> str | None:
    """The help line for a misspelt name, or None when nothing is near."""
    near = _nearest(word, tuple(dict.fromkeys(candidates)))
    return None if near is None else f"did you mean `{near}`?"


def did_you_mean_file(name: str, candidates: Iterable[str]) -> str | None:
    """The help line for a misspelt name of a file, or None when nothing is near. Endings such as
    `.yml` are not compared, because files of one kind share theirs; a candidate with the same
    ending comes first."""
    stem, ending = _stem_and_ending(name)
    parts = [(*_stem_and_ending(candidate), candidate) for candidate in candidates]
    parts.sort(key=lambda part: part[1] != ending)
    by_stem = {part[0]: part[2] for part in reversed(parts)}
    near = stem if stem in by_stem else _nearest(stem, tuple(by_stem))
    near = near or _only_part(stem, by_stem)
    return None if near is None else f"did you mean `{by_stem[near]}`?"


def _only_part(stem: str, names: Iterable[str]) -> str | None:
    """The only name whose words, separated by `_`, are all in a name, or have all of its words:
    `drop` for `drop_block`."""
    words = set(stem.casefold().split("_"))
    found = [
        name for name in names
        if (others := set(name.casefold().split("_"))) <= words or words <= others
    ]  # fmt: skip
    return found[0] if len(found) == 1 else None


def _stem_and_ending(name: str) -> tuple[str, str]:
    """The parts of a path before and after the first dot in its last name: `robots/arm` and
    `urdf.xacro`."""
    folder, slash, last = name.rpartition("/")
    stem, _, ending = last.partition(".")
    return f"{folder}{slash}{stem}", ending


# Cached, because a misspelt word is often repeated: without, a check of 1,000 states with the same
# misspelt template takes twice as long.
@lru_cache(maxsize=1000)
def _nearest(word: str, names: tuple[str, ...]) -> str | None:
    folded = word.casefold()
    nearest = [name for name in names if name.casefold() == folded and name != word]
    if not nearest and len(names) <= MOST_CANDIDATES and len(word) <= LONGEST_WORD:
        import difflib

        nearest = difflib.get_close_matches(word, names, n=1, cutoff=0.6)
    if not nearest or are_unlike(word, nearest[0]):
        return None
    return nearest[0]
