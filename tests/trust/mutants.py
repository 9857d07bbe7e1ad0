"""Mutants of correct projects: what a mutation is, and how the findings about a mutant are judged.

A mutation is a function from a `Subject`, which it changes, to a `Mutant`, or to None if it does
not apply to the project.
"""

from __future__ import annotations

import copy
import random
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

from smachac.diagnostics.source import Span
from smachac.driver import Analysis
from smachac.ir.nodes import Machine, Node
from smachac.ir.traversal import walk
from tests.trust.project_text import Project, Site, Steps, Written, analysed, judged, sites, texts
from tests.trust.random_runs import missing

Place = tuple[str, Steps]
Judgement = Literal["caught", "missed", "equivalent"]
RUNS = 40
"""Runs in which a key has to be missing at least once for the loss of it to be a fault."""


@dataclass
class Subject:
    """A correct project: a copy of it that a mutation may change, and its original machine."""

    project: Project
    machine: Machine
    draw: random.Random
    nodes: dict[tuple[str, int], Node] = field(default_factory=dict)

    @classmethod
    def of(cls, project: Project) -> Subject | None:
        """The subject, if the project has no error."""
        analysis = judged(project)
        if analysis.checked is None or analysis.machine is None:
            return None
        nodes = {
            (node.span.source.name, node.span.line): node for _, node in walk(analysis.machine.root)
        }
        return cls(project, analysis.machine, random.Random(), nodes)

    def copied(self, seed: str) -> Subject:
        """A copy to change; `seed` makes its random choices repeatable."""
        return replace(self, project=copy.deepcopy(self.project), draw=random.Random(seed))

    def sites(self) -> list[Site]:
        return list(sites(self.project))

    def node(self, site: Site) -> Node | None:
        """The node of a state in the original machine; None for the body of a sub-script."""
        if not site.path:
            return self.machine.root
        lines = texts(self.project)[site.file].lines
        return self.nodes.get((site.file, lines[site.path][0]))

    def pick(self, fitting: Iterable[Site]) -> Site | None:
        found = list(fitting)
        return self.draw.choice(found) if found else None


@dataclass(frozen=True, kw_only=True)
class Mutant:
    """The finding that a changed project must bring: one of `codes` at one of `places`.

    `edit` changes the text of `file` in the end, from the line of its place. `loss`: it is a fault
    only if some run finds a key missing, and then the state that does is a right place too.
    `ends`: what is wrong has two ends, as writer and reader of a type; either may be blamed, if
    the other is shown as a related place. So are all who read a key that gets lost.
    `lines` are right places in files that are no YAML.
    """

    codes: tuple[str, ...]
    places: tuple[Place, ...] = ()
    owners: tuple[Site, ...] = ()
    edit: Callable[[list[str], int], None] | None = None
    loss: bool = False
    ends: bool = False
    lines: tuple[tuple[str, int], ...] = ()


Mutation = Callable[[Subject], "Mutant | None"]
MUTATIONS: dict[str, Mutation] = {}


def mutation(function: Mutation) -> Mutation:
    """Enter a mutation in `MUTATIONS` under its name."""
    MUTATIONS[function.__name__.replace("_", " ")] = function
    return function


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """The result for a mutant. `said` are the findings as `code file:line`."""

    judgement: Judgement
    reason: str
    files: Mapping[str, str]
    wanted: str
    said: tuple[str, ...]


def own_lines(site: Site, text: Written) -> set[int]:
    """The lines of a state without those of the states in it."""
    first, last = text.lines[site.path]
    inner = text.lines.get((*site.path, "states"), (0, -1))
    found = set(range(first, last + 1)) - set(range(inner[0] + 1, inner[1] + 1))
    return found if site.path else found | {1}


def files_of(subject: Subject, mutant: Mutant) -> dict[str, str]:
    """The files of a changed project, by name."""
    printed = texts(subject.project)
    files = {name: each.text for name, each in printed.items()}
    if mutant.edit is not None:
        ((file, steps),) = mutant.places
        rows = files[file].split("\n")
        mutant.edit(rows, printed[file].lines[steps][0] - 1)
        files[file] = "\n".join(rows)
    return files


def judge(subject: Subject, mutant: Mutant) -> Verdict:
    """Whether a right code comes at a right line; if not, whether there is a fault at all."""
    printed, files = texts(subject.project), files_of(subject, mutant)
    right = {(file, printed[file].lines[steps][0]) for file, steps in mutant.places}
    if mutant.edit is not None:
        right |= {(file, line + 1) for file, line in right}
    right |= {*mutant.lines}
    for site in mutant.owners:
        right |= {(site.file, line) for line in own_lines(site, printed[site.file])}
    analysis = analysed(files)
    losers = missing(analysis.machine, RUNS) if mutant.loss and analysis.machine else set()
    right |= readers(subject, analysis, printed, losers)
    said = tuple(
        f"{item.code} {item.span.source.name}:{item.span.line}" for item in analysis.report
    )
    others = mutant.ends or mutant.loss
    caught = any(
        line_of(span) in right
        for item in analysis.report
        if item.code in mutant.codes
        for span in (item.span, *(one.span for one in item.finding.related if others))
    )
    judgement: Judgement = "caught" if caught else "missed"
    reason = ""
    if not caught and analysis.machine is not None:
        if same(analysis.machine, subject.machine):
            judgement, reason = "equivalent", "the machine is the same"
        elif mutant.loss and not losers:
            judgement, reason = "equivalent", "no run misses the key"
    wanted = f"{' or '.join(mutant.codes)} at one of {sorted(right)}"
    return Verdict(judgement=judgement, reason=reason, files=files, wanted=wanted, said=said)


def line_of(span: Span) -> tuple[str, int]:
    return span.source.name, span.line


def readers(
    subject: Subject, analysis: Analysis, printed: Mapping[str, Written], losers: set[str]
) -> set[tuple[str, int]]:
    """The lines of the states that found a key missing, and of the containers they are in: a key
    that a container takes in is asked for at its border."""
    if not losers or analysis.machine is None:
        return set()
    losers = {
        "/".join(parts[:count])
        for parts in (path.split("/") for path in losers)
        for count in range(2, len(parts) + 1)
    }
    lines = {
        (node.span.source.name, node.span.line)
        for path, node in walk(analysis.machine.root)
        if path in losers
    }
    found = set(lines)
    for site in subject.sites():
        text = printed[site.file]
        if (site.file, text.lines[site.path][0]) in lines:
            found |= {(site.file, line) for line in own_lines(site, text)}
    return found


def same(one: Machine, other: Machine) -> bool:
    """Whether two machines do the same: implicit edges count as if they were written."""
    return _edges(one) == _edges(other)


def _edges(machine: Machine) -> list[object]:
    found: list[object] = []
    for path, node in walk(machine.root):
        steps = sorted((step.outcome, step.target) for step in node.transitions)
        kept = {
            name: getattr(node, name)
            for name in node.__dataclass_fields__
            if name not in ("transitions", "children", "span", "via", "doc")
            and not name.endswith("_span")
        }
        found.append((path, steps, kept))
    return found


def broken(subject: Subject, name: str, seed: int) -> Verdict | None:
    """The verdict on one mutant of a project; None if the mutation does not apply."""
    subject = subject.copied(f"{name}/{seed}")
    mutant = MUTATIONS[name](subject)
    return None if mutant is None else judge(subject, mutant)
