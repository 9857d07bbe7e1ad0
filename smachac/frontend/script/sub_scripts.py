"""Sub-scripts: the one state of a file, the fields that a call overrides, the params it gives."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

from smachac.diagnostics.diagnostic import Diagnostic, Related, Report
from smachac.diagnostics.source import Source, Span, Word
from smachac.diagnostics.spelling import guesser_of
from smachac.frontend.errors.references import (
    bad_sub_script,
    look_up_of_all_calls,
    look_up_of_call,
    param_of_no_call,
    unresolved_look_up,
)
from smachac.frontend.script.params import look_ups
from smachac.frontend.text.fields import as_name, kind_of
from smachac.frontend.text.yaml_tree import Entry, Map, Scalar, Seq, Tree

SUB_SCRIPT_HELP = "write one state: `- NAME: {template: ...}`"
"""The help for a file that is no sub-script."""


def _state_name(item: Tree) -> Word | None:
    """The name of a state in the list of a sub-script."""
    if not isinstance(item, Map) or not item.entries:
        return None
    key = item.entries[0].key
    return Word(str(key.value), key.span)


def sub_script_state(
    tree: Tree, call: Word, report: Report
) -> tuple[Word, tuple[Entry, ...]] | None:
    """The name and the fields of the one state of a sub-script; SM014 if it is not one state."""

    def refuse(at: Span, fault: str, message: str, help: str = SUB_SCRIPT_HELP) -> None:
        """SM014; `fault` is the word for the fault among the arguments."""
        report.append(bad_sub_script(at, message, call.span, help, arguments=(fault,)))

    start = Span(tree.span.source, tree.span.start, tree.span.start + 1)
    if isinstance(tree, Map) and tree.get("states") is not None:
        own = tree.get("name")
        word = own.value.span.text.upper() if own is not None else "NAME"
        help = f"write `- {word}:` first, and indented below it `template: StateMachine`"
        message = "a sub-script must be a list with one state; this is a machine"
        refuse(start, "shape", message, f"{help} and the rest without `name:`")
        return None
    if not isinstance(tree, Seq):
        help = SUB_SCRIPT_HELP
        first = tree.entries[0] if isinstance(tree, Map) and tree.entries else None
        if first is not None and isinstance(first.value, Map):
            help = f"write `- {first.key.value}:`, the state as the item of a list"
        message = f"a sub-script must be a list with one state, not {kind_of(tree)}"
        refuse(start, "shape", message, help)
        return None
    if len(tree.items) != 1:
        message = f"a sub-script must have one state; this one has {len(tree.items)}"
        names = [name for name in map(_state_name, tree.items) if name is not None]
        place = names[1].span if len(names) > 1 else start
        inside = ", ".join(f"`{name.text}`" for name in names)
        help = f"remove all but one, or put {inside} into one container: `- NAME: {{template:"
        help += " StateMachine, outcomes: [...], states: [...]}`"
        refuse(place, "states", message, help if names else SUB_SCRIPT_HELP)
        return None
    item = tree.items[0]
    if not isinstance(item, Map) or not item.entries:
        refuse(start, "item", "the item of a sub-script must be a state")
        return None
    first, rest = item.entries[0], item.entries[1:]
    name = Word(str(first.key.value), first.key.span)
    if isinstance(first.value, Map) and not rest:
        return name, first.value.entries
    if isinstance(first.value, Scalar) and first.value.value is None and rest:
        return name, rest
    refuse(first.key.span, "key", "the state of a sub-script must have one key: its name")
    return None


def overridden(inner: dict[str, Entry], call: dict[str, Entry]) -> dict[str, Entry]:
    """The fields of a sub-script and its call: mappings are merged, other fields replaced."""
    merged = dict(inner)
    for key, entry in call.items():
        below = merged.get(key)
        if below is None or not isinstance(below.value, Map) or not isinstance(entry.value, Map):
            merged[key] = entry
            continue
        own = {item.key.value: item for item in entry.value.entries}
        entries = [own.pop(item.key.value, item) for item in below.value.entries]
        merged[key] = Entry(entry.key, Map((*entries, *own.values()), entry.value.span))
    return merged


def params_beside_call(
    found: Sequence[Diagnostic], fields: Mapping[str, Span], used: Collection[str]
) -> Report:
    """The findings in a called sub-script, with one finding for each field of the call that is a
    param of the sub-script, which was written beside `params`. `used` are the names in look-ups."""
    beside = fields.keys() & set(used)
    kept: Report = []
    for item in found:
        name = item.finding.arguments[0] if item.finding.arguments else ""
        if name in beside and item.kind is unresolved_look_up.code:
            continue
        if name in beside and item.span == fields[name]:
            help = f"`{name}` is a param of the sub-script: write it inside `params:`"
            item = replace(item, finding=replace(item.finding, help=help, edits=()))
        kept.append(item)
    return kept


def params_at_call(
    found: Sequence[Diagnostic],
    state: str,
    script: Word,
    given: Sequence[Entry],
    known: Sequence[str],
    used: Collection[str],
    settled: set[Span],
    trees: Mapping[Source, Tree],
) -> Report:
    """The findings in a sub-script that a state calls, with the look-ups that failed at the call
    that misspells the param or does not give it: one finding for each param.

    `script` is the name of the sub-script with the place of the call, `given` are the params of
    this call, `known` all those in scope of it, `used` the names in look-ups. `settled` are the
    places of calls that give params, but not one that is read; this call is added to them. `trees`
    are the texts of the scripts.
    """
    lost: dict[str, Diagnostic] = {}
    for item in found:
        if item.kind is unresolved_look_up.code and item.span.source is not script.span.source:
            lost.setdefault(item.finding.arguments[0], item)
    names = set(used)
    words = [as_name(each.key, []) for each in given]
    idle = [
        word
        for word in words
        if word is not None and (word.text not in names or _is_masked(word.text, lost, trees))
    ]
    moved = {
        name: look_up_of_call(
            item, script, state, idle, known, alone=len(lost) == 1, settled=item.span in settled
        )
        for name, item in lost.items()
    }
    if given:
        settled |= {item.span for item in moved.values()}
    kept: Report = []
    for item in found:
        name = item.finding.arguments[0] if item.finding.arguments else ""
        if item is lost.get(name):
            kept.append(moved[name])
        elif (
            item.kind is not unresolved_look_up.code
            or item.span.source is script.span.source
            or moved[name] is lost[name]
        ):
            kept.append(item)
    return kept


def _is_masked(name: str, lost: Mapping[str, Diagnostic], trees: Mapping[Source, Tree]) -> bool:
    """Whether a param of a call is one slip away from a lost one, and the script that lacks that
    one neither reads the param nor calls a sub-script without giving it the param."""
    meant = guesser_of(tuple(lost)).sure(name)
    tree = trees.get(lost[meant].span.source) if meant is not None else None
    return tree is not None and not _reads(tree, name)


def _reads(tree: Tree, name: str) -> bool:
    """Whether a look-up in a script, or in a sub-script that it calls, can read a param from
    outside."""
    if any(word.text == name for word in look_ups(tree)):
        return True
    waiting = [tree]
    while waiting:
        each = waiting.pop()
        if isinstance(each, Seq):
            waiting += each.items
        elif isinstance(each, Map):
            waiting += (entry.value for entry in each.entries)
            params = each.get("params")
            given = params.value.get(name) if params and isinstance(params.value, Map) else None
            if each.get("script") is not None and given is None:
                return True
    return False


def one_for_each_param(found: Sequence[Diagnostic], entries: Collection[str]) -> Report:
    """The findings, with one for all calls and look-ups that lack a param for the same reason.
    `entries` are the fields of the script."""
    lacking = one_for_all_lacking(one_for_all_calls(found), "params" in entries)
    return one_for_all_look_ups(lacking)


def one_for_all_calls(found: Sequence[Diagnostic]) -> Report:
    """The findings, with one finding at a look-up in a sub-script in place of those at its calls,
    if several calls give the param under the same other name."""
    groups: dict[tuple[Span, str], list[Diagnostic]] = {}
    for item in found:
        place = _look_up_of_other_name(item)
        if place is not None:
            groups.setdefault((place, item.finding.arguments[0]), []).append(item)
    first = {id(items[0]): key for key, items in groups.items() if len(items) > 1}
    others = {id(each) for items in groups.values() if len(items) > 1 for each in items[1:]}
    kept: Report = []
    for item in found:
        if id(item) in others:
            continue
        if id(item) in first:
            place, given = first[id(item)]
            calls = [each.span for each in groups[place, given]]
            item = replace(item, finding=look_up_of_all_calls(item.finding, place, given, calls))
        kept.append(item)
    return kept


def one_for_all_lacking(found: Sequence[Diagnostic], has_params: bool) -> Report:
    """The findings, with one for all calls that do not give the same param. `has_params`: the
    script has `params`."""
    groups: dict[str, list[Diagnostic]] = {}
    for item in found:
        arguments = item.finding.arguments
        if item.kind is unresolved_look_up.code and len(arguments) == 3:
            groups.setdefault(arguments[0], []).append(item)
    kept: Report = []
    for item in found:
        group = groups.get(item.finding.arguments[0]) if item.finding.arguments else None
        if group is None or len(group) < 2 or all(item is not each for each in group):
            kept.append(item)
        elif item is group[0]:
            states = [each.finding.arguments[1] for each in group]
            more = tuple(
                Related(span=each.span, message="this call does not give it either")
                for each in group[1 : 1 + MOST_LOOK_UPS]
            )
            one = param_of_no_call(item.finding, states, has_params)
            kept.append(replace(item, finding=replace(one, related=(*one.related, *more))))
    return kept


def one_for_all_look_ups(found: Sequence[Diagnostic]) -> Report:
    """The findings, with one for all look-ups in a text that fail for the same reason."""
    first: dict[tuple[str, Source, str | None], int] = {}
    kept: Report = []
    for item in found:
        if item.kind is not unresolved_look_up.code or item.finding.related:
            kept.append(item)
            continue
        which = item.finding.arguments[0], item.span.source, item.finding.help
        at = first.setdefault(which, len(kept))
        if at == len(kept):
            kept.append(item)
        if item.span == kept[at].span:
            continue
        others = kept[at].finding.related
        if len(others) < MOST_LOOK_UPS and all(each.span != item.span for each in others):
            more = Related(span=item.span, message=f"`{which[0]}` is used here too")
            related = (*others, more)
            kept[at] = replace(kept[at], finding=replace(kept[at].finding, related=related))
    return kept


MOST_LOOK_UPS = 3
"""The most further look-ups that a finding shows."""


def _look_up_of_other_name(item: Diagnostic) -> Span | None:
    """The look-up in a sub-script that failed because the call gives a param of another name, if a
    finding at the call is about it."""
    related = item.finding.related
    if item.kind is not unresolved_look_up.code or len(related) != 1:
        return None
    place = related[0].span
    moved = place.source is not item.span.source and item.finding.arguments[0] != place.text
    return place if moved else None
