"""The simulated world: physics, clock, the robot, bodies by name."""

from __future__ import annotations

import atexit
import hashlib
import math
import random
import struct
import threading
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, TypeVar

from smachac.sim import models, robots, skills, smach_bridge, transforms
from smachac.sim.arm import Arm
from smachac.sim.clock import Clock, Key, Skill
from smachac.sim.faults import Fault, Misfortune
from smachac.sim.inverse_kinematics import Shadow
from smachac.sim.physics import Engine, UnknownNameError
from smachac.sim.robots import Robot, mount
from smachac.sim.skills import TIME_STEP, Result
from smachac.sim.transforms import IDENTITY, Pose, as_pose
from smachac.sim.video import Film

if TYPE_CHECKING:
    from smachac.sim.faults import Fault


T = TypeVar("T")

_SOLVER_ITERATIONS = 50


@dataclass(frozen=True, slots=True)
class Event:
    """Something worth a line in the trace: when (s, simulated), what, and in words."""

    time: float
    name: str
    text: str


class World:
    """A robot on a floor, and what is loaded around it. Metres, rad, s, kg; gravity along -z.

    Poses are given in the frame "base" (the robot's base) unless a frame is named: "world", or the
    name of a body. Arguments left None take what `configure` set. `record` names a film (.gif or
    .mp4); `on_event` is told each Event as it happens. Raises SimUnavailable where PyBullet or
    what a film needs is missing. A context manager; close it, or the physics stays in memory.
    """

    def __init__(
        self,
        *,
        robot: Robot | None = None,
        seed: int | None = None,
        gui: bool | None = None,
        record: str | Path | None = None,
        faults: Iterable[Fault | Mapping[str, Any]] = (),
        on_event: Callable[[Event], None] | None = None,
        patience: float = 5.0,
    ) -> None:
        chosen = current()
        self.seed = chosen.seed if seed is None else seed
        self.random = random.Random(self.seed)
        self.gui = chosen.gui if gui is None else gui
        self.events: list[Event] = []
        self.bodies: dict[str, int] = {}
        self.caption = ""
        self.steps = 0
        self.clock = Clock(self._step, patience=patience, left_behind=self._left_behind)
        self._on_event = on_event
        self._faults = Misfortune((*chosen.faults, *faults), self.seed)
        self._attached: list[Any] = []
        self._painted: dict[str, int] = {}
        self._closing = threading.Lock()
        self._film: Film | None = None
        self.robot = robot or robots.panda()
        self.engine = Engine(gui=self.gui)
        try:
            self._build()
            self.shadow = Shadow(self.robot)
            film = record or chosen.record
            self._film = Film(self, film) if film else None
        except BaseException:
            self.close()
            raise
        opened(self)
        self._began = time.monotonic()

    def __enter__(self) -> World:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Write the film and free the physics; a second time does nothing."""
        with self._closing:
            closed(self)
            film, self._film = self._film, None
            try:
                if film is not None:
                    film.close()
            finally:
                if "shadow" in vars(self):
                    self.shadow.close()
                self.engine.close()

    def _build(self) -> None:
        engine = self.engine
        engine.setGravity(0.0, 0.0, -9.81)
        engine.setPhysicsEngineParameter(
            fixedTimeStep=TIME_STEP,
            numSolverIterations=_SOLVER_ITERATIONS,
            deterministicOverlappingPairs=1,
        )
        models.floor(engine)
        self.robot_body, parts = mount(engine, self.robot)
        self.arms = tuple(Arm(self, each) for each in parts)
        for arm in self.arms:
            arm.reset(arm.limb.home)

    # Time

    @property
    def time(self) -> float:
        """Simulated seconds since the world was opened."""
        return self.steps * TIME_STEP

    def run(self, skill: Skill[T]) -> T:
        """Run a skill of one's own: a generator that yields once per physics step."""
        return self.clock.run(skill)

    def sleep(self, seconds: float, preempted: skills.Preempted = None) -> Result:
        """Let `seconds` of simulated time pass."""
        return self.run(skills.sleep(seconds, preempted))

    def attach(self, root: Any, name: str = "sm") -> None:
        """Put a finished SMACH machine on this world's clock; once, before it is executed.

        Its Concurrences then run in lockstep, captions and faults follow its states. A machine
        without Concurrence runs as well without.
        """
        if not any(root is each for each in self._attached):
            self._attached.append(root)
            smach_bridge.attach(root, self.clock, self.enter, name)

    def together(self, *calls: Callable[[], Any]) -> list[Any]:
        """Call each in a thread of its own, as branches of the clock, and return what they return.

        The first error, in the order given, is raised when all have ended.
        """
        return smach_bridge.together(self.clock, calls)

    def enter(self, paths: Iterable[str]) -> None:
        """These states are active now: for the film's caption and the faults that wait for one."""
        active = tuple(paths)
        self.caption = " + ".join(active)
        self._faults.enter(active)

    def _step(self) -> None:
        self._faults.strike(self)
        if self._film is not None:
            self._film.watch()
        self.engine.stepSimulation()
        self.steps += 1
        if self.gui:
            time.sleep(max(0.0, self._began + self.time - time.monotonic()))

    def _left_behind(self, key: Key) -> None:
        branch = "/".join(map(str, key))
        self.note("clock", f"branch {branch} does not wait for simulated time; it is left behind")

    def note(self, name: str, text: str) -> None:
        """Add an event."""
        event = Event(self.time, name, text)
        self.events.append(event)
        if self._on_event is not None:
            self._on_event(event)

    # Names

    def unknown(self, kind: str, name: str, known: Iterable[str]) -> UnknownNameError:
        """The error for a name that is not there."""
        return UnknownNameError(kind, name, tuple(known))

    def arm(self, limb: str | None = None) -> Arm:
        """The arm of that name, or the only one. Raises UnknownNameError."""
        for arm in self.arms:
            if arm.name == limb or (not limb and len(self.arms) == 1):
                return arm
        raise self.unknown("limb", limb or "", (arm.name for arm in self.arms))

    def body(self, name: str) -> int:
        """PyBullet's number of a body. Raises UnknownNameError."""
        if name not in self.bodies:
            raise self.unknown("body", name, self.bodies)
        return self.bodies[name]

    def frame(self, name: str | None) -> Pose:
        """Where a frame is in the world. Raises UnknownNameError."""
        if name in (None, "", "base", self.robot.name):
            return self.robot.base
        if name == "world":
            return IDENTITY
        if name not in self.bodies:
            raise self.unknown("frame", str(name), ("base", "world", *self.bodies))
        return models.where(self.engine, self.bodies[str(name)])

    def seen_from(self, frame: str, pose: Pose) -> Pose:
        """A pose given in the world frame, in `frame` instead."""
        return transforms.compose(transforms.inverse(self.frame(frame)), pose)

    # Bodies

    def load(
        self,
        model: str,
        pose: Any,
        name: str = "",
        path: str | Path | None = None,
        frame: str = "base",
    ) -> Result:
        """Put a model of MODELS, or of a URDF or SDF file, at `pose`; the value is its name.

        `name` is the model's own if left out. Aborted when the model, the file or the frame does
        not exist, or the name is taken.
        """
        result = self.run(skills.load(self, model, pose, name or model, path, frame))
        if result.outcome != "succeeded":
            self.note("load", result.reason)
        return result

    def add(self, model: str, pose: Any, name: str, path: Any, frame: str) -> Result:
        """`load`, at once and without an event; for skills."""
        if name in self.bodies:
            return Result("aborted", f"a body `{name}` is there already")
        try:
            place = transforms.compose(self.frame(frame), as_pose(pose))
        except UnknownNameError as error:
            return Result("aborted", str(error))
        if path:
            body = models.read(self.engine, path, place)
        elif model in models.MODELS:
            turn = self._painted[model] = self._painted.get(model, -1) + 1
            body = models.build(self.engine, models.MODELS[model], place, turn)
        else:
            body = str(self.unknown("model", model, models.MODELS))
        if isinstance(body, str):
            return Result("aborted", body)
        self.bodies[name] = body
        return Result("succeeded", value=name)

    def remove(self, name: str) -> None:
        """Take a body out of the world. Raises UnknownNameError."""
        self.engine.removeBody(self.body(name))
        del self.bodies[name]

    # What came of it

    def pose(self, name: str, frame: str = "base") -> list[list[float]]:
        """Where a body is. Raises UnknownNameError."""
        place = models.where(self.engine, self.body(name))
        return transforms.as_lists(self.seen_from(frame, place))

    def error(self, name: str, pose: Any, frame: str = "base") -> float:
        """How far (m) a body is from where it was to be."""
        return math.dist(self.pose(name, frame)[0], as_pose(pose)[0])

    def at_rest(self, name: str) -> bool:
        """Whether a body moves slower than 5 mm/s and turns slower than 0.05 rad/s."""
        straight, turning = self.engine.getBaseVelocity(self.body(name))
        return math.hypot(*straight) < 0.005 and math.hypot(*turning) < 0.05

    def hash(self) -> str:
        """A digest of all poses, joints and velocities, exact to the last bit."""
        numbers: list[float] = []
        for name in sorted(self.bodies):
            body = self.bodies[name]
            for part in self.engine.getBasePositionAndOrientation(body):
                numbers += part
            for part in self.engine.getBaseVelocity(body):
                numbers += part
        count = self.engine.getNumJoints(self.robot_body)
        for state in self.engine.getJointStates(self.robot_body, range(count)):
            numbers += state[:2]
        return hashlib.blake2b(struct.pack(f"{len(numbers)}d", *numbers), digest_size=8).hexdigest()


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """What a World takes where it is told nothing else."""

    seed: int = 0
    gui: bool = False
    record: str | Path | None = None
    faults: tuple[Fault | Mapping[str, Any], ...] = ()


_settings = Settings()
_open: list[World] = []


def configure(
    *,
    seed: int = 0,
    gui: bool = False,
    record: str | Path | None = None,
    faults: Iterable[Fault | Mapping[str, Any]] = (),
) -> None:
    """Set what worlds opened from now on take; what is left out goes back to its default."""
    global _settings
    _settings = Settings(seed=seed, gui=gui, record=record, faults=tuple(faults))


def current() -> Settings:
    """What is set."""
    return _settings


def world() -> World:
    """The world that is open, the last one of several; one is opened if none is."""
    if _open:
        return _open[-1]

    return World()


def opened(each: World) -> None:
    """A world tells that it is open."""
    _open.append(each)


def closed(each: World) -> None:
    """A world tells that it is closed."""
    if each in _open:
        _open.remove(each)


@atexit.register
def close() -> None:
    """Close all worlds, so that films are whole even where nobody closed them."""
    while _open:
        _open[-1].close()
