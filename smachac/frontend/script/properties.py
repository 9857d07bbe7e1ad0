"""The properties of a script: from trees to typed forms (docs/properties.md)."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, cast

from smachac.diagnostics.diagnostic import Report, did_you_mean
from smachac.diagnostics.source import Source, Span
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import listed
from smachac.frontend.errors.script import wrong_shape
from smachac.frontend.loader import Library
from smachac.frontend.text.fields import kind_of
from smachac.frontend.text.yaml_tree import Entry, Map, Scalar, Seq, Tree, is_known_wrong
from smachac.grammars import parser_of
from smachac.ir.properties import (
    After,
    AlwaysEnds,
    AtMost,
    Atom,
    Atoms,
    Before,
    Exceptions,
    Form,
    Never,
    Property,
    Subject,
    in_words,
)
from smachac.records import replace

if TYPE_CHECKING:
    pass

FORMS = ("never", "before", "after", "whenever", "at_most", "always_ends")
OPTIONS = ("name", "exceptions", "stops")
EXCEPTIONS = ("caught", "all", "none")
STOPS = "write `stops: false` to leave stop requests out, or `stops: true`"

EXAMPLES: Mapping[str, str] = {
    "never": "`never: {after: CLOSE, until: OPEN, enter: MOVE}`",
    "before": "`before: {CLOSE: OPEN}`",
    "after": "`after: {PICK: [PLACE, LET_GO]}`",
    "whenever": "`whenever: {ALARM: STOP, within: 3 states, before_claim: arm}`",
    "at_most": "`at_most: {RETRY: 3}`",
    "always_ends": "`always_ends`",
}
"""How each form is written."""

MOST_TIMES = 1_000
"""Limit on the numbers of a property: its automaton has a state for each."""

_TIME = re.compile(r"[0-9.]{1,9}[ \t]*(ms|s|secs?|seconds?|min|minutes?|h|hours?)")
"""A time with its unit."""

_WITHIN = re.compile(r"([0-9]{1,9})(?:[ \t]+states?)?")


def properties_of(
    entry: Entry, source: Source, library: Library, report: Report
) -> tuple[Property, ...]:
    """The properties of a script: a list, or the name of a file with the list."""
    tree = entry.value
    if isinstance(tree, Scalar) and isinstance(tree.value, str) and not is_known_wrong(tree):
        found = _file(tree, source, library, report)
        if found is None:
            return ()
        tree = found
    if not isinstance(tree, Seq):
        if not is_known_wrong(tree):
            message = f"`properties` must be a list, not {kind_of(tree)}"
            help = _dashes(tree) or f"write a list: `- {EXAMPLES['before'].strip('`')}`"
            report.append(_fault(tree, message, help, "properties", kind_of(tree)))
        return ()
    reader = _Reader(report)
    split = {at for at, item in enumerate(tree.items[:-1]) if _is_split(item, tree.items[at + 1])}
    for at in split:
        form = cast(Map, tree.items[at + 1]).entries[0].key
        line, word = form.span.line, form.value
        help = f"remove the `-` before `{word}` in line {line}"
        reader.fault(tree.items[at], "this item has only a name", help, "no form")
    return tuple(
        found
        for at, item in enumerate(tree.items)
        if at not in split
        for found in reader.item(item)
    )


def _is_split(item: Tree, after: Tree) -> bool:
    """Whether an item has only a name, and the next one has a form and no name: they are probably
    one property."""
    if not (isinstance(item, Map) and isinstance(after, Map) and item.entries and after.entries):
        return False
    here, there = ([str(entry.key.value) for entry in one.entries] for one in (item, after))
    return here == ["name"] and there[0] in FORMS and "name" not in there


def _file(word: Scalar, source: Source, library: Library, report: Report) -> Tree | None:
    """The tree of the file that a script names; None if there is none, which is reported."""
    name = str(word.value)
    before = len(report)
    file = library.script(name, source.name)
    if file is not None:
        return library.parse(file, report)
    if len(report) == before:
        folders = ", ".join(f"`{folder}`" for folder in library.script_folders(source.name))
        message = f"the file `{name}` with the properties was not found"
        stem, dot, ending = name.rpartition(".")
        near = guesser(library.script_names(source.name))(stem if dot else name)
        help = f"give its path relative to a folder that is searched: {folders}"
        if near is not None and near != stem:
            help = f"did you mean `{near}{dot}{ending if dot else ''}`?"
        report.append(_fault(word, message, help, "file", name))
    return None


def _dashes(tree: Tree) -> str | None:
    """The help for properties that are written as one mapping, without the dashes of a list."""
    if not isinstance(tree, Map) or not tree.entries:
        return None
    if any(str(entry.key.value) not in FORMS for entry in tree.entries):
        return None
    first = tree.entries[0]
    text = Span(first.key.span.source, first.key.span.start, first.value.span.end).text
    shown = f"- {text}" if "\n" not in text else f"- {first.key.value}: ..."
    return f"begin each property with a dash: `{shown}`"


def _fault(tree: Tree | Scalar, message: str, help: str | None, *arguments: str) -> Any:
    effect = "no program is generated"
    if arguments[:1] == ("file",):
        effect = "without the file, none of its properties is checked, so no program is generated"
    return wrong_shape(tree.span, message, help, arguments=arguments, effect=effect)


class _Reader:
    """Reads items of a list of properties and reports what is wrong with them."""

    def __init__(self, report: Report) -> None:
        self.report = report

    def fault(self, tree: Tree, message: str, help: str | None, *arguments: str) -> None:
        if not is_known_wrong(tree):
            self.report.append(_fault(tree, message, help, *arguments))

    def item(self, tree: Tree) -> Iterator[Property]:
        """The properties of one item: one for each pair of its form."""
        if isinstance(tree, Scalar) and tree.value == "always_ends":
            tree = Map((Entry(tree, replace(tree, value=True)),), tree.span)
        if not isinstance(tree, Map):
            if isinstance(tree, Scalar):
                near = did_you_mean(str(tree.value), ("always_ends", *FORMS))
                if near is not None:
                    message = f"`{tree.value}` is not a form of property"
                    self.fault(tree, message, near, "form", str(tree.value))
                    return
            help = f"write it like {EXAMPLES['before']}"
            self.fault(tree, f"a property must be a mapping, not {kind_of(tree)}", help, "item")
            return
        fields: dict[str, Entry] = {}
        for entry in tree.entries:
            name = str(entry.key.value)
            if name in FORMS or name in OPTIONS:
                fields[name] = entry
            else:
                known = did_you_mean(name, (*FORMS, *OPTIONS))
                help = known or f"use one of {listed(FORMS)}"
                self.fault(entry.key, f"`{name}` is not a form of property", help, "form", name)
        forms = [name for name in fields if name in FORMS]
        if len(forms) > 1:
            second = fields[forms[1]].key
            help = f"begin another item with `- {forms[1]}:`"
            self.fault(second, "a property has one form; this is another one", help, "forms")
            return
        if not forms:
            if len(fields) == len(tree.entries):
                help = f"use one of {listed(FORMS)}"
                self.fault(tree, "this property has no form", help, "no form")
            return
        given = fields[forms[0]]
        options = self.options(fields)
        named = fields.get("name")
        for form in READERS[forms[0]](self, given.value):
            words = in_words(form)
            label = words
            if named is not None and isinstance(named.value, Scalar):
                label = str(named.value.value)
            yield Property(name=label, form=form, span=given.key.span, **options)

    def options(self, fields: Mapping[str, Entry]) -> dict[str, Any]:
        found: dict[str, Any] = {}
        if "exceptions" in fields:
            tree = fields["exceptions"].value
            if isinstance(tree, Scalar) and tree.value in EXCEPTIONS:
                found["exceptions"] = cast(Exceptions, tree.value)
            else:
                text = tree.span.text
                help = did_you_mean(text, EXCEPTIONS) or f"use one of {listed(EXCEPTIONS)}"
                message = "`exceptions` is none of `caught`, `all` and `none`"
                self.fault(tree, message, help, "exceptions", text)
        if "stops" in fields:
            tree = fields["stops"].value
            if isinstance(tree, Scalar) and isinstance(tree.value, bool):
                found["stops"] = tree.value
            else:
                self.fault(tree, "`stops` must be `true` or `false`", STOPS, "stops")
        return found

    def entries(self, tree: Tree, form: str) -> tuple[Entry, ...]:
        if isinstance(tree, Map) and tree.entries:
            return tree.entries
        message = f"`{form}` must be a mapping, not {kind_of(tree)}"
        self.fault(tree, message, f"write it like {EXAMPLES[form]}", form, kind_of(tree))
        return ()

    def never(self, tree: Tree) -> Iterator[Form]:
        parts: dict[str, Atoms] = {}
        entries = self.entries(tree, "never")
        wrong = False
        for entry in entries:
            name = str(entry.key.value)
            if name in ("after", "until", "enter"):
                parts[name] = self.atoms(entry.value)
                wrong = wrong or not parts[name]
                continue
            wrong = True
            help = did_you_mean(name, ("after", "until", "enter"))
            help = help or f"write it like {EXAMPLES['never']}"
            self.fault(entry.key, f"`{name}` is not a part of `never`", help, "never", name)
        if entries and not wrong and "enter" not in parts:
            help = f"write it like {EXAMPLES['never']}"
            self.fault(tree, "`never` needs `enter`: what must not happen", help, "never", "enter")
        elif parts and not wrong:
            yield Never(**parts)

    def before(self, tree: Tree) -> Iterator[Form]:
        for later, earlier in self.pairs(self.entries(tree, "before")):
            yield Before(later=later, earlier=earlier)

    def after(self, tree: Tree) -> Iterator[Form]:
        for first, answer in self.pairs(self.entries(tree, "after")):
            yield After(first=first, answer=answer)

    def pairs(self, entries: tuple[Entry, ...]) -> Iterator[tuple[Atoms, Atoms]]:
        for entry in entries:
            key, value = self.atoms(entry.key), self.atoms(entry.value)
            if key and value:
                yield key, value

    def whenever(self, tree: Tree) -> Iterator[Form]:
        entries = self.entries(tree, "whenever")
        limits = {str(entry.key.value): entry.value for entry in entries}
        pairs = [entry for entry in entries if entry.key.value not in ("within", "before_claim")]
        within, claims, wrong = 0, cast(Atoms, ()), False
        if "within" in limits:
            within = self.within(limits["within"])
            wrong = not within
        if "before_claim" in limits:
            claims = tuple(
                Atom(subject="claim", name=str(name.value), span=name.span)
                for name in self.names(limits["before_claim"])
            )
        if entries and not pairs:
            help = f"write it like {EXAMPLES['whenever']}"
            self.fault(tree, "`whenever` needs an event and its answer", help, "whenever")
        for first, answer in self.pairs(tuple(pairs)):
            if wrong:
                continue  # without its limit it would be another property
            yield After(first=first, answer=answer, within=within, before_claim=claims)

    def at_most(self, tree: Tree) -> Iterator[Form]:
        for entry in self.entries(tree, "at_most"):
            event = self.atoms(entry.key)
            never = f"write `never: {{enter: {entry.key.value}}}`"
            times = self.number(entry.value, "at_most", "`3`", never)
            if event and times:
                yield AtMost(event=event, times=times)

    def always_ends(self, tree: Tree) -> Iterator[Form]:
        if isinstance(tree, Scalar) and tree.value is True:
            yield AlwaysEnds()
        else:
            self.fault(tree, "`always_ends` has no parts", "write `- always_ends`", "always_ends")

    def within(self, tree: Tree) -> int:
        """The limit of a `whenever`; 0 for anything else, which is reported."""
        text = str(tree.value) if isinstance(tree, Scalar) else ""
        if _TIME.fullmatch(text):
            message = f"`within: {text}` is a time, but `within` counts states that are entered"
            self.fault(tree, message, "write a number of states: `within: 3 states`", "within")
            return 0
        return self.number(tree, "within", "`3 states`")

    def number(self, tree: Tree, form: str, example: str, zero: str = "") -> int:
        """A number of at least 1; 0 for anything else, which is reported. `zero`: the help for
        0."""
        text = str(tree.value) if isinstance(tree, Scalar) else ""
        found = _WITHIN.fullmatch(text)
        times = int(found[1]) if found else 0
        if not 1 <= times <= MOST_TIMES:
            message = f"`{form}` needs a whole number from 1 to {MOST_TIMES}"
            message += f", not `{text}`" if text else f", not {kind_of(tree)}"
            help = zero if zero and text == "0" else f"write it like {example}"
            self.fault(tree, message, help, form, "number")
            return 0
        return times

    def names(self, tree: Tree) -> list[Scalar]:
        """The scalars of a list of names or of one name."""
        items = tree.items if isinstance(tree, Seq) else (tree,)
        found = [item for item in items if isinstance(item, Scalar) and item.value is not None]
        if len(found) < len(items) or not items:
            help = "write a name, or a list of names: `[PLACE, LET_GO]`"
            self.fault(tree, f"expected the name of a state, found {kind_of(tree)}", help, "names")
            return []
        return found

    def atoms(self, tree: Tree) -> Atoms:
        """The atoms of a list or of one atom; none if one of them is wrong."""
        found = [self.atom(name) for name in self.names(tree)]
        return () if None in found else cast(Atoms, tuple(found))

    def atom(self, tree: Scalar) -> Atom | None:
        from smachac.grammars.standalone.lalr import LarkError

        text = tree.value if isinstance(tree.value, str) else tree.span.text
        if is_known_wrong(tree):
            return None
        try:
            parsed: Any = parser_of("property").parse(text)
        except LarkError:
            message = f"`{text}` does not name an event"
            help = "write a state, `PICK/GRASP`, an outcome, `PICK:aborted`, or `tag NAME`,"
            help += " `type NAME`, `claim NAME`"
            self.fault(tree, message, help, "atom", text)
            return None
        subject, outcome = parsed.children
        names = [_name(child) for child in subject.children if not hasattr(child, "type")]
        return Atom(
            subject=cast(Subject, str(subject.data)),
            name="/".join(names),
            outcome=None if outcome is None else _name(outcome),
            span=tree.span,
        )


READERS: Mapping[str, Callable[[_Reader, Tree], Iterator[Form]]] = {
    "never": _Reader.never,
    "before": _Reader.before,
    "after": _Reader.after,
    "whenever": _Reader.whenever,
    "at_most": _Reader.at_most,
    "always_ends": _Reader.always_ends,
}
"""The reader of each form."""


def _name(tree: Any) -> str:
    """The text of a name; in a quoted one a backslash stands before a quote."""
    token = tree.children[0]
    if token.type != "STRING":
        return str(token)
    return re.sub(r"\\(.)", r"\1", token[1:-1])
