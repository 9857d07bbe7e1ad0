"""The inputs of a sweep: what its runs depend on, as digests by which a database is recognised."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path

from smachac.interpreter.interpreter import MAX_STEPS
from smachac.ir.nodes import Machine
from smachac.robots.files import SUFFIXES, find_file, read_file
from smachac.robots.scene import read as read_scene
from smachac.sweep.task import Task
from smachac.version import __version__


def scene_file(machine: Machine) -> str:
    """The file of the scene that the base of a machine has; empty if there is none."""
    for variable in machine.variables:
        if variable.name == "scene" and isinstance(variable.value.data, str):
            return variable.value.data
    return ""


def scene_bodies(machine: Machine, folders: Sequence[Path]) -> list[str]:
    """The names of the bodies of a scene, in its order."""
    name = scene_file(machine)
    return [body.name for body in read_scene(read_file(find_file(name, folders)))] if name else []


def input_digests(
    task: Task, machine: Machine, files: Mapping[str, str], folders: Sequence[Path]
) -> dict[str, str]:
    """The digest of each input by name: the script with its sub-scripts, the generated program,
    the files of scene and robot, faults, scenario, varied values, and the version of smachac.

    Modules of the user and URDF files are not among them.
    """
    inputs = {
        "script": machine.digest,
        "program": _digest(repr(sorted(files.items()))),
        "scenario": _digest(repr(task.scenario)),
        "faults": _digest(repr(task.faults)),
        "vary": _digest(repr(sorted(task.variations, key=lambda variation: variation.name))),
        "smachac": __version__,
    }
    if task.max_steps != MAX_STEPS:
        inputs["max-steps"] = _digest(repr(task.max_steps))
    described = machine.robot.description if machine.robot is not None else ""
    for name, file in (("scene", scene_file(machine)), ("robot", described)):
        if file.endswith(SUFFIXES):
            inputs[name] = _digest(repr(read_file(find_file(file, folders))))
    return inputs


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()
