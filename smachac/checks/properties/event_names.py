"""The findings on events of properties that name no state of the script, or several (SM703)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from smachac.analysis.context import Context
from smachac.diagnostics.diagnostic import Finding, did_you_mean
from smachac.diagnostics.negation import are_opposite
from smachac.diagnostics.source import Word
from smachac.diagnostics.spelling import guesser, respelt, words_of
from smachac.diagnostics.wording import either, listed
from smachac.ir.nodes import Data, Leaf
from smachac.ir.outcome_names import fails, is_failure
from smachac.ir.properties import After, AtMost, Atom, Atoms, Before, Form, Never, Property, atoms
from smachac.ir.script_paths import name_in_script, walk_script
from smachac.ir.traversal import outcome_names, walk

if TYPE_CHECKING:
    from smachac.analysis.property_events import NameFault


def name_fault(
    fault: NameFault, given: Property, context: Context, *, is_searched: bool
) -> Finding:
    """The finding on the name of an event. `is_searched`: states and properties are searched for
    what is meant, which takes long for many names."""
    atom = fault.atom
    if fault.kind == "ambiguous":
        return Finding(
            span=atom.span,
            message=f"`{atom.name}` may be any of {listed(fault.known)}",
            arguments=("ambiguous", atom.name),
            help="write more of its path",
        )
    if fault.kind == "outcome":
        outcome = atom.outcome or ""
        return Finding(
            span=atom.span,
            message=f"`{atom.name}` has no outcome `{outcome}`",
            arguments=("outcome", atom.name, outcome),
            help=did_you_mean(outcome, fault.known)
            or f"use one of its outcomes: {listed(fault.known) or 'it has none'}",
        )
    what = {"path": "state", "tag": "state with the tag", "type": "state of the type"}
    subject = what.get(atom.subject, "state with a claim of")
    known: Sequence[str] = fault.known
    if atom.subject == "path":  # without the states that a retry or a time limit adds
        written = context.of_machine(_written)
        known = [name for name in known if name in written]
    beside = _beside(given.form, atom) if atom.subject == "path" else ()
    known = [name for name in known if all(name != each.name for each in beside)]
    sure = guesser(known).sure(atom.name)
    edits = respelt(Word(atom.name, atom.span), sure) if atom.subject == "path" else ()
    names = listed(known)
    alike = _as_good(given, atom, known) if sure is None else known
    return Finding(
        span=atom.span,
        message=f"there is no {subject} `{atom.name}`",
        arguments=("unknown", atom.subject, atom.name),
        help=_other_subject(atom, context)
        or (_with_the_words(atom, alike) if sure is None else None)
        or _as_failure(atom, known, alike, context)
        or did_you_mean(atom.name, alike)
        or _by_words(atom, alike)
        or (_searched(given, atom, beside, known, alike, context) if is_searched else None)
        or (f"use one of {names}" if names else _nothing_known(atom)),
        edits=edits,
    )


def _written(context: Context) -> frozenset[str]:
    """The names of the states of the script."""
    return frozenset(
        each.plain.rpartition("/")[2]
        for each in walk_script(context.machine.root)
        if not each.added
    )


def _named(context: Context) -> frozenset[str]:
    """The names of states that properties have."""
    return frozenset(
        atom.name.rpartition("/")[2]
        for each in context.machine.properties
        for atom in atoms(each.form)
        if atom.subject == "path"
    )


def _searched(
    given: Property, atom: Atom, beside: Atoms, known: Sequence[str], alike: Sequence[str],
    context: Context,
) -> str | None:  # fmt: skip
    """The help for an unknown event that its place among states and properties gives."""
    return (
        _of_same_work(beside, known, context)
        or _unnamed(alike, context)
        or _led_to(given, atom, alike, context)
    )


def _beside(form: Form, atom: Atom) -> Atoms:
    """The other events, without an outcome, of the list that an event of a property is in."""
    lists: tuple[Atoms, ...] = ()
    match form:
        case Never(after=after, until=until, enter=enter):
            lists = (after, until, enter)
        case Before(later=later, earlier=earlier):
            lists = (later, earlier)
        case After(first=first, answer=answer, before_claim=claims):
            lists = (first, answer, claims)
        case AtMost(event=event):
            lists = (event,)
    for each in lists:
        if any(one is atom for one in each):
            return tuple(one for one in each if one is not atom and one.outcome == atom.outcome)
    return ()


def _of_same_work(beside: Atoms, known: Sequence[str], context: Context) -> str | None:
    """The help for an unknown event in a list of states that do the same work: the only other state
    that does it."""
    names = [each.name for each in beside if each.subject == "path"]
    leaves = [node for _, node in context.states if isinstance(node, Leaf)]
    done = [work(node) for node in leaves
                   if node.name in names and own_work(context, node)]  # fmt: skip
    found = {node.name for node in leaves if node.name in known and work(node) in done}
    if len(found) != 1:
        return None
    (name,) = found
    return f"write `{name}`: it does the same as {either(names)}"


def _unnamed(known: Sequence[str], context: Context) -> str | None:
    """The help for an unknown event: the only state that no property names."""
    named = context.of_machine(_named)
    root = context.machine.root.name
    left = [name for name in known if name not in named and name != root]
    return f"write `{left[0]}`, the only state that no property names" if len(left) == 1 else None


def _led_to(given: Property, atom: Atom, known: Sequence[str], context: Context) -> str | None:
    """The guess for an unknown event: the only state that no property names and to which the other
    states of the property lead; of several the only one to which they lead after a failure."""
    if atom.subject != "path":
        return None
    named = context.of_machine(_named)
    others = {each.name.rpartition("/")[2] for each in atoms(given.form) if each is not atom}
    found: dict[str, str] = {}
    failed: dict[str, str] = {}
    every = [node for _, node in walk(context.machine.root)]
    left = {node.name for node in every if node.name in known and node.name not in named
            and (atom.outcome is None or atom.outcome in outcome_names(node))}  # fmt: skip
    for node in every:
        for step in node.transitions if name_in_script(node) in others else ():
            if step.target in left:
                found[step.target] = name_in_script(node)
                if fails(node, step.outcome):
                    failed[step.target] = name_in_script(node)
    for each in (found, failed):
        if len(each) == 1:
            ((name, before),) = each.items()
            return f"did you mean `{name}`, to which `{before}` leads?"
    return None


def _as_good(given: Property, atom: Atom, known: Sequence[str]) -> Sequence[str]:
    """The names of states that can be meant by an unknown event by their words: those that the
    property does not have elsewhere, and of which none but the event has a word of failure."""
    if atom.subject != "path":
        return known
    others = {each.name for each in atoms(given.form) if each is not atom}
    failed = is_failure(atom.name)
    return [name for name in known if name not in others and is_failure(name) == failed]


def _as_failure(
    atom: Atom, known: Sequence[str], alike: Sequence[str], context: Context
) -> str | None:
    """The guess for an unknown event that is the name of a state without its word of failure: the
    only other state that does the same as `DETACH_ABORT`, for `DETACH`."""
    words = set(atom.name.split("_"))
    failed = [name for name in known if name not in alike and words <= set(name.split("_"))]
    if atom.subject != "path" or len(failed) != 1 or not is_failure(failed[0]):
        return None
    beside = (replace(atom, name=failed[0]),)
    return _of_same_work(beside, alike, context)


def _with_the_words(atom: Atom, known: Sequence[str]) -> str | None:
    """The guess for the path of a state whose words are words of the name of one state only:
    `LOCK` of `LOCK_TOOL`, although `DOCK` has but one other letter."""
    words = words_of(atom.name)
    found = [name for name in known if all(map(_has_word(name), words))]
    found = [name for name in found if len(words_of(name)) == len(words)] or found
    fits = atom.subject == "path" and len(found) == 1 and not are_opposite(atom.name, found[0])
    return f"did you mean `{found[0]}`?" if fits else None


SHORTEST_STEM = 4
"""The letters of a word that has another ending in another name: `CLOSE` and `CLOSED`."""


def _has_word(name: str) -> Callable[[str], bool]:
    """Whether a name has a word, or one that is the same without its ending."""

    def has(word: str) -> bool:
        pairs = [sorted((word, other), key=len) for other in words_of(name)]
        return any(
            long == short or (len(short) >= SHORTEST_STEM and long.startswith(short))
            for short, long in pairs
        )

    return has


def _by_words(atom: Atom, known: Sequence[str]) -> str | None:
    """The guess for the path of a state whose first words are the name of one state only."""
    words = atom.name.split("_")
    begins = ["_".join(words[:count]) for count in range(len(words) - 1, 0, -1)]
    meant = [name for name in begins if name in known]
    fits = atom.subject == "path" and meant and not are_opposite(atom.name, meant[0])
    return f"did you mean `{meant[0]}`?" if fits else None


def _other_subject(atom: Atom, context: Context) -> str | None:
    """The help for a tag, type or claim that is written without its word."""
    if atom.subject != "path":
        return None
    states = [node for _, node in walk(context.machine.root)]
    subjects = {
        "tag": (name for node in states for name in node.tags),
        "type": (node.type for node in states if isinstance(node, Leaf)),
        "claim": (name for names in context.claims.values() for name in names),
    }
    for subject, names in subjects.items():
        if atom.name in names:
            outcome = f":{atom.outcome}" if atom.outcome else ""
            return f"`{atom.name}` is a {subject}: write `{subject} {atom.name}{outcome}`"
    return None


def _nothing_known(atom: Atom) -> str:
    return "remove it" if atom.subject == "path" else f"add `{atom.subject}s:` to a state"


def own_work(context: Context, leaf: Leaf) -> bool:
    """Whether a state sets a variable to another value than its default."""
    type_ = context.machine.state_types.get(leaf.type)
    known = type_.variables if type_ is not None else {}
    defaults = {name: each.default.data for name, each in known.items() if each.default}
    return any(each.value.data != defaults.get(each.name) for each in leaf.variables)


def work(leaf: Leaf) -> tuple[str, list[tuple[str, Data]]]:
    """The type of a state and the values of its variables."""
    return leaf.type, sorted(((each.name, each.value.data) for each in leaf.variables), key=repr)
