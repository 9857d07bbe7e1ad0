"""Fields of records that a value lacks, misspells, or has with another field's value (SM304)."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.analysis.type_inference import Clash
from smachac.analysis.type_lattice import fields
from smachac.checks.findings.value_places import part_at, steps_to_misfit
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import listed
from smachac.ir.nodes import Struct


def missing_fields(clash: Clash) -> list[str]:
    """The fields of a record that a mapping or another record lacks."""
    given, wanted = clash.misfit.given, clash.misfit.wanted
    if wanted.name != "record" or given.name not in ("mapping", "record"):
        return []
    return [name for name, type_ in fields(wanted).items()
            if name not in fields(given) and type_.name != "optional"]  # fmt: skip


def misspelt_fields(clash: Clash) -> Iterator[tuple[str, str]]:
    """The missing fields of a record, each with the field that is likely meant for it: one of a
    similar name, or one whose value is the missing name."""
    given, wanted = clash.misfit.given, clash.misfit.wanted
    missing = missing_fields(clash)
    others = [field for field in fields(given) if field not in fields(wanted)] if missing else []
    for name in missing:
        near = guesser(others)(name) or next(
            (other for other in others if is_inverted_field(clash, name, other)), None
        )
        if near is not None:
            yield name, near


def is_inverted_field(clash: Clash, name: str, other: str) -> bool:
    """Whether a literal has `other: name` in place of the field `name`."""
    value = clash.flow.value
    if not isinstance(value, tuple | Struct):
        return False
    whole = part_at(value, steps_to_misfit(value, clash.cell.declared))
    return isinstance(whole, Struct) and dict(whole.entries).get(other) == name


def misspelt_help(clash: Clash) -> str | None:
    """The help for the first field of a record that is misspelt or inverted."""
    for name, near in misspelt_fields(clash):
        if is_inverted_field(clash, name, near):
            return f"write `{name}: {near}`: the name of the field comes first"
        return f"did you mean `{name}` in place of `{near}`?"
    return None


def without_fields(clash: Clash) -> str:
    """The fields that a record lacks, as part of a message; empty if it lacks none."""
    missing = missing_fields(clash)
    if not missing:
        return ""
    key = f"`{clash.flow.origin.cell.key}`"
    whose = key if clash.misfit.given == clash.flow.type else f"an item of {key}"
    return f"{whose} has no field{'s' if len(missing) > 1 else ''} {listed(missing)}"
