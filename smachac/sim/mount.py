"""A robot put into the physics: loaded, its motors silenced, its limbs found by name."""

from dataclasses import dataclass
from typing import Any

from . import models
from .engine import Engine, UnknownNameError, quiet
from .robots import Limb, Robot

_FINGER_FRICTION = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Parts:
    """A limb's joints, tip and fingers by PyBullet's numbers, with its joints' limits.

    Positions in rad, speeds in rad/s, efforts in N m.
    """

    limb: Limb
    joints: tuple[int, ...]
    fingers: tuple[int, ...]
    tip: int
    limits: tuple[tuple[float, float], ...]
    speeds: tuple[float, ...]
    efforts: tuple[float, ...]


def mount(engine: Engine, robot: Robot) -> tuple[int, tuple[Parts, ...]]:
    """Load the robot, on its stand, held still: its body and the parts of each limb.

    Raises UnknownNameError when a limb names a joint or link that the file does not have.
    """
    if robot.stand is not None:
        models.stand(engine, robot.stand.size, robot.stand.centre, robot.base)
    with quiet():
        body = engine.loadURDF(str(robot.path), robot.base[0], robot.base[1], useFixedBase=True)
    known = [engine.getJointInfo(body, k) for k in range(engine.getNumJoints(body))]
    for each in known:
        if each[2] != engine.JOINT_FIXED:
            # The default motors would fight an arm's own; what no arm owns is held still.
            engine.setJointMotorControl2(body, each[0], engine.VELOCITY_CONTROL, force=0.0)
            engine.setJointMotorControl2(
                body, each[0], engine.POSITION_CONTROL, targetPosition=0.0, force=each[10]
            )
    joints = {each[1].decode(): each for each in known}
    links = {each[12].decode(): each[0] for each in known}
    parts = tuple(_parts(limb, joints, links) for limb in robot.limbs)
    for each in parts:
        _ready_fingers(engine, body, each)
    return body, parts


def _parts(limb: Limb, joints: dict[str, Any], links: dict[str, int]) -> Parts:
    for name in (*limb.joints, *(finger.joint for finger in limb.fingers)):
        if name not in joints:
            raise UnknownNameError("joint", name, tuple(joints))
    if limb.tip not in links:
        raise UnknownNameError("link", limb.tip, tuple(links))
    efforts = dict(limb.efforts)
    found = [joints[name] for name in limb.joints]
    return Parts(
        limb=limb,
        joints=tuple(each[0] for each in found),
        fingers=tuple(joints[finger.joint][0] for finger in limb.fingers),
        tip=links[limb.tip],
        limits=tuple((each[8], each[9]) for each in found),
        speeds=tuple(each[11] for each in found),
        efforts=tuple(float(efforts.get(name) or joints[name][10]) for name in limb.joints),
    )


def _ready_fingers(engine: Engine, body: int, parts: Parts) -> None:
    for finger in parts.fingers:
        engine.changeDynamics(
            body,
            finger,
            lateralFriction=_FINGER_FRICTION,
            spinningFriction=0.001,
            restitution=0.0,
        )
    if len(parts.fingers) != 2:
        return
    # Without the gear a closing hand drags the block along, 12 mm.
    gear = engine.createConstraint(
        body,
        parts.fingers[0],
        body,
        parts.fingers[1],
        engine.JOINT_GEAR,
        (1, 0, 0),
        (0, 0, 0),
        (0, 0, 0),
    )
    engine.changeConstraint(gear, gearRatio=parts.limb.gear, erp=0.1, maxForce=50)
