"""The fields of an interface, and those that unknown ones are meant for."""

from __future__ import annotations

from collections.abc import Mapping

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.meanings import of_same_meaning
from smachac.diagnostics.source import Word
from smachac.diagnostics.spelling import guesser_of
from smachac.frontend.errors.script import Choice, Owner, unknown_variable
from smachac.frontend.schema import INTERFACE_FIELDS
from smachac.frontend.text.fields import as_map
from smachac.frontend.text.yaml_tree import Map, Tree

_OTHER_FIELDS: Mapping[str, tuple[str, ...]] = {
    "inputs": ("input_keys",),
    "io_keys": ("output_keys",),
    "outputs": ("output_keys",),
    "arguments": ("variables",),
    "parameters": ("variables",),
    "params": ("variables",),
    "ends": ("outcomes",),
    "exits": ("outcomes",),
    "results": ("outcomes",),
    "transitions": ("outcomes",),
}
"""Fields that other tools have, with those of interfaces that they are meant for."""

SECTIONS = ("outcomes", "output_keys", "input_keys", "variables")
"""The fields that are proposed in place of one with an unknown name: a new check shows which one is
meant."""


def interface_fields(tree: Map, report: Report) -> dict[str, Tree]:
    """The fields of an interface. One with an unknown name is also the field that it is certainly
    meant for: then it is one finding."""
    given = {str(entry.key.value) for entry in tree.entries}
    missing = [name for name in INTERFACE_FIELDS if name not in given]
    proposed = [name for name in SECTIONS if name in missing]
    fields: dict[str, Tree] = {}
    meant: dict[str, Tree] = {}
    sure = guesser_of(tuple(INTERFACE_FIELDS)).unique_match
    owner = Owner("interface", "an interface", "field")
    for entry in as_map(tree, report):
        key = str(entry.key.value)
        if key in INTERFACE_FIELDS:
            fields[key] = entry.value
            continue
        near = sure(key) or of_same_meaning(key, [*INTERFACE_FIELDS])
        names = _OTHER_FIELDS.get(key, (near,) if near is not None else ())
        meant |= dict.fromkeys(names, entry.value)
        one = names[0] if names and key != "io_keys" else None
        word = Word(key, entry.key.span)
        report.append(
            unknown_variable(
                word, owner, INTERFACE_FIELDS, Choice(meant=one, free=missing, proposed=proposed)
            )
        )
    return meant | fields
