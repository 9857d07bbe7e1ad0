"""Operators: the changes of a text that are tried for a finding, a function for each kind of slip.

An operator sees the text and the place of a finding, and proposes edits with a cost. It judges
nothing: whether an edit corrects the fault, a new check shows (search.py).
"""

from __future__ import annotations

import difflib
import re
import sys
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from itertools import islice, pairwise
from typing import NamedTuple

from smachac.diagnostics.diagnostic import Diagnostic
from smachac.diagnostics.negation import are_unlike
from smachac.diagnostics.repair import Certainty, Edit, Repair
from smachac.diagnostics.source import NOWHERE, Source, Span
from smachac.diagnostics.spelling import slips, words_of
from smachac.frontend import schema
from smachac.frontend.text.fields import PRESET_FIELDS
from smachac.frontend.text.recovering_parser import parse_with_recovery
from smachac.frontend.text.yaml_tree import Entry, Map, Scalar, Seq, Tree, parse
from smachac.ir.nodes import Machine
from smachac.ir.outcome_names import OF_SMACH
from smachac.ir.traversal import walk
from smachac.ir.types import WORDS as TYPE_WORDS
from smachac.records import replace

MOST_CANDIDATES = 8
"""The most candidates for one finding: each costs a check of the whole script."""

MOST_NEAR = 3
"""The most names near to a word."""

MOST_WORDS = 20
"""The most names of a finding, and of the other findings, that are compared with others."""

RENAME = "write another name"

KNOWN_FIELDS = {*schema.VARIABLES, *schema.LONG, *schema.VALUE_FACTS, *PRESET_FIELDS}
"""The names of the fields of states, of states' other forms, of values and of keys."""

SHORT_TEMPLATE = next(short for short, name in schema.LONG.items() if name == "template")

LEAST_LIKE = 0.65
"""The least part of equal letters of two names of which one can be the other one, misspelt."""

LONGEST_NAME = 100
"""In characters: a comparison of two names takes quadratic time."""

NAME = re.compile(r"[A-Za-z_]\w{2,}")


class Candidate(NamedTuple):
    """A repair that may correct a fault. Of two that do, the one with the lower cost is meant."""

    cost: float
    repair: Repair

    @property
    def order(self) -> tuple[object, ...]:
        """The place among all candidates: the same in every run."""
        spans = [(edit.span, edit.text) for edit in self.repair.edits]
        rows = [(span.source.name, span.start, span.end, text) for span, text in spans]
        return (self.cost, rows)


def candidate(
    cost: float, operator: str, *edits: Edit, certainty: Certainty = Certainty.LIKELY
) -> Candidate:
    """The candidate of an operator."""
    return Candidate(cost, Repair(edits=edits, certainty=certainty, operator=operator))


class Text(NamedTuple):
    """A source with what operators read of it: its tree, its names with how often each is, and the
    names that can be meant: those of the source, of the machine and of its state types. `uses` is
    how often each name is in the source, in the language and in the state types, `by_slip` are the
    names by what they have in common with a name that is one slip away (`slips`)."""

    source: Source
    tree: Tree | None
    counts: Counter[str]
    uses: Counter[str]
    names: tuple[str, ...]
    by_slip: Mapping[str, list[str]]

    @property
    def whole(self) -> Span:
        """The range of the source."""
        return Span(self.source, 0, len(self.source.text))


def text_of(source: Source, machine: Machine | None, types: Iterable[str]) -> Text:
    """A source, read for operators. `types` are the names of all state types."""
    counts = Counter(NAME.findall(source.text))
    given = [*_given_names(machine)] if machine is not None else []
    own = _names_in(machine) if machine is not None else ()
    known = dict.fromkeys([*counts, *TYPE_WORDS, *types, *given, *own])
    names = [name for name in known if len(name) <= LONGEST_NAME and " " not in name]
    by_slip: dict[str, list[str]] = {}
    for name in names:
        for slip in dict.fromkeys(slips(name)):
            by_slip.setdefault(slip, []).append(name)
    return Text(
        source, parse_with_recovery(source, []), counts, counts + Counter(given), (*names,), by_slip
    )


def _given_names(machine: Machine) -> Iterator[str]:
    """The names of the language, and those in the interfaces of the state types of a machine."""
    yield from (*schema.VARIABLES, *OF_SMACH)
    for name, type_ in machine.state_types.items():
        yield name
        yield from type_.variables
        yield from (key.name for key in (*type_.input_keys, *type_.output_keys))
        yield from (outcome.name for outcome in type_.outcomes)


def _names_in(machine: Machine) -> Iterator[str]:
    """The names in the states of a machine."""
    for _, node in walk(machine.root):
        yield node.name
        yield from (key.name for key in (*node.inputs, *node.outputs))
        yield from (outcome.name for outcome in node.outcomes)


MOST_PLACES = 4
"""The most places of a finding at which the structure of the text is changed."""


class Around(NamedTuple):
    """What operators know beside a finding: `read` returns what they read of a source, `others` are
    the names that the other findings are about, `types` the texts of interfaces by state type,
    `interface` returns the user's interface of a state type, `vocabulary` are the names of the
    project."""

    read: Callable[[Source], Text]
    others: Sequence[str]
    types: Mapping[str, str]
    interface: Callable[[str], Source | None]
    vocabulary: Vocabulary


class Vocabulary(NamedTuple):
    """How often each name is in the texts of a project, scripts, interfaces and classes, and how
    often each word of a name; `capitals` are the names of states and of types."""

    names: Counter[str]
    words: Counter[str]
    capitals: frozenset[str]

    def is_rarer(self, name: str, other: str) -> bool:
        """Whether a name is more likely to be misspelt than another one: it is used less often, or
        its words are that the other one does not have, or it has capital letters and is not the
        name of a state or of a type. A name in no text is one of the language."""
        words, others = {*name.split("_")}, {*other.split("_")}
        is_part = words <= others or others <= words
        has_capitals = name in self.capitals or other in self.capitals

        def use(name: str, own: set[str]) -> tuple[int, int, bool]:
            if not self.names[name]:
                return (1, sys.maxsize, True)
            rarest = sys.maxsize if is_part else min(self.words[word] for word in own)
            return (self.names[name], rarest, name.islower() != has_capitals)

        return use(name, words - others) < use(other, others - words)


def vocabulary_of(
    texts: Iterable[str], machine: Machine | None, types: Iterable[str]
) -> Vocabulary:
    """The names in the texts of a project. `types` are the names of all state types."""
    names = Counter(name for text in texts for name in NAME.findall(text))
    words: Counter[str] = Counter()
    for name, count in names.items():
        words.update(dict.fromkeys(name.split("_"), count))
    states = (node.name for _, node in walk(machine.root)) if machine is not None else ()
    return Vocabulary(names, words, frozenset([*types, *states]))


def candidates(item: Diagnostic, around: Around) -> list[Candidate]:
    """The candidates for a finding, the best first; at most MOST_CANDIDATES."""
    places = [item.span, *(related.span for related in item.finding.related)]
    places = [span for span in places if span.source is not NOWHERE.source]
    if not places or places[0] is not item.span:
        return []
    text = around.read(item.span.source)
    found = [*_near_names(item, text, around.vocabulary)]
    same = _same_keys(item.span, text.tree)
    if same != 1 or item.span.text not in KNOWN_FIELDS:
        # The names in code are not those of the script around it.
        found += _mentioned_names(item, () if item.code == "SM019" else around.others)
    if same > 1:  # which of them is wrong is not known
        found = [_only_possible(made) for made in found]
    found += _unused_names(item, text)
    found += _other_forms(item, text)
    for span in dict.fromkeys(places[:MOST_PLACES]):
        tree = around.read(span.source).tree
        path = list(_path_to(tree, span.start, span.end)) if tree is not None else []
        interface = around.interface(_type_of(path))
        if interface is not None:
            found += _names_of_interface(item, text, around.read(interface), around.vocabulary)
            found += _other_classes(_type_of(path), around.read(interface), around.types)
        found += _turned_pairs(path)
        found += _exchanged_values(path, item.span)
        found += _repeated_parts(path, span.source, 1.0 if span is item.span else 1.1)
        found += _other_types(path, around.types)
        found += _lengths(item, path, around.others)
        found += _moved_out(path, span.source)
        found += _moved_states(path, span.source)
    unique = {made.repair.edits: made for made in sorted(found, key=_order, reverse=True)}
    return sorted(unique.values(), key=_order)[:MOST_CANDIDATES]


def _order(made: Candidate) -> tuple[object, ...]:
    return made.order


def _path_to(tree: Tree, start: int, end: int) -> Iterator[Tree | Entry]:
    """The parts of a tree that hold a range, from the whole to the smallest."""
    part: Tree | Entry | None = tree
    while part is not None:
        yield part
        inside: list[Tree | Entry]
        match part:
            case Map(entries=entries):
                inside = [*entries]
            case Seq(items=items):
                inside = [*items]
            case Entry(key=key, value=value):
                inside = [key, value]
            case _:
                return
        part = next((item for item in inside if _start(item) <= start and end <= _end(item)), None)


def _start(part: Tree | Entry) -> int:
    return part.key.start if isinstance(part, Entry) else part.span.start


def _end(part: Tree | Entry) -> int:
    return part.value.span.end if isinstance(part, Entry) else part.span.end


def _near_names(item: Diagnostic, text: Text, vocabulary: Vocabulary) -> Iterator[Candidate]:
    """A name in place of one that it is like: at the place of the finding, and where a name is
    written only once that the finding is about, or that is like one that it is about."""
    words = dict.fromkeys(NAME.findall(item.span.text)[:MOST_NEAR])
    for word in words:
        for cost, name in _near(word, text):
            cost += text.uses[name] < text.uses[word]
            for span in _places(word, item.span):
                yield candidate(cost, RENAME, Edit(span=span, text=name))
    yield from _declared_names(item, text, vocabulary, 0.5)
    for word in _words_of(item):
        if text.counts[word] == 1 and word not in item.span.text:
            for cost, name in _near(word, text):
                for span in _places(word, text.whole):
                    yield candidate(cost + 0.5, RENAME, Edit(span=span, text=name))


def _declared_names(
    item: Diagnostic, text: Text, vocabulary: Vocabulary, more: float
) -> Iterator[Candidate]:
    """A name that the finding is about in place of one that is like it, and that is in a text only
    once: there it is declared, or misspelt."""
    for word in _words_of(item):
        for cost, name in _near(word, text):
            if text.counts[name] == 1:
                cost += 0.1 if vocabulary.is_rarer(name, word) else more
                for span in _places(name, text.whole):
                    yield candidate(cost, RENAME, Edit(span=span, text=word))


def _words_of(item: Diagnostic) -> Iterable[str]:
    """The names at the place of a finding, and those that it is about."""
    words = (*NAME.findall(item.span.text)[:MOST_NEAR], *item.finding.arguments[:MOST_WORDS])
    return dict.fromkeys(word for word in words if NAME.fullmatch(word))


def _names_of_interface(
    item: Diagnostic, text: Text, interface: Text, vocabulary: Vocabulary
) -> Iterator[Candidate]:
    """As `_declared_names`, in the interface of the state; and a name of the finding there, in
    place of which a name that it is like is meant. Not in `code`: without a class less is known;
    no name of a state, which is in upper case."""
    found = [*_declared_names(item, interface, vocabulary, 0.6)]
    for word in _words_of(item):
        if interface.counts[word] == 1:
            for cost, name in _near(word, text):
                for span in _places(word, interface.whole):
                    found.append(candidate(cost + 0.7, RENAME, Edit(span=span, text=name)))
    code = interface.tree.get("code") if isinstance(interface.tree, Map) else None
    for made in found:
        (edit,) = made.repair.edits
        is_in_code = code is not None and _start(code) <= edit.span.start < _end(code)
        if not is_in_code and edit.text.isupper() <= edit.span.text.isupper():
            yield made


def _other_classes(type_: str, interface: Text, types: Collection[str]) -> Iterator[Candidate]:
    """The name of the state type, in its interface, in place of that of another one."""
    for name in interface.counts:
        if name in types and name != type_:
            for span in _places(name, interface.whole):
                yield candidate(1.5, RENAME, Edit(span=span, text=type_))


def _unused_names(item: Diagnostic, text: Text) -> Iterator[Candidate]:
    """A name of the finding that is in a text only once, so that nothing uses it: in place of a
    name with a word in common, in a state whose name has its other word."""
    if text.tree is None:
        return
    for word in _words_of(item):
        words = words_of(word) if text.counts[word] == 1 else set()
        names = text.counts if words and len(text.counts) <= MOST_COMPARED else ()
        alike = (name for name in names if name != word and words & words_of(name))
        for name in islice(alike, MOST_WORDS):
            for span in _places(name, text.whole):
                path = _path_to(text.tree, span.start, span.end)
                keys = [str(part.key.value) for part in path if isinstance(part, Entry)]
                if words_of(*keys) & (words - words_of(name)):
                    yield candidate(1.6, RENAME, Edit(span=span, text=word))


_VALUE = r"(?<=: )(?:WORD|\$\((?:\w+ )?WORD\)|['\"](?:\$\{|\{\{)\s*WORD\s*\}+['\"])(?=[,}\s])"
"""A value that is a word, or its look-up in the syntax of launch files, shells or templates."""


def _other_forms(item: Diagnostic, text: Text) -> Iterator[Candidate]:
    """A name of the finding without the brackets of a list of this one name; and as a look-up of a
    param in place of a value that is its name."""
    for word in _words_of(item):
        alone = [*re.finditer(rf"\[\s*{word}\s*\]", text.source.text)]
        values = [*re.finditer(_VALUE.replace("WORD", word), text.source.text)]
        for found in alone:
            edit = Edit(span=Span(text.source, *found.span()), text=word)
            yield candidate(1.4, "remove the brackets", edit)
        for found in (*alone, *values) if "params" in text.counts else ():
            edit = Edit(span=Span(text.source, *found.span()), text=f"[params, {word}]")
            yield candidate(1.5, "look the param up", edit)


def _mentioned_names(item: Diagnostic, others: Sequence[str]) -> Iterator[Candidate]:
    """Another name that this or another finding is about, or that is at its other places, in place
    of the one at its place."""
    word = item.span.text
    if not NAME.fullmatch(word):
        return
    near = [related.span.text for related in item.finding.related]
    own = (*item.finding.arguments[:MOST_WORDS], *near)
    for cost, names in ((1.6, own), (1.7, others)):
        for name in dict.fromkeys(names):
            if name != word and NAME.fullmatch(name) and not _are_of_two_kinds(word, name):
                yield candidate(cost, RENAME, Edit(span=item.span, text=name))


def _same_keys(span: Span, tree: Tree | None) -> int:
    """How many entries of a mapping have the name at a range; 0 if it is not that of an entry."""
    path = list(_path_to(tree, span.start, span.end)) if tree is not None else []
    for around, part in pairwise(path):
        if isinstance(around, Map) and isinstance(part, Entry) and part.key.span == span:
            return sum(entry.key.value == part.key.value for entry in around.entries)
    return 0


def _only_possible(made: Candidate) -> Candidate:
    return made._replace(repair=replace(made.repair, certainty=Certainty.POSSIBLE))


def _places(word: str, span: Span) -> Iterator[Span]:
    """The places of a name in a range."""
    for found in re.finditer(rf"(?<!\w){re.escape(word)}(?!\w)", span.text):
        yield Span(span.source, span.start + found.start(), span.start + found.end())


MOST_COMPARED = 500
"""With more names, only those one slip away are found: to compare all would take too long."""


def _near(word: str, text: Text) -> list[tuple[float, str]]:
    """The names that a word is like, with costs: 1 for one slip, 1.5 for a name of which the word
    is a part, else 2 minus the ratio of equal letters."""
    if len(word) > LONGEST_NAME:
        return []
    ranked: dict[str, float] = {}
    for slip in slips(word):
        ranked.update(dict.fromkeys(text.by_slip.get(slip, ()), 1.0))
    folded = word.casefold()
    for name in text.names if len(text.names) <= MOST_COMPARED else ():
        if name in ranked:
            continue
        if folded in name.casefold().split("_"):
            ranked[name] = 1.5
            continue
        likeness = _likeness(folded, name.casefold())
        if likeness > LEAST_LIKE:
            ranked[name] = 2.0 - likeness
    found = [
        (cost - 0.01 * min(text.counts[name], 9), name)
        for name, cost in ranked.items()
        if name != word and not are_unlike(word, name) and not _are_of_two_kinds(word, name)
    ]
    return sorted(found)[:MOST_NEAR]


def are_alike(word: str, name: str) -> bool:
    """Whether one of two names can be the other one, misspelt."""
    return _likeness(word.casefold(), name.casefold()) > LEAST_LIKE


def _likeness(word: str, name: str) -> float:
    """The part of the letters of two names that they have in common; 0.0 if it is too small."""
    if max(len(word), len(name)) > LONGEST_NAME:
        return 0.0
    match = difflib.SequenceMatcher(None, word, name)
    is_near = match.real_quick_ratio() > LEAST_LIKE and match.quick_ratio() > LEAST_LIKE
    return match.ratio() if is_near else 0.0


def _are_of_two_kinds(word: str, name: str) -> bool:
    """Whether one of two names begins with a capital letter, as those of types and states do, and
    the other one is not the same name without it."""
    return word[0].isupper() != name[0].isupper() and word.casefold() != name.casefold()


def _turned_pairs(path: list[Tree | Entry]) -> Iterator[Candidate]:
    """The innermost entry with two plain words, turned round; not if it begins with the name of a
    field and would not do so then."""
    for part in reversed(path):
        if isinstance(part, Entry) and isinstance(part.value, Scalar) and part.value.span.text:
            key, value = part.key.span, part.value.span
            if key.text in KNOWN_FIELDS and value.text not in KNOWN_FIELDS:
                return
            edits = (Edit(span=key, text=value.text), Edit(span=value, text=key.text))
            yield candidate(1.5, "exchange name and value", *edits)
            return


def _exchanged_values(path: list[Tree | Entry], found: Span) -> Iterator[Candidate]:
    """The value of the innermost entry, exchanged with the others of its mapping. A list or a
    mapping is exchanged only if the finding is about the whole value: then its shape can be the
    fault."""
    for around, entry in reversed([*pairwise(path)]):
        if not isinstance(around, Map) or not isinstance(entry, Entry):
            continue
        own = entry.value.span
        fits = _fits_anywhere if own == found else _is_word
        for other in around.entries if fits(entry.value) else ():
            value = other.value.span
            if fits(other.value) and value.text != own.text:
                edits = (Edit(span=own, text=value.text), Edit(span=value, text=own.text))
                names = f"`{entry.key.value}` and `{other.key.value}`"
                yield candidate(1.8, f"exchange the values of {names}", *edits)
        return


def _is_word(value: Tree) -> bool:
    """Whether a value is a single one that is written."""
    return isinstance(value, Scalar) and bool(value.span.text)


def _fits_anywhere(value: Tree) -> bool:
    """Whether a value can stand in the place of every other one: it has text, on one line, and a
    list or a mapping has brackets."""
    text = value.span.text
    return bool(text) and "\n" not in text and (isinstance(value, Scalar) or text[0] in "[{")


def _state_in(path: list[Tree | Entry]) -> Map | None:
    """The fields of the innermost state that has a template."""
    for part in reversed(path):
        fields = part.value if isinstance(part, Entry) else part
        if isinstance(fields, Map) and _template_in(fields) is not None:
            return fields
    return None


def _template_in(state: Map) -> Entry | None:
    return state.get("template") or state.get(SHORT_TEMPLATE)


def _type_of(path: list[Tree | Entry]) -> str:
    """The state type of the innermost state; empty if there is none."""
    state = _state_in(path)
    entry = _template_in(state) if state is not None else None
    return entry.value.span.text if entry is not None else ""


def _other_types(path: list[Tree | Entry], types: Mapping[str, str]) -> Iterator[Candidate]:
    """The state types that have all fields of the innermost state, in place of its own one; for a
    container, the other kinds of containers."""
    state = _state_in(path)
    entry = _template_in(state) if state is not None else None
    if state is None or entry is None:
        return
    word = entry.value.span.text
    own = [str(entry.key.value) for entry in state.entries if entry.key.value not in schema.LONG]
    fields = [name for name in own if name not in schema.VARIABLES]
    fitting = [
        name
        for name, text in types.items()
        if fields and name != word
        if all(re.search(rf"\b{re.escape(field)}\b", text) for field in fields)
    ]
    entries = [part for part in path if isinstance(part, Entry)][-1:]
    is_own = any(entry.value is state or entry in state.entries for entry in entries)
    is_whole = is_own and word in schema.CONTAINERS
    kinds = [name for name in schema.CONTAINERS if is_whole and name != word]
    for name in (*kinds, *(fitting if len(fitting) <= MOST_NEAR else ())):
        cost = 1.2 if name in kinds else 1.7
        yield candidate(cost, RENAME, Edit(span=entry.value.span, text=name))


_LENGTH = re.compile(r"\[\d+\]")


def _lengths(
    item: Diagnostic, path: list[Tree | Entry], others: Sequence[str]
) -> Iterator[Candidate]:
    """The length of the list at a finding in place of that in the type of the innermost entry, if
    the type is an argument of another finding too: then several lists do not fit it."""
    entry = path[-2] if len(path) > 1 else None
    text, value = item.span.text, entry.value if isinstance(entry, Entry) else None
    if not isinstance(value, Scalar) or text[:1] != "[" or value.value not in others:
        return
    length = parse(Source("", text), [])
    found = _LENGTH.search(value.span.text)
    if isinstance(length, Seq) and found is not None and value.value in item.finding.arguments:
        type_ = _LENGTH.sub(f"[{len(length.items)}]", value.span.text, count=1)
        edit = Edit(span=value.span, text=type_)
        yield candidate(1.2, "write the length of the lists", edit)


def _moved_out(path: list[Tree | Entry], source: Source) -> Iterator[Candidate]:
    """The lines of the innermost entry, moved out of the one or the two entries that it is in:
    behind that one, with its indentation."""
    entries = [part for part in path if isinstance(part, Entry)]
    if len(entries) < 2:
        return
    inner, text = entries[-1], source.text
    start, end = _lines_of(inner, text)
    if text[start : _start(inner)].strip():
        return  # in braces
    for outer in entries[-2:-4:-1]:
        first, last = _lines_of(outer, text)
        columns = inner.key.span.column - outer.key.span.column
        moved = re.sub(rf"(?m)^ {{{columns}}}", "", text[start:end])
        rest = text[end:last]
        whole = Span(source, start, last)
        if columns > 0 and first < start:
            name, position = inner.key.span.text, source.position
            after = f"behind line {position(last - 1)[0]}" if rest else "there"
            operator = f"move `{name}` {after}, {columns} columns to the left"
            yield candidate(1.3, operator, Edit(span=whole, text=rest + moved))


def _moved_states(path: list[Tree | Entry], source: Source) -> Iterator[Candidate]:
    """The lines of the innermost state with another indentation: that of the states around its
    container if it is the last one in that, and that of the states of the container before it."""
    lists = [
        (around, part)
        for around, part in pairwise(path)
        if isinstance(around, Seq) and isinstance(part, Map)
    ]
    if not lists:
        return
    items, state = lists[-1]
    at = next(number for number, item in enumerate(items.items) if item is state)
    others: list[Tree] = [lists[-2][1]] if at + 1 == len(items.items) and len(lists) > 1 else []
    before = items.items[at - 1] if at > 0 else None
    fields = before.entries[0].value if isinstance(before, Map) and before.entries else None
    inner = fields.get("states") if isinstance(fields, Map) else None
    if inner is not None and isinstance(inner.value, Seq) and inner.value.items:
        others.append(inner.value.items[-1])
    start, end = _lines_of(state, source.text)
    lines = source.text[start:end].splitlines(keepends=True)
    for other in others:
        columns = _dash(other, source.text) - _dash(state, source.text)
        moved = (" " * columns + line if columns > 0 else line[-columns:] for line in lines)
        text, way = "".join(moved), "right" if columns > 0 else "left"
        operator = f"move them {abs(columns)} columns to the {way}"
        yield candidate(1.3, operator, Edit(span=Span(source, start, end), text=text))


def _dash(part: Tree | Entry, text: str) -> int:
    """The column of the `-` before an item of a list."""
    line, _ = _lines_of(part, text)
    return text.find("-", line) - line


def _lines_of(part: Tree | Entry, text: str) -> tuple[int, int]:
    """The range of the whole lines of a part of a tree."""
    end = text.find("\n", _end(part)) + 1
    return text.rfind("\n", 0, _start(part)) + 1, end or len(text)


def _repeated_parts(path: list[Tree | Entry], source: Source, cost: float) -> Iterator[Candidate]:
    """The lines of an entry or an item that is in its mapping or list twice, deleted."""
    for around, part in reversed([*pairwise(path)]):
        others: list[Tree | Entry] = []
        if isinstance(around, Map):
            others = [*around.entries]
        elif isinstance(around, Seq):
            others = [*around.items]
        if sum(other == part for other in others) > 1:
            span = Span(source, *_lines_of(part, source.text))
            yield candidate(cost, "delete a copy", Edit(span=span, text=""))
            return
