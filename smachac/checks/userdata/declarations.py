"""The rules on declarations that nothing uses: keys, outcomes, params, types."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator
from itertools import groupby
from typing import Literal

from smachac.analysis.accesses import callback_names, leaves_with_code, unreceived_outputs
from smachac.analysis.context import Context
from smachac.analysis.definite_assignment import UserdataScope
from smachac.analysis.error_recovery import undeclared_reads
from smachac.analysis.function_slots import function_reads
from smachac.analysis.type_lattice import misfit
from smachac.analysis.unset_reads import container_name
from smachac.analysis.used_keys import sees_everything, used_in
from smachac.analysis.uses import place_of
from smachac.checks.findings import notation
from smachac.checks.findings.condition_outcomes import suggested_default, unknown_endings
from smachac.checks.findings.help_text import CALLED_HERE, calls, did_you_mean, other_place
from smachac.checks.rule import rule
from smachac.checks.userdata.unused_keys import (
    Unwritten,
    read_unwritten,
    unreceived_finding,
    unsent_keys,
    unwritten_finding,
    unwritten_keys,
)
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.source import NOWHERE, Span, Word
from smachac.diagnostics.spelling import guesser, is_plain, respelt
from smachac.diagnostics.wording import listed
from smachac.frontend.errors.script import number_before
from smachac.ir import nodes
from smachac.ir.leaf import functions, variable, variable_of
from smachac.ir.nodes import Container, Key, Leaf, Machine, Node, Remap, Unused
from smachac.ir.script_code import script_code
from smachac.ir.traversal import expressions, walk
from smachac.records import replace


@rule(
    "SM305",
    "dead-key",
    Severity.WARNING,
    effect="the value has no effect",
)
def dead_key(context: Context) -> Iterator[Finding]:
    """A userdata key is set, but nothing in its container reads it.

    The key is left over, or a state that should read it uses another name and so works with a
    wrong value.

    Exactly: only keys in `userdata` and in the `output_keys` of states are checked, not the outputs
    of a state type or sub-script, unless the script remaps the output to a key that is one slip
    away from a key that is read. It is an info for outputs of states in the outermost machine,
    because they can be read after the run; its `output_keys` declare the results.

    Wrong:
        name: sm
        template: Base
        outcomes: [held]
        userdata: {pose: 0.5, old_pose: 0.4}
        states:
          - GRASP:
              template: PrintUserdataState
              input_keys: [pose]
              transitions: {succeeded: held}

    Right:
        name: sm
        template: Base
        outcomes: [held]
        userdata: {pose: 0.5}
        states:
          - GRASP:
              template: PrintUserdataState
              input_keys: [pose]
              transitions: {succeeded: held}
    """
    flow = context.absorbed_flow
    in_functions = function_reads(context)
    # A state outside or inside the container needs the key, but does not get it.
    needed = {(lost.keeper.path, lost.written.outer) for lost in context.lost_outputs}
    needed |= {(missing.other, missing.key) for missing in context.missing_keys("outside")}
    for scope in flow.scopes.values():
        container = scope.container
        if context.of_container(sees_everything, scope.path, scope) or container.sugar:
            continue
        read = context.of_container(used_in, scope.path, scope)
        for key, node, span in context.of_container(_set_by_the_script, scope.path, scope):
            if key in read or key in in_functions.get(scope.path, ()):
                continue
            if (scope.path, key) in needed:
                continue
            finding = _unread_key(scope, key, node, span)
            # The userdata of the machine can be read after the run.
            is_result = container is flow.machine.root and node is not container
            yield replace(finding, severity=Severity.INFO) if is_result else finding
        for child, remap, meant in context.of_container(_misnamed_outputs, scope.path, scope):
            if remap.to not in read:
                yield _lost_result(scope, child, remap, meant)


def _unread_key(scope: UserdataScope, key: str, node: Node, span: Span) -> Finding:
    """SM305 for a key of a container that a node sets."""
    where = container_name(scope, span)
    return Finding(
        span=span,
        message=f"`{key}` is set, but nothing in {where} reads it",
        arguments=(key,),
        help=f"remove `{key}`; or add it to the `input_keys` of the state that must read"
        f" it, or to the `output_keys` of {where}",
        related=calls(node, span),
        node=scope.path if node is scope.container else f"{scope.path}/{node.name}",
    )


def _lost_result(scope: UserdataScope, child: Node, remap: Remap, meant: str) -> Finding:
    """SM305 for an output of a state that is remapped to a misspelt key."""
    return Finding(
        span=remap.to_span,
        message=f"`{remap.to}` is set, but nothing in {container_name(scope, remap.span)} reads it",
        arguments=(remap.to,),
        help=f"did you mean `{meant}`? Write `{notation.entry(child, remap.key, meant)}`",
        effect=f"the result `{remap.key}` of `{child.name}` is lost: what reads `{meant}`"
        " works without it",
        related=calls(child, remap.span),
        node=f"{scope.path}/{child.name}",
    )


def _set_by_the_script(scope: UserdataScope) -> tuple[tuple[str, Node, Span], ...]:
    """The keys of a container that the script itself sets, each once: presets and outputs that it
    lists, not those of a state type or sub-script."""
    found: dict[str, tuple[str, Node, Span]] = {}
    for use in scope.uses.all:
        key, node = use.declared, use.node
        if use.kind == "presets":
            found[use.outer] = (use.outer, node, use.span)
        elif use.writes and isinstance(key, Key) and use.outer not in found:
            # A key that only the code of the state has, not the script, has the place of the state.
            is_listed = key.span != node.span or node.span == NOWHERE
            if is_listed and key.span.source is node.span.source and _sets(node, key):
                found[use.outer] = (use.outer, node, use.span)
    return tuple(found.values())


def _misnamed_outputs(scope: UserdataScope) -> tuple[tuple[Node, Remap, str], ...]:
    """The outputs of state types that the script remaps to a key that is one slip away from another
    one that the container reads, with that key. The reader must accept the type of the output."""
    children = scope.container.children
    remapped = [
        (child, remap, key)
        for child in children
        if child.remaps
        for key in child.outputs
        for remap in child.remaps
        if remap.key == key.name and key.span.source is not child.span.source
    ]
    if not remapped:
        return ()
    read: dict[str, list[Key]] = {}
    for use in scope.uses.all:
        if use.reads and isinstance(use.declared, Key):
            read.setdefault(use.outer, []).append(use.declared)
    guess = guesser(read)
    found: list[tuple[Node, Remap, str]] = []
    for child, remap, key in remapped:
        meant = guess.unique_match(remap.to) if remap.to not in read else None
        if meant is None or key.name in {input_.name for input_ in child.inputs}:
            continue
        if all(misfit(key.type, member.type) is None for member in read[meant]):
            found.append((child, remap, meant))
    return tuple(found)


def _sets(node: Node, key: Key) -> bool:
    """Whether a state can set one of its outputs (if not: SM306)."""
    if not isinstance(node, Leaf):
        return True
    if key.role != "result":
        return key.name not in unreceived_outputs(node)
    return key.name in callback_names(node)


@rule("SM306", "unused-declaration", Severity.WARNING)
def unused_declaration(context: Context) -> Iterator[Finding]:
    """A key, an outcome, a param or a type is declared, but nothing uses it.

    The caller of a container must provide a key without need, or expects a result that is never
    set. An unused param has no effect, so the robot does not do what the caller intended.

    Exactly: params are not checked where a template without an interface reads `params`. An output
    key of a ServiceState or SimpleActionState is set if `response_slots` or `result_slots` lists
    it, or if a function of the script receives the userdata and passes it on.

    Wrong:
        name: sm
        template: Base
        outcomes: [held]
        userdata: {pose: 0.5, speed: 1.0}
        states:
          - PICK:
              template: StateMachine
              outcomes: [done]
              input_keys: [pose, speed]
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
    needed = {(missing.other, missing.key) for missing in context.missing_keys("outside")}
    yield from context.at_containers(_unused_in)
    unwritten = context.of_machine(unwritten_keys)
    read = context.of_machine(read_unwritten)
    yield from _unwritten_outputs(context, unwritten, read)
    yield from unsent_keys(context)
    for scope in flow.scopes.values():
        container = scope.container
        if isinstance(container, nodes.Iterator):
            yield from words_as_lists(scope.path, container)
        if context.of_container(sees_everything, scope.path, scope) or container.sugar:
            continue
        used = context.of_container(used_in, scope.path, scope)
        for key in container.inputs:
            if key.name not in used and (scope.path, key.name) not in needed:
                yield _unused(scope.path, container, key, "input")
        set_ = scope.uses.provided
        for key in container.outputs:
            if key.name not in set_:
                own = {output.name for output in container.outputs}
                meant = guesser(sorted(set_ - own)).unique_match(key.name)
                finding = _unused(scope.path, container, key, "output", meant)
                is_read = (scope.path, key.name) in read
                yield replace(finding, severity=Severity.ERROR) if is_read else finding
    yield from _unused_by_the_script(context)


def _unwritten_outputs(
    context: Context, unwritten: Iterable[Unwritten], read: Collection[tuple[str, str]]
) -> Iterator[Finding]:
    """The output keys that built-in states never write. `read`: those that are read and unset."""
    for path, found in groupby(unwritten, key=lambda unwritten: unwritten.path):
        every = [unwritten for unwritten in found if unwritten.slots]
        if every:
            is_read = any((path, unwritten.key.name) in read for unwritten in every)
            yield unreceived_finding(every, context.machine.definitions, read=is_read)
    for other in unwritten:
        if other.slots:
            continue
        finding = unwritten_finding(other, read=(other.path, other.key.name) in read)
        if finding is not None:
            yield finding


def _unused(
    path: str, node: Node, key: Key, role: Literal["input", "output"], meant: str | None = None
) -> Finding:
    span = key.span if not isinstance(node, Leaf) else place_of(node, key)
    verb = "read" if role == "input" else "set"
    effect = "a state that reads the key afterwards finds it unset, or with an older value"
    if role == "input":
        effect = "the container around it must set a key that has no effect"
    if isinstance(node, Leaf):
        nothing = f"none of its functions {verb}s it"
        other = f"read it in one of its functions as `ud.{key.name}`"
    else:
        nothing = f"no state in `{node.name}` {verb}s it"
        other = f"add it to the `{role}_keys` of the state in `{node.name}` that {verb}s it"
    return Finding(
        span=span,
        message=f"`{node.name}` declares the {role} key `{key.name}`, but {nothing}",
        arguments=(role, key.name),
        help=did_you_mean(meant)
        or f"remove `{key.name}` from the `{role}_keys` of `{node.name}`, or {other}",
        effect=effect,
        related=calls(node, span),
        node=path,
        edits=respelt(Word(key.name, span), meant),
    )


MOST_SHOWN = 40
"""The longest value that a message shows, in characters."""


_PARAM_IN_CODE = re.compile(r"\bparams(?:\.|\[['\"])(\w+)")


def _params_in_code(machine: Machine) -> set[str]:
    """The params that code of the script names as if they were variables: `params.limit`."""
    codes = [code.text for _, node in walk(machine.root) for code in expressions(node)]
    return {name for text in codes for name in _PARAM_IN_CODE.findall(text)}


def _unused_by_the_script(context: Context) -> Iterator[Finding]:
    """The params and types of the script that nothing uses."""
    machine = context.machine
    if not machine.unused:
        return
    in_code = _params_in_code(machine)
    for what, word, via, known, kept in machine.unused:
        if what == "param" and word.text in in_code:  # SM019
            continue
        yield _unused_word(Unused(what, word, via, known, kept), machine.root.name)


def _unused_word(unused: Unused, root: str) -> Finding:
    """SM306 for a param or type of the script that nothing uses."""
    what, word, via, known, kept = unused
    outside = (call for call in via if call.source is not word.span.source)
    meant = guesser(known).unique_match(word.text)
    help = did_you_mean(meant)
    if help is None and known:
        help = f"the params that are used here are {listed(known)}"
        if len(known) == 1:
            meant = known[0]
            help = f"write `{meant}`, the param that is used here"
    effect = "its value has no effect" if what == "param" else None
    number = number_before(word)
    if number:
        help = f"write `{number}.{word.text}`: a decimal number has a point, not a comma"
        effect = f"YAML reads `{number},{word.text}` as two entries"
    default = kept.get(meant or "") if not number else None
    if default is not None and "\n" not in default.text and len(default.text) <= MOST_SHOWN:
        effect = f"its value has no effect: the sub-script keeps `{meant}: {default.text}`"
    return Finding(
        span=word.span,
        message=f"the {what} `{word.text}` is defined, but nothing uses it",
        arguments=(what, word.text),
        help=help or "remove it, or correct its name",
        effect=effect,
        related=(
            *(other_place(default, f"the value of `{meant}` in the sub-script") if default else ()),
            *(Related(span=call, message=CALLED_HERE) for call in outside),
        ),
        node=root,
    )


def _unused_in(path: str, container: Container) -> Iterator[Finding]:
    for inner, leaf in leaves_with_code(path, container):
        yield from _unused_by_code(inner, leaf)


def _unused_by_code(path: str, leaf: Leaf) -> Iterator[Finding]:
    """The declared keys and outcomes of a leaf that its code in the script does not use."""
    callbacks, conditions = functions(leaf, "callbacks"), functions(leaf, "conditions")
    chooses = variable_of(leaf, "conditions") is not None
    if callbacks is None or conditions is None or not (callbacks or chooses):
        return
    called = [*callbacks.values(), *conditions.values()]
    if chooses and not called and not [*unknown_endings(path, leaf)]:
        lacking = _without_conditions(path, leaf)
        if lacking is not None:
            yield lacking
            return
    known = [script_code(code.text).fields for code in called]
    fields = [fields for fields in known if fields is not None]
    if len(fields) == len(known):
        used = {key for field in fields for key in (*field.read, *field.tested)}
        undeclared = [key for key, _ in undeclared_reads(leaf)]
        used |= _suggested_keys(undeclared, leaf.inputs) if undeclared else set()
        arguments = [key for key in leaf.inputs if key.role == "argument"]
        if any(key.name not in used for key in arguments):
            used |= {
                name.id for code in called for name in script_code(code.text).free_names
            }  # SM019
        yield from _unused_keys(path, leaf, arguments, used, "input")
    if chooses and not [*unknown_endings(path, leaf)] and suggested_default(leaf) is None:
        yield from _unused_outcomes(path, leaf, conditions)


def _without_conditions(path: str, leaf: Leaf) -> Finding | None:
    """The finding on a state of conditions that has none, although it has outcomes for them."""
    possible = {variable(leaf, "default_outcome"), leaf.catches}
    outcomes = [outcome for outcome in leaf.outcomes if outcome.name not in possible]
    held = variable_of(leaf, "conditions")
    if not outcomes or held is None or suggested_default(leaf) is not None:
        return None
    names = [outcome.name for outcome in outcomes]
    keys = [name if is_plain(name) else f"'{name}'" for name in names]
    pairs = ", ".join(f"{key}: 'lambda ud: ...'" for key in keys)
    reads = listed([f"ud.{key.name}" for key in leaf.inputs if key.role == "argument"])
    return Finding(
        span=outcomes[0].span,
        message=f"`{leaf.name}` has no condition for {listed(names)}",
        arguments=("conditions", *names),
        help=f"write `{held.name}: {{{pairs}}}`" + (f", with {reads}" if reads else ""),
        effect="the transitions for these outcomes are never taken",
        related=calls(leaf, outcomes[0].span),
        node=path,
    )


def _unused_outcomes(path: str, leaf: Leaf, conditions: Iterable[str]) -> Iterator[Finding]:
    """The declared outcomes without a condition."""
    possible = {*conditions, variable(leaf, "default_outcome"), leaf.catches}
    for outcome in leaf.outcomes:
        if outcome.name not in possible:
            yield Finding(
                span=outcome.span,
                message=f"`{outcome.name}` is declared as an outcome, but no condition leads to it",
                arguments=("outcome", outcome.name),
                help=f"add a condition for it, as in `{outcome.name}: 'lambda ud: True'`, or remove"
                " it from `outcomes` and from the transitions",
                effect="a transition for this outcome is never taken",
                related=calls(leaf, outcome.span),
                node=path,
            )


def _unused_keys(
    path: str,
    leaf: Leaf,
    keys: Iterable[Key],
    used: Iterable[str],
    role: Literal["input", "output"],
) -> Iterator[Finding]:
    names = set(used)
    return (_unused(path, leaf, key, role) for key in keys if key.name not in names)


def _suggested_keys(wrong: Iterable[str], known: Iterable[Key]) -> set[str]:
    """The likely keys behind misspelt names (SM308, SM310)."""
    guess = guesser(key.name for key in known)
    return {name for key in wrong if (name := guess(key)) is not None}


def words_as_lists(path: str, loop: nodes.Iterator) -> Iterator[Finding]:
    """The finding on an iterator over the name of one of its input keys, which its state does not
    read."""
    read = {key.name for child in loop.children for key in child.inputs}
    for key in loop.inputs if not loop.sugar else ():
        if loop.items is not None and loop.items.data == (key.name,) and key.name not in read:
            yield word_as_list(path, loop, key.name)


def word_as_list(path: str, loop: nodes.Iterator, key: str) -> Finding:
    """The finding on a loop over one text, which is the name of a key."""
    return Finding(
        span=loop.items_span,
        message=f"`{loop.name}` runs once, for the text `{key}`, not for the items of the key"
        f" `{key}`",
        arguments=("items", key),
        help=f"write `it: {key}`",
        effect="the state gets the name of the key in place of an item",
        related=calls(loop, loop.items_span),
        node=path,
    )
