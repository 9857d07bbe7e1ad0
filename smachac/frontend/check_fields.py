"""Which variables a state has, may have and lacks: SM003, SM004, SM005."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from smachac.diagnostics.diagnostic import Related, Report, did_you_mean
from smachac.diagnostics.source import Word
from smachac.diagnostics.spelling import guesser_of
from smachac.frontend import field_shapes, schema
from smachac.frontend.errors.script import missing_variable, unknown_variable, wrong_shape
from smachac.frontend.state_types import StateType
from smachac.frontend.sugar import check_sugar
from smachac.frontend.yaml_tree import Entry
from smachac.ir.nodes import Key, Outcome


def check_variables(
    name: Word,
    fields: Mapping[str, Entry],
    owner: str,
    type_: StateType,
    inner: Word | None,
    report: Report,
) -> dict[str, Any]:
    """SM003, SM004 and SM005 over the variables of one state; `inner` is its name in the
    sub-script that a call stands for. Returns those that are names, or pairs of names, as read."""
    read = {}
    meant: set[str | None] = set()
    for key, entry in fields.items():
        row = schema.VARIABLES.get(key)
        if key in type_.variables:
            shape = row.shape if row is not None else "value"
        elif row is not None and owner in row.owners:
            shape = row.shape
        elif type_.open or "variables" in type_.given:
            shape = "value"
            if type_.used is not None and key not in type_.used:
                words = [*schema.names_for(owner), *type_.used]
                word = Word(str(entry.key.value), entry.key.span)
                report.append(unknown_variable(word, f"`{type_.name}`", words, anything=True))
        else:
            known = [*schema.names_for(owner), *type_.variables]
            word = Word(str(entry.key.value), entry.key.span)
            whose = f"state type `{type_.name}`" if owner == "state" else _called(owner)
            report.append(unknown_variable(word, whose, known))
            meant.add(guesser_of(tuple(known))(word.text))
            continue
        if key not in ("template", "states"):
            value = field_shapes.READERS[shape](entry.value, report)
            if shape in ("names", "pairs"):
                read[key] = value
    check_sugar(fields, type_, report)
    if owner == "state" and not type_.open:
        _check_interface(fields, type_, report)
    required = [*schema.REQUIRED[owner]]
    required += [key for key, variable in type_.variables.items() if variable.required]
    for key in required:
        if key not in fields and key not in meant:
            whose = f"state type `{type_.name}`" if key in type_.variables else _called(owner)
            related: tuple[Related, ...] = ()
            if inner is not None:
                related = (Related(span=inner.span, message="nor does the sub-script give it"),)
            report.append(missing_variable(name.span, key, whose, related))
    return read


def _check_interface(fields: Mapping[str, Entry], type_: StateType, report: Report) -> None:
    """What a state lists beyond an interface that is complete."""
    declared: dict[str, tuple[Key, ...] | tuple[Outcome, ...]] = {
        "input_keys": type_.input_keys,
        "output_keys": type_.output_keys,
        "outcomes": type_.outcomes,
    }
    for part, entries in declared.items():
        if part in type_.given or part not in fields:
            continue
        known = [entry.name for entry in entries]
        for word, _ in field_shapes.as_keys(fields[part].value, []):
            if word.text not in known:
                what = part.replace("_", " ").removesuffix("s")
                message = f"state type `{type_.name}` has no {what} `{word.text}`"
                listed = ", ".join(f"`{name}`" for name in known) or "none"
                help = did_you_mean(word.text, known) or f"it has {listed}"
                report.append(wrong_shape(word.span, message, help))


def _called(owner: str) -> str:
    if owner == "base":
        return "the script"
    return "a state" if owner == "state" else f"a container of type `{owner}`"
