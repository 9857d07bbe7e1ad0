"""Mutations of names, text and structure: SM0xx and SM1xx."""

from __future__ import annotations

from smachac.ir.nodes import Sequence
from tests.trust.mutants import Mutant, Place, Subject, mutation
from tests.trust.project_text import Data, Quoted, Site, Steps

FRAMES = ("StateMachine", "Sequence", "Concurrence", "Iterator")
MACHINES = ("StateMachine", "Sequence")


def swap_letters(name: str) -> str:
    """A slip of the fingers: two letters of the middle swapped, or one doubled."""
    at = len(name) // 2
    turned = name[: at - 1] + name[at] + name[at - 1] + name[at + 1 :]
    return turned if turned != name and len(name) > 3 else f"{name}{name[-1:]}x"


def renamed(data: dict[str, Data], old: str, new: str) -> None:
    """Give an entry another key, in the same place."""
    entries = list(data.items())
    data.clear()
    data.update((new if key == old else key, value) for key, value in entries)


def transitions(subject: Subject, *frames: str) -> list[tuple[Site, str]]:
    """States of containers of these types with the outcomes that the script leads somewhere."""
    return [
        (site, outcome)
        for site in subject.sites()
        if site.around is not None and site.around.target in (frames or MACHINES)
        for outcome in site.pairs("transitions")
    ]


def pick_transition(subject: Subject) -> tuple[Site, str] | None:
    found = transitions(subject)
    return subject.draw.choice(found) if found else None


@mutation
def rename_a_target(subject: Subject) -> Mutant | None:
    found = pick_transition(subject)
    if found is None:
        return None
    site, outcome = found
    site.body["transitions"][outcome] = swap_letters(site.body["transitions"][outcome])
    return Mutant(codes=("SM101",), places=((site.file, (*site.path, "transitions", outcome)),))


@mutation
def drop_a_transition(subject: Subject) -> Mutant | None:
    """Where the container has an outcome of that name, or a Sequence links, it goes there."""
    found = pick_transition(subject)
    if found is None:
        return None
    site, outcome = found
    around = site.around
    assert around is not None
    frame = subject.node(around)
    linked = isinstance(frame, Sequence) and outcome == frame.connector_outcome
    del site.body["transitions"][outcome]
    if not site.body["transitions"]:
        del site.body["transitions"]
    if linked and site.name == list(around.states())[-1].name:
        linked = False
    implicit = outcome in around.keys("outcomes") or linked
    codes = ("SM105",) if implicit else ("SM104",)
    return Mutant(codes=codes, owners=(site,), ends=implicit)


@mutation
def rename_an_outcome_in_a_transition(subject: Subject) -> Mutant | None:
    found = [
        (site, outcome)
        for site, outcome in transitions(subject)
        if subject.node(site) is not None and not getattr(subject.node(site), "open", False)
    ]
    if not found:
        return None
    site, outcome = subject.draw.choice(found)
    new = swap_letters(outcome)
    renamed(site.body["transitions"], outcome, new)
    return Mutant(codes=("SM102",), places=((site.file, (*site.path, "transitions", new)),))


@mutation
def drop_a_container_outcome(subject: Subject) -> Mutant | None:
    """The transitions to it lead nowhere; a rule, or the default, of a concurrence as well. If only
    one name is missing, the finding is at the list that lacks it."""
    found = [
        (site, outcome, steps)
        for site in subject.sites()
        if site.target in (*MACHINES, "Concurrence")
        for outcome in site.keys("outcomes")
        if (steps := uses_of_outcome(site, outcome))
    ]
    if not found:
        return None
    site, outcome, uses = subject.draw.choice(found)
    site.body["outcomes"] = [name for name in site.body["outcomes"] if name != outcome]
    codes = ("SM103",) if site.target == "Concurrence" else ("SM101",)
    places = [(site.file, steps) for steps in (*uses, (*site.path, "outcomes"))]
    return Mutant(codes=codes, places=tuple(places))


def uses_of_outcome(site: Site, outcome: str) -> list[Steps]:
    """Where a container's own text leads to one of its outcomes."""
    if site.target == "Concurrence":
        found = (
            [(*site.path, "outcome_map", outcome)] if outcome in site.pairs("outcome_map") else []
        )
        if site.body.get("default_outcome") == outcome:
            found.append((*site.path, "default_outcome"))
        return found
    if not isinstance(site.body.get("outcomes"), list):
        return []
    return [
        (*child.path, "transitions", name)
        for child in site.states()
        for name, target in child.pairs("transitions").items()
        if target == outcome
    ]


@mutation
def duplicate_a_state_name(subject: Subject) -> Mutant | None:
    found = [site for site in subject.sites() if len(site.states()) > 1]
    site = subject.pick(found)
    if site is None:
        return None
    first, second = subject.draw.sample(range(len(site.states())), 2)
    states = site.states()
    first, second = sorted((first, second))
    item = site.body["states"][second]
    renamed(item, states[second].name, states[first].name)
    place = (*site.path, "states", second, states[first].name)
    return Mutant(codes=("SM106",), places=((site.file, place),))


@mutation
def call_a_state_like_an_outcome(subject: Subject) -> Mutant | None:
    found = [
        (site, child)
        for site in subject.sites()
        if site.target in MACHINES and site.keys("outcomes")
        for child in site.states()
    ]
    if not found:
        return None
    site, child = subject.draw.choice(found)
    new = subject.draw.choice(site.keys("outcomes"))
    place = rename_state(site, child, new)
    return Mutant(codes=("SM107",), places=((site.file, place),))


@mutation
def call_a_state_like_its_container(subject: Subject) -> Mutant | None:
    found = [
        (site, child)
        for site in subject.sites()
        if site.template in FRAMES and site.name
        for child in site.states()
        if subject.node(site) is not None
    ]
    if not found:
        return None
    site, child = subject.draw.choice(found)
    place = rename_state(site, child, site.name)
    return Mutant(codes=("SM108",), places=((site.file, place),))


def rename_state(site: Site, child: Site, new: str) -> tuple[str | int, ...]:
    """Rename a state together with everything that names it; where it stands then."""
    for other in site.states():
        steps = other.pairs("transitions")
        steps.update({outcome: new for outcome, to in steps.items() if to == child.name})
    for rule in site.pairs("outcome_map").values():
        if isinstance(rule, dict) and child.name in rule:
            renamed(rule, child.name, new)
    if site.body.get("initial") == child.name:
        site.body["initial"] = new
    at = child.path[-2]
    renamed(site.body["states"][at], child.name, new)
    return (*site.path, "states", at, new)


def with_entry(subject: Subject, name: str, *, path: bool = True) -> Site | None:
    """A state whose body has an entry."""
    return subject.pick(
        site for site in subject.sites() if name in site.body and (site.path or not path)
    )


@mutation
def misspell_a_template(subject: Subject) -> Mutant | None:
    site = with_entry(subject, "template")
    if site is None:
        return None
    site.body["template"] = swap_letters(site.template)
    return Mutant(codes=("SM013",), places=((site.file, (*site.path, "template")),))


@mutation
def misspell_a_variable(subject: Subject) -> Mutant | None:
    known = (
        "outcomes",
        "transitions",
        "remapping",
        "input_keys",
        "output_keys",
        "userdata",
        "states",
    )
    found = [(site, name) for site in subject.sites() for name in known if name in site.body]
    if not found:
        return None
    site, name = subject.draw.choice(found)
    new = swap_letters(name)
    renamed(site.body, name, new)
    return Mutant(codes=("SM003",), places=((site.file, (*site.path, new)),))


@mutation
def misspell_a_sub_script(subject: Subject) -> Mutant | None:
    site = with_entry(subject, "script")
    if site is None:
        return None
    site.body["script"] = swap_letters(site.body["script"])
    return Mutant(codes=("SM011",), places=((site.file, (*site.path, "script")),))


@mutation
def include_a_script_in_itself(subject: Subject) -> Mutant | None:
    site = subject.pick(
        site for site in subject.sites() if site.around is not None and site.file != "main.yml"
    )
    if site is None:
        return None
    steps = site.pairs("transitions")
    site.body.clear()
    site.body.update({"script": site.file.removesuffix(".yml"), "transitions": dict(steps)})
    return Mutant(codes=("SM012",), places=((site.file, (*site.path, "script")),))


@mutation
def put_two_states_into_a_sub_script(subject: Subject) -> Mutant | None:
    callers = [site for site in subject.sites() if isinstance(site.body.get("script"), str)]
    site = subject.pick(callers)
    if site is None:
        return None
    file = f"{site.body['script']}.yml"
    if file not in subject.project:
        return None
    subject.project[file].append({"ANOTHER": {"template": "ScriptedState", "outcomes": ["done"]}})
    places: list[Place] = [(file, ()), (file, (1,))]
    places += [
        (caller.file, (*caller.path, "script"))
        for caller in callers
        if caller.body["script"] == site.body["script"]
    ]
    return Mutant(codes=("SM014",), places=tuple(places))


def look_ups(
    data: Data, steps: tuple[str | int, ...] = ()
) -> list[tuple[list[Data], tuple[str | int, ...]]]:
    """The lists that are look-ups, with the place of each: [params, x] and [[x]]."""
    if isinstance(data, dict):
        return [item for key, value in data.items() for item in look_ups(value, (*steps, key))]
    if not isinstance(data, list):
        return []
    if len(data) == 2 and data[0] == "params" and not isinstance(data[0], Quoted):
        return [(data, (*steps, 1))]
    if len(data) == 1 and isinstance(data[0], list) and len(data[0]) == 1:
        return [(data[0], (*steps, 0, 0))] if type(data[0][0]) is str else []
    return [item for at, value in enumerate(data) for item in look_ups(value, (*steps, at))]


@mutation
def misspell_a_look_up(subject: Subject) -> Mutant | None:
    found = [
        (file, *item)
        for file, data in subject.project.items()
        if "/" not in file
        for item in look_ups(data)
    ]
    if not found:
        return None
    file, words, steps = subject.draw.choice(found)
    words[-1] = swap_letters(words[-1])
    return Mutant(codes=("SM015",), places=((file, steps),))


@mutation
def drop_a_template(subject: Subject) -> Mutant | None:
    site = with_entry(subject, "template")
    if site is None:
        return None
    del site.body["template"]
    return Mutant(codes=("SM005",), owners=(site,))


@mutation
def start_at_an_unknown_state(subject: Subject) -> Mutant | None:
    site = subject.pick(site for site in subject.sites() if site.target in MACHINES)
    if site is None or not site.states():
        return None
    site.body["initial"] = swap_letters(site.states()[0].name)
    return Mutant(codes=("SM205",), places=((site.file, (*site.path, "initial")),))


# --- the text


def entries(subject: Subject, *names: str) -> list[tuple[Site, str]]:
    return [(site, name) for site in subject.sites() for name in names if name in site.body]


@mutation
def write_a_key_twice(subject: Subject) -> Mutant | None:
    found = entries(subject, "template", "doc", "outcomes", "transitions")
    if not found:
        return None
    site, name = subject.draw.choice(found)
    value = "[a]" if name == "outcomes" else "{a: b}" if name == "transitions" else "Base"

    def edit(rows: list[str], at: int) -> None:
        margin = rows[at][: len(rows[at]) - len(rows[at].lstrip(" "))]
        below = at + 1
        while below < len(rows) and len(rows[below]) - len(rows[below].lstrip()) > len(margin):
            below += 1
        rows.insert(at, f"{margin}{name}: {value}")

    return Mutant(codes=("SM002",), places=((site.file, (*site.path, name)),), edit=edit)


@mutation
def indent_with_a_tab(subject: Subject) -> Mutant | None:
    found = [entry for entry in entries(subject, "outcomes", "transitions") if entry[0].path]
    if not found:
        return None
    site, name = subject.draw.choice(found)

    def edit(rows: list[str], at: int) -> None:
        rows[at] = "\t" + rows[at].lstrip()

    return Mutant(codes=("SM001",), places=((site.file, (*site.path, name)),), edit=edit)


@mutation
def leave_a_bracket_open(subject: Subject) -> Mutant | None:
    found = entries(subject, "template", "script")
    if not found:
        return None
    site, name = subject.draw.choice(found)

    def edit(rows: list[str], at: int) -> None:
        rows[at] = rows[at].replace(": ", ": [", 1)

    return Mutant(codes=("SM001",), places=((site.file, (*site.path, name)),), edit=edit)


@mutation
def leave_a_block_empty(subject: Subject) -> Mutant | None:
    found = entries(subject, "outcomes", "transitions", "states", "remapping", "input_keys")
    if not found:
        return None
    site, name = subject.draw.choice(found)
    site.body[name] = None
    return Mutant(codes=("SM004",), places=((site.file, (*site.path, name)),))


@mutation
def write_a_list_for_a_mapping(subject: Subject) -> Mutant | None:
    found = entries(subject, "transitions", "remapping", "userdata")
    found = [(site, name) for site, name in found if site.pairs(name)]
    if not found:
        return None
    site, name = subject.draw.choice(found)
    site.body[name] = list(site.pairs(name))
    places = [(site.file, (*site.path, name)), (site.file, (*site.path, name, 0))]
    return Mutant(codes=("SM004",), places=tuple(places))
