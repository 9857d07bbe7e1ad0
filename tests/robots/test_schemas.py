"""The JSON Schemas of robots, scenes and faults: they refuse what their readers refuse."""

from __future__ import annotations

import copy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from smachac.robots import description, scene
from smachac.robots import faults as faults_of
from smachac.robots.fields import DataError
from smachac.robots.files import BUILT_IN, FOLDER, plain, read_file
from tests.robots.test_description import LEFT, ROBOT, SCENE, changed
from tests.support.json_schema import Schema, faults

ROOT = Path(__file__).parents[2]
STATION = "{name: two, parts: {near: {robot: panda}, far: {robot: iiwa, base: [1, 0, 0]}}}"
FAULTS = """
faults:
  - {kind: gripper_slips, state: LIFT, probability: 0.3, each_time: true}
  - {kind: move_body, target: block, value: [0.02, 0.0, 0.0], at: 1.5}
"""

Reader = Callable[[Any], object]
READERS: dict[str, tuple[Reader, Schema]] = {
    ROBOT: (description.read, description.SCHEMA),
    STATION: (description.read, description.SCHEMA),
    SCENE: (scene.read, scene.SCHEMA),
    FAULTS: (faults_of.read_file, faults_of.SCHEMA),
}
GRIPPER = (*LEFT, "gripper")
BODY = ("bodies", "block")
CAP = ("bodies", "cap")
FIRST, SECOND = ("faults", 0), ("faults", 1)

WRONG: list[tuple[str, tuple[str | int, ...], Any]] = [
    (ROBOT, ("name",), None),
    (ROBOT, ("urdf",), ""),
    (ROBOT, ("arms",), {}),
    (ROBOT, ("arms", "left"), []),
    (ROBOT, ("arms", "left", "joint"), []),
    (ROBOT, (*LEFT, "joints"), "a"),
    (ROBOT, (*LEFT, "joints", 1), "a"),
    (ROBOT, (*LEFT, "home", 1), "high"),
    (ROBOT, (*LEFT, "home", 1), True),
    (ROBOT, (*LEFT, "tool"), 1),
    (ROBOT, (*LEFT, "tool", "offset"), [0, 0]),
    (ROBOT, (*LEFT, "tool", "link"), None),
    (ROBOT, (*LEFT, "grasp"), [[0, 0, 0], [0, 0, 1]]),
    (ROBOT, (*LEFT, "tolerance"), 0),
    (ROBOT, (*LEFT, "efforts"), {"a": -1}),
    (ROBOT, (*LEFT, "limits"), [[-1, 0, 1], [0, 1]]),
    (ROBOT, (*LEFT, "speeds"), [1, -1]),
    (ROBOT, (*GRIPPER, "joints"), {}),
    (ROBOT, (*GRIPPER, "joints", "f", "open"), None),
    (ROBOT, (*GRIPPER, "width", "open"), 80),
    (ROBOT, (*GRIPPER, "width", "closed"), -0.1),
    (ROBOT, (*GRIPPER, "anchored"), "yes"),
    (ROBOT, (*GRIPPER, "force"), 0),
    (ROBOT, ("base",), [[0, 0, 400], [0, 0, 0, 1]]),
    (ROBOT, ("base",), [0, 0, 400]),
    (ROBOT, ("base",), [[0, 0], [0, 0, 0, 1]]),
    (ROBOT, ("stand",), {"size": [1]}),
    (ROBOT, ("stand",), {"size": [1, 0]}),
    (ROBOT, ("stand",), {"size": [250, 1]}),
    (ROBOT, ("stand",), {"size": [1, 1], "centre": [0, 40]}),
    (ROBOT, ("frames",), ["a", 1]),
    (ROBOT, ("parts",), {"near": {"robot": "panda"}}),
    (STATION, ("parts",), {}),
    (STATION, ("parts", "base"), {"robot": "panda"}),
    (STATION, ("parts", "near", "robot"), None),
    (STATION, ("arms",), {}),
    (SCENE, ("bodies",), {}),
    (SCENE, ("bodies", "world"), {"model": "block"}),
    (SCENE, (*BODY, "model"), "blok"),
    (SCENE, (*BODY, "path"), "a.urdf"),
    (SCENE, (*BODY, "mass"), 1),
    (SCENE, (*BODY, "spread"), [0.1, -0.1, 1]),
    (SCENE, (*BODY, "spread"), [40, 0, 0]),
    (SCENE, (*BODY, "colour"), [255, 0, 0]),
    (SCENE, (*CAP, "size"), None),
    (SCENE, (*CAP, "size"), [100, 1, 1]),
    (SCENE, (*CAP, "mass"), -1),
    (SCENE, (*CAP, "friction"), 0),
    (SCENE, (*CAP, "apart"), {"table": 0}),
    (FAULTS, (*FIRST, "kind"), "slips"),
    (FAULTS, (*FIRST, "state"), None),
    (FAULTS, (*FIRST, "at"), 1),
    (FAULTS, (*FIRST, "probability"), 2),
    (FAULTS, (*FIRST, "value"), 1),
    (FAULTS, (*SECOND, "each_time"), True),
    (FAULTS, (*SECOND, "target"), None),
    (FAULTS, (*SECOND, "value"), None),
    (FAULTS, (*SECOND, "value"), 1),
    (FAULTS, (*SECOND, "at"), -1),
    (FAULTS, SECOND, {"kind": "crash", "target": "arm", "at": 1}),
]


@pytest.mark.parametrize(("text", "place", "value"), WRONG)
def test_reader_and_schema_refuse_the_same(
    text: str, place: tuple[str | int, ...], value: Any
) -> None:
    read, schema = READERS[text]
    data = changed(text, place, value)
    with pytest.raises(DataError):
        read(copy.deepcopy(data))
    assert faults(data, schema) != []


@pytest.mark.parametrize("text", READERS)
def test_reader_and_schema_accept_the_same(text: str) -> None:
    read, schema = READERS[text]
    read(plain(text))
    assert faults(plain(text), schema) == []


@pytest.mark.parametrize(
    ("text", "place", "value"),
    [
        (ROBOT, ("stand",), {"size": [1, 1], "centre": [0, -1]}),
        (ROBOT, (*LEFT, "tool"), "hand"),
        (ROBOT, ("base",), [0, 0, 0.4]),
        (SCENE, (*CAP, "apart"), {}),
        (SCENE, (*CAP, "friction"), 1),
        (FAULTS, FIRST, {"kind": "crash", "at": 0}),
        (FAULTS, ("faults",), []),
    ],
)
def test_other_forms_are_accepted(text: str, place: tuple[str | int, ...], value: Any) -> None:
    read, schema = READERS[text]
    data = changed(text, place, value)
    read(copy.deepcopy(data))
    assert faults(data, schema) == []


def test_an_empty_optional_key_is_as_absent() -> None:
    robot, bodies = plain(ROBOT), plain(SCENE)
    robot |= {"stand": None, "base": None, "frames": None}
    robot["arms"]["left"] |= {"gripper": None, "grasp": None, "limits": None}
    bodies["bodies"]["block"] |= {"path": None, "size": None, "mass": None, "colour": None}
    description.read(robot)
    scene.read(bodies)
    assert faults(robot, description.SCHEMA) == []
    assert faults(bodies, scene.SCHEMA) == []


@pytest.mark.parametrize("name", BUILT_IN)
def test_the_built_in_robots_fit(name: str) -> None:
    assert faults(read_file(FOLDER / f"{name}.yml"), description.SCHEMA) == []


def test_the_files_of_the_page_fit() -> None:
    """The robots, scenes and faults that docs/robots.md shows."""
    page = (ROOT / "docs/robots.md").read_text("utf-8")
    blocks = [part.partition("\n```")[0] for part in page.split("```yaml\n")[1:]]
    found = []
    for block in blocks:
        data = plain(block)
        schema = {"arms": description.SCHEMA, "parts": description.SCHEMA, "bodies": scene.SCHEMA,
                  "faults": faults_of.SCHEMA}  # fmt: skip
        for key in schema.keys() & data.keys():
            found.append(key)
            assert faults(data, schema[key]) == []
    assert {*found} == {"arms", "parts", "bodies", "faults"}


@pytest.mark.parametrize("schema", [description.SCHEMA, scene.SCHEMA, faults_of.SCHEMA])
def test_every_key_has_a_description(schema: Schema) -> None:
    def missing(part: Any, at: str) -> list[str]:
        below: list[str] = []
        if isinstance(part, dict):
            below = [name for key, each in part.items() for name in missing(each, key)]
            own = part.get("properties", {}) if "additionalProperties" in part else {}
            below += [name for name, each in own.items() if not each.get("description")]
        elif isinstance(part, list):
            below = [name for item in part for name in missing(item, at)]
        return below

    assert missing(schema, "") == []
