"""Definitions and references: what a word of a script names, where that is declared and used."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import Literal

from smachac.diagnostics.source import Source, Span
from smachac.frontend.text.yaml_tree import Entry, Map, Scalar, Seq, Tree
from smachac.ir.nodes import NATIVE, Machine, StateType
from smachac.ir.script_paths import ScriptPath, walk_script
from smachac.lsp.facts import Facts
from smachac.lsp.place import FIELD, ITEM, KEY, STATE, VALUE, Body, Place
from smachac.pysource.modules.modules import load_module
from smachac.records import dataclass
from smachac.refactor.cst import UnsupportedYamlError
from smachac.refactor.editor import RefusedError, ScriptEditor
from smachac.refactor.refactorings import RENAME
from smachac.refactor.rename import Renaming

Kind = Literal["state", "outcome", "key"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Named:
    """What a word names: a state, an outcome of a state or a key of a container.

    `body` is the state, or the state or container that has the outcome or key. `declared`
    identifies the name for the refactoring engine, `places` are its declarations.
    """

    kind: Kind
    name: str
    body: Body
    declared: Span
    places: tuple[Span, ...]


def named_at(place: Place, facts: Facts) -> Named | None:
    """What the word at a place names, if that can be renamed."""
    word, body, around = str(place.word.value), place.body, place.around
    depth = len(place.inner)
    field, role = place.field, place.role
    if role == STATE:
        return _state(body) if place.word is body.name else None
    if role == FIELD:
        return None
    match field:
        case "transitions" if role == VALUE and depth == 1 and around is not None:
            return _child_or_outcome(around, word, facts)
        case "transitions" | "autonomy" if role == KEY:
            return _outcome(body, word, facts)
        case "outcomes" | "default_outcome" | "exhausted_outcome":
            return _outcome(body, word, facts)
        case "outcome_map" if role == KEY and depth == 0:
            return _outcome(body, word, facts)
        case "outcome_map" if role == KEY and depth == 1:
            return _child(body, word)
        case "outcome_map" if role == VALUE and depth == 2:
            child = _body_named(body, place.inner[1])
            return _outcome(child, word, facts) if child is not None else None
        case "initial" | "on_error":
            return _child_or_outcome(body, word, facts)
        case "final_outcome_map" if role == VALUE:
            return _outcome(body, word, facts)
        case "final_outcome_map" | "loop_outcomes" | "break_outcomes" | "connector_outcome":
            children = [state for state in body.states if word in facts.outcomes(state)]
            return _outcome(children[0], word, facts) if children else None
        case "remapping" if role == VALUE and around is not None:
            return _key(around, word, facts)
        case "remapping" if role == KEY:
            return _key(body, word, facts) if body.states else None
        case "input_keys" | "output_keys" if role == ITEM or (role == KEY and depth == 0):
            renamed = body.pairs("remapping")
            owner = body if body.states or around is None else around
            return _key(owner, word if owner is body else renamed.get(word, word), facts)
        case "userdata" if role == KEY and depth == 0:
            return _key(body if body.states or around is None else around, word, facts)
        case "it" | "it_label":
            return _key(body, word, facts)
    return None


def _state(body: Body) -> Named | None:
    if body.name is None:
        return None
    span = body.name.span
    return Named(kind="state", name=str(body.name.value), body=body, declared=span, places=(span,))


def _body_named(container: Body, name: str) -> Body | None:
    return next((state for state in container.states
                 if state.name is not None and str(state.name.value) == name), None)  # fmt: skip


def _child(container: Body, name: str) -> Named | None:
    found = _body_named(container, name)
    return _state(found) if found is not None else None


def _child_or_outcome(container: Body, name: str, facts: Facts) -> Named | None:
    return _child(container, name) or _outcome(container, name, facts)


def _outcome(body: Body, name: str, facts: Facts) -> Named | None:
    inner = facts.called(body)
    spans = [
        scalar.span for scalar in _names(inner.fields.get("outcomes")) if str(scalar.value) == name
    ]
    for field in ("default_outcome", "exhausted_outcome"):
        entry = inner.fields.get(field)
        if entry is not None and isinstance(entry.value, Scalar) and inner.text(field) == name:
            spans.append(entry.value.span)
    type_ = facts.type_named(inner.template)
    if type_ is not None:
        spans += [outcome.span for outcome in type_.outcomes if outcome.name == name]
    if not spans:
        return None
    return Named(kind="outcome", name=name, body=body, declared=spans[0], places=tuple(spans[:1]))


def _names(entry: Entry | None) -> Iterator[Scalar]:
    """The words of a field that is a list, or the keys of one that is a mapping."""
    match entry.value if entry is not None else None:
        case Seq(items=items):
            yield from (item for item in items if isinstance(item, Scalar))
        case Map(entries=entries):
            yield from (entry.key for entry in entries)


def _key(container: Body, name: str, facts: Facts) -> Named | None:
    """A key of a container; its declarations, or the states that write it if it has none."""
    states = container.states
    if not states or states[0].name is None:
        return None
    places = [
        scalar.span
        for field in ("userdata", "input_keys", "output_keys")
        for scalar in _names(container.fields.get(field))
        if str(scalar.value) == name
    ]
    if not places:
        for child in states:
            if any(key == name and writes for key, writes in facts.outer_keys(child)):
                places.append(_written_in(child, name) or _name_span(child))
    if not places and name not in facts.keys_in(container):
        return None
    declared = states[0].name.span
    return Named(kind="key", name=name, body=container, declared=declared,
                 places=tuple(places[:1]))  # fmt: skip


def _written_in(child: Body, name: str) -> Span | None:
    """The word of a state for a key of the container that it writes."""
    entry = child.fields.get("remapping")
    pairs = entry.value.entries if entry is not None and isinstance(entry.value, Map) else ()
    for pair in pairs:
        if isinstance(pair.value, Scalar) and str(pair.value.value) == name:
            return pair.value.span
    words = (*_names(child.fields.get("output_keys")), *_names(child.fields.get("userdata")))
    return next((word.span for word in words if str(word.value) == name), None)


def _name_span(body: Body) -> Span:
    assert body.name is not None
    return body.name.span


def definitions(place: Place, facts: Facts) -> list[Span]:
    """The places where the word at a place is defined."""
    word = str(place.word.value)
    if place.role != FIELD:
        if place.field == "template":
            return type_places(word, facts)
        if place.field == "script":
            found = facts.sub_script(word, facts.caller)
            return [_name_span(found[1])] if found is not None and found[1].name else []
        if place.siblings[:1] == ("params",) or f"[[{word}]]" in _around(place.word):
            return _params(place, word)
    if place.role == FIELD:
        return _variable_places(place.body, word, facts)
    if place.field == "remapping" and place.role == KEY and not place.body.states:
        return _interface_key(facts.called(place.body), word, facts)
    named = named_at(place, facts)
    return list(named.places) if named is not None else []


def _around(word: Scalar) -> str:
    return word.source.text[max(word.start - 2, 0) : word.end + 2]


def _params(place: Place, name: str) -> list[Span]:
    for body in reversed(place.bodies):
        found = [
            scalar.span for scalar in _names(body.fields.get("params")) if str(scalar.value) == name
        ]
        if found:
            return found
    return []


def type_places(name: str, facts: Facts) -> list[Span]:
    """The interface or template of a state type, and its Python class."""
    library = facts.library
    files = (f"{name}.yml", f"{name}.tpl.py", f"{name}.tpl")
    found = [source for file in files if (source := library.template(file)) is not None][:1]
    places = [Span(source, 0, 0) for source in found]
    type_ = facts.type_named(name)
    if type_ is not None:
        places += _class_places(type_, facts)
    return places


def _class_places(type_: StateType, facts: Facts) -> Iterator[Span]:
    """The class of a state type: in a module of Python, or in a header of C++."""
    known = type_.class_facts
    if known is not None and known.name is not None:
        yield known.name.span
    elif ":" in (code := next(_modules(type_), "")):
        module = load_module(code.partition(":")[0], facts.library)
        text = getattr(module, "text", None)
        if isinstance(text, Source):
            yield Span(text, 0, 0)
    elif type_.code.get("python"):
        template = facts.library.template(type_.code["python"])
        if template is not None:
            yield Span(template, 0, 0)
    header = type_.classes.get("cpp", {}).get("header", "")
    source = facts.library.code(header) if header else None
    if source is not None:
        at = source.text.find(f"class {type_.classes['cpp']['class'].rpartition('::')[2]}")
        yield Span(source, max(at, 0), max(at, 0))


def _modules(type_: StateType) -> Iterator[str]:
    """The code of a state type that names a class in a module of Python, or a template."""
    return (type_.code[key] for key in ("python", *NATIVE) if key in type_.code)


def _variable_places(body: Body, name: str, facts: Facts) -> list[Span]:
    """The declaration of a variable in the interface of the state's type."""
    source = facts.library.template(f"{body.template}.yml")
    tree = facts.library.parse(source, []) if source is not None else None
    return _in_section(tree, "variables", name)


def _interface_key(body: Body, name: str, facts: Facts) -> list[Span]:
    source = facts.library.template(f"{body.template}.yml")
    tree = facts.library.parse(source, []) if source is not None else None
    own = [scalar.span for part in ("input_keys", "output_keys")
           for scalar in _names(body.fields.get(part)) if str(scalar.value) == name]  # fmt: skip
    return [*own, *_in_section(tree, "input_keys", name), *_in_section(tree, "output_keys", name)]


def _in_section(tree: Tree | None, section: str, name: str) -> list[Span]:
    entry = tree.get(section) if isinstance(tree, Map) else None
    return [scalar.span for scalar in _names(entry) if str(scalar.value) == name]


def references(named: Named, machines: list[Machine]) -> list[Span]:
    """The words that stand for a name in the texts of some machines, its declaration first.

    They are those that the refactoring engine would replace; a text that it cannot rewrite has
    none.
    """
    editors: dict[str, ScriptEditor] = {}

    def editor(source: Source) -> ScriptEditor:
        key = os.path.realpath(source.name)
        if key not in editors:
            try:
                editors[key] = ScriptEditor(source)
            except UnsupportedYamlError as error:
                raise RefusedError(Span(source, 0, 0), str(error)) from error
        return editors[key]

    work = Renaming(named.name, f"{named.name}_renamed", editor)
    for machine in machines:
        try:
            RENAME[named.kind](work, machine, named.declared)
        except RefusedError:
            continue
    found = dict.fromkeys(
        [*named.places, *(s for editor in editors.values() for s in editor.replaced)]
    )
    return list(found)


def script_path(machine: Machine, body: Body, path: str) -> str | None:
    """The path of a state of a text in the script, without roles; None if it is not in the
    machine."""
    if body.name is None:
        return machine.root.name
    first = body.states[0].name if body.states else None
    inside: str | None = None
    for other in walk_script(machine.root):
        if _is_at(other.node.span, body.name, path):
            return other.plain
        if first is not None and inside is None and _is_at(other.node.span, first, path):
            inside = _above(other)
    return inside


def _is_at(span: Span, word: Scalar, path: str) -> bool:
    return span.start == word.start and os.path.realpath(span.source.name) == path


def _above(path: ScriptPath) -> str:
    return path.plain.rpartition("/")[0]
