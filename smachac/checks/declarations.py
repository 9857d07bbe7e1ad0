"""Rules over keys that are declared and not used, and used but not declared."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from smachac.analysis.accesses import callback_names, callbacks, userdata_fields
from smachac.analysis.context import Context
from smachac.analysis.control_flow import is_open
from smachac.analysis.def_use import place_of
from smachac.analysis.definite_assignment import UserdataScope
from smachac.analysis.error_recovery import undeclared_reads, undeclared_writes
from smachac.analysis.unset_reads import container_name
from smachac.checks.edits import with_output
from smachac.checks.expressions import unknown_endings
from smachac.checks.messages import CALLED_HERE, calls, did_you_mean
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import listed
from smachac.ir import nodes
from smachac.ir.graph import START
from smachac.ir.leaf import variable
from smachac.ir.nodes import Body, Key, Leaf, Machine, Node
from smachac.ir.traversal import outcome_names, remapping


@rule("SM305", "dead-key", Severity.WARNING)
def dead_key(context: Context) -> Iterator[Finding]:
    """A key is set, and nothing ever reads it.

    Either it is left over, or its reader knows it by another name and works with something else.
    Outputs that a state has by its type, and those of a sub-script, are nobody's fault. What the
    outermost machine has set can be read after the run, so that is only noted: its `output_keys`
    name the results.

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
    flow = context.mended_flow
    told = {(each.keeper.path, each.own) for each in context.lost_outputs}
    told |= {(each.other, each.key) for each in context.missing_keys("outside")}
    for scope in flow.scopes.values():
        container = scope.container
        if container.sugar or _sees_everything(scope):
            continue
        read = _read_in(scope) | scope.outputs.keys()
        for key, node, span in _set_by_the_script(scope):
            if key in read or (scope.path, key) in told:
                continue
            # After the run the machine's own userdata can be read (smach-semantics M14).
            is_result = container is flow.machine.root and node is not container
            where = container_name(scope, span)
            yield Finding(
                span=span,
                message=f"`{key}` is set here, and nothing in {where} reads it",
                help=f"take it out, or add it to the `output_keys` of {where}",
                related=calls(node, span),
                severity=Severity.INFO if is_result else None,
                node=scope.path if node is container else f"{scope.path}/{node.name}",
            )


def _sees_everything(scope: UserdataScope) -> bool:
    """Whether something in a container may read any key."""
    raw = isinstance(scope.container, nodes.Iterator)
    return any(
        is_open(child) or (raw and isinstance(child, Leaf)) for child in scope.container.children
    )


def _read_in(scope: UserdataScope) -> set[str]:
    """The keys that something in a container declares as its input, or goes through."""
    found = set(scope.reads.get(START, ()))
    for child in scope.container.children:
        names = remapping(child)
        found.update(names.get(key.name, key.name) for key in child.inputs)
    return found


def _written_in(scope: UserdataScope) -> set[str]:
    """The keys that are there from the start, or that something in a container declares to set."""
    container = scope.container
    found = {*scope.inputs, *(preset.key for preset in container.userdata)}
    if isinstance(container, nodes.Iterator):
        found.add(container.item_key)
    for child in container.children:
        names = remapping(child)
        found.update(names.get(key.name, key.name) for key in child.outputs)
    return found


def _set_by_the_script(scope: UserdataScope) -> Iterator[tuple[str, Node, Span]]:
    """The keys of a container that the script itself sets, each once: presets and outputs that it
    lists, not those of a state type or sub-script."""
    seen: set[str] = set()
    for preset in scope.container.userdata:
        seen.add(preset.key)
        yield preset.key, scope.container, preset.span
    for child in scope.container.children:
        names = remapping(child)
        for each in child.outputs:
            key = names.get(each.name, each.name)
            if key not in seen and each.span.source is child.span.source and _sets(child, each):
                seen.add(key)
                yield key, child, place_of(child, each)


def _sets(node: Node, key: Key) -> bool:
    """Whether a state can set one of its outputs (SM306 says where it cannot)."""
    if not isinstance(node, Leaf) or node.type != "CallbacksState":
        return True
    return key.name in callback_names(node)


@rule("SM306", "unused-declaration", Severity.WARNING)
def unused_declaration(context: Context) -> Iterator[Finding]:
    """A key, an outcome, a param or a type is declared, and nothing uses it.

    Who calls a container has to hand in what nobody needs, or waits for a result that never comes;
    a param that nobody looks up changes nothing, though whoever sets it believes so. Nothing is
    said of params where a template without an interface may read them.

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
    flow = context.mended_flow
    missing = {(each.scope.path, each.key) for each in context.missing_keys("unset", "nowhere")}
    kept = {(each.other, each.key) for each in context.missing_keys("outside")}
    for path, leaf in _leaves_with_code(context):
        yield from _unused_by_code(path, leaf)
    for scope in flow.scopes.values():
        container = scope.container
        if container.sugar or _sees_everything(scope):
            continue
        used = _read_in(scope) | scope.outputs.keys()
        for key in container.inputs:
            if key.name not in used and (scope.path, key.name) not in kept:
                yield _unused(scope.path, container, key, "input", "reads")
        set_ = _written_in(scope)
        outer = scope.path.rpartition("/")[0]
        for key in container.outputs:
            if key.name not in set_ and (outer, scope.outputs[key.name]) not in missing:
                yield _unused(scope.path, container, key, "output", "sets")
    yield from _unused_by_the_script(context.machine)


def _unused(path: str, node: Node, key: Key, what: str, use: str) -> Finding:
    span = key.span if not isinstance(node, Leaf) else place_of(node, key)
    return Finding(
        span=span,
        message=f"`{key.name}` is declared as an {what} here, and nothing inside {use} it",
        help=f"take it out of the `{what}_keys`",
        related=calls(node, span),
        node=path,
    )


def _unused_by_the_script(machine: Machine) -> Iterator[Finding]:
    """Params and types: what is left of them in the graph is nothing."""
    for what, word, via in machine.unused:
        message = f"the type `{word.text}` is named here, and nothing is of it"
        if what == "param":
            message = f"the param `{word.text}` is given here, and nothing inside looks it up"
        outside = (call for call in via if call.source is not word.span.source)
        yield Finding(
            span=word.span,
            message=message,
            help="take it out, or look for the name that was meant",
            related=tuple(Related(span=call, message=CALLED_HERE) for call in outside),
            node=machine.root.name,
        )


def _unused_by_code(path: str, leaf: Leaf) -> Iterator[Finding]:
    """The keys that a leaf made of code in the script declares, and that none of it uses."""
    functions = callbacks(leaf)
    if leaf.type not in ("CallbacksState", "ConditionalOutcomeState") or functions is None:
        return
    if not functions and leaf.type == "CallbacksState":
        return
    known = [userdata_fields(code.text) for code in functions.values()]
    fields = [each for each in known if each is not None]
    if len(fields) == len(known):
        used = {key for each in fields for key in (*each.read, *each.tested)}
        used |= _meant_keys((key for key, _ in undeclared_reads(leaf)), leaf.inputs)
        yield from _unused_keys(path, leaf, leaf.inputs, used, "input", "reads")
    if leaf.type == "ConditionalOutcomeState" and not [*unknown_endings(path, leaf)]:
        yield from _unused_outcomes(path, leaf, functions)
    if leaf.type == "CallbacksState":
        made = callback_names(leaf) | _meant_keys(undeclared_writes(leaf), leaf.outputs)
        yield from _unused_keys(path, leaf, leaf.outputs, made, "output", "sets")


def _unused_outcomes(path: str, leaf: Leaf, functions: Iterable[str]) -> Iterator[Finding]:
    """The outcomes for which there is no condition."""
    possible = {*functions, variable(leaf, "default_outcome"), leaf.catches}
    for outcome in leaf.outcomes:
        if outcome.name not in possible:
            yield Finding(
                span=outcome.span,
                message=f"`{outcome.name}` is declared as an outcome here, and no condition leads"
                " to it",
                help=f"give it one in `callbacks`, or take it out of the outcomes of `{leaf.name}`",
                related=calls(leaf, outcome.span),
                node=path,
            )


def _unused_keys(
    path: str, leaf: Leaf, keys: Iterable[Key], used: Iterable[str], what: str, use: str
) -> Iterator[Finding]:
    names = set(used)
    return (_unused(path, leaf, key, what, use) for key in keys if key.name not in names)


@rule("SM308", "lossy-write", Severity.ERROR)
def lossy_write(context: Context) -> Iterator[Finding]:
    """A state sets a key that is not among its output keys.

    SMACH drops the write and only logs it: the counter never counts, and the loop that it is to
    end goes on.

    Wrong:
        name: sm
        template: Base
        outcomes: [counted]
        userdata: {n: 0}
        states:
          - COUNT:
              template: CallbacksState
              input_keys: [n]
              callbacks: {n: 'lambda ud: ud.n + 1'}
              transitions: {succeeded: counted}

    Right:
        name: sm
        template: Base
        outcomes: [counted]
        userdata: {n: 0}
        states:
          - COUNT:
              template: CallbacksState
              input_keys: [n]
              output_keys: [n]
              callbacks: {n: 'lambda ud: ud.n + 1'}
              transitions: {succeeded: counted}
    """
    for path, leaf in _leaves_with_code(context):
        for key in undeclared_writes(leaf):
            only = any(each.name == key for each in leaf.inputs)
            what = "which is an input key only" if only else "which is none of its output keys"
            span = _place_of_write(leaf, key)
            meant = _meant(key, leaf.outputs if not only else ())
            yield Finding(
                span=span,
                message=f"`{leaf.name}` sets `{key}`, {what}: the value is dropped",
                help=meant or f"add `{key}` to the `output_keys` of `{leaf.name}`",
                related=calls(leaf, span),
                node=path,
                edits=with_output(leaf, key) if not meant else (),
            )
    yield from dropped_writes(context)


def _leaves_with_code(context: Context) -> Iterator[tuple[str, Leaf]]:
    """The leaves but those that see every key of an iterator, as there is nothing to declare."""
    for path, container in context.containers:
        for child in container.children if not isinstance(container, nodes.Iterator) else ():
            if isinstance(child, Leaf) and not child.open:
                yield f"{path}/{child.name}", child


def _meant_keys(wrong: Iterable[str], known: Iterable[Key]) -> set[str]:
    """The keys that were meant by names of none (SM308, SM310)."""
    guess = guesser(each.name for each in known)
    return {name for key in wrong if (name := guess(key)) is not None}


def _meant(key: str, known: Iterable[Key]) -> str | None:
    return did_you_mean(guesser(each.name for each in known)(key))


def _place_of_write(leaf: Leaf, key: str) -> Span:
    code = (callbacks(leaf) or {}).get(key)
    if code is not None:
        return code.span
    steps = next((each for each in leaf.variables if each.name == "steps"), None)
    return steps.value.span if steps is not None else leaf.span


@rule("SM310", "undeclared-access", Severity.ERROR)
def undeclared_access(context: Context) -> Iterator[Finding]:
    """Code of the script reads a userdata key that its state does not declare.

    The state sees only its input keys: the read fails, and the machine stops there.

    Wrong:
        name: sm
        template: Base
        outcomes: [low, high]
        userdata: {level: 7}
        output_keys: [level]
        states:
          - JUDGE:
              template: ConditionalOutcomeState
              outcomes: [low]
              callbacks: {low: 'lambda ud: ud.level < 10'}
              default_outcome: high
              transitions: {low: low, high: high}

    Right:
        name: sm
        template: Base
        outcomes: [low, high]
        userdata: {level: 7}
        output_keys: [level]
        states:
          - JUDGE:
              template: ConditionalOutcomeState
              input_keys: [level]
              outcomes: [low]
              callbacks: {low: 'lambda ud: ud.level < 10'}
              default_outcome: high
              transitions: {low: low, high: high}
    """
    for path, leaf in _leaves_with_code(context):
        for key, code in undeclared_reads(leaf):
            yield Finding(
                span=code.span,
                message=f"the code of `{leaf.name}` reads `{key}`, which is none of its input keys",
                help=_meant(key, leaf.inputs)
                or f"add `{key}` to the `input_keys` of `{leaf.name}`",
                related=calls(leaf, code.span),
                node=path,
            )
    yield from unknown_reads(context)


def leaves_by_type(context: Context, *, declared: bool) -> Iterator[tuple[str, Leaf, Body]]:
    """A leaf of each type whose code was read, with its path. `declared`: one that sees only the
    keys it declares, unlike the child of an iterator."""
    seen: set[str] = set()
    for path, container in context.containers:
        if declared and isinstance(container, nodes.Iterator):
            continue
        for child in container.children:
            if isinstance(child, Leaf) and child.body is not None and child.type not in seen:
                seen.add(child.type)
                yield f"{path}/{child.name}", child, child.body


@rule("SM309", "undeclared-return", Severity.ERROR)
def undeclared_return(context: Context) -> Iterator[Finding]:
    """The Python code of a state type returns what is not one of its outcomes, or nothing.

    SMACH ends the whole machine with an error then. The code is read, never run; what Jinja fills
    in is not judged. A warning where only some ways through `execute` end without `return`: they
    may be ways that nothing ever takes.

    Wrong:
        name: sm
        template: Base
        outcomes: [pressed, late]
        states:
          - WAIT:
              template: WaitForButton
              transitions: {pressed: pressed, timed_out: late}
        == templates/WaitForButton.yml ==
        name: WaitForButton
        outcomes: {pressed: {}, timed_out: {}}
        code: {python: WaitForButton.tpl.py}
        == templates/WaitForButton.tpl.py ==
        {% block class_defs %}
        class WaitForButton(smach.State):
            def __init__(self):
                super().__init__(outcomes=["pressed", "timed_out"])

            def execute(self, userdata):
                return "pressed" if button.wait(10) else "timeout"
        {% endblock %}

    Right:
        name: sm
        template: Base
        outcomes: [pressed, late]
        states:
          - WAIT:
              template: WaitForButton
              transitions: {pressed: pressed, timed_out: late}
        == templates/WaitForButton.yml ==
        name: WaitForButton
        outcomes: {pressed: {}, timed_out: {}}
        code: {python: WaitForButton.tpl.py}
        == templates/WaitForButton.tpl.py ==
        {% block class_defs %}
        class WaitForButton(smach.State):
            def __init__(self):
                super().__init__(outcomes=["pressed", "timed_out"])

            def execute(self, userdata):
                return "pressed" if button.wait(10) else "timed_out"
        {% endblock %}
    """
    for path, leaf, body in leaves_by_type(context, declared=False):
        yield from _wrong_returns(path, leaf, body)


def _wrong_returns(path: str, leaf: Leaf, body: Body) -> Iterator[Finding]:
    outcomes = outcome_names(leaf)
    guess = guesser(outcomes)
    known = f"its outcomes are {listed(outcomes)}" if outcomes else "it has no outcomes"
    for word in body.returns:
        if word.text not in outcomes:
            yield Finding(
                span=word.span,
                message=f"`{leaf.type}` returns `{word.text}`, which is none of its outcomes",
                help=did_you_mean(guess(word.text)) or known,
                node=path,
            )
    if body.silent is not None:
        does = "never returns" if body.always_silent else "can end without returning"
        yield Finding(
            span=body.silent,
            message=f"`execute` of `{leaf.type}` {does} an outcome",
            help=known,
            severity=None if body.always_silent else Severity.WARNING,
            node=path,
        )


def unknown_reads(context: Context) -> Iterator[Finding]:
    """The keys that code of a type reads and its interface does not take; SM310 says them."""
    for path, leaf, body in leaves_by_type(context, declared=True):
        inputs = [key.name for key in leaf.inputs]
        for word in _first_of_each(body.reads, inputs):
            yield Finding(
                span=word.span,
                message=f"the code of `{leaf.type}` reads `{word.text}`, which is none of the input"
                " keys of its interface",
                help=did_you_mean(guesser(inputs)(word.text))
                or f"add `{word.text}` to the `input_keys` of the interface `{leaf.type}`",
                node=path,
            )


def dropped_writes(context: Context) -> Iterator[Finding]:
    """The keys that code of a type writes and its interface does not give; SM308 says them, but
    for those that are read as well and not known at all, which is SM310."""
    for path, leaf, body in leaves_by_type(context, declared=True):
        inputs = {key.name for key in leaf.inputs}
        outputs = [key.name for key in leaf.outputs]
        unknown = {word.text for word in body.reads} - inputs
        for word in _first_of_each(body.writes, [*outputs, *unknown]):
            only = word.text in inputs
            what = "an input key only" if only else "none of the output keys of its interface"
            guess = None if only else did_you_mean(guesser(outputs)(word.text))
            yield Finding(
                span=word.span,
                message=f"the code of `{leaf.type}` writes `{word.text}`, which is {what}:"
                " the value is dropped",
                help=guess
                or f"add `{word.text}` to the `output_keys` of the interface `{leaf.type}`",
                node=path,
            )


def _first_of_each(words: Iterable[Word], known: Iterable[str]) -> list[Word]:
    """The words that are not known, each where it first stands."""
    found: dict[str, Word] = {}
    for word in words:
        found.setdefault(word.text, word)
    left = found.keys() - set(known)
    return [word for word in found.values() if word.text in left]
