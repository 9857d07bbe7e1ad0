"""Bodies in a physics client: built of boxes or read from URDF and SDF files, and placed."""

from pathlib import Path

from smachac.robots.models import MODELS as MODELS
from smachac.robots.models import RGB, Box, Model
from smachac.sim.loading import load
from smachac.sim.physics import Engine, data_file
from smachac.sim.robot_file import EngineFile, LoadError, engine_file, read_robot_file
from smachac.sim.transforms import IDENTITY, Pose, compose, inverse


def build(engine: Engine, model: Model, pose: Pose, turn: int = 0) -> int:
    """Make a body of `model` at `pose` (world frame) and return its number.

    `turn` counts the bodies of this model and selects the colour.
    """
    own = model.colours[turn % len(model.colours)]
    halves = [[edge / 2 for edge in box.size] for box in model.boxes]
    centres = [list(box.centre) for box in model.boxes]
    kinds = [engine.GEOM_BOX] * len(model.boxes)
    colours = [[*(box.colour or own), 1.0] for box in model.boxes]
    shape = -1
    if model.solid:
        shape = engine.createCollisionShapeArray(
            shapeTypes=kinds, halfExtents=halves, collisionFramePositions=centres
        )
    look = engine.createVisualShapeArray(
        shapeTypes=kinds, halfExtents=halves, visualFramePositions=centres, rgbaColors=colours
    )
    # The centre of mass of a body that moves is that of its first box.
    centre = model.boxes[0].centre if model.mass > 0.0 else (0.0, 0.0, 0.0)
    body: int = engine.createMultiBody(
        model.mass, shape, look, pose[0], pose[1], baseInertialFramePosition=centre
    )
    place(engine, body, pose)
    for k, colour in enumerate(colours):
        engine.changeVisualShape(body, -1, shapeIndex=k, rgbaColor=colour)
    touch(engine, body, model.friction)
    return body


def paint(engine: Engine, body: int, colour: RGB) -> None:
    """Give all shapes of a body one colour."""
    for shape in engine.getVisualShapeData(body):
        engine.changeVisualShape(body, shape[1], rgbaColor=(*colour, 1.0))


def floor(engine: Engine) -> None:
    """The ground at z = 0 of the world."""
    ground = Model(
        boxes=(Box(size=(4.0, 4.0, 0.1), centre=(0, 0, -0.05)),), colours=((0.72, 0.76, 0.80),)
    )
    build(engine, ground, IDENTITY)


def stand(
    engine: Engine, size: tuple[float, float], centre: tuple[float, float], base: Pose
) -> None:
    """The box under a robot's base, from the floor up; none for a base on the floor."""
    height = base[0][2]
    if height <= 0.0:
        return
    # 2 mm lower than the base, so that the two never touch.
    box = Box(size=(*size, height - 0.002), centre=(*centre, -height / 2 - 0.001))
    build(engine, Model(boxes=(box,), colours=((0.30, 0.33, 0.38),)), base)


def touch(engine: Engine, body: int, friction: float) -> None:
    """Set the contact parameters with which the grasps were measured, on every link of `body`."""
    for link in range(-1, engine.getNumJoints(body)):
        engine.changeDynamics(
            body, link, lateralFriction=friction, spinningFriction=0.001, restitution=0.0
        )


def file_of(path: str | Path) -> EngineFile:
    """The file of a body, URDF or SDF, on disk or in PyBullet's data. Raises LoadError."""
    found = data_file(path)
    if found is None:
        raise LoadError(f"model file `{path}` not found")
    file = EngineFile(path=found)
    if found.suffix.lower() == ".sdf" or file.is_shipped:
        return file
    return engine_file(read_robot_file(found))


def read(engine: Engine, file: EngineFile, pose: Pose) -> int:
    """Load the first body of a file at `pose` (world frame): its number. Raises LoadError."""
    bodies = load(engine, file)
    for extra in bodies[1:]:
        engine.removeBody(extra)
    place(engine, bodies[0], pose)
    return bodies[0]


def place(engine: Engine, body: int, pose: Pose) -> None:
    """Put the model frame of `body` at `pose` (world frame), at rest."""
    centre = compose(pose, _mass_frame(engine, body))
    engine.resetBasePositionAndOrientation(body, centre[0], centre[1])
    engine.resetBaseVelocity(body, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


def where(engine: Engine, body: int) -> Pose:
    """The pose of the model frame of `body` in the world frame."""
    position, rotation = engine.getBasePositionAndOrientation(body)
    return compose((position, rotation), inverse(_mass_frame(engine, body)))


def _mass_frame(engine: Engine, body: int) -> Pose:
    """The frame of PyBullet's base poses, at the centre of mass, in the model frame."""
    known = engine.getDynamicsInfo(body, -1)
    return known[3], known[4]
