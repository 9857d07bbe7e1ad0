"""Readers of fields: from a tree to a typed value, one reader for each shape of the schema.

A reader reports each part that does not have the shape (SM004, SM002) and returns the others.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from itertools import pairwise
from typing import TypeAlias

from smachac.diagnostics.diagnostic import Diagnostic, Report
from smachac.diagnostics.repair import Edit
from smachac.diagnostics.source import Span, Word, new_tuple
from smachac.frontend import schema
from smachac.frontend.errors.script import (
    Choice,
    Owner,
    duplicate_key,
    unknown_variable,
    wrong_shape,
)
from smachac.frontend.text.values import as_value
from smachac.frontend.text.yaml_tree import (
    Entry,
    Map,
    Scalar,
    Seq,
    Tree,
    is_known_wrong,
    known_wrong,
)
from smachac.ir.nodes import Outcome, Preset, Value
from smachac.ir.types import ANY, Type, parse_type

Pairs: TypeAlias = tuple[tuple[Word, Word], ...]
"""Names with names: transitions, remapping."""

Rules: TypeAlias = tuple[tuple[Word, Pairs], ...]
"""An outcome map: each outcome with pairs of a state and its outcome."""

Keys: TypeAlias = tuple[tuple[Word, Type | None], ...]
"""Userdata keys, each with its type if the script gives one."""

YAML_1_1_BOOLEANS = {
    form: value
    for value, words in (("true", ("yes", "on", "true")), ("false", ("no", "off", "false")))
    for word in words
    for form in (word, word.capitalize(), word.upper())
}
"""The words that YAML 1.1 reads as booleans, with their value in YAML 1.2."""


def kind_of(tree: Tree) -> str:
    """The kind of a tree, as messages name it."""
    match tree:
        case Map():
            return "a mapping"
        case Seq():
            return "a list"
        case Scalar(value=None):
            return "nothing"
        case Scalar(value=bool()):
            return "a boolean"
        case Scalar(value=int() | float()):
            return "a number"
    return "a string"


SHAPES = {
    "name": ("a name", "write one name, such as `READY`"),
    "names": ("a list of names", "write it as `[a, b]`"),
    "outcomes": ("a list of outcomes", "write it as `[a, b]` or `{a: {}, b: {failure: true}}`"),
    "keys": ("a list of keys", "write it as `[a, b]` or `{a: float}`"),
    "type": ("a type", "write it as `float`, `list[Pose]` or `{x: float, y: float}`"),
    "items": ("a list or the name of a key", "write it as `[a, b]`, or name a key with a list"),
    "map": ("a mapping", "write it as `{name: value}`"),
    "conditions": ("a mapping", "write it as `{STATE: OUTCOME}`"),
    "rule": ("one rule", "write it as `{OUTCOME: {STATE: OUTCOME}}`"),
    "text": ("a text", "write it in quotes: `'...'`"),
    "flag": ("`true` or `false`", "write `true` or `false`, without quotes"),
    "duration": ("a duration", "write it as `20s`, `500ms`, `1.5min` or `1h`"),
    "state": ("a state", "write it as `- NAME: {template: ...}`"),
    "states": ("a list of states", "write each state as `- NAME: {...}`"),
}
"""Each shape of a value, as messages name it, and how it is written."""


def wrong(tree: Tree, shape: str, report: Report, help: str | None = None) -> None:
    """SM004 for a tree that does not have a shape of SHAPES, unless it was reported before."""
    if is_known_wrong(tree):
        return
    expected, example = SHAPES[shape]
    found = kind_of(tree)
    message = f"expected {expected}, found {found}"
    arguments = (shape, found)
    words = _words_of(tree) if shape in LISTS else ()
    edits: tuple[Edit, ...] = ()
    if shape == "states" and isinstance(tree, Map) and tree.entries:
        first = tree.entries[0].key.value
        help = f"write a list: begin each state with `- `, as in `- {first}:`"
    if words and help is None:
        text = f"[{', '.join(word.text for word in words)}]"
        help, edits = f"write it as `{text}`", (Edit(span=tree.span, text=text),)
    text = tree.span.text
    shown = f"`{text}`" if 0 < len(text) <= _LONGEST_SHOWN and "\n" not in text else "the value"
    effect = f"only {expected} has a meaning here; {shown} is {found}"
    if found == "nothing":
        effect = f"only {expected} has a meaning here; nothing is written"
    report.append(
        wrong_shape(
            tree.span, message, help or example, arguments=arguments, edits=edits, effect=effect
        )
    )


def _mapping_help(tree: Seq, value: str) -> str | None:
    """The help for a list in place of a mapping: the mapping of its mappings, or of its names."""
    entries = _recovered_entries(tree)
    pairs: list[str] = []
    for entry in entries:
        text = value if is_known_wrong(entry.value) else entry.value.span.text
        if isinstance(entry.value, Map) and not text.startswith("{"):
            text = f"{{{text}}}"
        pairs.append(f"{entry.key.span.text}: {text}")
    if not entries:
        pairs = [f"NAME: {item.span.text}" for item in tree.items if isinstance(item, Scalar)]
    shown = ", ".join(pairs)
    if not pairs or len(pairs) > _MOST_SHOWN or len(pairs) < len(tree.items) or "\n" in shown:
        return None
    if all(is_known_wrong(entry.value) for entry in entries) and entries and value == "...":
        return f"write a mapping with a value for each name: `{{{shown}}}`"
    return f"write one mapping: `{{{shown}}}`"


_LONGEST_SHOWN = 40
"""The longest value that a finding repeats."""

_MOST_SHOWN = 6
"""The most entries that a help shows."""


def _recovered_entries(tree: Seq) -> tuple[Entry, ...]:
    """The entries of a list in place of a mapping: those of its mappings, except of remappings in
    the form of ROS, and its names, whose values are `known_wrong`."""
    entries: list[Entry] = []
    for item in tree.items:
        if isinstance(item, Map):
            is_pair = {entry.key.value for entry in item.entries} == {"from", "to"}
            entries += () if is_pair else item.entries
        elif isinstance(item, Scalar) and item.plain and str(item.value).isidentifier():
            entries.append(Entry(item, known_wrong(item.span)))
        else:
            entries += _arrows(item)
    return tuple(entries)


_ARROW = r"\s*(\w+)\s*(?:->|=>|\u2192|=|;|:)\s*(\w+)\s*"
"""A transition written as in a drawing, `held -> LIFT`, or with another wrong sign."""


def _arrows(tree: Tree) -> tuple[Entry, ...]:
    """The entries meant by a plain text such as `held -> LIFT, slipped -> aborted`, in one line or
    several; none if a part of it has another form."""
    if not isinstance(tree, Scalar) or not tree.plain or not isinstance(tree.value, str):
        return ()
    entries, start = [], tree.start
    for part in re.split("[,\n]", tree.span.text):
        found = re.fullmatch(_ARROW, part)
        if found is None:
            return ()
        key, value = (
            Scalar(
                found[group],
                True,
                *Span(tree.source, start + found.start(group), start + found.end(group)),
            )
            for group in (1, 2)
        )
        entries.append(Entry(key, value))
        start += len(part) + 1
    if len(entries) == 1 and ":" in tree.span.text:
        return ()  # only the space is missing
    return tuple(entries)


LISTS = ("names", "outcomes", "keys")
"""The shapes that are lists of names."""


def _words_of(tree: Tree) -> tuple[Word, ...]:
    """The names in a plain text without brackets, such as `a, b`; none if a part is no name."""
    if not isinstance(tree, Scalar) or not isinstance(tree.value, str) or not tree.plain:
        return ()
    if tree.span.text != tree.value:
        return ()
    words, start = [], tree.start
    for part in tree.value.split(","):
        name = part.strip()
        if not name.isidentifier() or name in YAML_1_1_BOOLEANS:
            return ()
        begin = start + part.index(name)
        words.append(Word(name, Span(tree.source, begin, begin + len(name))))
        start += len(part) + 1
    return tuple(words)


def name_of(tree: Tree) -> Word | None:
    """The name that a tree holds, without diagnostics; None for collections and null."""
    if not isinstance(tree, Scalar) or tree.value is None:
        return None
    return Word(tree.value if isinstance(tree.value, str) else tree.span.text, tree.span)


def as_name(tree: Tree, report: Report) -> Word | None:
    """A name: of a state, an outcome, a key, a script, a template."""
    if not isinstance(tree, Scalar):
        name_text(tree, report)
        return None
    text = tree.value
    if not isinstance(text, str) or text in YAML_1_1_BOOLEANS:  # few names: a call less for others
        text = name_text(tree, report)
    if text is None:
        return None
    return new_tuple(Word, (text, new_tuple(Span, (tree.piece, tree.first, tree.last))))


def expanded(entries: Iterable[Entry], report: Report) -> dict[str, Entry]:
    """The fields by long name; duplicates are reported (SM002)."""
    fields: dict[str, Entry] = {}
    for entry in entries:
        text = entry.key.value
        if not isinstance(text, str) or text in YAML_1_1_BOOLEANS:  # as in `as_name`
            text = name_text(entry.key, report)
            if text is None:
                continue
        first = fields.setdefault(schema.LONG.get(text, text), entry)
        if first is not entry and first.key.value != entry.key.value:
            report.append(duplicate_key(Word(text, entry.key.span), first.key.span))
    return fields


def _only_name(tree: Tree) -> Word | None:
    """The name that is alone in brackets or braces."""
    if isinstance(tree, Map) and len(tree.entries) == 1 and not tree.entries[0].value.span.text:
        return name_of(tree.entries[0].key)
    if isinstance(tree, Seq) and len(tree.items) == 1 and isinstance(tree.items[0], Scalar):
        return name_of(tree.items[0])
    return None


def name_text(tree: Tree, report: Report) -> str | None:
    """The text of a name, without its span."""
    if not isinstance(tree, Scalar):
        only = _only_name(tree)
        wrong(tree, "name", report, f"write `{only.text}` without brackets" if only else None)
        return None
    value = tree.value
    if isinstance(value, str) and (value not in YAML_1_1_BOOLEANS or not tree.plain):
        return value
    if value is None:
        wrong(tree, "name", report)
        return None
    if isinstance(value, (str, bool)):
        text = tree.span.text
        report.append(
            wrong_shape(
                tree.span,
                f"`{text}` is a boolean for many YAML parsers, not a name",
                f"write it in quotes: '{text}', or use another name",
                arguments=("boolean", text),
            )
        )
        return text
    # A number is a fine name for a state or an outcome once it is text.
    return tree.span.text


def as_names(tree: Tree, report: Report, shape: str = "names") -> tuple[Word, ...]:
    """A list of names, each once. `shape` is that of a tree that is no list, for the message."""
    if not isinstance(tree, Seq):
        wrong(tree, shape, report)
        # Names without brackets stand for the list, so that their uses are not reported too.
        word = name_of(tree)
        return _words_of(tree) or ((word,) if word is not None and word.text else ())
    found: dict[str, Word] = {}
    for item in tree.items:
        word = as_name(item, report)
        if word is None or (not word.text and is_known_wrong(item)):
            continue
        first = found.setdefault(word.text, word)
        if first is not word:
            report.append(duplicate_key(word, first.span))
    return tuple(found.values())


def as_outcomes(tree: Tree, report: Report) -> tuple[Outcome, ...]:
    """Outcomes, each once: `[a, b]`, or with what they mean, `{a: {}, b: {failure: true}}`."""
    if not isinstance(tree, Map):
        words = as_names(tree, report, "outcomes")
        return tuple([Outcome(name=word.text, span=word.span) for word in words])
    if _is_list_in_braces(tree):
        return tuple(Outcome(name=word.text, span=word.span)
                     for word in _listed(tree, "outcomes", report))  # fmt: skip
    rows = ((as_name(entry.key, report), entry.value) for entry in tree.entries)
    return tuple([as_outcome(word, value, report) for word, value in rows if word is not None])


def _is_list_in_braces(tree: Map) -> bool:
    """Whether a mapping is a list of names in braces: `{a, b}`."""
    if not tree.entries or not tree.span.text.startswith("{"):
        return False
    values = [entry.value for entry in tree.entries]
    return all(isinstance(value, Scalar) and value.value is None and value.start == value.end
               for value in values) and ":" not in tree.span.text  # fmt: skip


def _listed(tree: Map, shape: str, report: Report) -> tuple[Word, ...]:
    """The names of a list in braces, which is reported."""
    words = tuple(Word(str(entry.key.value), entry.key.span) for entry in tree.entries)
    text = f"[{', '.join(word.text for word in words)}]"
    wrong(tree, shape, report, f"write the list in brackets: `{text}`")
    return words


def as_outcome(word: Word, tree: Tree, report: Report, *more: str) -> Outcome:
    """An outcome with what is written below its name: `doc`, `failure`, and what `more` names."""
    parts: dict[str, Tree] = {}
    known, owner = ("doc", "failure", *more), Owner("outcome", "an outcome")
    for entry in as_map(tree, report):
        part = Word(str(entry.key.value), entry.key.span)
        if part.text not in known:
            choice = Choice(owners=schema.special_owners(part.text))
            report.append(unknown_variable(part, owner, known, choice))
        parts[part.text] = entry.value
    return Outcome(
        name=word.text,
        doc=as_text(parts["doc"], report) if "doc" in parts else "",
        failure=as_flag(parts["failure"], report) if "failure" in parts else None,
        span=word.span,
    )


def as_map(tree: Tree, report: Report, value: str = "...") -> tuple[Entry, ...]:
    """A mapping of names to anything; a null block (`userdata:` with nothing) is an error. Of a
    list, which is one too, the entries are those that are probably meant. `value` stands in the
    help for the value of a name alone."""
    if not isinstance(tree, Map):
        from smachac.frontend.text.yaml_errors import JOINED, spaced

        nothing = isinstance(tree, Scalar) and tree.value is None
        help = "write `{}`, or remove the key" if nothing else None
        if isinstance(tree, Seq):
            help = _mapping_help(tree, value)
        arrows = _arrows(tree)
        if (
            isinstance(tree, Scalar)
            and tree.plain
            and not arrows
            and JOINED.fullmatch(str(tree.value))
        ):
            help = spaced(str(tree.value))
        if arrows:
            shown = ", ".join(f"{arrow.key.span.text}: {arrow.value.span.text}" for arrow in arrows)
            help = f"write a mapping: `{{{shown}}}`"
        wrong(tree, "map", report, help)
        return _recovered_entries(tree) if isinstance(tree, Seq) else arrows
    return tuple([entry for entry in tree.entries if _names(entry.key, report)])


def _names(key: Scalar, report: Report) -> bool:
    """Whether a key is a name; if not, that is reported."""
    value = key.value
    if isinstance(value, str) and value not in YAML_1_1_BOOLEANS:
        return True
    return as_name(key, report) is not None


def as_pairs(tree: Tree, report: Report) -> Pairs:
    """A mapping of names to names: transitions, remapping. A value that is no name is reported, and
    becomes the empty name, as a look-up that fails does; so a key has a value all the same."""
    pairs = []
    entries = tree.entries if isinstance(tree, Map) else as_map(tree, report)
    # Most keys are words without signs: a transition is no single word.
    is_word = not entries or str(entries[0].key.value).isidentifier()
    if not is_word and isinstance(tree, Map) and tree.span.text.startswith("{"):
        arrows = [_arrows(entry.key) for entry in entries if "\n" not in entry.key.span.text]
        if arrows and len(arrows) == len(entries) and all(len(arrow) == 1 for arrow in arrows):
            entries = tuple(arrow[0] for arrow in arrows)
            shown = ", ".join(
                f"{entry.key.span.text}: {entry.value.span.text}" for entry in entries
            )
            message, help = "a `:` is due between a name and its value", f"write `{{{shown}}}`"
            report.append(wrong_shape(tree.span, message, help, arguments=("arrows",)))
    if isinstance(tree, Seq):  # it is not known what names alone mean
        entries = tuple(entry for entry in entries if not is_known_wrong(entry.value))
    for entry in entries:
        key = as_name(entry.key, report)
        if key is not None:
            target = as_name(entry.value, report) or _only_name(entry.value)
            pairs.append((key, target or Word("", key.span)))
    return tuple(pairs)


def usual_name(tree: Tree) -> str | None:
    """The text of a scalar for which `as_name` reports nothing; None for other trees, also for some
    names, such as a number."""
    text = tree.value if isinstance(tree, Scalar) else None
    return text if isinstance(text, str) and text not in YAML_1_1_BOOLEANS else None


def pairs_of(tree: Tree) -> Pairs:
    """The pairs of names that a tree holds, without diagnostics."""
    entries = tree.entries if isinstance(tree, Map) else ()
    pairs = ((name_of(entry.key), name_of(entry.value)) for entry in entries)
    return tuple((key, value) for key, value in pairs if key and value)


def as_items(tree: Tree, report: Report) -> Value:
    """The items of a loop: a list, code, or the name of a key."""
    if isinstance(tree, Map) or (isinstance(tree, Scalar) and not isinstance(tree.value, str)):
        number = tree.value if isinstance(tree, Scalar) and type(tree.value) is int else None
        few = number is not None and 0 < number <= _MOST_SHOWN
        meant = f"[{', '.join(map(str, range(number or 0)))}]" if few else f"`range({number})`"
        help = f"a loop of {number} turns has the items `{meant}`" if few else None
        if number is not None and not few:
            help = f"a loop of {number} turns has the items '{meant}', with backticks and quotes"
        wrong(tree, "items", report, help)
        return as_value(known_wrong(tree.span))
    return as_value(tree)


def as_rules(tree: Tree, report: Report) -> Rules:
    """A mapping of names to mappings of names to names: an outcome map. As a list, each item has
    one rule, so that several can have one outcome."""
    if isinstance(tree, Seq):
        return tuple(rule for item in tree.items for rule in _one_rule(item, report))
    rules = []
    for entry in as_map(tree, report):
        key = name_of(entry.key)
        if key is not None:
            if isinstance(entry.value, Map):
                rules.append((key, as_pairs(entry.value, report)))
                continue
            wrong(entry.value, "conditions", report)
            nothing = Word("", key.span)
            rules.append((key, ((nothing, nothing),)))
    return tuple(rules)


def _one_rule(item: Tree, report: Report) -> Rules:
    """The rule of an item of a list."""
    found = as_rules(item, report) if isinstance(item, Map) else ()
    if len(found) != 1:
        wrong(item, "rule", report)
    return found


def as_keys(tree: Tree, report: Report) -> Keys:
    """Keys with their types where given: `[a, b]` or `{a: float, b: Pose}`."""
    if isinstance(tree, Seq):
        entries = [item.entries[0] for item in tree.items if isinstance(item, Map) and item.entries]
        if entries and len(entries) == len(tree.items):
            rows = ", ".join(f"{entry.key.span.text}: {entry.value.span.text}" for entry in entries)
            wrong(
                tree,
                "keys",
                report,
                f"write one mapping: `{{{rows}}}`" if "\n" not in rows else None,
            )
            tree = Map(tuple(entries), tree.span)
        else:
            return tuple((word, None) for word in as_names(tree, report))
    if isinstance(tree, Map):
        if _is_list_in_braces(tree):
            return tuple((word, None) for word in _listed(tree, "keys", report))
        if any(isinstance(entry.value, Map) for entry in tree.entries):
            tree = Map(tuple([_of_type(entry, report) for entry in tree.entries]), tree.span)
        return tuple((key, parse_type(type_.text)) for key, type_ in as_pairs(tree, report))
    wrong(tree, "keys", report)
    return tuple((word, None) for word in _words_of(tree))


def _of_type(entry: Entry, report: Report) -> Entry:
    """A key with its type. Fields of userdata and interfaces in place of a type are reported."""
    value = entry.value
    if not isinstance(value, Map):
        return entry
    key, parts = entry.key.span.text, {part.key.value: part.value for part in value.entries}
    type_, preset = parts.get("type"), parts.get("value")
    help = None
    if isinstance(type_, Scalar):
        help = f"write `{key}: {type_.span.text}`"
    if help and preset is not None and "\n" not in preset.span.text:
        help += f", and `userdata: {{{key}: {preset.span.text}}}` beside the keys"
    elif help:
        help += ": only userdata and interfaces have fields beside the type"
    wrong(value, "type", report, help)
    return Entry(entry.key, type_ if isinstance(type_, Scalar) else known_wrong(value.span))


def listed_keys(tree: Tree) -> Keys:
    """The keys that a variable of a state type lists, without diagnostics: rules check the value
    of the variable against its type."""
    if isinstance(tree, Map):
        return tuple((key, parse_type(type_.text)) for key, type_ in pairs_of(tree))
    found: dict[str, Word] = {}
    for item in tree.items if isinstance(tree, Seq) else (tree,):
        word = name_of(item)
        if word is not None and word.text:
            found.setdefault(word.text, word)
    return tuple((word, None) for word in found.values())


def as_presets(tree: Tree, report: Report) -> tuple[Preset, ...]:
    """Userdata in the short form `key: value` or the long one `key: {type: T, value: V}`."""
    entries = as_map(tree, report)
    for before, entry in pairwise(entries):
        number = _decimal_comma(before, entry)
        if number is not None:
            report.append(_with_comma(number))
            entries = tuple(item for item in entries if item is not entry)
    return tuple([_preset(entry, report) for entry in entries])


def _with_comma(number: Span) -> Diagnostic:
    """SM004 for a number with a decimal comma in a mapping."""
    message = f"`{number.text}` has a decimal comma: YAML reads two entries"
    help = f"write `{number.text.replace(',', '.')}`"
    return wrong_shape(number, message, help, arguments=("decimal comma", number.text))


def _preset(entry: Entry, report: Report) -> Preset:
    value, type_, secret = entry.value, ANY, False
    if isinstance(value, Map) and is_long_form(value):
        parts = {item.key.value: item.value for item in value.entries}
        named = parts.get("type")
        if isinstance(named, Scalar) and isinstance(named.value, str):
            type_ = parse_type(named.value) or ANY
        elif named is not None and not isinstance(named, Map):
            whole = f"{entry.key.span.text}: {{value: {value.span.text}}}"
            help = "write it as `float`, `list[Pose]` or `{x: float, y: float}`"
            wrong(named, "type", report, f"{help}; data with these fields is `{whole}`")
        value = parts["value"]
        secret = "secret" in parts and as_flag(parts["secret"], report)
    key = entry.key
    if isinstance(value, Seq | Map):
        _check_decimal_commas(value, report)
    return Preset(
        key=str(key.value), value=as_value(value), type=type_, span=key.span, secret=secret
    )


def _check_decimal_commas(value: Seq | Map, report: Report) -> None:
    """Reports numbers with a decimal comma in a mapping: `{x: 2,5}` has the entries `x: 2` and
    `5`."""
    todo: list[Tree] = [value]
    while todo:
        tree = todo.pop()
        if isinstance(tree, Seq):
            todo += [item for item in tree.items if not isinstance(item, Scalar)]
        elif isinstance(tree, Map):
            todo += [entry.value for entry in tree.entries if not isinstance(entry.value, Scalar)]
            for before, entry in pairwise(tree.entries):
                number = _decimal_comma(before, entry)
                if number is not None:
                    report.append(_with_comma(number))


def _decimal_comma(before: Entry, entry: Entry) -> Span | None:
    """The place of a number whose decimals are the name of the next entry, which has no value."""
    whole, decimals = before.value, entry.key
    if not isinstance(whole, Scalar) or type(whole.value) is not int:
        return None
    if not isinstance(entry.value, Scalar) or entry.value.value is not None:
        return None
    span = Span(decimals.source, whole.start, decimals.end)
    parts = span.text.partition(",")
    return span if parts[0].lstrip("-").isdigit() and parts[2].isdigit() else None


PRESET_FIELDS = ("type", "value", "doc", "secret")
"""The fields of the long form of userdata."""


def is_long_form(tree: Tree) -> bool:
    """Whether userdata is written `{type: T, value: V}`."""
    if not isinstance(tree, Map):
        return False
    keys = {entry.key.value for entry in tree.entries}
    return "value" in keys and keys <= {*PRESET_FIELDS}


def as_text(tree: Tree, report: Report) -> str:
    """A text on one or more lines."""
    if isinstance(tree, Scalar) and tree.value is not None:
        return str(tree.value)
    wrong(tree, "text", report)
    return ""


def as_flag(tree: Tree, report: Report) -> bool:
    """`true` or `false`."""
    if isinstance(tree, Scalar) and isinstance(tree.value, bool):
        return tree.value
    wrong(tree, "flag", report)
    return False


READERS: dict[str, Callable[[Tree, Report], object]] = {
    "name": as_name,
    "names": as_names,
    "outcomes": as_outcomes,
    "keys": as_keys,
    "map": as_map,
    "userdata": as_presets,
    "pairs": as_pairs,
    "rules": as_rules,
    "items": as_items,
    "text": as_text,
    "flag": as_flag,
    "value": lambda tree, report: as_value(tree),
}
"""Shape to reader."""
