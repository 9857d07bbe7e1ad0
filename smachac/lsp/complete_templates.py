"""Completion of state types and sub-scripts, by how well they fit the other fields of a state."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from smachac.frontend import schema
from smachac.frontend.schema import CONTAINER_DOCS, CONTAINERS
from smachac.frontend.types.state_types import find_state_type
from smachac.ir.nodes import StateType
from smachac.ir.outcome_names import PREEMPTED
from smachac.lsp.word import Completion, Request


def templates(here: Request) -> Iterable[Completion]:
    """The state types, those first that fit the other fields of the state."""
    wanted = ("base",) if here.body.name is None else ("state", "container")
    names = [*here.facts.library.template_names(), *(CONTAINERS if len(wanted) > 1 else ())]
    used = Counter(used_templates(here))
    ranked: list[tuple[tuple[float, int, int], Completion]] = []
    for number, name in enumerate(dict.fromkeys(names)):
        if name in CONTAINERS:
            word = Completion(word=name, kind="template", doc=CONTAINER_DOCS[CONTAINERS[name]])
            type_ = None
        else:
            type_ = find_state_type(name, here.facts.library, [])
            if type_ is None or type_.kind not in wanted:
                continue
            own = any(here.facts.library.own_template(f"{name}{end}")
                      for end in (".yml", ".tpl.py", ".tpl"))  # fmt: skip
            if type_.open and not own:
                continue
            word = Completion(word=name, kind="template", doc=type_.doc)
        score = fitness(here, name, type_)
        ranked.append(((-score, -used[name], number), word))
    return [word for _, word in sorted(ranked, key=lambda pair: pair[0])]


def used_templates(here: Request) -> Iterable[str]:
    todo = list(here.place.bodies[:1])
    while todo:
        body = todo.pop()
        yield body.template
        todo += body.states


def fitness(here: Request, name: str, type_: StateType | None) -> float:
    """How well a type fits the fields that the state has."""
    fields = {*here.body.fields} - {"template"}
    if name in CONTAINERS:
        own = {*schema.names_for(CONTAINERS[name])} - {*schema.names_for("state")}
        score = 2.0 * len(fields & own) - 2.0 * len(fields - {*schema.names_for(name)})
        needed = {*schema.REQUIRED[CONTAINERS[name]]}
        return score - len(needed - fields) - (0.5 if not fields & own else 0)
    if type_ is None:
        return -9.0
    if here.body.name is None:
        score = 1.0 * (type_.simulation == is_simulated(here)) + 0.5 * (name == "Base")
        return score + 0.2 * is_robot_of(here, type_)
    common = {*schema.names_for("state")}
    own = {*type_.variables}
    extra = fields - common - own
    missing = [variable for variable in type_.variables.values() if variable.required]
    score = 2.0 * len(fields & own) - 3.0 * len(extra)
    score -= 2.0 * len([type_ for type_ in missing if type_.name not in fields])
    outcomes = {outcome.name for outcome in type_.outcomes} | {*here.body.names("outcomes")}
    outcomes |= {here.body.text("default_outcome")}
    led = {*here.body.pairs("transitions")} - {"timeout", "exhausted"}
    free = "outcomes" in type_.given
    score -= 2.0 * len(led - outcomes) if not (free and not type_.open) else 0.0
    score += 0.5 * len(led & {outcome.name for outcome in type_.outcomes})
    must = {outcome.name for outcome in type_.outcomes} - type_.optional
    score -= 0.5 * len(must - led - {PREEMPTED}) if led else 0.0
    keys = {key.name for key in (*type_.input_keys, *type_.output_keys)}
    score += 1.5 * len(keys & {*here.body.pairs("remapping")})
    free_keys = {"input_keys", "output_keys"} & type_.given
    score -= 1.5 * len({*here.body.pairs("remapping")} - keys) if not free_keys else 0.0
    for part in ("outcomes", "input_keys", "output_keys"):
        has, allowed = part in fields, part in type_.given
        score += 0.7 if has and allowed else -2.0 if has else -0.6 if allowed else 0.0
    return score


def is_simulated(here: Request) -> bool:
    """Whether a state of the script has a type that uses the simulated world."""
    types = map(here.facts.type_named, used_templates(here))
    return any(type_.simulation for type_ in types if type_ is not None and type_.kind == "state")


def is_robot_of(here: Request, type_: StateType) -> bool:
    """Whether the robot of a base is that of the script, which names it only if it is another."""
    robot = type_.variables.get("robot")
    usual = robot.default.data if robot is not None and robot.default is not None else None
    if "robot" in here.body.fields:
        return usual != here.body.text("robot")
    several = any("limb" in body.fields for body in here.body.states)
    return several == (usual == "baxter")


def scripts(here: Request) -> Iterable[Completion]:
    """The sub-scripts, one named like the state first."""
    name = str(here.body.name.value).lower() if here.body.name is not None else ""
    known = here.facts.library.script_names(here.facts.caller)
    given = {*here.body.pairs("remapping")} | {*here.body.names("params")}
    ranked = []
    for number, text in enumerate(known):
        found = here.facts.sub_script(text, here.facts.caller)
        if found is None or found[1].name is None:
            continue  # a script of its own
        inner = found[1]
        score = 3 * (text == name) + 2 * (str(inner.name.value).lower() == name)  # type: ignore[union-attr]
        score += len(given & {*inner.names("input_keys"), *inner.names("output_keys")})
        led = {*here.body.pairs("transitions")}
        score += len(led & {*inner.names("outcomes")}) - len(led - {*inner.names("outcomes")})
        ranked.append((-score, number, Completion(word=text, kind="script",
                                                  doc=inner.text("doc"))))  # fmt: skip
    return [word for _, _, word in sorted(ranked, key=lambda row: row[:2])]
