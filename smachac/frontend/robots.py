"""The robot that a script names: a built-in one, or one in a URDF file beside the script."""

from __future__ import annotations

from dataclasses import replace

from smachac.diagnostics.diagnostic import Related, Report, did_you_mean
from smachac.diagnostics.source import NOWHERE, Source, Word
from smachac.frontend.errors.references import bad_robot
from smachac.frontend.loader import Library
from smachac.frontend.script import State
from smachac.frontend.urdf import XACRO, UrdfError, read_urdf
from smachac.ir.nodes import StateType
from smachac.ir.robot import BUILT_IN, Robot

SUFFIXES = (".urdf", ".xml", ".xacro")
"""The endings of files; any other text is the name of a robot."""


def robot_of(base: State, source: Source, library: Library, report: Report) -> Robot | None:
    """The robot of a script; None if it names none, or one that only its base type defines."""
    found = default_robot(base.type)
    if base.robot is not None:
        found = _named(base.robot, base.type, source, library, report)
    if found is None:
        return None
    span = base.robot.span if base.robot is not None else NOWHERE
    return replace(found, added=frozenset(word.text for word in base.frames), span=span)


def default_robot(base: StateType) -> Robot | None:
    """The robot that the interface of a base presets in its variable `robot`."""
    held = base.variables.get("robot")
    name = held.default.data if held is not None and held.default is not None else None
    return BUILT_IN.get(name) if isinstance(name, str) else None


def _named(
    word: Word, base: StateType, source: Source, library: Library, report: Report
) -> Robot | None:
    if word.text in BUILT_IN:
        return BUILT_IN[word.text]
    if word.text.lower().endswith(SUFFIXES):
        return _described(word, source, library, report)
    if "robot" not in base.variables and not base.open and "variables" not in base.given:
        known = ", ".join(f"`{name}`" for name in BUILT_IN)
        help = did_you_mean(word.text, BUILT_IN)
        help = help or f"use one of {known}, or the name of a URDF file such as `arm.urdf`"
        message = f"`{word.text}` is not a known robot"
        report.append(bad_robot(word, message, help, arguments=("name", word.text)))
    return None


def _described(word: Word, source: Source, library: Library, report: Report) -> Robot | None:
    if word.text.lower().endswith(".xacro"):
        message = f"`{word.text}` is a xacro file, not a URDF file"
        report.append(bad_robot(word, message, XACRO, arguments=("xacro", word.text)))
        return None
    before = len(report)
    text = library.script(word.text, source.name)
    if text is None:
        if len(report) == before:
            folders = ", ".join(f"`{folder}`" for folder in library.script_folders(source.name))
            help = f"give its path relative to a folder that is searched: {folders}"
            message = f"the file `{word.text}` was not found"
            report.append(bad_robot(word, message, help, arguments=("file", word.text)))
        return None
    try:
        return read_urdf(text)
    except UrdfError as error:
        message = f"`{word.text}` does not describe a robot: {error.message}"
        related = (Related(span=error.span, message="found here"),)
        arguments = ("urdf", word.text, error.span.text)
        report.append(bad_robot(word, message, error.help, related, arguments=arguments))
        return None
