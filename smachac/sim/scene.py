"""The scene: a robot in a physics client, bodies by name, frames, simulated time, events."""

from __future__ import annotations

import hashlib
import math
import random
import struct
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from smachac.robots.models import RGB, Model
from smachac.sim import loading, models, transforms
from smachac.sim.clock import TIME_STEP, Clock, Key, Skill
from smachac.sim.inverse_kinematics import Kinematics
from smachac.sim.outcome import Result
from smachac.sim.physics import Engine, UnknownNameError
from smachac.sim.robot_file import EngineFile, LoadError
from smachac.sim.robots import MountedLimb, Robot, mount
from smachac.sim.transforms import IDENTITY, Pose, as_pose

T = TypeVar("T")

_GRAVITY = -9.81
"""m/s^2, along z."""
_SOLVER_ITERATIONS = 50
"""Iterations of the constraint solver in each physics step."""
_REST_SPEED = 0.005
"""Speed (m/s) below which a body is at rest."""
_REST_RATE = 0.05
"""Angular speed (rad/s) below which a body is at rest."""


@dataclass(frozen=True, slots=True)
class Event:
    """An entry of the world's event log: simulated time (s), name, and text."""

    time: float
    name: str
    text: str


class Scene:
    """A robot on the floor of a physics client, and the bodies around it.

    Metres, rad, s, kg; gravity along -z. `files` are those of bodies that will be added: they are
    tried together with those of the robot. Raises SimUnavailable without PyBullet, and LoadError
    for a file of the robot that cannot be loaded.

    Attributes:
        random: the source of random numbers, seeded with `seed`.
        events: the events so far.
        bodies: name -> PyBullet's number, without the robot.
        caption: the text under the film: the paths of the active states.
        steps: the number of physics steps so far.
        noise: the standard deviation (m) of measured positions.
        crashed: whether the world has crashed, by an injected fault.
        limbs: the limbs of all robots with PyBullet's numbers.
        kinematics: PyBullet's number of each robot -> its forward and inverse kinematics.
    """

    def __init__(
        self,
        robot: Robot,
        seed: int,
        *,
        files: Iterable[EngineFile] = (),
        gui: bool = False,
        on_event: Callable[[Event], None] | None = None,
        patience: float = 5.0,
    ) -> None:
        self.robot = robot
        self.seed = seed
        self.gui = gui
        self.random = random.Random(seed)
        self.events: list[Event] = []
        self.bodies: dict[str, int] = {}
        self.caption = ""
        self.steps = 0
        self.noise = 0.0
        self.crashed = False
        self._measured = random.Random(f"{seed}/noise")
        self.clock = Clock(self._step, patience=patience, left_behind=self._left_behind)
        self._on_event = on_event
        self._model_counts: dict[str, int] = {}
        self.limbs: tuple[MountedLimb, ...] = ()
        self.kinematics: dict[int, Kinematics] = {}
        parts = [(part, part.engine_file()) for part in robot.parts]
        try:
            with loading.tried([*(file for _, file in parts), *files]):
                self.engine = Engine(gui=gui)
        except LoadError:
            self.engine.close()
            raise
        try:
            self.engine.setGravity(0.0, 0.0, _GRAVITY)
            self.engine.setPhysicsEngineParameter(
                fixedTimeStep=TIME_STEP,
                numSolverIterations=_SOLVER_ITERATIONS,
                deterministicOverlappingPairs=1,
            )
            models.floor(self.engine)
            for part, file in parts:
                body, limbs = mount(self.engine, part, file)
                self.kinematics[body] = Kinematics(part)
                self.limbs += limbs
        except BaseException:
            Scene.close(self)
            raise

    def close(self) -> None:
        """Free the physics client; a second call has no effect."""
        self.engine.close()

    # Time and events

    @property
    def time(self) -> float:
        """Simulated seconds since the start."""
        return self.steps * TIME_STEP

    def run(self, skill: Skill[T]) -> T:
        """Run a skill, a generator that yields once per physics step; its value."""
        return self.clock.run(skill)

    def note(self, name: str, text: str) -> None:
        """Add an event."""
        event = Event(self.time, name, text)
        self.events.append(event)
        if self._on_event is not None:
            self._on_event(event)

    def _step(self) -> None:
        """Make one physics step."""
        self.engine.stepSimulation()
        self.steps += 1

    def _left_behind(self, key: Key) -> None:
        branch = "/".join(map(str, key))
        self.note("clock", f"branch {branch} does not wait for simulated time; it is left behind")

    # Frames

    def frame(self, name: str | None) -> Pose:
        """The pose of a frame in the world frame. Raises UnknownNameError.

        Frames are "base" or the robot's name (also None and ""), "world", the parts of a robot of
        several, and the bodies by name.
        """
        if name in (None, "", "base", self.robot.name):
            return self.robot.base
        if name == "world":
            return IDENTITY
        for part in self.robot.parts:
            if name == part.name:
                return part.base
        if name not in self.bodies:
            raise UnknownNameError("frame", str(name), ("base", "world", *self.bodies))
        return models.where(self.engine, self.bodies[str(name)])

    def seen_from(self, frame: str, pose: Pose) -> Pose:
        """A pose of the world frame in the frame `frame`. Raises UnknownNameError."""
        return transforms.compose(transforms.inverse(self.frame(frame)), pose)

    # Bodies

    def add(
        self,
        model: str | Model,
        pose: Any,
        name: str,
        path: str | Path | None,
        frame: str,
        colour: RGB | None = None,
    ) -> Result:
        """Put a model at `pose` without an event, between two physics steps; see `World.load`.

        `colour` replaces that of the model.
        """
        if name in self.bodies:
            return Result("aborted", f"a body `{name}` is there already")
        try:
            place = transforms.compose(self.frame(frame), as_pose(pose))
        except UnknownNameError as error:
            return Result("aborted", str(error))
        if path:
            try:
                file = models.file_of(path)
                loading.try_out([file])
                body = models.read(self.engine, file, place)
            except (LoadError, OSError) as error:
                return Result("aborted", str(error))
        elif isinstance(model, Model):
            body = models.build(self.engine, model, place)
        elif model in models.MODELS:
            count = self._model_counts.get(model, 0)
            self._model_counts[model] = count + 1
            body = models.build(self.engine, models.MODELS[model], place, count)
        else:
            return Result("aborted", str(UnknownNameError("model", model, tuple(models.MODELS))))
        if colour is not None:
            models.paint(self.engine, body, colour)
        self.bodies[name] = body
        return Result("succeeded", value=name)

    def remove(self, name: str) -> None:
        """Remove a body. Raises UnknownNameError."""
        self.engine.removeBody(self.body(name))
        del self.bodies[name]

    def body(self, name: str) -> int:
        """PyBullet's number of a body. Raises UnknownNameError."""
        if name not in self.bodies:
            raise UnknownNameError("body", name, tuple(self.bodies))
        return self.bodies[name]

    def pose(self, name: str, frame: str = "base") -> list[list[float]]:
        """The pose of a body in `frame`. Raises UnknownNameError."""
        place = models.where(self.engine, self.body(name))
        return transforms.as_lists(self.seen_from(frame, place))

    def measured_pose(self, name: str, frame: str = "base") -> list[list[float]]:
        """The pose of a body as a camera measures it: with `noise`. Raises UnknownNameError."""
        position, rotation = self.pose(name, frame)
        if self.noise > 0.0:
            position = [number + self._measured.gauss(0.0, self.noise) for number in position]
        return [position, rotation]

    def error(self, name: str, pose: Any, frame: str = "base") -> float:
        """The distance (m) of a body from the position of `pose`. Raises UnknownNameError."""
        return math.dist(self.pose(name, frame)[0], as_pose(pose)[0])

    def at_rest(self, name: str) -> bool:
        """Whether a body moves slower than 5 mm/s and turns slower than 0.05 rad/s."""
        linear, angular = self.engine.getBaseVelocity(self.body(name))
        return math.hypot(*linear) < _REST_SPEED and math.hypot(*angular) < _REST_RATE

    def hash(self) -> str:
        """A digest of all poses, joint positions and velocities, exact to the last bit."""
        numbers: list[float] = []
        for name in sorted(self.bodies):
            body = self.bodies[name]
            for part in self.engine.getBasePositionAndOrientation(body):
                numbers += part
            for part in self.engine.getBaseVelocity(body):
                numbers += part
        for body in self.kinematics:
            count = self.engine.getNumJoints(body)
            for state in self.engine.getJointStates(body, range(count)):
                numbers += state[:2]
        return hashlib.blake2b(struct.pack(f"{len(numbers)}d", *numbers), digest_size=8).hexdigest()
