"""The simulated world: a scene with arms, faults and a film; the worlds and settings of a process.

A generated program opens a world or uses the open one with `world()`; what runs the program sets
the seed, the window, the film and the faults with `configure()`. Both are process-wide by design:
there is one robot, and no state has to be handed the world.
"""

from __future__ import annotations

import atexit
import threading
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType
from typing import Any

from smachac.robots.files import find_file, read_file
from smachac.robots.scene import Body, posed
from smachac.robots.scene import read as read_scene
from smachac.sim import models, robots, skills, smach_bridge, tasks
from smachac.sim.arm import Arm, arm_named
from smachac.sim.clock import Skill
from smachac.sim.faults import Fault, FaultSchedule
from smachac.sim.faults import read as read_faults
from smachac.sim.outcome import Preempted, Result
from smachac.sim.robots import Robot
from smachac.sim.scene import Event, Scene
from smachac.sim.video import Film


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """The defaults of a World's arguments, set by `configure`."""

    seed: int = 0
    gui: bool = False
    record: str | Path | None = None
    faults: tuple[Fault | Mapping[str, Any], ...] = ()
    on_event: Callable[[Event], None] | None = None
    folders: tuple[Path, ...] = ()
    poses: Mapping[str, Mapping[str, float]] = field(default_factory=dict)


_settings = Settings()
"""The settings of this process."""
_open_worlds: list[World] = []
"""The open worlds of this process, in the order of opening."""


class World(Scene):
    """A robot on a floor, and the bodies that are loaded around it.

    Metres, rad, s, kg; gravity along -z. Poses are given in the frame "base" (the robot's base)
    unless a frame is named: "world", or the name of a body. `robot` is a Robot, the name of a
    built-in one or the file of a description (default: the Panda); `scene` the file of a scene, or
    its bodies, which are placed with the seed. Arguments that are None take the value
    set by `configure`; `faults` are added to those of `configure`. `record` names a film (.gif or
    .mp4). `on_event` is called with each Event. A branch that submits no skill for `patience`
    seconds of wall time is left behind.

    A context manager; a world that is not closed stays in memory. Raises SimUnavailable without
    PyBullet or, for a film, Pillow or imageio-ffmpeg; LoadError for a file of the robot or the
    scene that cannot be loaded; DataError for a description that does not fit its URDF file;
    ValueError for a wrong fault or film name.

    Attributes:
        arms: the arms of the robot, in the order of its limbs.
    """

    def __init__(
        self,
        *,
        robot: Robot | str | None = None,
        scene: str | Path | Iterable[Body] | None = None,
        seed: int | None = None,
        gui: bool | None = None,
        record: str | Path | None = None,
        faults: Iterable[Fault | Mapping[str, Any]] = (),
        on_event: Callable[[Event], None] | None = None,
        patience: float = 5.0,
    ) -> None:
        seed = _settings.seed if seed is None else seed
        self._faults = FaultSchedule((*_settings.faults, *faults), seed)
        self._attached: list[Any] = []
        self._closing = threading.Lock()
        self._film: Film | None = None
        bodies = list(_bodies(scene))
        super().__init__(
            _robot(robot),
            seed,
            files=[models.file_of(_body_file(body)) for body in bodies if body.path],
            gui=_settings.gui if gui is None else gui,
            on_event=on_event or _settings.on_event,
            patience=patience,
        )
        try:
            self.arms = tuple(Arm(self, limb) for limb in self.limbs)
            for arm in self.arms:
                arm.reset(arm.limb.home)
            film = record or _settings.record
            for body in bodies:
                self._add_body(body)
            self._film = Film(self, film) if film else None
        except BaseException:
            self.close()
            raise
        _open_worlds.append(self)
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
        """Write the film and free the physics clients; a second call has no effect."""
        with self._closing:
            if self in _open_worlds:
                _open_worlds.remove(self)
            film, self._film = self._film, None
            try:
                if film is not None:
                    film.close()
            finally:
                super().close()

    def _add_body(self, body: Body) -> None:
        """Put a body of the scene into the world. Raises ValueError if that is not possible."""
        pose = tasks.scattered(self, body.pose, body.spread, dict(body.apart))
        path = _body_file(body) if body.path else None
        model = body.box or body.model
        result = self.add(model, pose, body.name, path, body.frame, body.colour)
        if result.outcome != "succeeded":
            raise ValueError(f"the scene: {result.reason}")

    def arm(self, limb: str | None = None) -> Arm:
        """The arm of that name; the only arm if no name is given. Raises UnknownNameError."""
        return arm_named(self.arms, limb)

    # Skills of the world

    def sleep(self, seconds: float, preempted: Preempted = None) -> Result:
        """Wait for `seconds` of simulated time."""
        return self.run(skills.sleep(seconds, preempted))

    def load(
        self,
        model: str,
        pose: Any,
        name: str = "",
        path: str | Path | None = None,
        frame: str = "base",
    ) -> Result:
        """Put a model of MODELS, or the URDF or SDF file `path`, at `pose`; the value is its name.

        `name` defaults to the model. Aborted, with an Event, if the model, the file or the frame
        does not exist, or the name is taken. Raises ValueError for a pose that is none.
        """

        def load() -> Skill[Result]:
            yield from ()
            return self.add(model, pose, name or model, path, frame)

        result = self.run(load())
        if result.outcome != "succeeded":
            self.note("load", result.reason)
        return result

    # Threads and states

    def attach(self, root: Any, name: str = "sm") -> None:
        """Attach a finished SMACH machine to this world's clock, before it is executed.

        Its Concurrences then run in lockstep with simulated time, and captions and faults follow
        its states. `name` is the path of the machine. A second call has no effect.
        """
        if not any(root is item for item in self._attached):
            self._attached.append(root)
            smach_bridge.attach(root, self.clock, self.enter, name)

    def together(self, *calls: Callable[[], Any]) -> list[Any]:
        """Call each in a thread of its own, as branches of the clock; the list of their results.

        When all have ended, the first error, in the order given, is raised.
        """
        return smach_bridge.together(self.clock, calls)

    def enter(self, paths: Iterable[str], began: str | None = None) -> None:
        """Set the active states, by path: the caption of the film, and faults that wait for one.

        `began` is the state that begins now; None: all of them. Raises WorldCrash.
        """
        active = tuple(paths)
        self.caption = " + ".join(active)
        self._faults.enter(self, self.arms, active if began is None else (began,))

    def _step(self) -> None:
        """Apply the faults that are due, film, make one physics step; with a GUI, in real time."""
        self._faults.apply(self, self.arms)
        if self._film is not None:
            self._film.update()
        super()._step()
        if self.gui:
            time.sleep(max(0.0, self._began + self.time - time.monotonic()))


def _robot(robot: Robot | str | None) -> Robot:
    if isinstance(robot, Robot):
        return robot
    return robots.load(robot or "panda", folders=_settings.folders)


def _bodies(scene: str | Path | Iterable[Body] | None) -> Iterable[Body]:
    if scene is None:
        return ()
    if not isinstance(scene, str | Path):
        return scene
    bodies = read_scene(read_file(find_file(scene, _settings.folders)))
    return [posed(body, _settings.poses.get(body.name, {})) for body in bodies]


def _body_file(body: Body) -> Path:
    return find_file(body.path, _settings.folders)


# Settings and open worlds of the process


def configure(
    *,
    seed: int = 0,
    gui: bool = False,
    record: str | Path | None = None,
    faults: Iterable[Fault | Mapping[str, Any]] = (),
    on_event: Callable[[Event], None] | None = None,
    folders: Iterable[Path] = (),
    poses: Mapping[str, Mapping[str, float]] | None = None,
) -> None:
    """Set the defaults of all worlds opened later; an argument left out is reset.

    `folders` are searched for descriptions of robots and scenes, after the working folder. `poses`
    are other values for poses of bodies in the file of a scene: body to axis (robots.scene.AXES) to
    value.
    """
    global _settings
    _settings = Settings(
        seed=seed,
        gui=gui,
        record=record,
        faults=read_faults(faults),
        on_event=on_event,
        folders=tuple(folders),
        poses=poses or {},
    )


def open_world() -> World | None:
    """The open world, the last opened one of several; None if none is open."""
    return _open_worlds[-1] if _open_worlds else None


def world() -> World:
    """The open world, the last opened one of several; if none is open, a new one."""
    return open_world() or World()


@atexit.register
def close() -> None:
    """Close all worlds. Runs at the end of the process too, so that films are complete."""
    while _open_worlds:
        _open_worlds[-1].close()
