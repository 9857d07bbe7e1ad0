"""Slips in an interface that one finding explains: a field under another name, and outputs of
`writes` without their declaration."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import replace

from smachac.diagnostics.diagnostic import Diagnostic, Related, Report
from smachac.diagnostics.source import Word
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import both
from smachac.frontend.errors.script import wrong_shape
from smachac.frontend.schema import KEY_FACTS, OUTCOME_FACTS, VARIABLE_FACTS
from smachac.frontend.text.fields import name_of
from smachac.frontend.text.yaml_tree import Entry, Map, Scalar, Seq, Tree
from smachac.frontend.types.interface_code import Section
from smachac.frontend.types.type_annotations import as_record
from smachac.frontend.types.value_facts import LANGUAGES
from smachac.ir.class_facts import ClassFacts
from smachac.ir.types import parse_type, unknown_words

# --- fields under another name


def fields_of_shape(value: Tree, missing: Collection[str]) -> list[str]:
    """The fields among `missing`, fields of an interface, that can have a value."""
    return [name for name in missing if _fits_field(name, value)]


def _fits_field(name: str, value: Tree) -> bool:
    match value:
        case Map(entries=entries):
            trees = [each.value for each in entries]
            match name:
                case "outcomes":
                    return bool(trees) and all(_has_facts(each, OUTCOME_FACTS) for each in trees)
                case "variables":
                    return bool(trees) and all(_describes(each, VARIABLE_FACTS) for each in trees)
                case "input_keys" | "output_keys":
                    return bool(trees) and all(_describes(each, KEY_FACTS) for each in trees)
                case "writes":
                    return bool(trees) and all(isinstance(each, Seq) for each in trees)
                case "code":
                    return bool(trees) and all(each.key.value in LANGUAGES for each in entries)
            return False
        case Seq(items=items):
            names = bool(items) and all(name_of(each) is not None for each in items)
            return names and name in ("outcomes", "input_keys", "output_keys", "claims")
        case Scalar(value=bool()):
            return name in ("blocking", "stand_in", "simulation", "checks_grasp")
        case Scalar(value="state" | "container" | "base"):
            return name == "kind"
        case Scalar(value=str(text)):
            return name == "doc" and " " in text
    return False


def _has_facts(tree: Tree, facts: Collection[str]) -> bool:
    """Whether a tree is a mapping of nothing but these facts; it may be empty."""
    return isinstance(tree, Map) and all(each.key.value in facts for each in tree.entries)


def _describes(tree: Tree, facts: Collection[str]) -> bool:
    """Whether a tree is a type, or a mapping of one or more of these facts."""
    return _is_type(tree) or (_has_facts(tree, facts) and tree != Map((), tree.span))


def _is_type(tree: Tree) -> bool:
    return isinstance(tree, Scalar) and isinstance(tree.value, str) and _type_fits(tree)


def _type_fits(tree: Tree) -> bool:
    tree = as_record(tree)
    text = tree.value if isinstance(tree, Scalar) else None
    type_ = parse_type(text) if isinstance(text, str) else None
    return type_ is not None and not unknown_words(type_)


def field_meant(
    value: Tree, fitting: Sequence[str], facts: Callable[[], ClassFacts | None], writes: Tree | None
) -> str | None:
    """The field of an interface that an unknown one is meant for: the only one of `fitting`, or the
    one whose names the class and `writes` use; else the outcomes, which every state needs."""
    if len(fitting) < 2:
        return next(iter(fitting), None)
    if "variables" in fitting and isinstance(value, Map):
        own = [each.value for each in value.entries]
        if any(isinstance(each, Map) and not _has_facts(each, KEY_FACTS) for each in own):
            return "variables"
    names = set(_names_in(value))
    found = facts()
    used: dict[str, set[str]] = {name: set() for name in fitting}
    if found is not None:
        words = {
            "outcomes": (*found.returns, *(found.outcomes or ())),
            "input_keys": found.reads if found.inputs is None else found.inputs,
            "output_keys": found.writes if found.outputs is None else found.outputs,
            "variables": tuple(each.word for each in found.parameters or ()),
        }
        for field, own_words in words.items():
            if field in used:
                used[field] |= {word.text for word in own_words}
    if isinstance(writes, Map):
        keys = {name for each in writes.entries for name in _names_in(each.value)}
        used.get("output_keys", set()).update(keys)
        ends = {str(each.key.value) for each in writes.entries}
        used.get("outcomes", set()).update(ends)
    shared = [field for field in fitting if names & used[field]]
    if len(shared) == 1:
        return shared[0]
    return "outcomes" if "outcomes" in fitting and not shared else None


def _names_in(tree: Tree) -> Iterator[str]:
    """The names in a list, or before the values of a mapping."""
    if isinstance(tree, Map):
        yield from (str(each.key.value) for each in tree.entries)
    elif isinstance(tree, Seq):
        words = map(name_of, tree.items)
        yield from (word.text for word in words if word is not None)


# --- outputs without their declaration


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
    elif all(isinstance(each.value, Map) and not each.value.entries for each in section):
        every = [str(each.key.value) for each in section] + names
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


def _renamed_output(
    lost: Sequence[Word], sections: Mapping[str, Section], facts: ClassFacts | None
) -> Entry | None:
    """The only output of an interface that neither `writes` nor the class has, if `writes` has one
    key that the interface lacks: its old name."""
    if len(lost) != 1 or facts is None:
        return None
    items = [each.value for each in sections["writes"]]
    words = [name_of(word) for each in items if isinstance(each, Seq) for word in each.items]
    used = {word.text for word in (*words, *facts.writes, *(facts.outputs or ())) if word}
    left = [each for each in sections["output_keys"] if str(each.key.value) not in used]
    return left[0] if len(left) == 1 else None


def with_lost_outputs(
    sections: dict[str, Section], facts: ClassFacts | None, report: Report
) -> dict[str, Section]:
    """The parts of an interface with the outputs of `writes` that it lacks, which are reported."""
    lost = lost_outputs(sections, facts) if sections["writes"] else ()
    if not lost:
        return sections
    renamed = _renamed_output(lost, sections, facts)
    if renamed is not None:
        found = undeclared_outputs(lost, sections["output_keys"])
        old = str(renamed.key.value)
        help = f"write `{lost[0].text}` in place of `{old}` in `output_keys`"
        place = Related(span=renamed.key.span, message=f"no outcome in `writes` has `{old}`")
        finding = replace(found.finding, help=help, related=(place,))
        report.append(replace(found, finding=finding))
        outputs = tuple(
            Entry(Scalar(lost[0].text, True, *lost[0].span), each.value)
            if each is renamed
            else each
            for each in sections["output_keys"]
        )
        return sections | {"output_keys": outputs}
    report.append(undeclared_outputs(lost, sections["output_keys"]))
    more = tuple(Entry(Scalar(word.text, True, *word.span), Map((), word.span)) for word in lost)
    return sections | {"output_keys": (*sections["output_keys"], *more)}
