"""The rule on output keys that an interface promises and its class does not set (SM314)."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.analysis.context import Context
from smachac.analysis.type_lattice import is_unknown, present
from smachac.checks.findings import notation
from smachac.checks.findings.candidate_keys import SCALARS
from smachac.checks.findings.help_text import other_place
from smachac.checks.findings.types_with_code import own_types, used_here
from smachac.checks.rule import rule
from smachac.checks.userdata.undeclared_accesses import lone_output
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.source import Word
from smachac.diagnostics.spelling import guesser, words_of
from smachac.frontend.text.yaml_tree import Map, Seq, parse
from smachac.ir.class_facts import ClassFacts, Ending
from smachac.ir.nodes import Leaf, StateType
from smachac.records import replace


@rule(
    "SM314",
    "unwritten-output",
    Severity.WARNING,
    effect="a state that reads the key afterwards gets an old value, or fails with KeyError",
)
def unwritten_output(context: Context) -> Iterator[Finding]:
    """The class of a state type returns an outcome without setting an output key that its
    interface promises for that outcome.

    The rules and the next states rely on the interface: a state that reads the key stops the
    machine with an error, or works with an old value.

    Exactly: the class is read, never run: methods of the class and functions of its module are
    followed, and a class that passes the userdata to other code is not checked. `writes:` in the
    interface names the outcomes that set a key. There is a finding at a `return` of such an outcome
    if no path to it sets the key, or if a branch, an exception or the end of a loop leads past the
    assignment straight to it. Behind a further condition, and where a condition was examined
    before, the key counts as set, because the conditions can depend on each other. A key that is
    not in `writes:` must be set before one `return` at least; after the others it counts as unset
    (SM301). Of a key that is also an input there is a finding only if `writes:` promises it, its
    type is a number or a text, and the class never sets it.

    Wrong:
        name: sm
        template: Base
        outcomes: [seen, lost]
        output_keys: [pose]
        states:
          - FIND:
              template: FindPart
              transitions: {found: seen, lost: lost}
        == templates/FindPart.yml ==
        name: FindPart
        output_keys: {pose: Pose}
        outcomes: {found: {}, lost: {}}
        writes: {found: [pose]}
        code: {python: "cell.find_part:FindPart"}
        == cell/find_part.py ==
        import smach

        from cell_drivers import camera


        class FindPart(smach.State):
            def __init__(self):
                super().__init__(outcomes=["found", "lost"], output_keys=["pose"])

            def execute(self, userdata):
                pose = camera.look()
                return "lost" if pose is None else "found"

    Right:
        name: sm
        template: Base
        outcomes: [seen, lost]
        output_keys: [pose]
        states:
          - FIND:
              template: FindPart
              transitions: {found: seen, lost: lost}
        == templates/FindPart.yml ==
        name: FindPart
        output_keys: {pose: Pose}
        outcomes: {found: {}, lost: {}}
        writes: {found: [pose]}
        code: {python: "cell.find_part:FindPart"}
        == cell/find_part.py ==
        import smach

        from cell_drivers import camera


        class FindPart(smach.State):
            def __init__(self):
                super().__init__(outcomes=["found", "lost"], output_keys=["pose"])

            def execute(self, userdata):
                pose = camera.look()
                if pose is None:
                    return "lost"
                userdata.pose = pose
                return "found"
    """
    for path, leaf, type_, facts in own_types(context, declared=True):
        if any(variable.role == "callbacks" for variable in type_.variables.values()):
            continue
        kept = {key.name for key in type_.input_keys}  # set before, perhaps changed in place
        outputs = [key.name for key in type_.output_keys if key.name not in kept]
        yield from _unchanged_keys(path, leaf, type_, facts)
        guess = guesser(outputs)
        misspelt = {guess(word.text) for word in facts.writes if word.text not in outputs}
        lone = lone_output(facts, kept, [key.name for key in type_.output_keys])
        misspelt |= {lone[1]} if lone is not None else set()  # SM308
        unused = dict(facts.unused)
        read = {word.text for word in facts.reads} if not facts.passed else set()
        collected = read - {word.text for word in facts.writes}
        for key in outputs:
            if key in misspelt or key in collected:
                continue  # SM308, SM310
            found = [*_unwritten(path, leaf, type_, facts, key)]
            if found and key in unused:
                found = [_local(path, leaf, key, unused[key])]
            yield from found


FIXED = frozenset(["int", "float", "bool", "str", "one_of"])
"""The types of values that no code can change in place."""


def _unchanged_keys(
    path: str, leaf: Leaf, type_: StateType, facts: ClassFacts
) -> Iterator[Finding]:
    """The first return that breaks a promise of `writes:` for a key that is also an input, if the
    class never sets the key: a number or a text, which code can only replace."""
    inputs = {key.name for key in type_.input_keys}
    known = facts.endings and all(ending.written is not None for ending in facts.endings)
    unused = dict(facts.unused)
    guess = guesser([key.name for key in type_.output_keys])
    names = [key.name for key in type_.output_keys]
    misspelt = {guess(word.text) for word in facts.writes if word.text not in names}
    for key in type_.output_keys if known else ():
        name = key.name
        if name not in inputs or name in misspelt or present(key.type).name not in FIXED:
            continue
        if any(name in (ending.written or ()) for ending in facts.endings):
            continue
        promised = {outcome for outcome, keys in type_.writes if name in keys}
        for ending in facts.endings:
            if ending.outcome.text in promised:
                (finding,) = _broken_promise(path, leaf, type_, ending, name)
                meant = unused.get(name)
                if meant is not None:
                    line = f"{meant.text} = {meant.span.text}"
                    finding = replace(finding, help=f"write `{line}` before this `return`")
                effect = "the states that follow get the old value of the key"
                yield replace(finding, effect=effect)
                break


def _local(path: str, leaf: Leaf, key: str, meant: Word) -> Finding:
    """The finding on a local variable or an attribute of `self` with the name of an output key that
    is not set."""
    kept = meant.span.text.startswith("self.")
    what = "an attribute of the object" if kept else "a local variable"
    return Finding(
        span=meant.span,
        message=f"`{meant.span.text}` is {what} here: the output key `{key}` of `{leaf.type}` is"
        " not set",
        arguments=(leaf.type, key),
        help=f"write `{meant.text}`",
        related=used_here(leaf),
        node=path,
    )


def _unwritten(
    path: str, leaf: Leaf, type_: StateType, facts: ClassFacts, key: str
) -> Iterator[Finding]:
    """The returns that break a promise of `writes:`, or the whole `execute` if it never sets a key
    that is not in `writes:`."""
    promised = {outcome for outcome, keys in type_.writes if key in keys}
    missing = [ending for ending in facts.endings if ending.written is not None]
    missing = [ending for ending in missing if key not in (ending.written or ())]
    if promised:
        for ending in facts.endings:
            if ending.outcome.text in promised:
                yield from _broken_promise(path, leaf, type_, ending, key)
    elif facts.complete and facts.execute is not None and missing == [*facts.endings] != []:
        yield Finding(
            span=facts.execute,
            message=f"`execute` of `{leaf.type}` never sets its output key `{key}`",
            arguments=(leaf.type, key),
            help=f"set `userdata.{key}`, or remove it from {notation.declared(leaf)}",
            related=used_here(leaf),
            node=path,
        )


WAY_PAST = {
    "if": "if this is false, `{key}` is not set",
    "else": "if this is true, `{key}` is not set",
    "match": "not every `case` sets `{key}`",
    "except": "after this exception, `{key}` is not set",
    "loop": "this loop can end without setting `{key}`",
    "return": "this `return` comes before `{key}` is set",
}
"""The place that leads past the assignment to an output key, by its kind."""


def _promise(type_: StateType, outcome: str, key: str) -> tuple[Related, ...]:
    """The place in the interface that promises a key for an outcome; none if the interface is not a
    file of its own."""
    place = next((member.span for member in type_.output_keys if member.name == key), None)
    if place is None or not place.source.name.endswith((".yml", ".yaml")):
        return ()
    tree = parse(place.source, [])
    writes = tree.get("writes") if isinstance(tree, Map) else None
    entry = (
        writes.value.get(outcome) if writes is not None and isinstance(writes.value, Map) else None
    )
    items = entry.value.items if entry is not None and isinstance(entry.value, Seq) else ()
    found = next((item for item in items if getattr(item, "value", None) == key), None)
    return () if found is None else other_place(found.span, f"`writes:` promises `{key}` here")


def _setting(leaf: Leaf, type_: StateType, ending: Ending, key: str, where: str) -> str:
    """The help that sets a key before a `return`: to the local variable of its name or the only one
    with a word of it, or to the only input of its type."""
    facts = leaf.class_facts
    name = (facts.userdata if facts is not None else "") or "userdata"
    at = ending.outcome.span
    known = {
        word.text
        for word in (facts.local if facts is not None else ())
        if word.span.source == at.source and word.span.start <= at.start < word.span.end
    }
    is_set = any(word.text == key for word in (facts.writes if facts is not None else ()))
    words = words_of(key) if not is_set else set()
    near = [key] if key in known else [text for text in known if words & words_of(text)]
    if len(near) == 1:
        return f"write `{name}.{key} = {near[0]}` {where} this `return`"
    example = _of_same_type(type_, key, name) if not is_set else ""
    return f"set `{name}.{key}` {where} this `return`{example}"


def _of_same_type(type_: StateType, key: str, userdata: str) -> str:
    """The part of a help with the only input that has the same type as an output. Empty if there is
    no such input, or if the type is a plain number, text or boolean."""
    wanted = next(member.type for member in type_.output_keys if member.name == key)
    if is_unknown(wanted) or (wanted.name in SCALARS and not wanted.args):
        return ""
    found = [
        member.name for member in type_.input_keys if member.type == wanted and member.name != key
    ]
    if len(found) != 1:
        return ""
    return f", for example to `{userdata}.{found[0]}`, which has its type"


def _broken_promise(
    path: str, leaf: Leaf, type_: StateType, ending: Ending, key: str
) -> Iterator[Finding]:
    """The finding on a return that breaks a promise of `writes:`, on all paths to it or on some."""
    place = dict(ending.skipped).get(key)
    never = ending.written is not None and key not in ending.written
    if place is None and not never:
        return
    does, where = ("returns", "before") if place is None else ("can return", "on each path to")
    past = other_place(place.span, WAY_PAST[place.text].format(key=key)) if place else ()
    promise = _promise(type_, ending.outcome.text, key)
    setting = _setting(leaf, type_, ending, key, where)
    other = f"correct `writes:` in the interface `{leaf.type}`"
    if promise:
        other = f"remove `{key}` from `{ending.outcome.text}` in the `writes:` of the interface"
        meant = _promised_elsewhere(leaf, type_, key)
        if meant and never:
            setting = f"write `{key}` for `{meant}`, not for `{ending.outcome.text}`, in the"
            setting += " `writes:` of the interface"
            other = f"set `{key}` before this `return`"
    yield Finding(
        span=ending.outcome.span,
        message=f"`{leaf.type}` {does} `{ending.outcome.text}` without setting its output key"
        f" `{key}`",
        arguments=(leaf.type, key, ending.outcome.text),
        help=f"{setting}, or {other}",
        related=(*past, *promise, *used_here(leaf)),
        node=path,
    )


def _promised_elsewhere(leaf: Leaf, type_: StateType, key: str) -> str:
    """The outcome before which a class sets a key, if that is the only one and `writes:` does not
    have it; else empty."""
    endings = leaf.class_facts.endings if leaf.class_facts is not None else ()
    found = {ending.outcome.text for ending in endings if key in (ending.written or ())}
    promised = {outcome for outcome, keys in type_.writes if key in keys}
    return found.pop() if len(found) == 1 and found.isdisjoint(promised) else ""
