"""The types in a script: aliases of `types:` are replaced, and errors are reported (SM017)."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source, Word
from smachac.diagnostics.spelling import guesser_of, respelt
from smachac.frontend.errors.script import Owner, bad_type, unknown_variable
from smachac.frontend.text.fields import PRESET_FIELDS, as_pairs, is_long_form
from smachac.frontend.text.type_names import WORD, Aliases, field_name, filled
from smachac.frontend.text.yaml_tree import Entry, Map, Scalar, Tree, is_known_wrong
from smachac.ir.types import WORDS, Type, parse_type, unknown_words
from smachac.records import replace

TYPED = ("input_keys", "output_keys", "userdata")
"""The fields that have types."""


def read_aliases(tree: Tree, outer: Aliases, report: Report) -> Aliases:
    """The `types:` of a script beside those of its project, `outer`; an alias may use earlier
    ones."""
    found = dict(outer)
    for key, value in as_pairs(_with_records(tree), report):
        text = filled(value.text, found)
        if read_type(text, value, report) is not None:
            found[key.text] = text
    return found


def explain_aliases(aliases: Aliases, outer: Aliases, source: Source, report: Report) -> set[str]:
    """The names of aliases that other files than the script use as types, where they are unknown
    (SM017): the help of these findings is the type to write there. For any other unknown type it is
    the alias that is meant: in the script one of all, elsewhere one of the project, `outer`."""
    found: set[str] = set()
    for index, item in enumerate(report) if aliases else ():
        finding = item.finding
        unknown = finding.arguments[1] if item.code == "SM017" and finding.arguments[1:] else ""
        if unknown in aliases and finding.span.source is not source:
            found.add(unknown)
            meant = filled(finding.arguments[0], aliases)
            help = f"an interface does not use the `types:` of a script: write `{meant}`,"
            help += " or move the type to `[types]` of smachac.toml"
            report[index] = replace(item, finding=replace(finding, help=help))
            continue
        known = aliases if finding.span.source is source else outer
        near = guesser_of(tuple(known)).unique_match(unknown) if unknown else None
        if near:
            edits = respelt(Word(unknown, finding.span), near)
            help = f"did you mean `{near}`?"
            report[index] = replace(item, finding=replace(finding, help=help, edits=edits))
    return found


def read_type(text: str, place: Word, report: Report, where: str = "`types:`") -> Type | None:
    """The type that a text names; SM017 at `place` if it names none. `where` are the names of
    types that its file can use, for the help."""
    type_ = parse_type(text)
    if type_ is None:
        report.append(bad_type(place, WORDS))
        return None
    unknown = unknown_words(type_)
    if unknown:
        turned: list[tuple[str, str]] = []
        meant = _fields_turned_back(type_, turned)
        name, type_name = next((pair for pair in turned if pair[0] == unknown[0]), ("", ""))
        help = f"write `{name}: {type_name}`: the name of the field comes first" if name else None
        report.append(bad_type(place, WORDS, unknown[0], help=help, where=where))
        type_ = meant if help else type_
    return type_


def _fields_turned_back(type_: Type, turned: list[tuple[str, str]]) -> Type:
    """A type with the fields of records turned back that have a type as their name and an unknown
    word as their type. These are collected, as names and types."""
    args = [_fields_turned_back(arg, turned) if isinstance(arg, Type) else arg
            for arg in type_.args]  # fmt: skip
    for at in range(0, len(args) if type_.name == "record" else 0, 2):
        name, field = str(args[at]), args[at + 1]
        if name not in WORDS or not isinstance(field, Type) or field.args:
            continue
        if unknown_words(field) and field.name not in args[::2]:
            turned.append((field.name, name))
            args[at : at + 2] = [field.name, Type(name)]
    return Type(type_.name, tuple(args))


def _with_records(tree: Tree) -> Tree:
    """A mapping of names to types, in which records are texts."""
    if not isinstance(tree, Map):
        return tree
    return Map(tuple(Entry(entry.key, as_record(entry.value)) for entry in tree.entries), tree.span)


def as_record(tree: Tree) -> Tree:
    """A mapping of names to types as the text of a record type; any other tree as it is."""
    if not isinstance(tree, Map) or not tree.entries:
        return tree
    parts = []
    for entry in tree.entries:
        value = as_record(entry.value)
        if not isinstance(value, Scalar) or not isinstance(value.value, str):
            return tree
        parts.append(f"{field_name(str(entry.key.value))}: {value.value}")
    return Scalar(f"{{{', '.join(parts)}}}", False, *tree.span)


def typed(key: str, entry: Entry, aliases: Aliases, report: Report) -> Entry:
    """A field with the aliases in its types replaced; any other field as it is."""
    value = entry.value
    if key not in TYPED or not isinstance(value, Map):
        return entry
    items = tuple(
        Entry(
            item.key,
            _long_form(item.value, aliases, report)
            if key == "userdata"
            else _key_type(item.value, aliases, report),
        )
        for item in value.entries
    )
    return Entry(entry.key, Map(items, value.span))


def with_types(section: tuple[Entry, ...], aliases: Aliases) -> tuple[Entry, ...]:
    """The keys or variables of an interface with the names in their types replaced."""
    if not aliases:
        return section
    return tuple(Entry(entry.key, _in_interface(entry.value, aliases)) for entry in section)


def _in_interface(tree: Tree, aliases: Aliases) -> Tree:
    """`T`, or the `type` of a mapping, with the names in it replaced."""
    if isinstance(tree, Map):
        items = (
            Entry(item.key, _in_interface(as_record(item.value), aliases))
            if item.key.value == "type"
            else item
            for item in tree.entries
        )
        return Map(tuple(items), tree.span)
    if isinstance(tree, Scalar) and isinstance(tree.value, str):
        return Scalar(filled(tree.value, aliases), tree.plain, *tree.span)
    return tree


def type_words(key: str, tree: Tree) -> Iterator[str]:
    """The words in the types of a field."""
    if key not in TYPED or not isinstance(tree, Map):
        return
    for item in tree.entries:
        value = item.value
        if key == "userdata":
            entry = value.get("type") if isinstance(value, Map) and is_long_form(value) else None
            if entry is None:
                continue
            value = entry.value
        yield from words_of(value)


def words_of(tree: Tree) -> list[str]:
    """The words of a type, as written."""
    tree = as_record(tree)
    if isinstance(tree, Scalar) and isinstance(tree.value, str):
        return WORD.findall(tree.value)
    return []


_OTHER_FIELDS = {
    "typ": "type",
    "dtype": "type",
    "docs": "doc",
    "val": "value",
    "default": "value",
    "initial": "value",
    **dict.fromkeys(("unit", "min", "max", "exclusive", "one_of", "names"), ""),
}
"""Fields that userdata does not have, with those that are meant; the others are of interfaces."""


def _long_form(tree: Tree, aliases: Aliases, report: Report) -> Tree:
    if not isinstance(tree, Map):
        return tree
    tree = _respelt(tree, aliases, report)
    if not is_long_form(tree):
        return tree
    items = tuple(
        Entry(item.key, _type(item.value, aliases, report)) if item.key.value == "type" else item
        for item in tree.entries
    )
    return Map(items, tree.span)


def _respelt(tree: Map, aliases: Aliases, report: Report) -> Map:
    """The long form with its misspelt fields corrected, which are reported (SM003). Any other
    mapping is data: it stays as it is."""
    if is_long_form(tree) or not 2 <= len(tree.entries) <= MOST_FIELDS:
        return tree
    guess = guesser_of(PRESET_FIELDS)
    meant: dict[str, Entry] = {}
    wrong = []
    for entry in tree.entries:
        name = str(entry.key.value)
        field = (
            name if name in PRESET_FIELDS else guess.unique_match(name) or _OTHER_FIELDS.get(name)
        )
        if field is None or field in meant:
            return tree
        if field != name:
            wrong.append(Word(name, entry.key.span))
        if field:
            key = Scalar(field, entry.key.plain, *entry.key.span)
            meant[field] = Entry(key, entry.value)
    if not {"type", "value"} <= meant.keys() or not _is_type(meant["type"].value, aliases):
        return tree
    owner = Owner("userdata", "userdata", "field")
    for word in wrong:
        known = [_OTHER_FIELDS[word.text]] if _OTHER_FIELDS.get(word.text) else PRESET_FIELDS
        report.append(unknown_variable(word, owner, known))
    return Map(tuple(meant.values()), tree.span)


MOST_FIELDS = 8
"""The most fields of a mapping that can be a misspelt long form."""


def _is_type(tree: Tree, aliases: Aliases) -> bool:
    """Whether a tree holds a type without unknown words."""
    tree = as_record(tree)
    if not isinstance(tree, Scalar) or not isinstance(tree.value, str):
        return False
    type_ = parse_type(filled(tree.value, aliases))
    return type_ is not None and not unknown_words(type_)


def _key_type(tree: Tree, aliases: Aliases, report: Report) -> Tree:
    """The type of a key. A mapping with the fields of an interface stays: the reader of the keys
    reports it."""
    if isinstance(tree, Map) and tree.get("type") is not None:
        text = as_record(tree)
        if isinstance(text, Scalar) and parse_type(filled(str(text.value), aliases)) is None:
            return tree
    return _type(tree, aliases, report)


def _type(tree: Tree, aliases: Aliases, report: Report) -> Tree:
    tree = as_record(tree)
    if not isinstance(tree, Scalar) or not isinstance(tree.value, str) or is_known_wrong(tree):
        return tree
    text = filled(tree.value, aliases)
    read_type(text, Word(tree.value, tree.span), report)
    return Scalar(text, tree.plain, *tree.span)
