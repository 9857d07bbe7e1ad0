"""What an arm can do, as generators that yield once per physics step and return a Result.

The figures were measured on 100 random pick-and-place tasks: with them every one succeeds.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from smachac.sim import transforms
from smachac.sim.clock import Skill
from smachac.sim.transforms import Pose

if TYPE_CHECKING:
    from smachac.sim.arm import Arm
    from smachac.sim.world import World

Outcome = Literal["succeeded", "aborted", "preempted"]
Preempted = Callable[[], bool] | None

TIME_STEP = 1 / 240
"""s; 1/120 to 1/1000 work, 1/60 loses grasps."""
_SHORTEST = 0.5
_PATIENCE = 2.0
_STILL_SPEED = 0.01
_LOST = 0.05
_LOST_TIME = 0.1
_WAYPOINTS = 6
_GRIP_TIME = 0.5
_STILL_STEPS = 12
_THIN = 0.004
_PRESS = 0.5


@dataclass(frozen=True, slots=True)
class Result:
    """How a skill ended, why when it did not succeed, and what it found."""

    outcome: Outcome
    reason: str = ""
    value: Any = None


def sleep(seconds: float, preempted: Preempted) -> Skill[Result]:
    """Do nothing for `seconds` of simulated time."""
    for _ in range(round(seconds / TIME_STEP)):
        if preempted is not None and preempted():
            return Result("preempted", "told to stop while waiting")
        yield
    return Result("succeeded")


def move(arm: Arm, positions: Sequence[float], speed: float, preempted: Preempted) -> Skill[Result]:
    """Go to `positions` in joint space."""
    names = arm.limb.joints
    if len(positions) != len(names):
        return Result("aborted", f"{len(names)} joint positions wanted, {len(positions)} given")
    for name, position, (low, high) in zip(names, positions, arm.limits, strict=True):
        # Solutions are clipped to the limit, so allow for rounding.
        if not low - 1e-6 <= position <= high + 1e-6:
            return Result("aborted", f"{name}: {position:.3f} is not in {low:.3f}..{high:.3f} rad")
    return (yield from _follow(arm, [tuple(map(float, positions))], speed, preempted))


def move_along(arm: Arm, target: Pose, speed: float, preempted: Preempted) -> Skill[Result]:
    """Go straight to `target` (base frame); a move in joint space would bow by some 6 mm."""
    joints, waypoints = arm.joints, []
    start = arm.world.shadow.tip(arm.limb, joints)
    for pose in transforms.straight(start, target, _WAYPOINTS):
        solved = arm.world.shadow.solve(arm.limb, pose, joints)
        if solved is None:
            place = ", ".join(f"{each:.3f}" for each in pose[0])
            return Result("aborted", f"({place}) on the way is out of reach")
        if max(abs(a - b) for a, b in zip(solved, joints, strict=True)) > 1.0:
            return Result("aborted", "no straight way: the arm would have to turn over")
        joints = solved
        waypoints.append(joints)
    return (yield from _follow(arm, waypoints, speed, preempted))


def _follow(
    arm: Arm, waypoints: list[tuple[float, ...]], speed: float, preempted: Preempted
) -> Skill[Result]:
    """Run through the waypoints under one minimum-jerk law, then settle on the last.

    A joint that lags more than 0.05 rad for 0.1 s, twelve times the usual, will not arrive.
    """
    if speed <= 0.0:
        raise ValueError(f"the speed has to be above 0, not {speed}")
    corners = [arm.joints, *waypoints]
    steps = max(1, round(_duration(arm, corners, speed) / TIME_STEP))
    lost = 0
    for k in range(1, steps + 1):
        if preempted is not None and preempted():
            return _stop(arm)
        wanted = _at(corners, k / steps, steps * TIME_STEP)
        arm.command(*wanted)
        yield
        lag = [abs(a - b) for a, b in zip(arm.joints, wanted[0], strict=True)]
        lost = lost + 1 if max(lag) > _LOST else 0
        if lost * TIME_STEP > _LOST_TIME:
            arm.hold()
            return Result("aborted", f"{_worst(arm, lag)} does not follow")
    return (yield from _settle(arm, corners[-1], preempted))


def _duration(arm: Arm, corners: list[tuple[float, ...]], speed: float) -> float:
    """So long (s) that at the fastest moment, 1.875 times the mean, no joint is too fast."""
    pieces = len(corners) - 1
    slowest = max(
        abs(b - a) * pieces / limit
        for start, end in itertools.pairwise(corners)
        for a, b, limit in zip(start, end, arm.speeds, strict=True)
    )
    return max(_SHORTEST, 1.875 * slowest / speed)


def _at(
    corners: list[tuple[float, ...]], t: float, duration: float
) -> tuple[list[float], list[float]]:
    """Positions and velocities at the part `t` (0..1) of the time, minimum jerk on the way."""
    way = t**3 * (10 - 15 * t + 6 * t * t)
    pace = 30 * t * t * (1 - t) ** 2 / duration
    pieces = len(corners) - 1
    piece = min(int(way * pieces), pieces - 1)
    part = way * pieces - piece
    ends = list(zip(corners[piece], corners[piece + 1], strict=True))
    return (
        [a + (b - a) * part for a, b in ends],
        [(b - a) * pieces * pace for a, b in ends],
    )


def _settle(arm: Arm, goal: tuple[float, ...], preempted: Preempted) -> Skill[Result]:
    off: list[float] = []
    for _ in range(round(_PATIENCE / TIME_STEP)):
        if preempted is not None and preempted():
            return _stop(arm)
        off = [abs(a - b) for a, b in zip(arm.joints, goal, strict=True)]
        if max(off) < arm.limb.settled and max(map(abs, arm.velocities)) < _STILL_SPEED:
            return Result("succeeded", value=list(arm.joints))
        arm.command(goal, [0.0] * len(goal))
        yield
    arm.hold()
    return Result("aborted", f"not settled in time: {_worst(arm, off)} is {max(off):.3f} rad off")


def _worst(arm: Arm, errors: list[float]) -> str:
    return arm.limb.joints[errors.index(max(errors))]


def _stop(arm: Arm) -> Result:
    arm.hold()
    return Result("preempted", "told to stop; the arm stays where it is")


def grip(arm: Arm, opening: bool, preempted: Preempted) -> Skill[Result]:
    """Open or close, until the fingers have been still for a while."""
    arm.squeeze([each.opened if opening else each.closed for each in arm.limb.fingers])
    still, before = 0, arm.opening
    for step in range(round(_PATIENCE / TIME_STEP)):
        if preempted is not None and preempted():
            return Result("preempted", "told to stop; the gripper goes on", arm.width)
        yield
        after = arm.opening
        still = (
            still + 1 if max(abs(a - b) for a, b in zip(after, before, strict=True)) < 1e-5 else 0
        )
        before = after
        if still >= _STILL_STEPS and step * TIME_STEP >= _GRIP_TIME:
            break
    return _opened(arm) if opening else _closed(arm)


def _opened(arm: Arm) -> Result:
    strokes = [abs(each.opened - each.closed) for each in arm.limb.fingers]
    if all(a > 0.9 * b for a, b in zip(arm.opening, strokes, strict=True)):
        return Result("succeeded", value=arm.width)
    return Result("aborted", f"the gripper did not open ({1000 * arm.width:.1f} mm)", arm.width)


def _closed(arm: Arm) -> Result:
    grasp = _grasp(arm, None)
    return Result(grasp.outcome, grasp.reason, arm.width)


def check_grasp(arm: Arm, name: str | None) -> Skill[Result]:
    """Look whether the gripper holds the body `name`, or any; takes no time."""
    yield from ()
    return _grasp(arm, name)


def _grasp(arm: Arm, name: str | None) -> Result:
    """Width and force, since a gripper that never closed is wide too."""
    if arm.width < _THIN:
        return Result("aborted", f"the grasp is empty ({1000 * arm.width:.1f} mm)")
    held = {each: force for each, force in arm.forces().items() if force > _PRESS}
    if name is not None and name not in held:
        return Result("aborted", f"`{name}` is not between the fingers")
    if not held:
        return Result("aborted", f"the fingers press nothing ({1000 * arm.width:.1f} mm open)")
    return Result("succeeded", value=name or max(held, key=lambda each: held[each]))


def load(world: World, model: str, pose: Any, name: str, path: Any, frame: str) -> Skill[Result]:
    """Put a model into the world; a skill, so that it happens between two physics steps."""
    yield from ()
    return world.add(model, pose, name, path, frame)
