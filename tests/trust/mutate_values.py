"""Mutations of values and of the interfaces that describe them: SM003, SM004, SM304, SM5xx."""

from __future__ import annotations

from typing import Any

from tests.trust.mutants import Mutant, Subject, mutation
from tests.trust.mutate_classes import interfaces
from tests.trust.mutate_data import typed_presets
from tests.trust.mutate_names import renamed, swap_letters
from tests.trust.project_text import Data, Quoted, Site

MODELS = ("LoadModelState", "model_name")
BODIES = ("CheckGraspState", "CheckPlacedState")
SIMULATED = ("LoadModelState", "MoveAlongState", "PoseToJointPositionsState", "CheckPlacedState")


def set_variables(subject: Subject, name: str) -> list[Site]:
    """The states that set a variable of the interfaces of random projects."""
    types = {data["name"] for data in interfaces(subject.project).values()}
    return [site for site in subject.sites() if name in site.body and site.template in types]


def changed(site: Site, name: str, value: Data, *codes: str) -> Mutant:
    """A state with another value of a variable."""
    site.body[name] = value
    return Mutant(codes=codes, places=((site.file, (*site.path, name)),))


@mutation
def set_a_speed_outside_its_limits(subject: Subject) -> Mutant | None:
    site = subject.pick(set_variables(subject, "speed"))
    value = subject.draw.choice([0, -0.5, 0.0])
    return None if site is None else changed(site, "speed", value, "SM520")


@mutation
def write_a_number_as_text(subject: Subject) -> Mutant | None:
    site = subject.pick(set_variables(subject, "speed"))
    value = subject.draw.choice(["0.5m/s", "0,5", "fast"])
    return None if site is None else changed(site, "speed", Quoted(value), "SM304")


@mutation
def write_a_wrong_waiting_time(subject: Subject) -> Mutant | None:
    site = subject.pick(site for site in subject.sites() if site.template == "SleepState")
    value = subject.draw.choice([Quoted("5s"), Quoted("1:30"), -5, Quoted("0,5"), True])
    return None if site is None else changed(site, "time", value, "SM304", "SM520")


@mutation
def misspell_a_model(subject: Subject) -> Mutant | None:
    found = [site for site in subject.sites() if site.template == "LoadModelState"]
    site = subject.pick(site for site in found if "model_path" not in site.body)
    if site is None or not isinstance(site.body["model_name"], str):
        return None
    site.body.setdefault("body", site.body["model_name"])
    return changed(site, "model_name", swap_letters(site.body["model_name"]), "SM521")


@mutation
def misspell_a_body(subject: Subject) -> Mutant | None:
    found = [site for site in subject.sites() if site.template in BODIES]
    site = subject.pick(site for site in found if isinstance(site.body.get("body"), str))
    return None if site is None else changed(site, "body", swap_letters(site.body["body"]), "SM521")


@mutation
def name_an_arm_that_the_robot_lacks(subject: Subject) -> Mutant | None:
    moves = ("MoveToJointPositionsState", "MoveAlongState", "GripperState")
    found = [site for site in subject.sites() if site.template in moves]
    site = subject.pick(site for site in found if subject.machine.base == "PyBulletBase")
    return None if site is None else changed(site, "limb", "middle", "SM521")


@mutation
def write_degrees(subject: Subject) -> Mutant | None:
    found = [preset for preset in typed_presets(subject) if preset[2]["type"] == "float<rad>[3]"]
    return of_preset(subject, found, [0, -45, 90], "SM522")


@mutation
def write_decimal_commas(subject: Subject) -> Mutant | None:
    """YAML reads two numbers in place of each."""
    sizes = ("float<rad>[3]", "Pose")
    found = [preset for preset in typed_presets(subject) if preset[2]["type"] in sizes]
    return of_preset(subject, found, [0, 5, 0, 0, 0, 1], "SM501", "SM304")


def of_preset(
    subject: Subject, found: list[tuple[Site, str, dict[str, Data]]], value: Any, *codes: str
) -> Mutant | None:
    if not found:
        return None
    site, key, preset = subject.draw.choice(found)
    preset["value"] = value
    place = (*site.path, "userdata", key)
    places = [(site.file, steps) for steps in (place, (*place, "type"), (*place, "value"))]
    return Mutant(codes=codes, places=tuple(places))


@mutation
def write_millimetres(subject: Subject) -> Mutant | None:
    """A position in the userdata of a state of the simulation that reads it."""
    found = [
        (site, key)
        for site in subject.sites()
        if site.template in SIMULATED
        for key in [site.pairs("remapping").get("pose", "pose")]
        if isinstance(site.pairs("userdata").get(key), list)
    ]
    if not found:
        return None
    site, key = subject.draw.choice(found)
    site.body["userdata"][key] = [500, 0, 20]
    return Mutant(codes=("SM522",), places=((site.file, (*site.path, "userdata", key)),))


@mutation
def misspell_a_field_of_a_preset(subject: Subject) -> Mutant | None:
    found = typed_presets(subject)
    if not found:
        return None
    site, key, preset = subject.draw.choice(found)
    old = subject.draw.choice(["type", "value"])
    new = swap_letters(old)
    renamed(preset, old, new)
    return Mutant(codes=("SM003",), places=((site.file, (*site.path, "userdata", key, new)),))


@mutation
def leave_out_a_field_of_a_record(subject: Subject) -> Mutant | None:
    site = subject.pick(site for site in subject.sites() if "states" in site.body)
    if site is None or not site.path:
        return None
    value = subject.draw.choice([{"name": "bolt"}, {"name": "bolt", "shefl": "left"}, "bolt"])
    type_ = {"name": "str", "shelf": "str"}
    site.body.setdefault("userdata", {})["part"] = {"type": type_, "value": value}
    place = (*site.path, "userdata", "part")
    places = [(site.file, (*place, *more)) for more in ((), ("value",), ("value", "name"))]
    return Mutant(codes=("SM304",), places=tuple(places))


# --- interfaces


def of_interface(subject: Subject) -> tuple[str, dict[str, Data]] | None:
    found = interfaces(subject.project)
    return subject.draw.choice(sorted(found.items())) if found else None


@mutation
def misspell_the_name_of_an_interface(subject: Subject) -> Mutant | None:
    found = of_interface(subject)
    if found is None:
        return None
    file, data = found
    data["name"] = swap_letters(data["name"])
    return Mutant(codes=("SM004",), places=((file, ("name",)),))


@mutation
def misspell_a_language(subject: Subject) -> Mutant | None:
    found = of_interface(subject)
    if found is None:
        return None
    file, data = found
    new = subject.draw.choice(["pyhton", "Python", "py", "java"])
    renamed(data["code"], "python", new)
    return Mutant(codes=("SM003",), places=((file, ("code", new)),))


@mutation
def misspell_a_field_of_a_variable(subject: Subject) -> Mutant | None:
    found = of_interface(subject)
    if found is None:
        return None
    file, data = found
    speed = data["variables"]["speed"]
    old = subject.draw.choice(["type", "default", "unit", "exclusive"])
    new = swap_letters(old)
    renamed(speed, old, new)
    return Mutant(codes=("SM003",), places=((file, ("variables", "speed", new)),))


@mutation
def give_a_default_that_does_not_fit(subject: Subject) -> Mutant | None:
    found = of_interface(subject)
    if found is None:
        return None
    file, data = found
    data["variables"]["speed"]["default"] = subject.draw.choice([-1, 0, Quoted("fast"), [1]])
    place = ("variables", "speed", "default")
    return Mutant(codes=("SM304", "SM520"), places=((file, place),))


@mutation
def look_for_a_body_too_early(subject: Subject) -> Mutant | None:
    """The first state of the machine needs a body that is loaded after it."""
    main = subject.project["main.yml"]
    found = [
        site
        for site in subject.sites()
        if site.template == "LoadModelState" and isinstance(site.body.get("model_name"), str)
    ]
    failures = [name for name in ("aborted", "failed") if name in main.get("outcomes", ())]
    if not found or not failures or "initial" in main or "states" not in main:
        return None
    body = subject.draw.choice(found).body
    name = body.get("body", body["model_name"])
    first = next(iter(main["states"][0]))
    early = {
        "template": "ReadBodyPoseState",
        "body": name,
        "transitions": {"succeeded": first, "aborted": failures[0]},
    }
    main["states"].insert(0, {"EARLY": early})
    return Mutant(codes=("SM521",), places=(("main.yml", ("states", 0, "EARLY", "body")),))
