"""The fields of an interface, and those that unknown ones are meant for."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.meanings import of_same_meaning
from smachac.diagnostics.source import NOWHERE, Word
from smachac.diagnostics.spelling import guesser_of
from smachac.frontend.errors.script import Owner, unknown_variable
from smachac.frontend.loader import Library
from smachac.frontend.schema import INTERFACE_FIELDS
from smachac.frontend.text.fields import as_map
from smachac.frontend.text.yaml_tree import Entry, Map, Tree
from smachac.frontend.types.interface_code import Section, code_by_language, python_code
from smachac.frontend.types.interface_slips import field_meant, fields_of_shape
from smachac.frontend.types.type_classes import class_facts
from smachac.ir.class_facts import ClassFacts

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


def interface_fields(name: str, tree: Map, library: Library, report: Report) -> dict[str, Tree]:
    """The fields of an interface. One with an unknown name is also the field that it is certainly
    meant for: then it is one finding."""
    fields: dict[str, Tree] = {}
    meant: dict[str, Tree] = {}
    unknown: list[tuple[Entry, tuple[str, ...]]] = []
    sure = guesser_of(tuple(INTERFACE_FIELDS)).sure
    for entry in as_map(tree, report):
        key = str(entry.key.value)
        if key in INTERFACE_FIELDS:
            fields[key] = entry.value
            continue
        near = sure(key) or of_same_meaning(key, [*INTERFACE_FIELDS])
        names = _OTHER_FIELDS.get(key, (near,) if near is not None else ())
        for each in names:
            meant[each] = entry.value
        unknown.append((entry, names))
    for entry, names in unknown:
        key = str(entry.key.value)
        missing = [each for each in INTERFACE_FIELDS if each not in fields and each not in meant]
        fitting = [] if names else fields_of_shape(entry.value, missing)
        other = None
        if fitting and sum(not each for _, each in unknown) == 1:
            code = fields.get("code")
            section = code.entries if isinstance(code, Map) else ()
            facts = partial(_facts_of, name, section, library)
            other = field_meant(entry.value, fitting, facts, fields.get("writes"))
        if other is not None:
            meant[other] = entry.value
        word, owner = Word(key, entry.key.span), Owner("interface", "an interface", "field")
        one = names[0] if names and key != "io_keys" else None
        certain = f"did you mean `{other}`?" if other is not None else None
        report.append(
            unknown_variable(
                word,
                owner,
                INTERFACE_FIELDS,
                meant=one,
                certain=certain,
                fitting=fitting or missing,
            )
        )
    return meant | fields


def _facts_of(name: str, section: Section, library: Library) -> ClassFacts | None:
    """The facts about the class of an interface whose fields are not read yet."""
    code = code_by_language(section, [])
    template = library.template(f"{name}.tpl.py") if "python" not in code else None
    if template is not None:
        code["python"] = f"{name}.tpl.py"
        return class_facts(name, python_code(section, code, template), frozenset(), library)
    return class_facts(name, python_code(section, code, NOWHERE.source), frozenset(), library)
