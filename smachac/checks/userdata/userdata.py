"""Rules on the flow of userdata: unset keys (SM301), remappings (SM302), and keys that do not cross
a container (SM303, SM307). The flow is that of analysis/definite_assignment.py."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache

from smachac.analysis.context import Context
from smachac.analysis.definite_assignment import DataFlow, UserdataScope
from smachac.analysis.error_recovery import is_around_open, lacking_inputs, unknown_remaps
from smachac.analysis.message_keys import remapped_fields
from smachac.analysis.type_inference import Types
from smachac.analysis.unset_reads import Missing, Searches, container_name, provided_keys, reader_at
from smachac.checks.findings import notation
from smachac.checks.findings.edits import likely, listing, with_input, with_output
from smachac.checks.findings.help_text import calls, did_you_mean, other_place
from smachac.checks.rule import rule
from smachac.checks.userdata.initial_presets import missing_together, together_finding
from smachac.checks.userdata.unset_read_findings import fitting_keys, unset_read
from smachac.checks.userdata.unused_keys import read_unwritten
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.repair import Certainty, Edit, Repair
from smachac.diagnostics.source import NOWHERE, Span, Word
from smachac.diagnostics.spelling import MOST_EXPLAINED, guesser, respelt
from smachac.diagnostics.wording import both, either, listed
from smachac.frontend.text.unquoted import is_name
from smachac.ir import nodes
from smachac.ir.message_types import Definitions
from smachac.ir.nodes import Container, Key, Node, Remap
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
    flow = context.absorbed_flow
    searches = Searches(flow)
    # What a state declares as an output and never sets is a fault of that state, and so is what
    # its code sets without a declaration.
    unwritten = set(context.of_machine(read_unwritten).values())
    dropped = cache(lambda path: _dropped(flow.scopes[path].container))
    causes = [
        missing
        for missing in context.missing_keys("unset", "nowhere")
        if (missing.scope.path, missing.key) not in unwritten
        and not (missing.cause == "nowhere" and missing.key in dropped(missing.scope.path))
    ]
    for lacking in missing_together(causes):
        yield together_finding(context, lacking)
        together = {id(missing) for missing in lacking}
        causes = [missing for missing in causes if id(missing) not in together]
    for number, missing in enumerate(causes):
        is_searched = number < MOST_EXPLAINED
        for witness in searches.witnesses(missing):
            node = witness.reader.node
            misplaced = node.misplaced_keys if isinstance(node, nodes.Leaf) else ()
            if witness.reader.key in misplaced and not witness.also:
                continue  # the state has its value, at a wrong place
            yield unset_read(flow, missing, witness, context.types, is_searched=is_searched)


def _dropped(container: Container) -> frozenset[str]:
    """The keys that the code of a state in a container sets, and its interface does not declare."""
    return frozenset(
        word.text
        for child in container.children
        if isinstance(child, nodes.Leaf) and child.class_facts is not None
        for word in child.class_facts.writes
        if all(key.name != word.text for key in child.outputs)
    )


@rule("SM302", "unknown-remap", Severity.ERROR)
def unknown_remap(context: Context) -> Iterator[Finding]:
    """A remapping contains a userdata key that does not exist.

    SMACH ignores such an entry without a message: the state uses the key of its own name, which has
    another value than intended, or is not set at all.

    Exactly: in `remapping: {a: b}`, `a` is not a key of the state, or it is a key that the state
    needs and nothing in the container sets `b`. A warning if it is an optional key and `b` is
    misspelt. Containers with states of YASMIN that can use any key are not checked.

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
    for finding in context.at_containers(_unknown_remaps, context.machine.definitions):
        if finding.node not in context.around_any_key:
            yield finding
    for missing in context.missing_keys("remapped"):
        yield from _remapped(context.types, missing)
    for scope in context.absorbed_flow.scopes.values():
        yield from _empty_remaps(scope)


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
        if not node.remaps or is_around_open(node):
            continue
        found = list(_unknown_remaps_of(f"{path}/{node.name}", node))
        leaf = node if found and isinstance(node, nodes.Leaf) else None
        reported = remapped_fields(leaf, definitions) if leaf is not None else ()
        yield from (finding for finding in found if finding.arguments[0] not in reported)
        keys = lacking_inputs(node)
        if keys and not isinstance(node, nodes.Leaf):
            place = node.children[0].span, keys
            if place not in lacking:  # else another call of the same sub-script
                yield _lacking(f"{path}/{node.name}", node, keys)
            lacking.add(place)


def _lacking(path: str, node: Container, keys: Sequence[str]) -> Finding:
    """SM302 for keys in the remapping of a container that it lacks as inputs."""
    first = next(remap for remap in node.remaps if remap.key in keys)
    source = node.children[0].span.source
    file = source.file_name
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


def _unknown_remaps_of(path: str, node: Node) -> Iterator[Finding]:
    own = list(dict.fromkeys(key.name for key in (*node.inputs, *node.outputs)))
    unknown = unknown_remaps(node)
    guess = guesser(sorted({*own} - {remap.key for remap in node.remaps}))
    inverted = [
        remap for remap in unknown if remap.to in own and guess.unique_match(remap.key) is None
    ]
    for remap in unknown:
        meant, certain = guess(remap.key), guess.unique_match(remap.key)
        known = f"use one of its keys: {listed(own)}" if own else "remove it: the state has no keys"
        if remap in inverted:
            if remap is not inverted[0]:
                continue
            right = notation.entries(node, ((remap.to, remap.key) for remap in inverted))
            right = f"{{{right}}}" if len(inverted) > 1 else right
            known = f"the key of the state comes first: write `{right}`"
        yield Finding(
            span=remap.span,
            message=f"`{remap.key}` in the remapping of `{node.name}` is not one of its userdata"
            " keys",
            arguments=(remap.key, remap.to),
            help=known if remap in inverted else did_you_mean(meant) or known,
            effect=_ignored(
                node, *((remap.to, remap.key) if remap in inverted else (meant, remap.to))
            ),
            related=calls(node, remap.span),
            node=path,
            edits=() if remap in inverted else respelt(Word(remap.key, remap.span), certain),
            repairs=tuple(_other_keys(remap, guess.names) if meant is None else ()),
        )


MOST_PROPOSED = 3
"""The most keys that are proposed for an entry of a remapping."""


def _other_keys(remap: Remap, names: Sequence[str]) -> Iterator[Repair]:
    """The repairs that write another key of the state in an entry of its remapping."""
    for name in names[:MOST_PROPOSED]:
        edits = respelt(Word(remap.key, remap.span), name)
        if edits:
            yield Repair(edits=edits, certainty=Certainty.POSSIBLE, operator="remap another key")


def _remapped(types: Types, missing: Missing) -> Iterator[Finding]:
    """The remaps to a key that nothing sets."""
    scope, key = missing.scope, missing.key
    for child in scope.container.children:
        for remap in child.remaps:
            if remap.to != key or child.name not in missing.vertices:
                continue
            wanted = types.inputs.get((f"{scope.path}/{child.name}", remap.key), ANY)
            fitting = fitting_keys(types, missing, child, wanted)
            choices = [notation.entry(child, remap.key, text) for text in fitting]
            initial = notation.initial_values(scope.container, [(key, "...")])
            help = f"write {either(choices)}, or " if choices else ""
            yield Finding(
                span=remap.to_span,
                message=f"`{remap.key}` of `{child.name}` is remapped to `{key}`, which nothing in"
                f" {container_name(scope, remap.span)} sets",
                arguments=(remap.key, key),
                help=help + f"set `{key}` before this state, or give it an initial value in"
                f" `{scope.container.name}`: `{initial}`",
                effect=UNSET,
                related=calls(child, remap.span),
                node=f"{scope.path}/{child.name}",
                repairs=tuple(
                    repair
                    for text in fitting
                    for repair in likely([Edit(span=remap.to_span, text=text)], "remap a key")
                ),
            )


def _empty_remaps(scope: UserdataScope) -> Iterator[Finding]:
    """The remaps of optional keys to a misspelt key, or to what is no name: a script can leave an
    optional key unset on purpose, as with `no_offset`."""
    for child in scope.container.children:
        optional = {key.name for key in child.inputs if key.type.name == "optional"}
        for remap in child.remaps if optional else ():
            if remap.key not in optional or scope.uses.provided.issuperset([remap.to]):
                continue
            provided = provided_keys(scope)
            meant = None if provided.has(remap.to) else guesser(sorted(provided.keys))(remap.to)
            if provided.has(remap.to) or (meant is None and is_name(remap.to)):
                continue
            yield Finding(
                span=remap.to_span,
                message=f"`{remap.key}` of `{child.name}` is remapped to `{remap.to}`, which"
                f" nothing in {container_name(scope, remap.span)} sets",
                arguments=(remap.key, remap.to),
                help=did_you_mean(meant)
                or f"a remapping takes the name of a key: set `{remap.key}` in the `userdata` of"
                f" `{scope.container.name}`, and remove this entry",
                effect=f"`{child.name}` works without `{remap.key}`",
                related=calls(child, remap.span),
                severity=Severity.WARNING,
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
    flow = context.absorbed_flow
    for missing in context.missing_keys("outside"):
        scope, key = missing.scope, missing.key
        reader = reader_at(scope, missing.vertices[0], key)
        holder = flow.scopes[missing.other].container
        between = _between(flow, scope.path, missing.other)
        others = tuple(reader_at(scope, vertex, key) for vertex in missing.vertices[1:])
        held = name_in_script(holder)
        why = f"which is a key of `{held}` but not an input of {listed(between)}"
        help = _input_help(flow, scope.path, missing.other, key)
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
                    for other in others[:MOST_RELATED]
                    for related in other_place(other.span, f"{other.words} as well")
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
    return list(dict.fromkeys(name_in_script(flow.scopes[path].container) for path in paths))


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
    own = [output.name for output in keeper.outputs if output.span.source is written.source]
    if own:
        return f"write `output_keys: [{', '.join([*own, key])}]` in {where}"
    return f"add `output_keys: [{key}]` to {where}"
