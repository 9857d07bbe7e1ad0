"""The search for what was meant: repairs of rules and of operators, each tried by a new check.

A repair is proven if the script with it has fewer findings, none that is new, and if no less of it
is understood: a state of an unknown type silences rules and corrects nothing. If more of it is
understood, new findings are allowed. Literature: Lerner
et al., Searching for type-error messages, PLDI 2007; Chen and Erwig, Counter-factual typing for
debugging type errors, POPL 2014.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from functools import cache
from itertools import chain
from pathlib import PurePath
from typing import NamedTuple, TypeAlias

from smachac.diagnostics.clusters import Cluster
from smachac.diagnostics.diagnostic import Diagnostic, Report, Severity, identity
from smachac.diagnostics.repair import Certainty, Repair, edited_texts
from smachac.diagnostics.source import Source
from smachac.driver import Analysis, IncrementalState, MachineCheck, analyse
from smachac.driver.batch import Batch, analyse_alone
from smachac.frontend.config import PROJECT_FILES
from smachac.frontend.loader import Library
from smachac.frontend.text.pieces import PieceTrees
from smachac.frontend.text.recovering_parser import parse_with_recovery
from smachac.frontend.text.yaml_tree import Tree
from smachac.ir.nodes import Leaf, Machine
from smachac.ir.traversal import walk
from smachac.records import replace
from smachac.repair.operators import (
    NAME,
    Around,
    Candidate,
    Vocabulary,
    are_alike,
    candidates,
    text_of,
    vocabulary_of,
)

MOST_CLUSTERS = 10
"""The most findings of a script for which a repair is searched."""

MOST_CHECKED = 100_000
"""The most that all trials of a script check together, in units of `_size`: each trial is a check
of the whole script, so that large ones get few trials."""

CHARACTERS = 20
"""The characters of a text that take about as long as one part of a machine."""

MOST_FINDINGS = 100
"""In a report of more findings nothing is searched."""

MOST_REVEALING = 1.5
"""Up to this cost, a repair after which more texts or types are understood can reveal other
findings: the name that it writes is like the one that it replaces."""

ONE_SLIP = 1.0
"""The same for a repair after which more names of transitions are known."""

Again: TypeAlias = "Callable[[Mapping[Source, str]], Analysis]"
"""A function that analyses a script again after changes of its texts."""

Mark: TypeAlias = "tuple[str, Severity, str, tuple[str, ...]]"
"""What stays of a finding when other text moves."""


class Unknown(NamedTuple):
    """How much of a script is not understood, in the order of the phases: texts that could not be
    read, states of an unknown type, and transitions with an unknown name."""

    unread: int
    unresolved: int
    unnamed: int


def clusters_of(
    batch: Batch, shown: Report, extra: MachineCheck | None = None
) -> tuple[Cluster, ...]:
    """The clusters of the findings that are shown, of all scripts of a batch. They are disjoint.

    `extra`: see `analyse`.
    """
    found: list[Cluster] = []
    wanted = {identity(item) for item in shown}
    for name, known in batch.analyses.items():
        mine = [item for item in known.report if identity(item) in wanted and _is_tried(item)]
        most = MOST_CLUSTERS - len(found)
        if not most or all(item.severity is Severity.INFO for item in mine):
            continue
        analysis = batch.whole(name)
        for cluster in clusters(analysis, mine, again(analysis, extra), most):
            found.append(cluster)
            wanted -= {identity(item) for item in (cluster.finding, *cluster.explained)}
    return (*found,)


def _is_tried(item: Diagnostic) -> bool:
    """Whether a trial can find a finding again: it does not read the project file."""
    return PurePath(item.span.source.name).name not in PROJECT_FILES


def again(analysis: Analysis, extra: MachineCheck | None = None) -> Again:
    """The function that analyses the script of an analysis after changes of its texts. An analysis
    uses what did not change since the one before, whose places move: it ends where the next one
    begins."""
    source, library = analysis.source, analysis.library
    previous, pieces = IncrementalState(), PieceTrees()

    def analysed(texts: Mapping[Source, str]) -> Analysis:
        assert source is not None
        assert library is not None
        changed = {old.name: Source(old.name, text) for old, text in texts.items()}
        own = _with_texts(library, changed, pieces)
        new = changed.get(source.name, source)
        if analysis.alone:
            return analyse_alone(new, own, [])
        return analyse(new, own, [], extra, render=True, previous=previous)

    return analysed


def _with_texts(library: Library, changed: Mapping[str, Source], pieces: PieceTrees) -> Library:
    """A library with other texts for some files."""
    new = {*changed.values()}

    def parsed(source: Source, report: Report) -> Tree | None:
        if source not in new:
            return library.parse(source, report)
        return pieces.parse(source) or parse_with_recovery(source, report)

    def now(found: Source | None) -> Source | None:
        return found if found is None else changed.get(found.name, found)

    return replace(
        library,
        script=lambda name, caller: now(library.script(name, caller)),
        template=lambda file: now(library.template(file)),
        own_template=lambda file: now(library.own_template(file)),
        release=lambda source: None,
        parse=parsed,
    )


def clusters(
    analysis: Analysis, shown: Report, analysed: Again, most: int = MOST_CLUSTERS
) -> list[Cluster]:
    """The clusters of the errors and warnings that are shown, in order; at most `most`. Of two
    repairs that correct the same finding, the first one by `_rank` is taken."""
    if analysis.source is None or analysis.library is None:
        return []
    types, own_template = _interfaces(analysis.library), analysis.library.own_template
    read = cache(lambda source: text_of(source, analysis.machine, types))
    interface = cache(lambda name: own_template(f"{name}.yml") if name else None)
    serious = [item for item in shown if item.severity is not Severity.INFO]
    if len(serious) > MOST_FINDINGS:
        return []
    if any(item.code == "SM704" for item in analysis.report):
        return []  # a property that takes all of its limit takes it again in each trial
    texts = {analysis.source, *(item.span.source for item in serious[:MOST_CLUSTERS])}
    # To read the texts for the operators takes about as long as one trial.
    trials = MOST_CHECKED // _size(texts, analysis.machine) - 1
    vocabulary = vocabulary_of(_texts(analysis, texts, interface), analysis.machine, types)
    proven: list[Proof] = []
    for item in sorted(serious, key=_is_no_error)[:MOST_CLUSTERS]:
        if trials <= 0:
            break
        rest = [other for other in serious if other is not item]
        named = (other.finding.arguments for other in rest)
        around = Around(read, [*chain.from_iterable(named)], types, interface, vocabulary)
        wrong = {other.span.text for other in rest if _has_same_fault(other, item)}
        proposed = [made for made in _proposals(item, around) if not _writes_one_of(made, wrong)]
        proof = _proof(item, analysis, analysed, proposed[:trials])
        trials -= len(proposed)
        if proof is not None:
            proven.append(proof)
    gone = {id(item) for proof in proven for item in _gone(proof, serious)}
    left = [item for item in serious if id(item) not in gone]
    proven = [_only_possible(proof) if _is_doubtful(proof, left) else proof for proof in proven]
    found: dict[int, Cluster] = {}
    covered: set[int] = set()
    for proof in sorted(proven, key=_rank):
        members = [item for item in _gone(proof, serious) if id(item) not in covered]
        if id(proof.item) not in covered and len(found) < most:
            others = tuple(item for item in members if item is not proof.item)
            repair = proof.candidate.repair
            found[id(proof.item)] = Cluster(finding=proof.item, repair=repair, explained=others)
            covered.update(map(id, (proof.item, *others)))
    return [found[id(item)] for item in serious if id(item) in found]


def _texts(
    analysis: Analysis, texts: Iterable[Source], interface: Callable[[str], Source | None]
) -> Iterable[str]:
    """The texts of a project: scripts, the user's interfaces, and classes of Python."""
    found: dict[Source | None, None] = dict.fromkeys(texts)
    if analysis.machine is not None:
        found.update(dict.fromkeys(node.span.source for _, node in walk(analysis.machine.root)))
        found.update((interface(name), None) for name in analysis.machine.state_types)
    if analysis.library is not None:
        found.update(dict.fromkeys(source for _, source in analysis.library.modules))
    return [source.text for source in found if source is not None]


def _size(texts: Iterable[Source], machine: Machine | None) -> int:
    """What a check of a script costs: the states, outcomes, transitions and keys of its machine, or
    the length of the texts where that is more."""
    parts = 0 if machine is None else sum(
        1 + sum(map(len, (node.outcomes, node.transitions, node.inputs, node.outputs)))
        for _, node in walk(machine.root)
    )  # fmt: skip
    return max(1, parts, sum(len(source.text) for source in texts) // CHARACTERS)


MOST_TYPES = 200
"""Of more state types, none is proposed in place of another: each has to be read."""


def _interfaces(library: Library) -> dict[str, str]:
    """The names of all state types with the texts of their interfaces."""
    names = library.template_names()
    if len(names) > MOST_TYPES:
        return dict.fromkeys(names, "")
    found = ((name, library.template(f"{name}.yml")) for name in names)
    return {name: source.text if source is not None else "" for name, source in found}


class Proof(NamedTuple):
    """A candidate that corrects a finding, and the findings that are left then."""

    item: Diagnostic
    candidate: Candidate
    left: Counter[Mark]


def _is_doubtful(proof: Proof, left: Iterable[Diagnostic]) -> bool:
    """Whether a repair may correct a consequence of a fault for which no repair is proven: `left`
    are the findings that are left after all repairs. One of them is about a name of the finding or
    of the edits, or it is an error, from which a warning can follow."""
    edits, item = proof.candidate.repair.edits, proof.item
    changed = (_names([edit.span.text]) ^ _names([edit.text]) for edit in edits)
    names = _names(item.finding.arguments).union(*changed)
    return any(
        names & _names(other.finding.arguments) or _is_no_error(item) > _is_no_error(other)
        for other in left
    )


def _names(texts: Iterable[str]) -> set[str]:
    return {name for text in texts for name in NAME.findall(text)}


def _only_possible(proof: Proof) -> Proof:
    repair = replace(proof.candidate.repair, certainty=Certainty.POSSIBLE)
    return proof._replace(candidate=proof.candidate._replace(repair=repair))


def _rank(proof: Proof) -> tuple[int, bool, bool, bool, bool]:
    """What a report names first: the repair after which fewer findings are left, then a likely one,
    then the one of an error, then one of a rule, then the one on the line of its finding."""
    item = proof.item
    place = proof.candidate.repair.edits[0].span
    is_there = place.source is item.span.source and place.line == item.span.line
    is_own = any(
        proof.candidate.repair.edits == repair.edits for repair in item.finding.all_repairs
    )
    is_possible = proof.candidate.repair.certainty is Certainty.POSSIBLE
    return (proof.left.total(), is_possible, _is_no_error(item), not is_own, not is_there)


def _is_no_error(item: Diagnostic) -> bool:
    return item.severity is not Severity.ERROR


def _proof(
    item: Diagnostic, analysis: Analysis, analysed: Again, proposed: Sequence[Candidate]
) -> Proof | None:
    """The candidate after which the fewest findings are left; None if none corrects the finding."""
    best: Proof | None = None
    before, marks = unknown(analysis), _marks(analysis.report)
    for candidate in proposed:
        after = analysed(edited_texts(candidate.repair.edits))
        left, still = _marks(after.report), unknown(after)
        if still > before or left[_mark(item)] >= marks[_mark(item)]:
            continue
        more = MOST_REVEALING if still[:2] < before[:2] else ONE_SLIP
        if left - marks and (still == before or candidate.cost > more):
            continue
        if _leaves_its_type(item, candidate, analysis.machine, after.machine):
            continue
        if best is None or left.total() < best.left.total():
            best = Proof(item, candidate, left)
        if not left:
            break
    return best


def _leaves_its_type(
    item: Diagnostic, candidate: Candidate, before: Machine | None, after: Machine | None
) -> bool:
    """Whether a finding is gone because a script no longer uses a state type of the project: the
    finding is in another file than the edits, and the files of that type are not read any more."""
    if before is None or after is None:
        return False
    if any(edit.span.source.name == item.span.source.name for edit in candidate.repair.edits):
        return False
    left = before.state_types.keys() - after.state_types.keys()
    return any(not before.state_types[name].built_in for name in left)


def _proposals(item: Diagnostic, around: Around) -> Sequence[Candidate]:
    """The repairs of the finding, those of the operators, and those of the finding that are only
    possible, the best first. What writes a rarer name is moved back."""
    own = [Candidate(0.1 * at, repair) for at, repair in enumerate(item.finding.all_repairs)]
    found = []
    for cost, repair in (*own, *candidates(item, around)):
        if _writes_rarer_name(repair, around.vocabulary):
            repair = replace(repair, certainty=Certainty.POSSIBLE)
        is_possible = repair.certainty is Certainty.POSSIBLE
        found.append(Candidate(cost + 2 * is_possible, repair))
    return sorted(found, key=lambda made: made.cost)


def _has_same_fault(one: Diagnostic, other: Diagnostic) -> bool:
    """Whether two findings are about the names at their places, and for the same reason."""
    about = [item.finding.arguments[:1] == (item.span.text,) for item in (one, other)]
    return one.kind is other.kind and all(about)


def _writes_one_of(made: Candidate, wrong: Collection[str]) -> bool:
    """Whether a candidate only replaces a name by one of these."""
    first, *others = made.repair.edits
    return not others and first.text in wrong


def _writes_rarer_name(repair: Repair, vocabulary: Vocabulary) -> bool:
    """Whether a repair replaces a name by one that is like it, and more likely to be misspelt."""
    old, new = repair.edits[0].span.text, repair.edits[0].text
    is_name = len(repair.edits) == 1 and old.isidentifier() and new.isidentifier()
    return is_name and are_alike(old, new) and vocabulary.is_rarer(new, old)


def unknown(analysis: Analysis) -> Unknown:
    """What an analysis has not understood."""
    unread = sum(item.code in ("SM001", "SM006") for item in analysis.report)
    if analysis.machine is None:
        return Unknown(unread + 1, 0, 0)
    unnamed = sum(item.code in ("SM101", "SM102") for item in analysis.report)
    return Unknown(unread, _unresolved(analysis.machine), unnamed)


def _unresolved(machine: Machine) -> int:
    return sum(isinstance(node, Leaf) and node.open for _, node in walk(machine.root))


def _marks(report: Iterable[Diagnostic]) -> Counter[Mark]:
    return Counter(_mark(item) for item in report if item.severity is not Severity.INFO)


def _mark(item: Diagnostic) -> Mark:
    return (item.code, item.severity, item.span.source.name, item.finding.arguments)


def _gone(proof: Proof, shown: Report) -> list[Diagnostic]:
    """The findings that a proven candidate corrects."""
    left = proof.left.copy()
    gone = []
    for item in shown:
        if left[_mark(item)]:
            left[_mark(item)] -= 1
        else:
            gone.append(item)
    return gone
