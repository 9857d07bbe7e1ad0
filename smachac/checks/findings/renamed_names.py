"""Names of an interface that have changed there, and not in the class of the state type."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import PurePath
from typing import Literal, NamedTuple

from smachac.checks.findings.help_text import other_place
from smachac.diagnostics.diagnostic import Related
from smachac.diagnostics.negation import is_negation
from smachac.diagnostics.source import Word
from smachac.ir.class_facts import ClassFacts, renamed_name
from smachac.ir.nodes import Key, Leaf, Outcome


class Renamed(NamedTuple):
    """A name that a class declares and uses, in place of which its interface has another one: its
    first use, the help, and the other places of the name."""

    old: str
    first: tuple[Word, ...]
    help: str
    places: tuple[Related, ...]


def renamed_in_interface(
    leaf: Leaf,
    part: Literal["outcomes", "input_keys", "output_keys"],
    facts: ClassFacts,
    declared: tuple[Word, ...] | None,
    known: Collection[str],
) -> Renamed | None:
    """The name of a part of the interface that has changed there, and not in the class."""
    found = renamed_name(declared, known) if part not in dict(facts.passed) else None
    if found is None or is_negation(found[0].text, found[1]):
        return None
    old, new = found
    ways = {"outcomes": facts.returns, "input_keys": facts.reads, "output_keys": facts.writes}
    uses = [word for word in ways[part] if word.text == old.text]
    if not uses or new in {word.text for word in ways[part]}:
        return None
    places = other_place(old.span, f"`{leaf.type}` declares it here")
    places += tuple(Related(span=use.span, message="also here") for use in uses[1:])
    help = f"write `{new}` in place of `{old.text}`, also where `{leaf.type}` declares it, or"
    names: dict[str, tuple[Outcome | Key, ...]] = {
        "outcomes": leaf.outcomes,
        "input_keys": leaf.inputs,
        "output_keys": leaf.outputs,
    }
    declared_at = next((name.span for name in names[part] if name.name == new), leaf.span)
    file = PurePath(declared_at.source.name)
    other = "correct the interface"
    if file.name.partition(".")[0] == leaf.type:
        other = f"write `{old.text}` in place of `{new}` in `{file.name}`"
    return Renamed(old.text, (uses[0],), f"{help} {other}", places)
