"""Fields of a state that are indented too far: they are in the mapping of another field, such as
`retry` under `transitions`.

They are reported once (SM004) and then count as fields of the state, so that nothing else follows.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Set

from smachac.diagnostics.diagnostic import Diagnostic, Report
from smachac.diagnostics.source import Span, Word
from smachac.frontend import schema
from smachac.frontend.errors.script import duplicate_key, wrong_shape
from smachac.frontend.field_shapes import fits_field
from smachac.frontend.params import look_up_word
from smachac.frontend.schema import FieldOwner
from smachac.frontend.sugar import duration
from smachac.frontend.yaml_tree import Entry, Map, Scalar, Seq, Tree
from smachac.ir.nodes import StateType

_OF_NAMES = ("transitions", "remapping", "final_outcome_map")
"""The fields that are mappings of names to names."""

_COLLECTIONS = frozenset(
    ["transitions", "remapping", "input_keys", "output_keys", "outcomes", "retry", "for_each"]
)
"""The fields that are certain in a mapping that may have any names, if the state has none."""

_WITHOUT_FIELDS = frozenset(
    ["params", "states", "properties", "types", *_OF_NAMES, *_COLLECTIONS]
).difference(["retry", "for_each"])
"""The fields that may contain anything, or whose parts are no fields of a state for other rules."""

_FIELDS = frozenset(
    name
    for row in schema.VARIABLES.values()
    if row.owners != {"base"}
    for name in (row.name, row.short)
    if name
)
"""The short and long names of the fields of states."""

_CODE = ("callbacks", "conditions")
"""The roles of variables that are mappings of declared names to code."""

_PARTS = {
    "transitions": "an outcome",
    "outcome_map": "an outcome",
    "conditions": "a condition",
    "remapping": "a key",
    "final_outcome_map": "a key",
    "callbacks": "a key",
    "userdata": "a key",
}
"""What the names in a mapping are, by the field or its role."""

_NAMED = frozenset(["template", "script"])
"""The fields with one name that every state has, if it is not another kind of field."""


_ONE_NAME: Mapping[str, frozenset[str]] = {
    owner: frozenset(
        key for key in schema.names_for(owner) if schema.VARIABLES[key].shape == "name"
    )
    - _NAMED
    for owner in ("base", "state", *schema.CONTAINERS)
}
"""The fields with one name that not every state has, by owner."""


def _has(tree: Map, names: Collection[object]) -> bool:
    """Whether a key of a mapping is one of the names."""
    found = False
    for entry in tree.entries:  # `any` takes longer, and this is done several times for each state
        found = found or entry.key.value in names
    return found


def with_outer_fields(name: Word, own: dict[str, Entry], report: Report) -> dict[str, Entry]:
    """The fields of a state by long name, with those that are in the mapping of another one beside
    it."""
    for part in _OF_NAMES:
        entry = own.get(part)
        if entry is None or not isinstance(entry.value, Map) or not _has(entry.value, _FIELDS):
            continue
        outer = dict(_outer_fields(entry.value, own))
        if outer:  # the rest that is no name was moved together with it
            found = {id(each) for each in outer.values()}
            outer = {
                schema.LONG.get(str(each.key.value), str(each.key.value)): each
                for each in entry.value.entries
                if id(each) in found or not (_is_text(each.value) or look_up_word(each.value))
            }
        own = _moved(name, own, part, outer, report)
    for part in own:
        if part in _WITHOUT_FIELDS:
            continue
        tree = own[part].value
        if not isinstance(tree, Map):
            continue
        outer = {key: each for each in tree.entries
                 if (key := str(each.key.value)) in _COLLECTIONS and key not in own
                 and fits_field(key, each.value)}  # fmt: skip
        if outer and part == "userdata":  # in a container, a state inside may read such a list
            outer = {key: each for key, each in outer.items() if key not in _names(own, None)
                     and ("states" not in own or isinstance(each.value, Map))}  # fmt: skip
        own = _moved(name, own, part, outer, report)
    return own


def with_inner_rules(own: dict[str, Entry], report: Report) -> dict[str, Entry]:
    """The fields of a concurrence by long name, with the outcome map that one of its states has in
    its place: an entry of it begins with the name of a state beside it."""
    template, states = own.get("template"), own.get("states")
    if template is None or states is None or "outcome_map" in own:
        return own
    is_concurrence = isinstance(template.value, Scalar) and template.value.value == "Concurrence"
    if not is_concurrence or not isinstance(states.value, Seq):
        return own
    items = states.value.items
    names = {str(each.key.value) for item in items if isinstance(item, Map)
             for each in item.entries}  # fmt: skip
    for at, item in enumerate(items):
        child = item.entries[0] if isinstance(item, Map) and len(item.entries) == 1 else None
        fields = child.value.entries if child is not None and isinstance(child.value, Map) else ()
        for each in fields:
            key = schema.LONG.get(str(each.key.value), str(each.key.value))
            if key != "outcome_map" or child is None or not _has_rules(each.value, names):
                continue
            word = str(each.key.value)
            where = "beside its `states`"
            if states.key.span.line != child.key.span.line:
                columns = each.key.span.column - states.key.span.column
                where = f"{columns} column{'s' * (columns > 1)} further left, {where}"
            message = f"`{word}` is a field of the concurrence, not of its state"
            message += f" `{child.key.value}`"
            report.append(
                wrong_shape(each.key.span, message, f"write `{word}` {where}",
                            arguments=("inner", word))
            )  # fmt: skip
            rest = tuple(other for other in fields if other is not each)
            fixed = Map((Entry(child.key, Map(rest, child.value.span)),), item.span)
            changed = Seq((*items[:at], fixed, *items[at + 1 :]), states.value.span)
            return {**own, "outcome_map": each, "states": Entry(states.key, changed)}
    return own


def _has_rules(tree: Tree, names: Set[str]) -> bool:
    """Whether a tree is an outcome map with a condition on one of some states."""
    return isinstance(tree, Map) and any(
        str(part.key.value) in names
        for rule in tree.entries
        if isinstance(rule.value, Map)
        for part in rule.value.entries
    )


def with_outer_variables(
    name: Word, own: dict[str, Entry], owner: FieldOwner, type_: StateType, report: Report
) -> dict[str, Entry]:
    """As `with_outer_fields`, for the variables of the state type, whose values are no names; and
    for those and the fields with one name in a mapping whose names the state declares."""
    own = _with_outer_names(name, own, owner, type_, report)
    for part in _OF_NAMES if type_.variables else ():
        entry = own.get(part)
        if entry is None or not isinstance(entry.value, Map):
            continue
        if not _has(entry.value, type_.variables):
            continue
        outer = {
            str(each.key.value): each
            for each in entry.value.entries
            if each.key.value in type_.variables and not _is_text(each.value)
        }
        own = _moved(name, own, part, outer, report)
    return own


def _with_outer_names(
    name: Word, own: dict[str, Entry], owner: FieldOwner, type_: StateType, report: Report
) -> dict[str, Entry]:
    """The fields with those of one value that are in a mapping of declared outcomes or keys."""
    fields, variables = _ONE_NAME[owner], type_.variables
    parts: list[str] = []
    if variables:
        parts = sorted([key for key in own if key in variables and variables[key].role in _CODE])
    for part in ("transitions", "outcome_map", *parts):
        entry = own.get(part)
        if entry is None or not isinstance(entry.value, Map):
            continue
        if not _has(entry.value, fields) and not _has(entry.value, variables):
            continue
        outer = {str(key): each for each in entry.value.entries
                 if ((key := each.key.value) in fields or key in variables)
                 and key not in own and _is_one_value(each.value)}  # fmt: skip
        if outer:
            outer = {key: each for key, each in outer.items() if key not in _names(own, type_)}
            role = type_.variables[part].role if part in parts else ""
            own = _moved(name, own, part, outer, report, role)
    return own


def _is_one_value(value: Tree) -> bool:
    """Whether a value is a number, a boolean, or one word, which is no code."""
    if not isinstance(value, Scalar) or value.value is None:
        return False
    return not isinstance(value.value, str) or value.value.isidentifier()


def _names(own: Mapping[str, Entry], type_: StateType | None) -> set[str]:
    """The outcomes and keys that a state and its type declare."""
    listed = (type_.outcomes, type_.input_keys, type_.output_keys) if type_ is not None else ()
    names = {each.name for names in listed for each in names}
    for part in ("outcomes", "input_keys", "output_keys"):
        tree = own[part].value if part in own else None
        if isinstance(tree, Map):
            names.update(str(each.key.value) for each in tree.entries)
        elif isinstance(tree, Seq):
            names.update(str(each.value) for each in tree.items if isinstance(each, Scalar))
    return names


def _moved(
    name: Word,
    own: dict[str, Entry],
    part: str,
    outer: Mapping[str, Entry],
    report: Report,
    role: str = "",
) -> dict[str, Entry]:
    """The fields with those of a mapping beside it, which are reported. `role`: that of the
    mapping."""
    if not outer:
        return own
    entry, moved = own[part], list(outer.values())
    tree = entry.value
    assert isinstance(tree, Map)
    words = [str(each.key.value) for each in moved]
    first = moved[0].key
    what = _PARTS.get(role or part, "a part")
    message = f"`{words[0]}` is a field of the state `{name.text}`, not {what} in `{part}`"
    columns = first.span.column - entry.key.span.column
    flow = first.span.line == entry.key.span.line or columns <= 0
    move = f"after the `}}` of `{entry.key.value}`"
    if not flow:
        move = f"{columns} column{'s' * (columns > 1)} further left, beside `{entry.key.value}`"
    help = f"write {' and '.join(f'`{word}`' for word in words)} {move}"
    spans = {each.key.span for each in moved}
    report[:] = [item for item in report if not _is_twice(item, spans)]
    report.append(wrong_shape(first.span, message, help, arguments=("outer", *words)))
    rest = tuple(each for each in tree.entries if all(each is not other for other in moved))
    changed = {**own, part: Entry(entry.key, Map(rest, tree.span))}
    if not rest:
        del changed[part]
    return {**outer, **changed}


def _is_twice(item: Diagnostic, spans: Set[Span]) -> bool:
    """Whether a finding (SM002) is about two entries of one name, of which one is moved."""
    places = (item.span, *(each.span for each in item.finding.related))
    return item.kind is duplicate_key.code and not spans.isdisjoint(places)


def _outer_fields(tree: Map, own: Mapping[str, Entry]) -> Iterator[tuple[str, Entry]]:
    """The entries of a mapping of names that are fields of the state, by long name: none of these
    values is a name."""
    for entry in [each for each in tree.entries if each.key.value in _FIELDS]:
        name, value = str(entry.key.value), entry.value
        key = schema.LONG.get(name, name)
        row = schema.VARIABLES[key]
        is_time = key == "timeout" and duration(value, []) is not None
        is_type = key in _NAMED and _NAMED.isdisjoint(own) and _is_text(value)
        has_shape = _has_shape(row.shape, value) and len(name) > 1
        if is_time or is_type or has_shape:
            yield key, entry


def _has_shape(shape: str, value: Tree) -> bool:
    """Whether a collection has the shape of a field."""
    if isinstance(value, Seq):
        return shape in ("names", "outcomes", "keys", "value", "items")
    return isinstance(value, Map) and shape not in ("name", "text", "flag", "names", "items")


def _is_text(value: Tree) -> bool:
    return isinstance(value, Scalar) and (isinstance(value.value, str) or value.value is None)
