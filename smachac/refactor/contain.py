"""Contain: states of a container are moved into a new nested container.

`plan_container` determines the container, `contain` writes it, `equal_after_contain` checks the
result.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType

from smachac.diagnostics.source import Source
from smachac.diagnostics.wording import listed
from smachac.ir.nodes import Container, Leaf, Machine, Node, StateMachine, Transition
from smachac.ir.outcome_names import GOOD_OUTCOMES
from smachac.ir.traversal import leads_to_child, outcome_names, outer_inputs, outer_outputs
from smachac.records import dataclass, replace
from smachac.refactor.cst import Atom, Collection, Item
from smachac.refactor.editor import (
    RefusedError,
    ScriptEditor,
    StateItem,
    add_entry,
    flow_mapping,
    new_atom,
    variable,
)
from smachac.refactor.equivalence import map_nodes, normalized
from smachac.refactor.field_order import variables_of

# --- plan

MOST_RULES = 64
"""Limit on the rules in the outcome map of a new concurrence."""

TargetName = tuple[str, bool]
"""The target of a transition: a name, and whether it is the name of a state."""

TransitionTargets = Mapping[tuple[str, str], TargetName]
"""The targets of transitions, by state and outcome."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ContainPlan:
    """A new container: the states of `parent` that it contains, its first state, its outcomes with
    the target of each, its input and output keys.

    `ends` gives the outcome of the container for each outcome of a state that leads out. `rules`
    are the rules of a concurrence by outcome, except for `default`. `on_error` is where exceptions
    of its states lead, if the `on_error` of `parent` catches them.
    """

    name: str
    kind: str
    parent: StateMachine
    inside: Sequence[Node]
    entry: str
    exits: Mapping[str, TargetName]
    ends: Mapping[tuple[str, str], str]
    inputs: Sequence[str]
    outputs: Sequence[str]
    rules: Mapping[str, Mapping[str, str]]
    default: str = ""
    on_error: str = ""


def preset_keys(editor: ScriptEditor, inside: Sequence[Node]) -> set[str]:
    """The userdata keys that some states preset, except containers."""
    found: set[str] = set()
    for child in inside:
        body = variables_of(editor.state(child.span).item)
        item = variable(body, "userdata") if body is not None else None
        if body is None or item is None or variable(body, "states") is not None:
            continue
        if isinstance(item.value, Collection):
            found |= {other.key.text.strip("'\"") for other in item.value.items if other.key}
    return found


def plan_container(
    parent: Node,
    inside: Sequence[Node],
    presets: set[str],
    name: str,
    kind: str,
    names: Mapping[str, str] = MappingProxyType({}),
) -> ContainPlan:
    """The container for some states of `parent`. `presets` are the userdata keys that they preset.
    `names` are names of its outcomes, by the state or outcome outside where each leads.

    States without an interface must have an inferred one (open_states.py). Raises RefusedError.
    """
    if not isinstance(parent, StateMachine) or parent.sugar:
        message = (
            f"`{parent.name}` is not a state machine: its states are not connected by transitions"
        )
        raise RefusedError(parent.span, message)
    for node in (*parent.children, *parent.outcomes):
        if node.name == name:
            message = f"`{parent.name}` already has a state or outcome `{name}`"
            raise RefusedError(node.span, message, "choose another name")
    entry = _entry(parent, inside)
    targets = _targets(parent, inside)
    inputs, outputs = _keys(parent, inside, presets)
    rules: dict[str, dict[str, str]] = {}
    ends: dict[tuple[str, str], str] = {}
    default = ""
    if kind == "Concurrence":
        _check_independence(inside)
        paths = list(_paths(inside, entry, targets))
        exits, rules, default = _rules(paths, {name, *(child.name for child in inside)}, names)
    else:
        exits, ends = _exits(inside, targets, {name, *(child.name for child in inside)}, names)
    _check_names(inside[0], exits, names)
    return ContainPlan(
        name=name,
        kind=kind,
        parent=parent,
        inside=inside,
        entry=entry,
        exits=dict(sorted(exits.items(), key=lambda pair: pair[0] not in GOOD_OUTCOMES)),
        ends=ends,
        inputs=inputs,
        outputs=outputs,
        rules=rules,
        default=default,
        on_error=_on_error(inside, ends) if kind != "Concurrence" else "",
    )


def _check_names(first: Node, exits: Mapping[str, TargetName], names: Mapping[str, str]) -> None:
    """Refuses a name for an outcome that the container does not have, or that is taken."""
    known = {place[0]: outcome for outcome, place in exits.items()}
    for target, outcome in names.items():
        if target not in known:
            message = f"no outcome of the container leads to `{target}`"
            raise RefusedError(first.span, message, f"its outcomes lead to {listed(known)}")
        if known[target] != outcome:
            message = f"`{outcome}` is the name of a state inside or of another outcome"
            raise RefusedError(first.span, message, "choose another name")


def _by_on_error(child: Node, step: Transition) -> bool:
    """Whether a transition comes from the `on_error` of the container."""
    return step.outcome == child.catches and step.span == step.target_span


def _on_error(inside: Sequence[Node], ends: Mapping[tuple[str, str], str]) -> str:
    """The `on_error` of a state machine around some states of a machine that has one: the outcome
    or the state that exceptions lead to."""
    steps = [(child, step) for child in inside for step in child.transitions]
    found = (
        ends.get((child.name, step.outcome), step.target)
        for child, step in steps
        if _by_on_error(child, step)
    )
    return next(found, "")


def _entry(parent: StateMachine, inside: Sequence[Node]) -> str:
    """The only state through which the others are entered. Raises RefusedError if there are
    several."""
    names = frozenset(child.name for child in parent.children)
    mine = {child.name: child for child in inside}
    entered: dict[str, str] = {}
    if parent.initial in mine:
        entered[parent.initial] = f"`{parent.name}` begins with `{parent.initial}`"
    for child in parent.children:
        for step in child.transitions if child.name not in mine else ():
            if leads_to_child(step, names) and step.target in mine:
                entered.setdefault(step.target, f"`{child.name}` leads to `{step.target}`")
    if len(entered) > 1:
        first, second = list(entered)[:2]
        message = f"a container begins with one state, but {entered[first]} and {entered[second]}"
        help = "add the states that lead there, or leave one of the two out"
        raise RefusedError(mine[second].span, message, help)
    return next(iter(entered), inside[0].name)


def _targets(parent: StateMachine, inside: Iterable[Node]) -> TransitionTargets:
    """The targets of the transitions of some states."""
    names = frozenset(child.name for child in parent.children)
    found: dict[tuple[str, str], TargetName] = {}
    for child in inside:
        for step in child.transitions:
            place = (step.target, leads_to_child(step, names))
            found.setdefault((child.name, step.outcome), place)
    return found


def _exits(
    inside: Sequence[Node],
    targets: TransitionTargets,
    taken: set[str],
    names: Mapping[str, str],
) -> tuple[dict[str, TargetName], dict[tuple[str, str], str]]:
    """The outcomes of a state machine around some states, one for each target.

    A target that is an outcome of the parent keeps its name, so that implicit transitions stay
    implicit.
    """
    mine = {child.name for child in inside}
    by_exit: dict[TargetName, list[tuple[str, str]]] = {}
    for step, place in targets.items():
        if not (place[1] and place[0] in mine):
            by_exit.setdefault(place, []).append(step)
    ends: dict[TargetName, str] = {}
    for place in sorted(by_exit, key=lambda pair: (pair[0] not in names, pair[1])):
        usual = Counter(outcome for _, outcome in by_exit[place]).most_common()
        words = [place[0]] if not place[1] else [word for word, _ in usual]
        ends[place] = _unique_name([names[place[0]]] if place[0] in names else words, taken)
    by_step = {step: ends[place] for place, steps in by_exit.items() for step in steps}
    return {ends[place]: place for place in by_exit}, by_step


def _unique_name(words: Sequence[str], taken: set[str]) -> str:
    """The first unused word, or a new name derived from the first word; it is then added to
    `taken`."""
    found = next((word for word in words if word not in taken), None)
    number = 2
    while found is None:
        word = f"{words[0]}_{number}"
        found, number = (word if word not in taken else None), number + 1
    taken.add(found)
    return found


# --- keys


def _keys(
    parent: StateMachine, inside: Sequence[Node], presets: set[str]
) -> tuple[list[str], list[str]]:
    """The input and output keys of a container around some states.

    The states must see the same values as before: each key from outside is copied in and, if it is
    written, copied out.
    """
    mine = {child.name for child in inside}
    others = [child for child in parent.children if child.name not in mine]
    reads = dict.fromkeys(key for child in inside for key in outer_inputs(child))
    writes = dict.fromkeys(key for child in inside for key in outer_outputs(child))
    wanted = {key for child in others for key in outer_inputs(child)}
    wanted |= {key.name for key in parent.outputs}
    given = {key for child in others for key in outer_outputs(child)}
    given |= {key.name for key in parent.inputs}
    given |= {preset.key for preset in parent.userdata if preset.key not in presets}
    sources = dict.fromkeys((*writes, *sorted(presets)))
    outputs = [key for key in sources if key in wanted or (key in given and key in reads)]
    inputs = [key for key in dict.fromkeys((*reads, *outputs)) if key in given]
    return inputs, outputs


# --- concurrences


def _check_independence(inside: Sequence[Node]) -> None:
    """Raises RefusedError if a state reads or writes a key that another one writes: they cannot run
    concurrently."""
    writers: dict[str, Node] = {}
    for child in inside:
        for key in outer_outputs(child):
            writers.setdefault(key, child)
    for child in inside:
        for key in (*outer_inputs(child), *outer_outputs(child)):
            writer = writers.get(key)
            if writer is not None and writer is not child:
                message = f"`{child.name}` uses `{key}`, which `{writer.name}` writes:"
                help = "leave one of them out, or remap the key"
                raise RefusedError(child.span, f"{message} they cannot run concurrently", help)


Path = tuple[tuple[tuple[str, str], ...], TargetName]
"""The outcomes along a path through some states, and the target of the last one."""


def _paths(inside: Sequence[Node], entry: str, targets: TransitionTargets) -> Iterator[Path]:
    """Every path through some states.

    Raises RefusedError if a state can be entered twice, or if there are too many paths.
    """
    by_name = {child.name: child for child in inside}
    todo: list[tuple[str, tuple[tuple[str, str], ...]]] = [(entry, ())]
    count = 0
    while todo:
        name, before = todo.pop()
        child = by_name[name]
        for outcome in reversed(outcome_names(child)):
            if (name, outcome) not in targets:
                continue
            place = targets[name, outcome]
            steps = (*before, (name, outcome))
            if not (place[1] and place[0] in by_name):
                count += 1
                yield steps, place
            elif any(place[0] == known for known, _ in steps):
                message = (
                    f"`{place[0]}` can be entered twice; in a concurrence each state runs once"
                )
                raise RefusedError(by_name[place[0]].span, message)
            else:
                todo.append((place[0], steps))
        if count + len(todo) > MOST_RULES:
            message = f"there are more than {MOST_RULES} paths through these states"
            raise RefusedError(by_name[entry].span, message, "take fewer states")


def _rules(
    paths: Sequence[Path], taken: set[str], names: Mapping[str, str]
) -> tuple[dict[str, TargetName], dict[str, dict[str, str]], str]:
    """The outcomes of a concurrence, with a rule for each former path through its states.

    The default is the target of most paths, the path through all states not counted.
    """
    whole = max(paths, key=lambda path: (len(path[0]), _goodness(path)))
    others = Counter(place for _, place in paths if place != whole[1])
    default = others.most_common(1)[0][0] if others else whole[1]
    exits: dict[str, TargetName] = {}
    rules: dict[str, dict[str, str]] = {}
    for steps, place in sorted(paths, key=lambda path: path is not whole):
        if place == default:
            continue
        word = names.get(place[0]) or (place[0] if not place[1] else steps[-1][1])
        end = _unique_name([word], taken)
        exits[end] = place
        rules[end] = dict(steps)
    last = next(steps[-1][1] for steps, place in paths if place == default)
    word = names.get(default[0]) or (default[0] if not default[1] else last)
    name = _unique_name([word], taken)
    exits[name] = default
    return exits, rules, name


def _goodness(path: Path) -> int:
    return sum(outcome in GOOD_OUTCOMES for _, outcome in path[0])


# --- writing


def contain(editors: Callable[[Source], ScriptEditor], plan: ContainPlan) -> None:
    """Apply a plan to the text of the states. Raises RefusedError."""
    editor = editors(plan.inside[0].span.source)
    places = [editor.state(child.span) for child in plan.inside]
    names = frozenset(child.name for child in plan.parent.children)
    for child, place in zip(plan.inside, places, strict=True):
        if plan.kind == "Concurrence":
            _remove_transitions(place.item)
        else:
            _retarget_transitions(editor, child, place, names, plan)
    mine = {child.name for child in plan.inside}
    for child in plan.parent.children:
        for step in child.transitions if child.name not in mine else ():
            if leads_to_child(step, names) and step.target in mine:
                editors(step.target_span.source).replace_word(step.target_span, plan.name)
    initial = plan.parent.initial_span
    written = plan.parent.initial in mine and initial.start != plan.parent.span.start
    if written and initial.text.strip("'\"") == plan.parent.initial:
        editors(initial.source).replace_word(initial, plan.name)
    editor.rewrite_state(places[0], [_written(plan, [place.item for place in places])])
    for place in places[1:]:
        editor.rewrite_state(place, [])


def _retarget_transitions(
    editor: ScriptEditor, child: Node, place: StateItem, names: frozenset[str], plan: ContainPlan
) -> None:
    """Let the transitions of a state out of the container lead to its outcomes."""
    body = variables_of(place.item)
    assert body is not None
    item = variable(body, "transitions")
    group = item.value if item is not None and isinstance(item.value, Collection) else None
    own = {item.key.text.strip("'\""): item for item in group.items if item.key} if group else {}
    for step in child.transitions:
        target = plan.ends.get((child.name, step.outcome), step.target)
        here = own.get(step.outcome)
        if _by_on_error(child, step):
            continue
        if here is None:
            by_name = target == step.outcome and not leads_to_child(step, names)
            if not (by_name and step.origin == "implicit"):
                add_entry(body, "transitions", step.outcome, target)
        elif isinstance(here.value, Atom) and here.value.text.strip("'\"") != target:
            here.value = Atom(target, -1, -1)
            if group is not None:
                group.flat = ""


def _remove_transitions(item: Item) -> None:
    """Remove the transitions of a state, which have no effect in a concurrence. Comments stay."""
    body = variables_of(item)
    found = variable(body, "transitions") if body is not None else None
    if body is None or found is None:
        return
    body.items = [item for item in body.items if item is not found]
    item.leading += [*found.leading, found.trailing.strip()] if found.trailing else found.leading
    if isinstance(found.value, Collection):
        for other in found.value.items:
            item.leading += [line for line in (*other.leading, other.trailing.strip()) if line]
        item.leading += found.value.tail


def _written(plan: ContainPlan, items: list[Item]) -> Item:
    """The syntax tree of the container with its states."""

    def name_list(names: Sequence[str]) -> Collection:
        return Collection(False, True, -1, items=[Item(None, new_atom(name)) for name in names])

    rows: list[tuple[str, Collection | Atom]] = [
        ("template", new_atom(plan.kind)),
        ("outcomes", name_list(list(plan.exits))),
    ]
    rows += [("input_keys", name_list(plan.inputs))] if plan.inputs else []
    rows += [("output_keys", name_list(plan.outputs))] if plan.outputs else []
    if plan.kind == "Concurrence":
        rows.append(("default_outcome", new_atom(plan.default)))
        rules = [
            Item(new_atom(end), flow_mapping(rule.items())) for end, rule in plan.rules.items()
        ]
        rows += [("outcome_map", Collection(True, False, -1, items=rules))] if rules else []
    rows.append(
        ("transitions", flow_mapping((end, place) for end, (place, _) in plan.exits.items()))
    )
    if plan.kind != "Concurrence" and plan.entry != plan.inside[0].name:
        rows.append(("initial", new_atom(plan.entry)))
    rows += [("on_error", new_atom(plan.on_error))] if plan.on_error else []
    lead = items[0].leading
    blank = bool(lead) and not lead[0]
    for item in items[:1]:
        item.leading = lead[1:] if blank else lead
    rows.append(("states", Collection(False, False, -1, items=items)))
    body = Collection(True, False, -1, items=[Item(new_atom(name), value) for name, value in rows])
    named = Collection(True, False, -1, items=[Item(new_atom(plan.name), body)])
    return Item(None, named, leading=[""] if blank else [])


# --- check


def equal_after_contain(before: Machine, after: Machine, plan: ContainPlan) -> bool:
    """Whether two machines are equal except for the new container.

    A concurrence changes the order in which its states run, so for it only the states outside are
    compared.
    """
    names = [child.name for child in plan.inside]

    def is_new(node: Node) -> bool:
        return (
            node.name == plan.name
            and not isinstance(node, Leaf)
            and ({child.name for child in node.children} == set(names))
        )

    def opened(node: Node) -> Node:
        if not isinstance(node, StateMachine):
            return _sorted(node)
        mine = next((child for child in node.children if is_new(child)), None)
        if mine is None or isinstance(mine, Leaf):
            return _sorted(node)
        return _sorted(_flattened(node, mine, plan.kind == "Concurrence"))

    def as_before(node: Node) -> Node:
        if plan.kind != "Concurrence" or not isinstance(node, StateMachine):
            return _sorted(node)
        if set(names) <= {child.name for child in node.children} and node.name == plan.parent.name:
            return _sorted(_collapsed(node, set(names)))
        return _sorted(node)

    return normalized(map_nodes(before.root, as_before)) == normalized(
        map_nodes(after.root, opened)
    )


def _sorted(node: Node) -> Node:
    """A node with its children and its userdata sorted by name."""
    if isinstance(node, Leaf):
        return node
    children = tuple(sorted(node.children, key=lambda child: child.name))
    userdata = tuple(sorted(node.userdata, key=lambda preset: preset.key))
    return replace(node, children=children, userdata=userdata)


def _flattened(parent: StateMachine, mine: Container, forget: bool) -> StateMachine:
    """A machine with the states of a nested container moved back into it."""
    inside = frozenset(child.name for child in mine.children)
    names = frozenset(child.name for child in parent.children)
    out = {step.outcome: step for step in mine.transitions}
    first = mine.initial if isinstance(mine, StateMachine) else mine.children[0].name

    def retargeted(step: Transition, here: bool) -> Transition:
        if here and not leads_to_child(step, inside):
            further = out.get(step.target)
            if further is None:
                return step
            targets = leads_to_child(further, names)
            target = first if targets and further.target == mine.name else further.target
            return replace(step, target=target, origin="written" if targets else "implicit")
        if not here and leads_to_child(step, names) and step.target == mine.name:
            return replace(step, target=first)
        return step

    def moved(child: Node, here: bool) -> Node:
        return replace(
            child, transitions=tuple(retargeted(step, here) for step in child.transitions)
        )

    children = [moved(child, False) for child in parent.children if child is not mine]
    children += [moved(child, True) for child in mine.children]
    initial = first if parent.initial == mine.name else parent.initial
    userdata = (*parent.userdata, *mine.userdata)
    whole = replace(parent, children=tuple(children), initial=initial, userdata=userdata)
    return _collapsed(whole, set(inside)) if forget else whole


def _collapsed(parent: StateMachine, inside: set[str]) -> StateMachine:
    """A container in which all states with the given names are replaced by one unknown state."""
    names = frozenset(child.name for child in parent.children)

    def retargeted(step: Transition) -> Transition:
        mine = leads_to_child(step, names) and step.target in inside
        return replace(step, target="?") if mine else step

    children = [
        replace(child, transitions=tuple(map(retargeted, child.transitions)))
        for child in parent.children
        if child.name not in inside
    ]
    initial = "?" if parent.initial in inside else parent.initial
    return replace(parent, children=tuple(children), initial=initial)
