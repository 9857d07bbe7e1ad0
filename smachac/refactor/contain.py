"""States that are put into a container of their own: how that is written."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from smachac.diagnostics.source import Source
from smachac.ir.nodes import Container, Key, Leaf, Machine, Node, StateMachine, Transition
from smachac.ir.outcome_names import GOOD_OUTCOMES
from smachac.ir.traversal import leads_to_child, outcome_names, remapping
from smachac.refactor.cst import Atom, Group, Item
from smachac.refactor.editor import Place, RefusedError, Sheet, pairs, put, variable, word
from smachac.refactor.equivalence import normal, rebuilt
from smachac.refactor.field_order import variables_of


def presets_of(sheet: Sheet, inside: Sequence[Node]) -> set[str]:
    """The keys of the userdata that comes with states that are no containers."""
    found: set[str] = set()
    for child in inside:
        body = variables_of(sheet.state(child.span).item)
        item = variable(body, "userdata") if body is not None else None
        if body is None or item is None or variable(body, "states") is not None:
            continue
        if isinstance(item.value, Group):
            found |= {each.key.text.strip("'\"") for each in item.value.items if each.key}
    return found


def contain(sheets: Callable[[Source], Sheet], made: Plan) -> None:
    """Write a plan into the text that holds the states. Raises RefusedError."""
    sheet = sheets(made.inside[0].span.source)
    places = [sheet.state(child.span) for child in made.inside]
    names = frozenset(child.name for child in made.parent.children)
    for child, place in zip(made.inside, places, strict=True):
        if made.kind == "Concurrence":
            _without_transitions(place.item)
        else:
            _lead_out(sheet, child, place, names, made)
    mine = {child.name for child in made.inside}
    for child in made.parent.children:
        for step in child.transitions if child.name not in mine else ():
            if leads_to_child(step, names) and step.target in mine:
                sheets(step.target_span.source).spell(step.target_span, made.name)
    initial = made.parent.initial_span
    written = made.parent.initial in mine and initial.start != made.parent.span.start
    if written and initial.text.strip("'\"") == made.parent.initial:
        sheets(initial.source).spell(initial, made.name)
    sheet.write_anew(places[0], [_written(made, [place.item for place in places])])
    for place in places[1:]:
        sheet.write_anew(place, [])


def _lead_out(sheet: Sheet, child: Node, place: Place, names: frozenset[str], made: Plan) -> None:
    """Let a state's edges lead to outcomes of the container, where they led out."""
    body = variables_of(place.item)
    assert body is not None
    item = variable(body, "transitions")
    group = item.value if item is not None and isinstance(item.value, Group) else None
    own = {each.key.text.strip("'\""): each for each in group.items if each.key} if group else {}
    for step in child.transitions:
        target = made.ends.get((child.name, step.outcome), step.target)
        here = own.get(step.outcome)
        if here is None:
            by_name = target == step.outcome and not leads_to_child(step, names)
            if not (by_name and step.origin == "implicit"):
                put(body, "transitions", step.outcome, target)
        elif isinstance(here.value, Atom) and here.value.text.strip("'\"") != target:
            here.value = Atom(target, -1, -1)
            if group is not None:
                group.flat = ""


def _without_transitions(item: Item) -> None:
    """Take the transitions of a state away: in a concurrence they mean nothing. Comments stay."""
    body = variables_of(item)
    found = variable(body, "transitions") if body is not None else None
    if body is None or found is None:
        return
    body.items = [each for each in body.items if each is not found]
    item.lead += [*found.lead, found.aside.strip()] if found.aside else found.lead
    if isinstance(found.value, Group):
        for each in found.value.items:
            item.lead += [line for line in (*each.lead, each.aside.strip()) if line]
        item.lead += found.value.tail


def _written(made: Plan, items: list[Item]) -> Item:
    """The container with its states."""

    def listed(names: Sequence[str]) -> Group:
        return Group(False, True, -1, items=[Item(None, word(name)) for name in names])

    rows: list[tuple[str, Group | Atom]] = [
        ("template", word(made.kind)),
        ("outcomes", listed(list(made.exits))),
    ]
    rows += [("input_keys", listed(made.inputs))] if made.inputs else []
    rows += [("output_keys", listed(made.outputs))] if made.outputs else []
    if made.kind == "Concurrence":
        rows.append(("default_outcome", word(made.default)))
        rules = [Item(word(end), pairs(rule.items())) for end, rule in made.rules.items()]
        rows += [("outcome_map", Group(True, False, -1, items=rules))] if rules else []
    rows.append(("transitions", pairs((end, place) for end, (place, _) in made.exits.items())))
    if made.kind != "Concurrence" and made.entry != made.inside[0].name:
        rows.append(("initial", word(made.entry)))
    lead = items[0].lead
    blank = bool(lead) and not lead[0]
    for item in items[:1]:
        item.lead = lead[1:] if blank else lead
    rows.append(("states", Group(False, False, -1, items=items)))
    body = Group(True, False, -1, items=[Item(word(name), value) for name, value in rows])
    named = Group(True, False, -1, items=[Item(word(made.name), body)])
    return Item(None, named, lead=[""] if blank else [])


MOST_RULES = 64
"""The most combinations that the outcome map of a new concurrence may tell apart."""

Exit = tuple[str, bool]
"""Where an edge leads: a name, and whether it is that of a state."""

Leads = Mapping[tuple[str, str], Exit]
"""Where states lead with their outcomes."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Plan:
    """A container to be: around which states of `parent`, where it begins, its outcomes with what
    each leads to, the keys that it takes in and hands out.

    `ends`: the outcome that a state's outcome becomes, where it leads out. `rules` are those of a
    concurrence by its outcomes, all but that of `default`.
    """

    name: str
    kind: str
    parent: StateMachine
    inside: Sequence[Node]
    entry: str
    exits: Mapping[str, Exit]
    ends: Mapping[tuple[str, str], str]
    inputs: Sequence[str]
    outputs: Sequence[str]
    rules: Mapping[str, Mapping[str, str]]
    default: str = ""


def plan(parent: Node, inside: Sequence[Node], presets: set[str], name: str, kind: str) -> Plan:
    """How some states of a container are put into one of their own; `presets` are the keys of the
    userdata that comes with them. All of the container's states are completed, where they have no
    interface. Raises RefusedError."""
    if not isinstance(parent, StateMachine) or parent.sugar:
        message = f"`{parent.name}` is no state machine: transitions do not lead what is in it"
        raise RefusedError(parent.span, message)
    for node in (*parent.children, *parent.outcomes):
        if node.name == name:
            message = f"`{parent.name}` has a state or outcome `{name}` already"
            raise RefusedError(node.span, message, "choose another name")
    entry = _entry(parent, inside)
    leads = _leads(parent, inside)
    inputs, outputs = _keys(parent, inside, presets)
    rules: dict[str, dict[str, str]] = {}
    ends: dict[tuple[str, str], str] = {}
    default = ""
    if kind == "Concurrence":
        _check_independence(inside)
        paths = list(_paths(inside, entry, leads))
        exits, rules, default = _rules(paths, {name, *(child.name for child in inside)})
    else:
        exits, ends = _exits(inside, leads, {name, *(child.name for child in inside)})
    return Plan(
        name=name,
        kind=kind,
        parent=parent,
        inside=inside,
        entry=entry,
        exits=dict(sorted(exits.items(), key=lambda each: each[0] not in GOOD_OUTCOMES)),
        ends=ends,
        inputs=inputs,
        outputs=outputs,
        rules=rules,
        default=default,
    )


def _entry(parent: StateMachine, inside: Sequence[Node]) -> str:
    """The state by which the others are entered. Raises RefusedError where there are several."""
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
        help = "take in what leads there, or leave one of the two out"
        raise RefusedError(mine[second].span, message, help)
    return next(iter(entered), inside[0].name)


def _leads(parent: StateMachine, inside: Iterable[Node]) -> Leads:
    names = frozenset(child.name for child in parent.children)
    found: dict[tuple[str, str], Exit] = {}
    for child in inside:
        for step in child.transitions:
            place = (step.target, leads_to_child(step, names))
            found.setdefault((child.name, step.outcome), place)
    return found


def _exits(
    inside: Sequence[Node], leads: Leads, taken: set[str]
) -> tuple[dict[str, Exit], dict[tuple[str, str], str]]:
    """The outcomes of a state machine around some states, one for each place they lead to.

    Outcomes of the parent keep their names, so that edges nobody wrote stay as they are.
    """
    mine = {child.name for child in inside}
    by_exit: dict[Exit, list[tuple[str, str]]] = {}
    for step, place in leads.items():
        if not (place[1] and place[0] in mine):
            by_exit.setdefault(place, []).append(step)
    ends: dict[Exit, str] = {}
    for place in sorted(by_exit, key=lambda each: each[1]):
        usual = Counter(outcome for _, outcome in by_exit[place]).most_common()
        ends[place] = _fresh([place[0]] if not place[1] else [word for word, _ in usual], taken)
    by_step = {step: ends[place] for place, steps in by_exit.items() for step in steps}
    return {ends[place]: place for place in by_exit}, by_step


def _fresh(words: Sequence[str], taken: set[str]) -> str:
    """The first word that is not taken yet, or one made of the first; it is taken then."""
    found = next((word for word in words if word not in taken), None)
    number = 2
    while found is None:
        word = f"{words[0]}_{number}"
        found, number = (word if word not in taken else None), number + 1
    taken.add(found)
    return found


# --- keys


def _outer(node: Node, keys: Iterable[Key]) -> list[str]:
    names = remapping(node)
    return [names.get(key.name, key.name) for key in keys]


def _keys(
    parent: StateMachine, inside: Sequence[Node], presets: set[str]
) -> tuple[list[str], list[str]]:
    """What a container around some states takes in and hands out, so that they see of each key
    what they saw: what comes from outside is brought in each time, and brought back."""
    mine = {child.name for child in inside}
    others = [child for child in parent.children if child.name not in mine]
    reads = dict.fromkeys(key for child in inside for key in _outer(child, child.inputs))
    writes = dict.fromkeys(key for child in inside for key in _outer(child, child.outputs))
    wanted = {key for child in others for key in _outer(child, child.inputs)}
    wanted |= {key.name for key in parent.outputs}
    given = {key for child in others for key in _outer(child, child.outputs)}
    given |= {key.name for key in parent.inputs}
    given |= {preset.key for preset in parent.userdata if preset.key not in presets}
    sources = dict.fromkeys((*writes, *sorted(presets)))
    outputs = [key for key in sources if key in wanted or (key in given and key in reads)]
    inputs = [key for key in dict.fromkeys((*reads, *outputs)) if key in given]
    return inputs, outputs


# --- concurrences


def _check_independence(inside: Sequence[Node]) -> None:
    """Raises RefusedError where a state needs what another one writes: they cannot run at once."""
    writers: dict[str, Node] = {}
    for child in inside:
        for key in _outer(child, child.outputs):
            writers.setdefault(key, child)
    for child in inside:
        for key in (*_outer(child, child.inputs), *_outer(child, child.outputs)):
            writer = writers.get(key)
            if writer is not None and writer is not child:
                message = f"`{child.name}` uses `{key}`, which `{writer.name}` writes:"
                help = "leave one of them out, or remap the key"
                raise RefusedError(child.span, f"{message} they cannot run at once", help)


Path = tuple[tuple[tuple[str, str], ...], Exit]
"""The outcomes that lead along some states, and where to in the end."""


def _paths(inside: Sequence[Node], entry: str, leads: Leads) -> Iterator[Path]:
    """Every way through some states that follow one another. Raises RefusedError where a state can
    come again, or there are too many ways."""
    by_name = {child.name: child for child in inside}
    todo: list[tuple[str, tuple[tuple[str, str], ...]]] = [(entry, ())]
    count = 0
    while todo:
        name, before = todo.pop()
        child = by_name[name]
        for outcome in reversed(outcome_names(child)):
            if (name, outcome) not in leads:
                continue
            place = leads[name, outcome]
            steps = (*before, (name, outcome))
            if not (place[1] and place[0] in by_name):
                count += 1
                yield steps, place
            elif any(place[0] == known for known, _ in steps):
                message = f"`{place[0]}` can come again: in a concurrence all run once"
                raise RefusedError(by_name[place[0]].span, message)
            else:
                todo.append((place[0], steps))
        if count + len(todo) > MOST_RULES:
            message = f"there are more than {MOST_RULES} ways through these states"
            raise RefusedError(by_name[entry].span, message, "take fewer states")


def _rules(
    paths: Sequence[Path], taken: set[str]
) -> tuple[dict[str, Exit], dict[str, dict[str, str]], str]:
    """The outcomes of a concurrence, and a rule for each way that states had when they followed one
    another; the default is the place that most ways lead to, but for the one through all states."""
    whole = max(paths, key=lambda each: (len(each[0]), _goodness(each)))
    others = Counter(place for _, place in paths if place != whole[1])
    default = others.most_common(1)[0][0] if others else whole[1]
    exits: dict[str, Exit] = {}
    rules: dict[str, dict[str, str]] = {}
    for steps, place in sorted(paths, key=lambda each: each is not whole):
        if place == default:
            continue
        end = _fresh([place[0]] if not place[1] else [steps[-1][1]], taken)
        exits[end] = place
        rules[end] = dict(steps)
    last = next(steps[-1][1] for steps, place in paths if place == default)
    name = _fresh([default[0]] if not default[1] else [last], taken)
    exits[name] = default
    return exits, rules, name


def _goodness(path: Path) -> int:
    return sum(outcome in GOOD_OUTCOMES for _, outcome in path[0])


# --- proof


def contained_alike(before: Machine, after: Machine, made: Plan) -> bool:
    """Whether a machine is another one but for the container; around a concurrence, whose states
    run in another order now, it is what is outside that has to be the same."""
    names = [child.name for child in made.inside]

    def is_new(node: Node) -> bool:
        return (
            node.name == made.name
            and not isinstance(node, Leaf)
            and ({child.name for child in node.children} == set(names))
        )

    def opened(node: Node) -> Node:
        if not isinstance(node, StateMachine):
            return _sorted(node)
        mine = next((child for child in node.children if is_new(child)), None)
        if mine is None or isinstance(mine, Leaf):
            return _sorted(node)
        return _sorted(_opened(node, mine, made.kind == "Concurrence"))

    def as_before(node: Node) -> Node:
        if made.kind != "Concurrence" or not isinstance(node, StateMachine):
            return _sorted(node)
        if set(names) <= {child.name for child in node.children} and node.name == made.parent.name:
            return _sorted(_without(node, set(names)))
        return _sorted(node)

    return normal(rebuilt(before.root, as_before)) == normal(rebuilt(after.root, opened))


def _sorted(node: Node) -> Node:
    """A node with its children and its userdata in the order of their names."""
    if isinstance(node, Leaf):
        return node
    children = tuple(sorted(node.children, key=lambda child: child.name))
    userdata = tuple(sorted(node.userdata, key=lambda preset: preset.key))
    return replace(node, children=children, userdata=userdata)


def _opened(parent: StateMachine, mine: Container, forget: bool) -> StateMachine:
    """A container whose states stand in the one around it again."""
    inside = frozenset(child.name for child in mine.children)
    names = frozenset(child.name for child in parent.children)
    out = {step.outcome: step for step in mine.transitions}
    first = mine.initial if isinstance(mine, StateMachine) else mine.children[0].name

    def led(step: Transition, here: bool) -> Transition:
        if here and not leads_to_child(step, inside):
            further = out.get(step.target)
            if further is None:
                return step
            leads = leads_to_child(further, names)
            target = first if leads and further.target == mine.name else further.target
            return replace(step, target=target, origin="written" if leads else "implicit")
        if not here and leads_to_child(step, names) and step.target == mine.name:
            return replace(step, target=first)
        return step

    def moved(child: Node, here: bool) -> Node:
        return replace(child, transitions=tuple(led(step, here) for step in child.transitions))

    children = [moved(child, False) for child in parent.children if child is not mine]
    children += [moved(child, True) for child in mine.children]
    initial = first if parent.initial == mine.name else parent.initial
    userdata = (*parent.userdata, *mine.userdata)
    whole = replace(parent, children=tuple(children), initial=initial, userdata=userdata)
    return _without(whole, set(inside)) if forget else whole


def _without(parent: StateMachine, inside: set[str]) -> StateMachine:
    """A container whose states of these names are all one, which nothing is known of."""
    names = frozenset(child.name for child in parent.children)

    def led(step: Transition) -> Transition:
        mine = leads_to_child(step, names) and step.target in inside
        return replace(step, target="?") if mine else step

    children = [
        replace(child, transitions=tuple(map(led, child.transitions)))
        for child in parent.children
        if child.name not in inside
    ]
    initial = "?" if parent.initial in inside else parent.initial
    return replace(parent, children=tuple(children), initial=initial)
