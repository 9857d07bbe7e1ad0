"""The Python statements that build a machine: containers, the calls that add states, userdata."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Iterable, Iterator
from keyword import iskeyword

from smachac.diagnostics.source import assert_never
from smachac.ir.concurrence_rules import by_priority
from smachac.ir.nodes import (
    Concurrence,
    Container,
    Data,
    Key,
    Node,
    OutcomeRule,
    Sequence,
    StateMachine,
    Transition,
)
from smachac.ir.nodes import Iterator as IteratorNode
from smachac.ir.traversal import ends_preempted
from smachac.records import replace
from smachac.targets import comment, comment_lines
from smachac.targets.python.formatter import (
    WIDTH,
    Doc,
    Group,
    call,
    flat,
    laid_out,
    literal,
    mapping,
    names,
    string,
)

OURS = (
    *("smach", "build", "main", "error_as_outcome", "with_callbacks"),
    *("ends_preempted", "pass_on_each_request", "pass_on_second_request"),
    *("pass_on_stop_requests", "withdraw", "with_retries", "with_timeout"),
    *("stop_at_signals", "stop_signals", "signals", "sim", "world"),
    *("rospy", "smach_ros", "start_node", "preempt_at_shutdown", "server", "sis"),
)
"""Names of the module that variables of containers must not have."""

WORDS = {
    "StateMachine": "state machine",
    "Sequence": "sequence",
    "Concurrence": "concurrence",
    "Iterator": "iterator",
}
"""The names of SMACH's classes for containers in words."""

_METHODS = frozenset(["keys", "update", "extract", "merge"])
"""Attributes of smach.UserData that a key of the same name must not replace."""

Arguments = list[tuple[str, Doc]]


def variable_names() -> Callable[[str, str], str]:
    """A function that makes a fresh name with a prefix: `sm_` for the variable of a container, as
    SMACHA named them, and no prefix for that of the outermost one."""
    taken: dict[str, int] = dict.fromkeys(OURS, 1)

    def fresh(name: str, prefix: str) -> str:
        word = unicodedata.normalize("NFKC", name.lower())
        word = "".join(text if f"_{text}".isidentifier() else " " for text in word)
        word = re.sub(r"\W+", "_", word).strip("_")
        if prefix or not word or word[0].isdigit() or iskeyword(word) or word in taken:
            word = f"{prefix or 'sm_'}{word}".rstrip("_")
        taken[word] = taken.get(word, 0) + 1
        return word if taken[word] == 1 else fresh(f"{name}_{taken[word]}", prefix)

    return fresh


def construct(
    node: Container, variable: str, depth: int, items: Doc | None = None, note: str = ""
) -> str:
    """The statement that makes a container; `note` is a comment at it. `items` are those of an
    Iterator that are not userdata."""
    arguments: Arguments = [("outcomes=", names(outcome.name for outcome in node.outcomes))]
    match node:
        case Sequence():
            arguments.append(("connector_outcome=", string(node.connector_outcome)))
        case Concurrence():
            # SMACH requires a default outcome; rules that cover every case never use it.
            default = node.default_outcome or node.rules[-1].outcome
            arguments.append(("default_outcome=", string(default)))
        case IteratorNode():
            from_userdata = f"lambda: {variable}.userdata[{string(node.items_key)}]"
            arguments.append(("it=", items or from_userdata))
            arguments.append(("it_label=", string(node.item_key)))
            arguments.append(("exhausted_outcome=", string(node.exhausted_outcome)))
        case StateMachine():
            pass
        case _:
            assert_never(node)
    # SMACH's Iterator requires both lists of keys.
    both = isinstance(node, IteratorNode)
    arguments += key_arguments(node.inputs, node.outputs, both=both)
    if isinstance(node, Concurrence):
        is_map = len({rule.outcome for rule in node.rules}) == len(node.rules)
        if not is_map or node.join == "rule":
            arguments.append(("outcome_cb=", _outcome_function(node)))
        elif node.rules:
            arguments.append(("outcome_map=", _outcome_map(node)))
        if node.join != "all":
            ends = "True" if node.join == "any" else _holds(node)
            arguments.append(("child_termination_cb=", f"lambda outcomes: {ends}"))
    head = f"{variable} = "
    made = call(f"smach.{kind(node)}", arguments)
    return head + _with_comment(made, note, width(depth), len(head))


def _with_comment(doc: Doc, text: str, width: int, before: int = 0) -> str:
    """A statement, laid out as by `laid_out`, with a comment on its first line, if there is one."""
    comment = f"  # {text}" if text else ""
    first, *rest = laid_out(doc, width, before, len(comment)).split("\n")
    return "\n".join([f"{first}{comment}", *rest])


def kind(node: Container) -> str:
    """The name of SMACH's class for a container."""
    return type(node).__name__


def width(depth: int) -> int:
    """The length of a line inside `depth` blocks."""
    return max(40, WIDTH - 4 * depth)


def key_arguments(
    inputs: tuple[Key, ...], outputs: tuple[Key, ...], both: bool = False
) -> Iterator[tuple[str, Doc]]:
    """The keyword arguments for keys; those without keys are left out, unless `both`."""
    for name, keys in (("input_keys=", inputs), ("output_keys=", outputs)):
        if keys or both:
            yield name, names(key.name for key in keys)


def _outcome_map(node: Concurrence) -> Group:
    """The rules, from fewer to more conditions: in that order all versions of SMACH choose the same
    rule where several hold."""
    rules = sorted(node.rules, key=lambda rule: len(rule.when))
    return mapping(
        (rule.outcome, mapping((one.child, string(one.outcome)) for one in rule.when))
        for rule in rules
    )


def _outcome_function(node: Concurrence) -> str:
    """The rules as a function, for an outcome with several rules: a map holds one rule each."""
    text = "None"
    for rule in reversed(by_priority(node)):
        holds = _conditions(rule, "ended[{}] == {}") or True
        text = f"{string(rule.outcome)} if {holds} else {text}"
    return f"lambda ended: {text}"


def _holds(node: Concurrence) -> str:
    """The code for whether a rule holds while branches run, which have no outcome."""
    rules = (_conditions(rule, "outcomes.get({}) == {}") for rule in node.rules)
    return " or ".join(f"({holds or True})" for holds in rules) or "False"


def _conditions(rule: OutcomeRule, form: str) -> str:
    """The code of the conditions of a rule, each of a form with a branch and its outcome."""
    pairs = ((string(one.child), string(one.outcome)) for one in rule.when)
    return " and ".join(form.format(*pair) for pair in pairs)


def userdata(variable: str, depth: int, presets: Iterable[tuple[str, Doc]]) -> list[str]:
    """The statements that set the userdata of a container before the run: keys and values."""
    lines = []
    for key, value in presets:
        plain = key.isidentifier() and not iskeyword(key) and key[0] != "_"
        place = f".{key}" if plain and key not in _METHODS else f"[{string(key)}]"
        head = f"{variable}.userdata{place} = "
        lines.append(head + laid_out(value, width(depth), len(head)))
    return lines


def initial(node: Container, variable: str) -> list[str]:
    """The statement that sets the initial state, if that is not the first state."""
    if not isinstance(node, (StateMachine, Sequence)) or not node.children:
        return []
    if node.initial == node.children[0].name:
        return []
    return [f"{variable}.set_initial_state({flat(names([node.initial]))})"]


def made(node: Node, state: Doc, used: dict[str, None], callbacks: Data = None) -> Doc:
    """The expression for a state, wrapped for `callbacks`, for exceptions that it catches, and for
    requests to stop that end a time limit, retry or loop. `used` gets the functions around it."""
    if callbacks is not None:
        used["with_callbacks"] = None
        state = call("with_callbacks", [("", state), ("", literal(callbacks))])
    if ends_preempted(node):
        used["ends_preempted"] = None
        state = call("ends_preempted", [("", state)])
    if not node.catches:
        return state
    used["error_as_outcome"] = None
    return call("error_as_outcome", [("", state), ("", string(node.catches))])


def add(node: Node, parent: Container, made: Doc, depth: int, note: str = "") -> str:
    """The statement that adds a state, made by the expression `made`, to its container; `note` is a
    comment at it."""
    return _with_comment(_add(node, parent, made), note, width(depth))


def _add(node: Node, parent: Container, made: Doc) -> Group:
    arguments: Arguments = [("", string(node.name)), ("", made)]
    if isinstance(parent, IteratorNode):
        arguments.append(("loop_outcomes=", names(parent.loop_outcomes)))
        if parent.final_map:
            pairs = ((key, string(to)) for key, to in parent.final_map)
            arguments.append(("final_outcome_map=", mapping(pairs)))
        return call("smach.Iterator.set_contained_state", arguments)
    if not isinstance(parent, Concurrence):
        edges = [
            (edge.outcome, string(edge.target))
            for edge in (*node.transitions, *_never_taken(node))
            if edge.origin != "connector"
        ]
        if edges:
            arguments.append(("transitions=", mapping(edges)))
    if node.remaps:
        pairs = ((remap.key, string(remap.to)) for remap in node.remaps)
        arguments.append(("remapping=", mapping(pairs)))
    return call(f"smach.{kind(parent)}.add", arguments)


def _never_taken(node: Node) -> Iterator[Transition]:
    """The transition for an exhausted outcome that the final map renames: SMACH's Iterator still
    registers the outcome, and its container requires a transition for each outcome."""
    if not isinstance(node, IteratorNode):
        return
    renamed = dict(node.final_map).get(node.exhausted_outcome)
    if any(outcome.name == node.exhausted_outcome for outcome in node.outcomes):
        return
    for edge in node.transitions:
        if edge.outcome == renamed:
            yield replace(edge, outcome=node.exhausted_outcome, origin="written")


def children(node: Container) -> Iterator[Node]:
    """The states of a container, without implicit transitions to an outcome that has the name of a
    state: written out, SMACH would take them as transitions to that state."""
    names = frozenset(child.name for child in node.children)
    for child in node.children:
        kept = [
            edge
            for edge in child.transitions
            if edge.origin != "implicit" or edge.target not in names
        ]
        shadowed = len(kept) < len(child.transitions)
        yield replace(child, transitions=tuple(kept)) if shadowed else child


def place(node: Node) -> str:
    """The place of a state in its script, without folders: `pick_block.yml:12`."""
    name = node.span.source.name.replace("\\", "/").rsplit("/", 1)[-1]
    return comment(f"{name}:{node.span.line}")


def notes(node: Node, depth: int) -> str:
    """The comment above a state that other code than ours adds: its place and documentation."""
    return _comment([place(node), *_lines(node.doc, depth)])


def documentation(doc: str, depth: int) -> str:
    """The comment above a state, with a line end; empty if it has no documentation."""
    text = _comment(_lines(doc, depth))
    return f"{text}\n" if text else ""


def _lines(doc: str, depth: int) -> list[str]:
    return [*comment_lines(doc, width(depth) - 2)] if doc else []


def _comment(lines: Iterable[str]) -> str:
    return "\n".join(f"# {line}".rstrip() for line in lines)
