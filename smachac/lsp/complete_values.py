"""Completion of params and of the values of variables."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Mapping

from smachac.frontend import schema
from smachac.ir.robot import MODELS, Robot
from smachac.ir.types import Type
from smachac.lsp.complete_flow import success_first, transitions
from smachac.lsp.complete_keys import callbacks, item_keys, key_word
from smachac.lsp.place import KEY, VALUE
from smachac.lsp.word import Completion, Request
from smachac.robots.files import BUILT_IN


def params(here: Request) -> Iterable[Completion]:
    """The params that the sub-script of a call looks up."""
    if here.place.role != KEY or not here.body.text("script"):
        return []
    return [Completion(word=param, kind="param") for param in params_of_call(here)
            if param not in here.place.siblings]  # fmt: skip


def params_of_call(here: Request) -> list[str]:
    """The params that the called sub-script looks up."""
    found = here.facts.sub_script(here.body.text("script"), here.facts.caller)
    text = found[0].text if found is not None else ""
    words = re.findall(r"\[params, *(\w+)\]|\[\[(\w+)\]\]", text)
    return list(dict.fromkeys(one or other for one, other in words))


def choices(here: Request) -> Iterable[Completion]:
    words = schema.FIELD_CHOICES.get(here.place.field, ())
    return [Completion(word=word, kind="value") for word in words]


def autonomy(here: Request) -> Iterable[Completion]:
    """The outcomes of a state, and the levels of autonomy."""
    is_level = here.place.role == VALUE and bool(here.place.inner)
    return choices(here) if is_level else transitions(here)


def robots(here: Request) -> Iterable[Completion]:
    """The built-in robots."""
    return [Completion(word=text, kind="value") for text in BUILT_IN]


def _choices_of(type_: Type) -> list[str]:
    """The words of a type that has few values; empty for other types."""
    if type_.name == "optional" and isinstance(type_.args[0], Type):
        return _choices_of(type_.args[0])
    return (
        [argument for argument in type_.args if isinstance(argument, str)]
        if type_.name == "one_of"
        else []
    )


def _robot(here: Request) -> Robot | None:
    machine = here.view.machine
    return machine.robot if machine is not None else None


def limbs(here: Request) -> Iterable[str]:
    """The limbs of the robot; `left` and `right` if it is not known."""
    robot = _robot(here)
    return robot.limb_names if robot is not None else ("left", "right")


def joints(here: Request) -> Iterable[str]:
    """The joints of the robot, those first that the list does not have."""
    robot = _robot(here)
    names = [joint.name for joint in robot.joints] if robot is not None else []
    return sorted(names, key=lambda name: name in here.place.siblings)


def frames(here: Request) -> Iterable[str]:
    """The frames that the script adds, then those of the robot."""
    robot = _robot(here)
    return [*sorted(robot.added), *sorted(robot.frames)] if robot is not None else []


def models(here: Request) -> Iterable[str]:
    """The models of the simulation, those first that no state has loaded."""
    return sorted(MODELS, key=lambda name: name in {*_loaded(here)})


def bodies(here: Request) -> Iterable[str]:
    """The bodies that states load, then those of the scene."""
    robot = _robot(here)
    return [*_loaded(here), *(sorted(robot.scene) if robot is not None else ())]


def _loaded(here: Request) -> Iterable[str]:
    """The bodies of the states that load a model, by name; without one, that of the model."""
    for body in here.place.bodies[0].states:
        type_ = here.facts.type_named(body.template)
        named = {variable.role: name for name, variable in type_.variables.items()} if type_ else {}
        if "model" in named and body.start != here.body.start:
            yield body.text("body") or body.text(named["model"])


NAMES: Mapping[str, Callable[[Request], Iterable[str]]] = {
    "limb": limbs,
    "joint": joints,
    "frame": frames,
    "model": models,
    "body": bodies,
}
"""The names that a variable of a role may have."""


def variable(here: Request) -> Iterable[Completion]:
    """The values of a variable that has few: booleans, names of outcomes and keys, models."""
    type_ = here.facts.type_named(here.facts.called(here.body).template)
    variable = type_.variables.get(here.place.field) if type_ is not None else None
    if here.place.role == KEY and variable is not None and variable.role == "callbacks":
        return callbacks(here)
    if here.place.role == KEY and variable is not None and variable.role == "steps":
        left = [name for name in ("outcome", "set") if name not in here.place.siblings]
        if not here.place.inner:
            return [Completion(word=text, kind="field", text=f"{text}: ") for text in left]
        return [key_word(here, output) for output in here.facts.outputs(here.body)]
    if variable is not None and here.place.inner[-1:] == ("outcome",):
        words = success_first(here.facts.outcomes(here.body))
        return [Completion(word=word, kind="outcome") for word in words]
    if variable is not None and str(variable.type) in ("bool", "bool?"):
        return [Completion(word=name, kind="value") for name in ("true", "false")]
    if variable is not None and (words := _choices_of(variable.type)):
        return [Completion(word=word, kind="value") for word in words]
    if variable is not None and variable.role in NAMES:
        return [Completion(word=text, kind="value") for text in NAMES[variable.role](here)]
    if variable is not None and variable.keys:
        return item_keys(here)
    used = Counter(
        state.text(here.place.field)
        for body in here.place.bodies
        for state in body.states
        if state.template == here.body.template
    )
    return [Completion(word=text, kind="value") for text, _ in used.most_common() if text]
