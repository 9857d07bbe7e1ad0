"""Films of a world: drawn on the CPU at a steady rate, captioned, written as GIF or MP4."""

from __future__ import annotations

import contextlib
import math
import os
from collections.abc import Callable, Generator, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from .engine import SimUnavailable
from .geometry import Vector

if TYPE_CHECKING:
    from .scene import World

SIZE = (320, 240)
RATE = 10
"""Frames in a simulated second, and in one of watching."""
_FIELD = 38.0
_VIEW = (0.74, -0.60, 0.42)
_COLOURS = 64


class Writer(Protocol):
    """Takes frames (RGB images) and makes a file of them when closed."""

    def add(self, image: Any) -> None:
        """The next frame."""

    def close(self) -> None:
        """Finish the file."""


class Film:
    """A film of `world` in the file `path`, which appears whole when the film is closed."""

    def __init__(self, world: World, path: str | Path) -> None:
        self._world = world
        self._path = Path(path)
        self._part = self._path.with_name(f".{self._path.stem}.part{self._path.suffix}")
        self._frames = 0
        self._camera: tuple[Any, Any] | None = None
        self._seen: set[str] = set()
        makers: dict[str, Callable[[Path], Writer]] = {".gif": Gif, ".mp4": Mp4}
        if self._path.suffix.lower() not in makers:
            raise ValueError(f"cannot film into `{path}`: the name has to end with .gif or .mp4")
        _pillow()
        self._path.parent.mkdir(parents=True, exist_ok=True)
        self._writer: Writer = makers[self._path.suffix.lower()](self._part)

    def watch(self) -> None:
        """Take a frame if one is due."""
        if self._world.time * RATE >= self._frames:
            self.take()

    def take(self) -> None:
        """Take a frame now."""
        self._frames += 1
        self._writer.add(caption(draw(self._world, self._fitted()), self._world.caption))

    def close(self) -> None:
        """Write the file; what was filmed so far is kept however the run ended."""
        try:
            if not self._frames:
                self.take()
            self._writer.close()
            os.replace(self._part, self._path)  # noqa: PTH105
        finally:
            with contextlib.suppress(OSError):
                self._part.unlink()

    def _fitted(self) -> tuple[Any, Any]:
        """The camera, set up anew only when bodies have come."""
        if self._camera is None or not self._seen >= self._world.bodies.keys():
            self._seen = set(self._world.bodies)
            self._camera = fit(self._world)
        return self._camera


def fit(world: World) -> tuple[Any, Any]:
    """View and projection matrices of a camera that has the robot and all bodies in sight."""
    low, high = _bounds(world)
    centre = tuple((a + b) / 2 for a, b in zip(low, high, strict=True))
    corners = [
        (x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])
    ]
    norm = math.hypot(*_VIEW)
    back = (_VIEW[0] / norm, _VIEW[1] / norm, _VIEW[2] / norm)
    flat = math.hypot(back[0], back[1])
    right = (-back[1] / flat, back[0] / flat, 0.0)
    up = (-back[2] * right[1], back[2] * right[0], back[0] * right[1] - back[1] * right[0])
    tall = math.tan(math.radians(_FIELD) / 2)
    wide = tall * SIZE[0] / SIZE[1]
    distance = 0.0
    for corner in corners:
        arm = tuple(a - b for a, b in zip(corner, centre, strict=True))
        near = _dot(arm, back)
        distance = max(
            distance, near + abs(_dot(arm, right)) / wide, near + abs(_dot(arm, up)) / tall
        )
    eye = [c + b * distance for c, b in zip(centre, back, strict=True)]
    engine = world.engine
    return (
        engine._module.computeViewMatrix(eye, centre, (0, 0, 1)),
        engine._module.computeProjectionMatrixFOV(_FIELD, SIZE[0] / SIZE[1], 0.1, 10.0),
    )


def _dot(a: Iterable[float], b: Iterable[float]) -> float:
    return sum(x * y for x, y in zip(a, b, strict=True))


def _bounds(world: World) -> tuple[Vector, Vector]:
    """The box around the robot and the bodies."""
    engine = world.engine
    boxes = [
        engine.getAABB(world.robot_body, link)
        for link in range(-1, engine.getNumJoints(world.robot_body))
    ]
    for body in world.bodies.values():
        boxes += [engine.getAABB(body, link) for link in range(-1, engine.getNumJoints(body))]
    lows, highs = zip(*boxes, strict=True)
    low = tuple(min(each) for each in zip(*lows, strict=True))
    high = tuple(max(each) for each in zip(*highs, strict=True))
    return (low[0], low[1], low[2]), (high[0], high[1], high[2])


def draw(world: World, camera: tuple[Any, Any]) -> Any:
    """One picture of the world, an RGB image of SIZE."""
    import numpy

    pil = _pillow()
    width, height = SIZE
    _, _, pixels, _, _ = world.engine.getCameraImage(
        width,
        height,
        viewMatrix=camera[0],
        projectionMatrix=camera[1],
        renderer=world.engine.ER_TINY_RENDERER,
        lightDirection=(0.6, -0.9, 1.6),
        shadow=1,
    )
    # Without numpy support in its build PyBullet gives a plain tuple.
    array = numpy.asarray(pixels, dtype=numpy.uint8).reshape(height, width, 4)
    return pil.fromarray(array[:, :, :3])


def caption(image: Any, text: str) -> Any:
    """The image with a line of text below the scene."""
    if not text:
        return image
    from PIL import ImageDraw, ImageFont

    pen = ImageDraw.Draw(image)
    pen.text((8, SIZE[1] - 18), text, fill=(30, 34, 40), font=ImageFont.load_default())
    return image


def _pillow() -> Any:
    try:
        from PIL import Image
    except ImportError as error:
        raise SimUnavailable("films need Pillow; pip install 'smachac[sim]'") from error
    return Image


class Gif:
    """An animated GIF of few colours, without dither, so that what rests costs nothing."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._images: list[Any] = []

    def add(self, image: Any) -> None:
        """The next frame."""
        pil = _pillow()
        if not self._images:
            self._images.append(image.quantize(_COLOURS, method=pil.Quantize.MEDIANCUT))
            return
        self._images.append(image.quantize(palette=self._images[0], dither=pil.Dither.NONE))

    def close(self) -> None:
        """Finish the file."""
        first, *rest = self._images
        first.save(
            self._path,
            save_all=True,
            append_images=rest,
            duration=1000 // RATE,
            loop=0,
            optimize=False,
        )


class Mp4:
    """An MP4 by the ffmpeg that imageio-ffmpeg brings."""

    def __init__(self, path: Path) -> None:
        try:
            import imageio_ffmpeg
        except ImportError as error:
            raise SimUnavailable(
                "films in MP4 need imageio-ffmpeg; pip install 'smachac[sim]', or film into a .gif"
            ) from error
        self._frames: Generator[None, bytes | None, None] = imageio_ffmpeg.write_frames(
            str(path), SIZE, fps=RATE
        )
        self._frames.send(None)

    def add(self, image: Any) -> None:
        """The next frame."""
        self._frames.send(image.tobytes())

    def close(self) -> None:
        """Finish the file."""
        self._frames.close()
