"""Rules on the flow of userdata: unset keys, remappings, keys that do not cross a container."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from pathlib import PurePath

from smachac.analysis.context import Context
from smachac.analysis.definite_assignment import DataFlow, UserdataScope
from smachac.analysis.error_recovery import lacking_inputs, unknown_remaps
from smachac.analysis.type_inference import Types
from smachac.analysis.unset_reads import Missing, Searches, Witness, container_name, reader_at
from smachac.checks.concurrence.raced_keys import raced_keys
from smachac.checks.edits import listing, with_input, with_output
from smachac.checks.help_text import added_remapping, calls, did_you_mean, other_place
from smachac.checks.outcomes.hidden_states import keys_of_hidden_states
from smachac.checks.outcomes.misled_failures import Misled, misled_failures
from smachac.checks.ros.message_keys import remapped_fields
from smachac.checks.rule import rule
from smachac.checks.userdata.candidate_keys import (
    MOST_FITTING,
    keys_of,
    keys_of_type,
    may_be,
    meant_by_remap,
    outer_value,
    unread_output,
)
from smachac.checks.userdata.empty_remaps import empty_remap_findings
from smachac.checks.userdata.initial_presets import missing_together, together_finding
from smachac.checks.userdata.meant_keys import MeantKey, loop_in_a_body, meant_keys, misnamed_keys
from smachac.checks.userdata.swapped_loops import swapped_loop
from smachac.checks.userdata.unset_read_findings import unset_read
from smachac.checks.userdata.unwritten_keys import read_unwritten, unwritten_keys
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.repair import Edit
from smachac.diagnostics.source import NOWHERE, Span, Word
from smachac.diagnostics.spelling import MOST_EXPLAINED, guesser, respelt, written_name
from smachac.diagnostics.wording import both, either, listed
from smachac.ir import nodes
from smachac.ir.message_types import Definitions
from smachac.ir.nodes import Container, Key, Node
from smachac.ir.script_paths import name_in_script
from smachac.ir.traversal import remapping
from smachac.ir.types import ANY

MOST_RELATED = 3
"""Limit on the related places of one kind in a finding."""

UNSET = "the state cannot read an unset key: it fails, or the machine stops with KeyError"


@rule(
    "SM301",
    "read-before-write",
    Severity.ERROR,
    effect=UNSET,
)
def read_before_write(context: Context) -> Iterator[Finding]:
    """A state reads a userdata key that is unset on at least one path to the state.

    On that path the machine stops with an error, and the robot stops in the middle of its task.

    Exactly: an error if the key is unset on every path, a warning if it is unset on some paths
    only. An output of a state counts as set on every outcome except `preempted`, unless `writes:`
    in the interface defines other outcomes. States of an unknown type are not checked.

    Wrong:
        name: sm
        template: Base
        outcomes: [held]
        states:
          - LOOK:
              template: ScriptedState
              outcomes: [seen, hidden]
              output_keys: [pose]
              steps: [{outcome: seen, set: {pose: 0.5}}, {outcome: hidden}]
              transitions: {seen: GRASP, hidden: GRASP}
          - GRASP:
              template: ScriptedState
              outcomes: [done]
              input_keys: [pose]
              transitions: {done: held}

    Right:
        name: sm
        template: Base
        outcomes: [held, lost]
        states:
          - LOOK:
              template: ScriptedState
              outcomes: [seen, hidden]
              output_keys: [pose]
              steps: [{outcome: seen, set: {pose: 0.5}}, {outcome: hidden}]
              transitions: {seen: GRASP, hidden: lost}
          - GRASP:
              template: ScriptedState
              outcomes: [done]
              input_keys: [pose]
              transitions: {done: held}
    """
    flow = context.corrected_flow
    searches = Searches(flow)
    presets, misled = context.of_machine(meant_keys), misled_failures(context)
    misnamed = context.of_machine(misnamed_keys)
    causes = _with_their_own_cause(context)
    for lacking in missing_together(causes):
        if lacking[0].scope.path in presets:
            continue
        yield together_finding(context, lacking)
        together = {id(each) for each in lacking}
        causes = [each for each in causes if id(each) not in together]
    for number, missing in enumerate(causes):
        is_searched = number < MOST_EXPLAINED
        swapped = swapped_loop(missing) if is_searched else None
        if swapped is not None:
            yield _swapped(missing, swapped)
            continue
        wrong = misnamed.get((missing.scope.path, missing.key))
        meant = presets.get(missing.scope.path)
        for witness in searches.witnesses(missing):
            node = witness.reader.node
            misplaced = node.misplaced_keys if isinstance(node, nodes.Leaf) else ()
            if witness.reader.key in misplaced and not witness.also:
                continue  # SM003 reports the cause
            finding = unset_read(flow, missing, witness, context.types, is_searched=is_searched)
            if wrong is not None:
                help = f"did you mean `{wrong.word.text}`?"
                finding = _with_unread(finding, help, wrong.word)
            elif meant is not None and meant.missing is missing:
                finding = _with_meant_key(finding, witness, meant)
            elif missing.cause != "nowhere":
                finding = _with_outer_key(finding, missing, flow.scopes)
                finding = _with_end(finding, missing, witness, misled)
            yield finding


def _with_their_own_cause(context: Context) -> list[Missing]:
    """The keys that nothing sets, or not on every path, without those whose cause another rule
    reports: SM308, SM306, SM305, SM405, or SM201."""
    misnamed = context.of_machine(misnamed_keys)
    unwritten = set(read_unwritten(context, unwritten_keys(context)).values()) | raced_keys(context)
    found: list[Missing] = []
    hidden: dict[tuple[str, str], frozenset[str]] | None = None
    dropped = cache(lambda path: _dropped(context.corrected_flow.scopes[path].container))
    for missing in context.missing_keys("unset", "nowhere"):
        place = missing.scope.path, missing.key
        if missing.cause == "unset" and hidden is None:
            hidden = keys_of_hidden_states(context)
        if hidden and place in hidden and hidden[place].isdisjoint(map(str, missing.vertices)):
            continue  # SM201
        wrong = misnamed.get(place)
        if missing.cause == "nowhere" and missing.key in dropped(missing.scope.path):
            continue  # SM308
        if place not in unwritten and (wrong is None or not wrong.declared):
            found.append(missing)
    return found


def _with_outer_key(
    finding: Finding, missing: Missing, scopes: Mapping[str, UserdataScope]
) -> Finding:
    """The finding on an output of a container that is read before it is set, where the container
    around it has a value for it: the key is probably meant as an input too."""
    place = outer_value(missing, scopes)
    if place is None:
        return finding
    help = listing([missing.scope.container], "input_keys", missing.key)
    owner = scopes[place[0]].container.name
    return replace(finding, help=f"{help}: `{owner}` has a value for it")


def _with_end(
    finding: Finding,
    missing: Missing,
    witness: Witness,
    misled: Mapping[tuple[str, str], Misled],
) -> Finding:
    """The finding on a key that is unset after a failure, where an outcome of the container, to
    which nothing leads, is probably meant as the target of its transition."""
    found = misled.get((missing.scope.path, missing.key))
    if found is None or found.step.target != witness.reader.node.name:
        return finding
    meant, step = found.meant, found.step
    return replace(
        finding,
        help=f"write `{written_name(step.outcome)}: {meant.name}`, to which nothing leads",
        related=(
            *other_place(step.target_span, f"`{step.outcome}` leads to `{step.target}`"),
            *other_place(meant.span, f"nothing leads to the outcome `{meant.name}`"),
            *finding.related,
        ),
    )


def _with_meant_key(finding: Finding, witness: Witness, meant: MeantKey) -> Finding:
    """The finding on a key that nothing sets, where a loop over a preset, or a remapping from a
    preset or input is missing."""
    name, key, other = witness.reader.node.name, meant.missing.key, meant.word.text
    if meant.iterated and isinstance(witness.reader.node, nodes.Iterator):
        field = "in" if witness.reader.node.sugar else "it"
        help = f"write `{field}: {other}`, or rename `{other}` to `{key}`"
        return _with_unread(finding, help, meant.word)
    purpose = f"must read `{other}`"
    cure = added_remapping(witness.reader.node, key, other)
    if meant.looped:
        purpose = f"must run for each item of `{other}`"
        cure = f"write `for_each: {{item: {key}, in: {other}}}` in `{name}`"
    if not meant.looped and guesser([key]).sure(other) is not None:
        return _with_unread(finding, f"rename `{other}` to `{key}`, or {cure}", meant.word)
    help = f"if `{name}` {purpose}, {cure}; otherwise give `{key}` an initial value in"
    help += f" {container_name(meant.missing.scope, finding.span)}"
    return _with_unread(finding, help, meant.word)


def _with_unread(finding: Finding, help: str, word: Word) -> Finding:
    """A finding with another help and the place of a key that nothing reads, once."""
    related = other_place(word.span, f"nothing reads `{word.text}`")
    others = (each for each in finding.related if each not in related)
    return replace(finding, help=help, related=(*related, *others))


def _swapped(missing: Missing, loop: nodes.Iterator) -> Finding:
    """The finding on a loop whose items and item have changed places."""
    items, item = missing.key, loop.item_key
    names = ("item", "in") if loop.sugar else ("it_label", "it")
    right = f"{names[0]}: {items}, {names[1]}: {item}"
    if loop.sugar:
        on = f", on: [{', '.join(loop.loop_outcomes)}]" if loop.loop_spans else ""
        help = f"`for_each: {{{right}{on}}}`"
    else:
        help = f"`{right}`".replace(", ", "` and `")
    return Finding(
        span=loop.item_span,
        message=f"`{names[0]}` and `{names[1]}` of `{loop.name}` are swapped: the states in it read"
        f" the item as `{items}`, and the list is in `{item}`",
        arguments=(items,),
        help=f"swap them: write {help}",
        effect=f"the loop cannot begin: nothing sets `{items}` before it",
        related=(*other_place(loop.items_span, "the item"), *calls(loop, loop.item_span)),
        node=missing.scope.path
        if loop is missing.scope.container
        else f"{missing.scope.path}/{loop.name}",
    )


def _dropped(container: Container) -> frozenset[str]:
    """The keys that the code of a state in a container sets, also those that its interface does not
    declare."""
    return frozenset(
        word.text
        for child in container.children
        if isinstance(child, nodes.Leaf) and child.class_facts is not None
        for word in child.class_facts.writes
    )


@rule("SM302", "unknown-remap", Severity.ERROR)
def unknown_remap(context: Context) -> Iterator[Finding]:
    """A remapping contains a userdata key that does not exist.

    SMACH ignores such an entry without a message: the state uses the key of its own name, which has
    another value than intended, or is not set at all.

    Exactly: in `remapping: {a: b}`, `a` is not a key of the state, or nothing in the container
    sets `b`. A warning if `a` is an optional key: the state works without it.

    Wrong:
        name: sm
        template: Base
        outcomes: [held]
        userdata: {pose: 0.0, block_pose: 0.5}
        output_keys: [pose]
        states:
          - GRASP:
              template: PrintUserdataState
              input_keys: [pose]
              remapping: {psoe: block_pose}
              transitions: {succeeded: held}

    Right:
        name: sm
        template: Base
        outcomes: [held]
        userdata: {pose: 0.0, block_pose: 0.5}
        output_keys: [pose]
        states:
          - GRASP:
              template: PrintUserdataState
              input_keys: [pose]
              remapping: {pose: block_pose}
              transitions: {succeeded: held}
    """
    yield from context.at_containers(_unknown_remaps, context.machine.definitions)
    for missing in context.missing_keys("remapped"):
        yield from _remapped(context.types, missing)
    yield from empty_remap_findings(context)


def _ignored(node: Node, meant: str | None, outer: str) -> str:
    """What happens without the entry of an unknown key in a remapping: the key of the state that
    was meant, and that of the container."""
    optional = any(key.name == meant and key.type.name == "optional" for key in node.inputs)
    if optional:
        return f"SMACH ignores the entry: the optional key `{meant}` stays unset"
    if meant is None:
        return "SMACH ignores the entry: the state uses the keys under its own names"
    verb = "reads" if any(key.name == meant for key in node.inputs) else "sets"
    return f"SMACH ignores the entry: `{node.name}` {verb} the key `{meant}`, not `{outer}`"


def _unknown_remaps(path: str, container: Container, definitions: Definitions) -> Iterator[Finding]:
    lacking: set[tuple[Span, tuple[str, ...]]] = set()
    for node in container.children:
        if not node.remaps:
            continue
        found = list(_unknown_remaps_of(f"{path}/{node.name}", node, container))
        leaf = node if found and isinstance(node, nodes.Leaf) else None
        reported = remapped_fields(leaf, definitions) if leaf is not None else ()
        yield from (each for each in found if each.arguments[0] not in reported)
        keys = lacking_inputs(node)
        if keys and not isinstance(node, nodes.Leaf):
            place = node.children[0].span, keys
            if place not in lacking:  # else another call of the same sub-script
                yield _lacking(f"{path}/{node.name}", node, keys)
            lacking.add(place)


def _lacking(path: str, node: Container, keys: Sequence[str]) -> Finding:
    """SM302 for keys in the remapping of a container that it lacks as inputs."""
    first = next(each for each in node.remaps if each.key in keys)
    source = node.children[0].span.source
    file = PurePath(source.name).name
    owner = f"`{node.name}`" if source is first.span.source else f"the state of `{file}`"
    inputs = [key.name for key in node.inputs if key.span.source is not NOWHERE.source]
    names = ", ".join([*inputs, *keys])
    readers = [
        (child, key)
        for child in node.children
        for key in child.inputs
        if remapping(child)[key.name] == first.key
    ]
    return Finding(
        span=first.span,
        message=f"`{node.name}` lacks the input key{'s' if len(keys) > 1 else ''} {both(keys)},"
        " which its states read",
        arguments=(first.key, first.to),
        help=f"write `input_keys: [{names}]` in {owner}",
        effect="a container gets only the keys that it declares: its states find the others unset",
        related=(
            *other_place(readers[0][0].span, f"`{readers[0][0].name}` reads `{first.key}`"),
            *calls(node, first.span),
        ),
        node=path,
    )


def _unknown_remaps_of(path: str, node: Node, container: Container) -> Iterator[Finding]:
    own = list(dict.fromkeys(key.name for key in (*node.inputs, *node.outputs)))
    unknown = unknown_remaps(node, container)
    turned = [remap for remap, _, certain in unknown if remap.to in own and certain is None]
    for remap, meant, certain in unknown:
        known = f"use one of its keys: {listed(own)}" if own else "remove it: the state has no keys"
        if remap in turned:
            if remap is not turned[0]:
                continue
            right = ", ".join(f"{each.to}: {each.key}" for each in turned)
            right = f"{{{right}}}" if len(turned) > 1 else right
            known = f"the key of the state comes first: write `{right}`"
        yield Finding(
            span=remap.span,
            message=f"`{remap.key}` in the remapping of `{node.name}` is not one of its userdata"
            " keys",
            arguments=(remap.key, remap.to),
            help=known if remap in turned else did_you_mean(meant) or known,
            effect=_ignored(
                node, *((remap.to, remap.key) if remap in turned else (meant, remap.to))
            ),
            related=calls(node, remap.span),
            node=path,
            edits=() if remap in turned else respelt(Word(remap.key, remap.span), certain),
        )


def _remapped(types: Types, missing: Missing) -> Iterator[Finding]:
    """The remaps to a key that nothing sets."""
    scope, key = missing.scope, missing.key
    around, guess = scope.container.name, guesser(sorted(keys_of(scope)))
    for child in scope.container.children:
        for remap in child.remaps:
            if remap.to != key or child.name not in missing.vertices:
                continue
            meant = meant_by_remap(types, scope, child, remap, guess)
            unread = unread_output(scope, key) if meant is None else None
            wanted = types.inputs.get((f"{scope.path}/{child.name}", remap.key), ANY)
            fits = unread is not None and may_be(types, scope, unread.key, wanted)
            help = unread.help if unread is not None and fits else None
            related: tuple[Related, ...] = ()
            if meant is not None:
                help = did_you_mean(meant.key)
            if meant is not None and meant.place is not None:
                help = f"write `{remap.key}: {meant.key}`"
                help += f", which `{meant.setter}` sets" if meant.setter else ""
                related = other_place(meant.place, f"nothing reads `{meant.key}`")
            own = {each.to for each in child.remaps}
            fitting = [each for each in keys_of_type(types, scope, wanted) if each not in own] \
                if help is None else []  # fmt: skip
            if 0 < len(fitting) <= MOST_FITTING:
                help = f"write {either(f'{remap.key}: {each}' for each in fitting)}, which"
                help += f" {'has' if len(fitting) == 1 else 'have'} its type, or set `{key}` before"
            yield Finding(
                span=remap.to_span,
                message=f"`{remap.key}` of `{child.name}` is remapped to `{key}`, which nothing in"
                f" {container_name(scope, remap.span)} sets",
                arguments=(remap.key, key),
                help=help
                or f"set `{key}` before this state, or give it an initial value in `{around}`:"
                f" `userdata: {{{key}: ...}}`",
                effect=UNSET,
                related=(*related, *calls(child, remap.span)),
                node=f"{scope.path}/{child.name}",
            )


@rule(
    "SM303",
    "undeclared-container-key",
    Severity.ERROR,
    effect="only `input_keys` are copied into a container: the state finds the key unset",
)
def undeclared_container_key(context: Context) -> Iterator[Finding]:
    """A state reads a key of an outer container, but it is not an input of its own container.

    A container has its own userdata: only the keys in its `input_keys` are copied into it. The
    state finds the key unset, and the machine stops with an error in the middle of the task.

    Wrong:
        name: sm
        template: Base
        outcomes: [held]
        userdata: {pose: 0.5}
        output_keys: [pose]
        states:
          - PICK:
              template: StateMachine
              outcomes: [done]
              states:
                - GRASP:
                    template: PrintUserdataState
                    input_keys: [pose]
                    transitions: {succeeded: done}
              transitions: {done: held}

    Right:
        name: sm
        template: Base
        outcomes: [held]
        userdata: {pose: 0.5}
        output_keys: [pose]
        states:
          - PICK:
              template: StateMachine
              outcomes: [done]
              input_keys: [pose]
              states:
                - GRASP:
                    template: PrintUserdataState
                    input_keys: [pose]
                    transitions: {succeeded: done}
              transitions: {done: held}
    """
    flow = context.corrected_flow
    misnamed = context.of_machine(misnamed_keys)
    for missing in context.missing_keys("outside"):
        scope, key = missing.scope, missing.key
        if (scope.path, key) in misnamed and misnamed[scope.path, key].declared:
            continue  # SM306 reports the cause
        reader = reader_at(scope, missing.vertices[0], key)
        holder = flow.scopes[missing.other].container
        between = _between(flow, scope.path, missing.other)
        others = tuple(reader_at(scope, vertex, key) for vertex in missing.vertices[1:])
        held = name_in_script(holder)
        why = f"which is a key of `{held}` but not an input of {listed(between)}"
        help = _input_help(flow, scope.path, missing.other, key)
        loop = loop_in_a_body(missing)
        if loop is not None:
            help = f"write `{key}` in place of `{loop.item_key}` in the `input_keys` of"
            help += f" {listed(between)}: the `for_each` of `{loop.name}` sets `{loop.item_key}`;"
            help += f" or move the `for_each` to {listed(between)}"
        if isinstance(holder, nodes.Iterator) and holder.item_key == key:
            why = f"which the loop `{held}` provides, but which is not an input of"
            why += " its state" if list(between) == [held] else f" {listed(between)}"
        yield Finding(
            span=reader.span,
            message=f"{reader.words}, {why}",
            arguments=(reader.key,),
            help=help,
            related=(
                *(
                    _list_of(scope.container, scope.container.inputs, "input_keys")
                    or other_place(scope.container.span, f"`{between[-1]}` is defined here")
                ),
                *(
                    related
                    for each in others[:MOST_RELATED]
                    for related in other_place(each.span, f"{each.words} as well")
                ),
                *calls(reader.node, reader.span),
            ),
            node=reader.path,
            edits=_taken_in(flow, scope.path, missing.other, key),
        )


def _list_of(container: Container, keys: Sequence[Key], field: str) -> tuple[Related, ...]:
    """The last name in a list of keys of a container, where its text has the list."""
    if not keys or keys[-1].span.source is not container.span.source:
        return ()
    return other_place(keys[-1].span, f"the `{field}` of `{container.name}`")


def _taken_in(flow: DataFlow, path: str, holder: str, key: str) -> tuple[Edit, ...]:
    """The edits that make the key an input of every container between its holder and its reader."""
    edits: list[Edit] = []
    while path != holder:
        added = with_input(flow.scopes[path].container, key)
        if not added:
            return ()
        edits += added
        path = path.rpartition("/")[0]
    return tuple(edits)


def _between(flow: DataFlow, path: str, holder: str) -> list[str]:
    """The names in the script of the containers between the holder of a key and its reader,
    outermost first."""
    names = path[len(holder) + 1 :].split("/")
    paths = ["/".join([holder, *names[: at + 1]]) for at in range(len(names))]
    return list(dict.fromkeys(name_in_script(flow.scopes[each].container) for each in paths))


def _input_help(flow: DataFlow, path: str, holder: str, key: str) -> str:
    """The help that makes a key an input of the containers between its holder and its reader."""
    own: dict[str, Container] = {}
    names = _between(flow, path, holder)
    while path != holder:
        container = flow.scopes[path].container
        if not container.sugar:
            own[name_in_script(container)] = container
        path = path.rpartition("/")[0]
    if own.keys() == {*names}:
        return listing(own.values(), "input_keys", key)
    return f"add `{key}` to the `input_keys` of {listed(names)}"


@rule("SM307", "lost-output", Severity.WARNING)
def lost_output(context: Context) -> Iterator[Finding]:
    """A key is set inside a container and read outside, but is not an output key of the container.

    Only the keys in `output_keys` are copied out of a container. The state that reads the key
    outside works with an older value, or finds the key unset, and then the machine stops.

    Exactly: an error if the key is unset outside, a warning if it has an older value. The reader
    can be the container itself, where it runs again, in a loop or for the next item of `for_each`,
    if no state in it reads the key after it is set, or if it counts once in each run for one of its
    conditions (`ud.tries + 1`) and nothing around it sets the key.

    Wrong:
        name: sm
        template: Base
        outcomes: [held]
        states:
          - FIND:
              template: StateMachine
              outcomes: [found]
              states:
                - LOOK:
                    template: ScriptedState
                    outcomes: [seen]
                    output_keys: [pose]
                    steps: [{outcome: seen, set: {pose: 0.5}}]
                    transitions: {seen: found}
              transitions: {found: GRASP}
          - GRASP:
              template: PrintUserdataState
              input_keys: [pose]
              transitions: {succeeded: held}

    Right:
        name: sm
        template: Base
        outcomes: [held]
        states:
          - FIND:
              template: StateMachine
              outcomes: [found]
              output_keys: [pose]
              states:
                - LOOK:
                    template: ScriptedState
                    outcomes: [seen]
                    output_keys: [pose]
                    steps: [{outcome: seen, set: {pose: 0.5}}]
                    transitions: {seen: found}
              transitions: {found: GRASP}
          - GRASP:
              template: PrintUserdataState
              input_keys: [pose]
              transitions: {succeeded: held}
    """
    shown: set[tuple[Span, str]] = set()
    for lost in context.lost_outputs:
        keeper, written = lost.keeper.container, lost.written.span
        own = lost.written.outer
        called = bool(keeper.via) and written.source is not keeper.span.source
        if called and (written, own) in shown:
            continue  # another call of the same sub-script
        shown.add((written, own))
        inner = f"`{own}`" + (f" (`{lost.key}` outside)" * (own != lost.key))
        gets = "an unset key" if lost.is_missing else "an older value"
        wrong, reader = lost.misspelt, name_in_script(lost.reader.node)
        writer = name_in_script(lost.written.node)
        itself = reader == keeper.name
        happens = "it is lost at the end of each run" if itself else f"`{reader}` reads {gets}"
        effect = f"`{reader}` works with a value that was set before"
        if lost.is_missing:
            effect = f"`{reader}` stops when it reads the key"
        elif itself:
            effect = f"each run of `{reader}` begins with the value that was set before the first"
        listed_here = [key for key in keeper.outputs if key.span.source is written.source]
        place = written if called else keeper.span
        if called and listed_here:
            place = listed_here[-1].span
        fix = f"write `{own}` in place of `{wrong.name}`" if wrong is not None else ""
        yield Finding(
            span=wrong.span if wrong is not None else place,
            message=f"{inner}, set by `{writer}`, is not an output of `{keeper.name}`: {happens}",
            arguments=(own,),
            help=fix or _output_help(own, keeper, written if called else None),
            related=(
                *(other_place(written, f"`{writer}` sets it here") if place != written else ()),
                *other_place(lost.reader.span, lost.reader.words),
                *_list_of(keeper, keeper.outputs, "output_keys"),
                *calls(keeper, keeper.span),
            ),
            effect=effect,
            severity=Severity.ERROR if lost.is_missing else None,
            node=lost.keeper.path,
            edits=()
            if called or wrong is not None or not lost.is_missing
            else with_output(keeper, own),
        )


def _output_help(key: str, keeper: Container, written: Span | None) -> str:
    """The help for an output that a container lacks. `written`: where a state in a sub-script sets
    it, if the container is the outermost state of that."""
    if written is None:
        return listing([keeper], "output_keys", key)
    where = f"the outermost state in `{written.source.name}`"
    own = [each.name for each in keeper.outputs if each.span.source is written.source]
    if own:
        return f"write `output_keys: [{', '.join([*own, key])}]` in {where}"
    return f"add `output_keys: [{key}]` to {where}"
