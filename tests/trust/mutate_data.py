"""Mutations of userdata, types and code: SM016, SM017, SM3xx and SM5xx."""

from __future__ import annotations

from typing import Any

from smachac.ir.nodes import Leaf
from tests.trust.mutants import Mutant, Subject, mutation
from tests.trust.mutate_names import renamed, swap_letters, transitions
from tests.trust.project_text import Data, Quoted, Site

LOSS = ("SM301", "SM302", "SM303", "SM307")
"""What it is called when a key does not arrive depends on where it was lost."""


def without(site: Site, variable: str, key: str) -> None:
    """Take an entry out of a list of names or a mapping."""
    held = site.body[variable]
    if isinstance(held, dict):
        del held[key]
    else:
        held.remove(key)
    if not held:
        del site.body[variable]


def keys_of(subject: Subject, variable: str, *, containers: bool) -> list[tuple[Site, str]]:
    return [
        (site, key)
        for site in subject.sites()
        if ("states" in site.body) == containers and (site.path or variable == "userdata")
        for key in (site.keys(variable) if isinstance(site.body.get(variable), list | dict) else ())
    ]


def is_read_beside(site: Site, key: str) -> bool:
    """Whether another state of the container reads what a state writes."""
    outer = site.pairs("remapping").get(key, key)
    for other in site.siblings():
        remaps = other.pairs("remapping")
        reads = {remaps.get(item, item) for item in other.keys("input_keys")}
        if other.name != site.name and outer in reads | set(remaps.values()):
            return True
    return False


@mutation
def drop_a_preset(subject: Subject) -> Mutant | None:
    found = keys_of(subject, "userdata", containers=True)
    found += keys_of(subject, "userdata", containers=False)
    if not found:
        return None
    site, key = subject.draw.choice(found)
    without(site, "userdata", key)
    return Mutant(codes=LOSS, loss=True)


@mutation
def drop_an_input_of_a_container(subject: Subject) -> Mutant | None:
    found = keys_of(subject, "input_keys", containers=True)
    if not found:
        return None
    site, key = subject.draw.choice(found)
    without(site, "input_keys", key)
    return Mutant(codes=LOSS, owners=(site,), loss=True)


@mutation
def drop_an_output_of_a_container(subject: Subject) -> Mutant | None:
    found = keys_of(subject, "output_keys", containers=True)
    found = [(site, key) for site, key in found if is_read_beside(site, key)]
    if not found:
        return None
    site, key = subject.draw.choice(found)
    without(site, "output_keys", key)
    return Mutant(codes=LOSS, owners=(site,), loss=True)


@mutation
def drop_the_write_of_a_key(subject: Subject) -> Mutant | None:
    found = keys_of(subject, "output_keys", containers=False)
    found = [(site, key) for site, key in found if is_read_beside(site, key)]
    if not found:
        return None
    site, key = subject.draw.choice(found)
    without(site, "output_keys", key)
    remaps = site.pairs("remapping")
    if key in remaps:
        del remaps[key]
        if not remaps:
            del site.body["remapping"]
    for step in site.body.get("steps") or ():
        step.get("set", {}).pop(key, None)
    site.pairs("callbacks").pop(key, None)
    return Mutant(codes=LOSS, loss=True)


@mutation
def write_a_key_only_sometimes(subject: Subject) -> Mutant | None:
    """An outcome without the key leads to where the one with it leads."""
    found = [
        (site, good, outcome)
        for site, outcome in transitions(subject, "StateMachine")
        if isinstance(subject.node(site), Leaf)
        for good in ("succeeded", "done")
        if good in site.pairs("transitions") and outcome not in (good, "preempted")
        if site.body["transitions"][outcome] != site.body["transitions"][good]
        if writes_something(subject, site)
    ]
    if not found:
        return None
    site, good, outcome = subject.draw.choice(found)
    site.body["transitions"][outcome] = site.body["transitions"][good]
    return Mutant(codes=LOSS, loss=True)


def writes_something(subject: Subject, site: Site) -> bool:
    node = subject.node(site)
    return node is not None and bool(node.outputs)


@mutation
def rename_a_key_in_a_remapping(subject: Subject) -> Mutant | None:
    """Of a state whose keys are known: by its interface, or because the script lists them."""
    found = [
        (site, key)
        for site in subject.sites()
        if not getattr(subject.node(site), "open", subject.node(site) is None)
        for key in site.pairs("remapping")
    ]
    if not found:
        return None
    site, key = subject.draw.choice(found)
    new = swap_letters(key)
    renamed(site.body["remapping"], key, new)
    return Mutant(codes=("SM302",), places=((site.file, (*site.path, "remapping", new)),))


# --- types


FAMILIES = ("str", "bool", "Pose", "float<m>", "list[str]")


def family(type_: str) -> str:
    for name, words in {
        "Pose": ("Pose",),
        "str": ("str", "one_of"),
        "bool": ("bool",),
        "list": ("list", "float<rad>["),
        "float": ("float", "int"),
    }.items():
        if type_.startswith(words):
            return name
    return type_


def other_type(subject: Subject, type_: str) -> Quoted:
    return Quoted(subject.draw.choice([item for item in FAMILIES if family(item) != family(type_)]))


def typed_presets(subject: Subject) -> list[tuple[Site, str, dict[str, Data]]]:
    """Presets in the long form that some state reads."""
    return [
        (site, key, value)
        for site in subject.sites()
        for key, value in site.pairs("userdata").items()
        if isinstance(value, dict) and set(value) >= {"type", "value"}
    ]


@mutation
def swap_the_type_of_a_preset(subject: Subject) -> Mutant | None:
    found = typed_presets(subject)
    if not found:
        return None
    site, key, preset = subject.draw.choice(found)
    preset["type"] = other_type(subject, str(preset["type"]))
    place = (*site.path, "userdata", key)
    places = [(site.file, steps) for steps in (place, (*place, "type"), (*place, "value"))]
    return Mutant(codes=("SM304", "SM501"), places=tuple(places))


@mutation
def give_a_preset_a_wrong_literal(subject: Subject) -> Mutant | None:
    found = typed_presets(subject)
    if not found:
        return None
    site, key, preset = subject.draw.choice(found)
    literals: dict[str, Any] = {"str": Quoted("word"), "bool": True, "float": 12.5, "list": [[1]]}
    own = family(str(preset["type"]))
    wrong = [name for name in literals if name != own and not (own == "Pose" and name == "list")]
    preset["value"] = literals[subject.draw.choice(wrong)]
    place = (*site.path, "userdata", key)
    places = [(site.file, steps) for steps in (place, (*place, "type"), (*place, "value"))]
    return Mutant(codes=("SM304", "SM501"), places=tuple(places))


@mutation
def change_the_length_of_a_literal(subject: Subject) -> Mutant | None:
    found = [item for item in typed_presets(subject) if str(item[2]["type"]).endswith("]")]
    found = [item for item in found if "[3]" in str(item[2]["type"])]
    if not found:
        return None
    site, key, preset = subject.draw.choice(found)
    value = preset["value"]
    preset["value"] = value[:-1] if subject.draw.random() < 0.5 else [*value, 0.5]
    place = (*site.path, "userdata", key)
    places = [(site.file, steps) for steps in (place, (*place, "type"), (*place, "value"))]
    return Mutant(codes=("SM501",), places=tuple(places))


@mutation
def write_another_unit(subject: Subject) -> Mutant | None:
    """The preset says degrees, or another unit of length, where somebody reads a unit."""
    units = {"float<m>": "float<mm>", "float<rad>": "float<deg>"}
    found = [item for item in typed_presets(subject) if str(item[2]["type"]) in units]
    found = [(s, k, p) for s, k, p in found if readers_with_types(subject, s, k)]
    if not found:
        return None
    site, key, preset = subject.draw.choice(found)
    preset["type"] = Quoted(units[str(preset["type"])])
    place = (*site.path, "userdata", key)
    places = [(site.file, steps) for steps in (place, (*place, "type"))]
    owners = tuple(child for child, _ in readers_with_types(subject, site, key))
    return Mutant(codes=("SM504",), places=tuple(places), owners=owners)


def readers_with_types(subject: Subject, site: Site, key: str) -> list[tuple[Site, str]]:
    """The states in a container that read a key of it under a type with a unit."""
    found = []
    for child in site.states():
        node = subject.node(child)
        remaps = child.pairs("remapping")
        for item in node.inputs if node is not None else ():
            if (
                remaps.get(item.name, item.name) == key
                and item.type.args
                and str(item.type) != "any"
            ):
                found.append((child, item.name))
    return found


@mutation
def misspell_a_type(subject: Subject) -> Mutant | None:
    found = typed_presets(subject)
    if not found:
        return None
    site, key, preset = subject.draw.choice(found)
    preset["type"] = Quoted(f"{preset['type']}[")
    place = (*site.path, "userdata", key, "type")
    return Mutant(codes=("SM017",), places=((site.file, place),))


@mutation
def swap_the_type_of_an_input(subject: Subject) -> Mutant | None:
    """Of a leaf that reads a preset whose type is known."""
    found = [
        (child, key, str(site.body["userdata"][to]["type"]))
        for site, to, _ in typed_presets(subject)
        for child in site.states()
        if isinstance(child.body.get("input_keys"), dict)
        for key in child.keys("input_keys")
        if child.pairs("remapping").get(key, key) == to
    ]
    if not found:
        return None
    child, key, type_ = subject.draw.choice(found)
    child.body["input_keys"][key] = other_type(subject, type_)
    place = (*child.path, "input_keys", key)
    places = ((child.file, place),)
    return Mutant(codes=("SM304", "SM501"), places=places, owners=(child,), ends=True)


@mutation
def swap_the_type_of_an_output(subject: Subject) -> Mutant | None:
    """Of a leaf that sets a literal there."""
    found = [
        (site, key)
        for site in subject.sites()
        if site.template == "ScriptedState" and isinstance(site.body.get("output_keys"), dict)
        for key in site.keys("output_keys")
        if any(key in step.get("set", {}) for step in site.body.get("steps") or ())
    ]
    if not found:
        return None
    site, key = subject.draw.choice(found)
    site.body["output_keys"][key] = other_type(subject, str(site.body["output_keys"][key]))
    return Mutant(codes=("SM304", "SM501"), owners=(site,), ends=True)


@mutation
def bend_a_rotation(subject: Subject) -> Mutant | None:
    found = [item for item in typed_presets(subject) if item[2]["type"] == "Pose"]
    if not found:
        return None
    site, key, preset = subject.draw.choice(found)
    preset["value"] = [preset["value"][0], [1.0, 0.0, 0.0, 1.0]]
    place = (*site.path, "userdata", key)
    return Mutant(codes=("SM503",), places=((site.file, place), (site.file, (*place, "value"))))


@mutation
def break_an_expression(subject: Subject) -> Mutant | None:
    found = [
        (site, key)
        for site in subject.sites()
        for key, code in site.pairs("callbacks").items()
        if isinstance(code, str)
    ]
    if not found:
        return None
    site, key = subject.draw.choice(found)
    code = str(site.body["callbacks"][key])
    ends = [] if "#" in code else [f"{code} +", f"{code})"]  # behind a comment nothing breaks
    broken = subject.draw.choice([*ends, code.replace(":", "", 1)])
    site.body["callbacks"][key] = Quoted(broken)
    return Mutant(codes=("SM016",), places=((site.file, (*site.path, "callbacks", key)),))


@mutation
def hold_a_key_that_nobody_reads(subject: Subject) -> Mutant | None:
    found = [site for site in subject.sites() if "states" in site.body and site.path]
    site = subject.pick(site for site in found if subject.node(site) is not None)
    if site is None:
        return None
    site.body.setdefault("userdata", {})["left_over"] = 1
    place = (*site.path, "userdata", "left_over")
    return Mutant(codes=("SM305",), places=((site.file, place),))


@mutation
def give_a_key_two_values(subject: Subject) -> Mutant | None:
    """In a container, and in a leaf of it."""
    found = [
        (site, key, leaf)
        for site in subject.sites()
        for key in site.pairs("userdata")
        for leaf in site.states()
        if isinstance(subject.node(leaf), Leaf) and "userdata" not in leaf.body
    ]
    if not found:
        return None
    site, key, leaf = subject.draw.choice(found)
    leaf.body["userdata"] = {key: "another one"}
    return Mutant(codes=("SM313",), places=((site.file, (*site.path, "userdata", key)),))


@mutation
def take_in_a_key_that_nobody_needs(subject: Subject) -> Mutant | None:
    found = [site for site in subject.sites() if site.target in ("StateMachine", "Sequence")]
    site = subject.pick(site for site in found if site.path and subject.node(site) is not None)
    if site is None:
        return None
    held = site.body.setdefault("input_keys", [])
    if isinstance(held, dict):
        held["unneeded"] = "any"
    else:
        held.append("unneeded")
    last = "unneeded" if isinstance(held, dict) else len(held) - 1
    place = (*site.path, "input_keys", last)
    return Mutant(codes=("SM306",), places=((site.file, place),))


def with_functions(subject: Subject) -> list[tuple[Site, str, str]]:
    """States whose code reads a key: the key of the function, and that key."""
    return [
        (site, name, key)
        for site in subject.sites()
        for name, code in site.pairs("callbacks").items()
        for key in site.keys("input_keys")
        if f"ud.{key}" in str(code)
    ]


@mutation
def read_a_key_that_is_no_input(subject: Subject) -> Mutant | None:
    """The code of a callback misspells it."""
    found = with_functions(subject)
    if not found:
        return None
    site, name, key = subject.draw.choice(found)
    code = str(site.body["callbacks"][name]).replace(f"ud.{key}", f"ud.{swap_letters(key)}")
    site.body["callbacks"][name] = Quoted(code)
    # What an iterator runs sees every key (docs/semantics.md, Iterator): there it is just not set.
    codes = ("SM301",) if in_iterator(site) else ("SM310",)
    return Mutant(codes=codes, owners=(site,))


def in_iterator(site: Site) -> bool:
    """Whether a state is run by an iterator, of the script or made of sugar."""
    made = {"retry", "for_each"} & set(site.body)
    return bool(made) or (site.around is not None and site.around.target == "Iterator")


@mutation
def set_a_key_that_is_no_output(subject: Subject) -> Mutant | None:
    found = [
        (site, key)
        for site in subject.sites()
        if site.template in ("CallbacksState", "ScriptedState") and not in_iterator(site)
        for key in site.keys("output_keys")
        if key in site.pairs("callbacks")
        or any(key in step.get("set", {}) for step in site.body.get("steps") or ())
    ]
    if not found:
        return None
    site, key = subject.draw.choice(found)
    without(site, "output_keys", key)
    return Mutant(codes=("SM308",), owners=(site,))
