"""Outputs in the `writes` of an interface that it does not declare."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from smachac.diagnostics.diagnostic import Diagnostic, Report
from smachac.diagnostics.source import Word
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import both
from smachac.frontend.errors.script import wrong_shape
from smachac.frontend.text.fields import name_of
from smachac.frontend.text.yaml_tree import Entry, Map, Scalar, Seq
from smachac.frontend.types.interface_code import Section

TYPE_CHECKING = False  # annotations only: most machines have no classes
if TYPE_CHECKING:
    from smachac.ir.class_facts import ClassFacts


def lost_outputs(sections: Mapping[str, Section], facts: ClassFacts | None) -> tuple[Word, ...]:
    """The keys in `writes` that `output_keys` lacks and that are certainly outputs: the interface
    declares no output, two outcomes have the key, or the class sets it."""
    declared = [str(entry.key.value) for entry in sections["output_keys"]]
    if "*" in declared:
        return ()
    outcomes = {str(entry.key.value) for entry in sections["outcomes"]}
    near = guesser(declared)
    rows: dict[str, list[Word]] = {}
    for entry in sections["writes"]:
        items = entry.value.items if isinstance(entry.value, Seq) else ()
        words = [word for word in map(name_of, items) if word is not None]
        for word in words if entry.key.value in outcomes else ():
            if word.text not in declared and word.text not in outcomes:
                rows.setdefault(word.text, []).append(word)
    known = facts is not None and facts.name is not None
    written = {word.text for word in facts.writes} if facts is not None else set()
    return tuple(
        words[0]
        for name, words in rows.items()
        if name.isidentifier()
        and near(name) is None
        and (name in written or (not known and (not declared or len(words) > 1)))
    )


def undeclared_outputs(lost: Sequence[Word], section: Section) -> Diagnostic:
    """SM004 for outputs in `writes` that the interface does not declare."""
    names = [word.text for word in lost]
    verb = "is" if len(names) == 1 else "are"
    if not section:
        help = f"add `output_keys: [{', '.join(names)}]`"
    elif all(isinstance(entry.value, Map) and not entry.value.entries for entry in section):
        every = [str(entry.key.value) for entry in section] + names
        help = f"write `output_keys: [{', '.join(every)}]`"
    else:
        each_type = " and ".join(f"`{name}: any`" for name in names)
        help = f"add {each_type} to `output_keys`, or its type in place of `any`"
    return wrong_shape(
        lost[0].span,
        f"{both(names)} {verb} in `writes`, but not in the `output_keys` of the interface",
        help,
        arguments=("output_keys", *names),
        effect="only names in `output_keys` have a meaning here, so no program is generated",
    )


def with_lost_outputs(
    sections: dict[str, Section], facts: ClassFacts | None, report: Report
) -> dict[str, Section]:
    """The parts of an interface with the outputs of `writes` that it lacks, which are reported."""
    lost = lost_outputs(sections, facts) if sections["writes"] else ()
    if not lost:
        return sections
    report.append(undeclared_outputs(lost, sections["output_keys"]))
    more = tuple(Entry(Scalar(word.text, True, *word.span), Map((), word.span)) for word in lost)
    return sections | {"output_keys": (*sections["output_keys"], *more)}
