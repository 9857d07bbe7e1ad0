"""The findings on events of properties that name no state of the script, or several (SM703)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from smachac.analysis.context import Context
from smachac.diagnostics.diagnostic import Finding, did_you_mean
from smachac.diagnostics.source import Word
from smachac.diagnostics.spelling import guesser, respelt
from smachac.diagnostics.wording import listed
from smachac.ir.nodes import Leaf
from smachac.ir.outcome_names import is_failure
from smachac.ir.properties import Atom
from smachac.ir.script_paths import walk_script
from smachac.ir.traversal import walk

if TYPE_CHECKING:
    from smachac.analysis.property_events import NameFault


def name_fault(fault: NameFault, context: Context) -> Finding:
    """The finding on the name of an event."""
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
    sure = guesser(known).unique_match(atom.name)
    edits = respelt(Word(atom.name, atom.span), sure) if atom.subject == "path" else ()
    names = listed(known)
    alike = [name for name in known if is_failure(name) == is_failure(atom.name)]
    return Finding(
        span=atom.span,
        message=f"there is no {subject} `{atom.name}`",
        arguments=("unknown", atom.subject, atom.name),
        help=_other_subject(atom, context)
        or did_you_mean(atom.name, alike)
        or (f"use one of {names}" if names else _nothing_known(atom)),
        edits=edits,
    )


def _written(context: Context) -> frozenset[str]:
    """The names of the states of the script."""
    return frozenset(
        path.plain.rpartition("/")[2]
        for path in walk_script(context.machine.root)
        if not path.added
    )


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
