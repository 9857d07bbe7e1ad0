"""The robot and the scene of a script: built in, or described in files beside the script."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Collection, Iterator, Mapping
from pathlib import Path
from typing import Any, Literal, TypeAlias, TypeVar

from smachac.diagnostics.diagnostic import Related, Report, did_you_mean, did_you_mean_file
from smachac.diagnostics.source import NOWHERE, Source, Span, Word
from smachac.diagnostics.spelling import guesser
from smachac.frontend.errors.references import bad_robot, package_help
from smachac.frontend.loader import ROBOT_FILES, Library
from smachac.frontend.resolved_script import State
from smachac.frontend.robots.urdf import checked_joint, robot_of_urdf
from smachac.frontend.text.data_files import plain, span_at
from smachac.frontend.text.yaml_tree import Map, Scalar, Tree
from smachac.ir.nodes import StateType
from smachac.ir.robot import Arm, Joint, Robot
from smachac.records import replace
from smachac.robots import description, urdf
from smachac.robots.description import NO_PARTS, Description, Part, Station, limb_names
from smachac.robots.engine_text import engine_text
from smachac.robots.faults import read_file as read_faults
from smachac.robots.fields import DataError, guess
from smachac.robots.files import BUILT_IN, Packages
from smachac.robots.files import SUFFIXES as DESCRIPTIONS
from smachac.robots.scene import Body
from smachac.robots.scene import read as read_scene
from smachac.robots.urdf import Urdf, check_sdf
from smachac.robots.xacro_files import SUFFIX as XACRO_SUFFIX
from smachac.robots.xacro_files import XacroError, located
from smachac.robots.xml_tree import XmlError

T = TypeVar("T")

SUFFIXES = (".urdf", ".xml", ".xacro")
"""The endings of URDF files; a description ends with `.yml`, any other text is a robot's name."""


NO_SCENE = "the bodies are not known: their names are not checked, and no program is generated"


def robot_of(base: State, source: Source, library: Library, report: Report) -> Robot | None:
    """The robot of a script; None if it names none, or one that only its base type defines."""
    reader = _Reader(source, library, report, base.scene)
    scene = reader.scene(base.scene) if base.scene is not None else None
    if base.robot is not None:
        found = reader.named(base.robot, base.type)
    else:
        found = default_robot(base.type, library)
    if found is None:
        return None
    bodies: frozenset[str] = frozenset()
    if base.scene is not None and scene is not None:
        bodies = frozenset(body.name for body in scene[0])
        for name in sorted(bodies & found.scene)[:1]:
            help = f"give the body another name, such as `{name}_body`"
            error = DataError(f"`{name}` is the name of a robot", ("bodies", name), help)
            reader.mistake(base.scene, scene[1], error, "scene")
    span = base.robot.span if base.robot is not None else NOWHERE
    added = frozenset(word.text for word in base.frames)
    places = tuple(_body_names(scene[1])) if scene is not None else ()
    return replace(found, added=added, scene=found.scene | bodies, span=span, bodies=places)


def _body_names(tree: Tree) -> Iterator[Word]:
    """The names of the bodies in the file of a scene."""
    for part in tree.entries if isinstance(tree, Map) else ():
        inner = part.value
        if isinstance(part.key, Scalar) and part.key.value == "bodies" and isinstance(inner, Map):
            for entry in inner.entries:
                if isinstance(entry.key, Scalar) and isinstance(entry.key.value, str):
                    yield Word(entry.key.value, entry.key.span)


def default_robot(base: StateType, library: Library) -> Robot | None:
    """The robot that the interface of a base presets in its variable `robot`."""
    held = base.variables.get("robot")
    name = held.default.data if held is not None and held.default is not None else None
    return built_in_robot(name, library) if isinstance(name, str) else None


def built_in_robot(name: str, library: Library) -> Robot | None:
    """The built-in robot of that name."""
    if name not in BUILT_IN:
        return None
    return _Reader(Source("", ""), library, []).built_in(Word(name, NOWHERE))


DataKind: TypeAlias = Literal["robot", "scene", "faults"]
"""The kinds of files of data."""


def check_data_file(source: Source, kind: DataKind, library: Library, report: Report) -> None:
    """Check a file of data in itself: a mistake is reported at its place in the file."""
    word = Word(source.file_name, Span(source, 0, 0))
    reader = _Reader(source, library, report)
    if kind == "robot":
        reader.described(word, source)
    elif kind == "scene":
        reader.data(word, source, read_scene, "scene")
    else:
        reader.data(word, source, read_faults, "list of faults")


class _Reader:
    """Reads the files that one script names; mistakes are reported."""

    def __init__(
        self, source: Source, library: Library, report: Report, scene: Word | None = None
    ) -> None:
        self.source, self.library, self.report, self.scene_word = source, library, report, scene

    def named(self, word: Word, base: StateType) -> Robot | None:
        """The robot that a script names."""
        if word.text in BUILT_IN:
            return self.built_in(word)
        if word.text.lower().endswith(DESCRIPTIONS):
            source = self.file(word)
            return self.described(word, source) if source is not None else None
        if word.text.lower().endswith(SUFFIXES):
            return self.urdf(word)
        own = "robot" in base.variables and not base.simulation
        if not own and not base.any_variable:
            known = ", ".join(f"`{name}`" for name in BUILT_IN)
            help = did_you_mean(word.text, BUILT_IN)
            help = help or (
                f"use one of {known}, or the name of a description such as `arm.yml` or of a URDF"
                " file such as `arm.urdf`"
            )
            self.wrong(word, f"`{word.text}` is not a known robot", help, ("name", word.text))
        return None

    def wrong(
        self,
        word: Word,
        message: str,
        help: str | None,
        arguments: tuple[str, ...],
        place: Span | None = None,
    ) -> None:
        """Report a mistake: at `place` in the file that a word names, if there is one."""
        effect = NO_SCENE if word is self.scene_word else None
        related: tuple[Related, ...] = ()
        where = word
        if place is not None:
            where = Word(word.text, place)
            if word.span.start < word.span.end:  # else a file is checked in itself
                related = (Related(span=word.span, message="the script names the file here"),)
        self.report.append(
            bad_robot(where, message, help, related, arguments=arguments, effect=effect)
        )

    def file(self, word: Word) -> Source | None:
        """The file that a word names; reported if there is none."""
        before = len(self.report)
        found = self.library.script(word.text, self.source.name)
        if found is None and len(self.report) == before:
            folders = self.library.script_folders(self.source.name)
            searched = ", ".join(f"`{folder}`" for folder in folders)
            help = f"give its path relative to a folder that is searched: {searched}"
            stem, dot, ending = word.text.rpartition(".")
            near = guesser(self.library.script_names(self.source.name))(stem)
            if near is not None and dot + ending in DESCRIPTIONS:
                help = f"did you mean `{near}{dot}{ending}`? (searched in {searched})"
            elif word.text.lower().endswith(ROBOT_FILES):
                robots = self.library.robot_names(self.source.name)
                guess = did_you_mean_file(word.text, robots)
                if guess is None and len(robots) == 1:
                    guess = f"write `{robots[0]}`, the only robot file there is"
                help = f"{guess} (searched in {searched})" if guess else help
            message = f"the file `{word.text}` was not found"
            self.wrong(word, message, help, ("file", word.text))
        return found

    def urdf(self, word: Word) -> Robot | None:
        """The robot of a URDF file without a description: the simulation cannot move it."""
        text = self.file(word)
        if text is None:
            return None
        try:
            return self.simulated(robot_of_urdf(self.read_urdf(text, {}, {}), text))
        except XmlError as error:
            self.bad_urdf(word, word.text, text, error)
            return None

    def read_urdf(self, source: Source, arguments: Mapping[str, str], packages: Packages) -> Urdf:
        """The robot in a URDF or xacro file. Raises XmlError."""
        if not source.name.lower().endswith(XACRO_SUFFIX):
            return urdf.read(source.text)
        text = self.library.expand(source.name, arguments, packages)
        try:
            return urdf.read(text)
        except XmlError as error:
            raise located(error, text, Path(source.name), source.text) from None

    def bad_urdf(self, word: Word, name: str, source: Source, error: XmlError) -> None:
        """Report the mistake in a URDF or xacro file, or in a file that it includes."""
        if isinstance(error, XacroError) and error.file.absolute() != Path(source.name).absolute():
            folder = Path(source.name).parent
            inside = os.path.relpath(error.file.absolute(), folder.absolute())
            source = Source(os.path.normpath(folder / inside), error.text)
        span = Span(source, *error.place)
        message = f"the robot file `{name}` has a mistake: {error.message}"
        self.wrong(word, message, error.help, ("urdf", name, error.message), span)

    def simulated(self, robot: Robot) -> Robot:
        """A robot of a URDF file; one with all joints of a built-in robot is simulated as that."""
        names = {joint.name for joint in robot.joints}
        for name in BUILT_IN:
            known = built_in_robot(name, self.library)
            if known and names.issuperset(joint.name for limb in known.limbs for joint in limb):
                return replace(robot, description=name)
        return robot

    def data(
        self, word: Word, source: Source, read: Callable[[object], T], what: str
    ) -> tuple[T, Tree] | None:
        """What `read` makes of a YAML file, with the tree of the file."""
        before = len(self.report)
        tree = self.library.parse(source, self.report)
        if tree is None:
            if len(self.report) == before:
                message = f"the {what} file `{word.text}` has a mistake: the file is empty"
                help = f"write the {what} in it; `smachac docs robots` shows the keys"
                self.wrong(word, message, help, (what, word.text, ""), Span(source, 0, 0))
            return None
        try:
            return read(plain(tree)), tree
        except DataError as error:
            self.mistake(word, tree, error, what)
            return None

    def mistake(self, word: Word, tree: Tree, error: DataError, what: str) -> None:
        message = f"the {what} file `{word.text}` has a mistake: {error.message}"
        span = span_at(tree, error.place, key=error.key)
        arguments = (what, word.text, ".".join(map(str, error.place)))
        if span.source.name == self.source.name:  # a file checked in itself
            self.wrong(Word(word.text, span), message, error.help, arguments)
            return
        self.wrong(word, message, error.help, arguments, span)

    def scene(self, word: Word) -> tuple[tuple[Body, ...], Tree] | None:
        """The bodies of a scene, with the tree of its file."""
        source = self.file(word)
        found = self.data(word, source, read_scene, "scene") if source is not None else None
        if found is None or source is None:
            return None
        for body in found[0]:
            if body.path:
                self.body_file(body, word, source, found[1])
        return found

    def body_file(self, body: Body, word: Word, scene: Source, tree: Tree) -> None:
        """Check the URDF or SDF file of a body; a mistake is reported."""
        before = len(self.report)
        source = self.library.script(body.path, scene.name)
        if source is None and self.library.robot(body.path) is not None:
            return  # shipped with PyBullet
        if len(self.report) > before:
            return  # it cannot be read
        if source is None:
            place = ("bodies", body.name, "path")
            help = "give its path relative to the folder of the scene or of the script"
            error = DataError(f"the file `{body.path}` was not found", place, help)
            self.mistake(word, tree, error, "scene")
            return
        try:
            if body.path.lower().endswith(".sdf"):
                check_sdf(source.text)
            else:
                self.engine_text(urdf.read(source.text), source, {})
        except XmlError as error:
            self.bad_urdf(word, body.path, source, error)

    # Descriptions

    def built_in(self, word: Word) -> Robot | None:
        source = self.library.robot(f"{word.text}.yml")
        return self.described(word, source) if source is not None else None

    def described(self, word: Word, source: Source, *, part: bool = False) -> Robot | None:
        """The robot of a description, whose joints have the limits of its URDF file. `part`: it is
        one of several robots, and has no parts of its own."""
        found = self.data(word, source, lambda data: self.description(data, source), "robot")
        if found is None:
            return None
        data, tree = found
        if isinstance(data, Station):
            if part:
                error = DataError("a part has no parts of its own", ("parts",), NO_PARTS)
                self.mistake(word, tree, error, "robot")
                return None
            return self.station(word, source, data, tree)
        facts = self.joints(word, source, data, tree)
        if facts is None:
            return None
        joints, frames = facts
        arms = tuple(
            Arm(
                name=limb.name,
                limb=limb,
                joints=tuple(joints[name] for name in limb.joints),
                base=data.base,
            )
            for limb in data.limbs
        )
        own = {name for limb in data.limbs for name in limb.joints}
        return Robot(
            name=data.name,
            joints=tuple(joint for joint in joints.values() if joint.turns or joint.name in own),
            limbs=tuple(arm.joints for arm in arms),
            arms=arms,
            base=data.base,
            description=word.text,
            frames=frames,
        )

    def description(self, data: Any, source: Source) -> Description | Station:
        """A description of its data. Raises DataError."""
        try:
            return description.read(data)
        except DataError as error:
            if error.place[:1] != ("arms",) or error.place[2:] != ("home",):
                raise
            limb = data["arms"][error.place[1]]
            help = self.missing_joint(data, limb, source) or error.help
            raise DataError(error.message, error.place, help, key=error.key) from None

    def missing_joint(self, data: Any, limb: Any, source: Source) -> str | None:
        """The help for an arm that has an angle for the only joint of its tool that it lacks."""
        name, tool = data.get("urdf"), limb.get("tool")
        link = tool.get("link") if isinstance(tool, dict) else tool
        if not isinstance(name, str) or not isinstance(link, str):
            return None
        text = self.library.script(name, source.name) or self.library.robot(name)
        if text is None:
            return None
        try:
            chain = [joint.name for joint in urdf.read(text.text).chain(link) if joint.is_moved]
        except XmlError:  # also a xacro file, which is not expanded for a line of help
            return None
        missing = [name for name in chain if name not in limb["joints"]]
        if len(missing) != 1 or len(chain) != len(limb["home"]):
            return None
        moved = f"`{missing[0]}` also moves the tool link `{link}`"
        return f"{moved}: write `joints: [{', '.join(chain)}]`, or remove its angle"

    def joints(
        self, word: Word, source: Source, data: Description, tree: Tree
    ) -> tuple[dict[str, Joint], frozenset[str]] | None:
        """The joints of a description by name, and its frames.

        Where the description has the limits of all joints, they hold, and the URDF file need not be
        there.
        """
        text, before = None, len(self.report)
        if word.text not in BUILT_IN or not data.has_limits:
            text = self.library.script(data.urdf, source.name) or self.library.robot(data.urdf)
        moved: dict[str, Joint] = {}
        frames = data.frames
        try:
            if len(self.report) > before:
                return None  # it cannot be read
            if text is None and not data.has_limits:
                help = package_help(data.urdf) or "put it beside this file"
                raise DataError(f"the file `{data.urdf}` was not found", ("urdf",), help)
            if text is not None:
                robot = self.loaded(data, text, source)
                rows = [joint for joint in robot.joints.values() if joint.is_moved]
                moved = {joint.name: checked_joint(joint, robot, text) for joint in rows}
                # Files of one robot of the industry define different links: only those of a user
                # count.
                frames = data.frames if word.text in BUILT_IN else robot.links
        except XmlError as error:
            assert text is not None
            self.bad_urdf(word, data.urdf, text, error)
            return None
        except DataError as error:
            self.mistake(word, tree, error, "robot")
            return None
        return moved | _described_joints(data, moved), frozenset(frames)

    def loaded(self, data: Description, text: Source, source: Source) -> Urdf:
        """The URDF file of a description, after all checks that the simulation makes before it
        loads the robot. Raises XmlError and DataError."""
        packages = data.package_folders(Path(source.name).parent)
        robot = self.read_urdf(text, dict(data.arguments), packages)
        description.check(data, robot)
        used = [name for limb in data.limbs for name in limb.links]
        self.engine_text(robot, text, packages, used)
        return robot

    def engine_text(
        self, robot: Urdf, source: Source, packages: Packages, used: Collection[str] = ()
    ) -> None:
        """Print the text for the simulation, as it does before it loads a file. Raises XmlError."""
        try:
            engine_text(robot, lambda name: self.library.mesh(name, source.name, packages), used)
        except XmlError as error:
            if robot.text == source.text:
                raise
            raise located(error, robot.text, Path(source.name), source.text) from None

    def station(self, word: Word, source: Source, data: Station, tree: Tree) -> Robot | None:
        """Several robots as one: the joints and limbs of all."""
        found: list[tuple[Part, Robot]] = []
        for part in data.parts:
            before = len(self.report)
            text = (
                self.library.script(part.robot, source.name)
                if part.robot.lower().endswith(DESCRIPTIONS)
                else self.library.robot(f"{part.robot}.yml")
            )
            span = span_at(tree, part.place)
            if text is None and len(self.report) > before:
                return None  # it cannot be read
            if text is None:
                message = f"there is no robot `{part.robot}`"
                help = guess(part.robot, BUILT_IN)
                self.mistake(word, tree, DataError(message, part.place, help), "robot")
                return None
            robot = self.described(Word(part.robot, span), text, part=True)
            if robot is None:
                return None
            found.append((part, robot))
        arms: dict[str, Arm] = {}
        for part, other in found:
            for arm in _arms(part, other, data):
                if arm.name in arms:
                    help = "give one of the two parts another name"
                    error = DataError(f"there are two arms `{arm.name}`", part.place, help)
                    self.mistake(word, tree, error, "robot")
                    return None
                arms[arm.name] = arm
        joints = {joint.name: joint for _, robot in found for joint in robot.joints}
        return Robot(
            name=data.name,
            joints=tuple(joints.values()),
            limbs=tuple(limb for _, robot in found for limb in robot.limbs),
            arms=tuple(arms.values()),
            base=data.base,
            description=word.text,
            scene=frozenset(part.name for part, _ in found),
        )


def _described_joints(data: Description, known: Mapping[str, Joint]) -> dict[str, Joint]:
    """The joints of arms whose limits are in the description, by name; `known`: those of the URDF
    file."""
    return {
        name: replace(known.get(name, Joint(name=name)), lower=low, upper=high, velocity=speed)
        for limb in data.limbs
        for name, (low, high), speed in zip(
            limb.joints if limb.limits else (),
            limb.limits,
            limb.speeds or (math.inf,) * len(limb.limits),
            strict=True,
        )
    }


def _arms(part: Part, robot: Robot, station: Station) -> Iterator[Arm]:
    """The arms of a part, with their names and their base in the station."""
    from smachac.sim.transforms import compose

    base = robot.base if part.base is None else compose(station.base, part.base)
    names = limb_names(part.name, robot.limb_names)
    for name, arm in zip(names, robot.arms, strict=True):
        yield replace(arm, name=name, base=base)
