"""Video of a scene: frames rendered on the CPU at a fixed rate, with a caption, as GIF or MP4."""

from __future__ import annotations

import contextlib
import math
import os
from collections.abc import Callable, Generator, Iterable, Iterator
from pathlib import Path
from typing import Any, Protocol, TypeAlias

from smachac.sim.models import MODELS
from smachac.sim.physics import SimUnavailable, pybullet
from smachac.sim.scene import Scene
from smachac.sim.transforms import Vector

RATE = 6
"""Frames per simulated second."""
SPEED = 12
"""Frames per second of playback; the caption shows the simulated time."""
Camera: TypeAlias = tuple[Any, Any]
"""View matrix and projection matrix, as PyBullet makes them."""

_FIELD = 38.0
"""Vertical field of view (degrees)."""
_FILLED = 0.88
"""Part of the picture that the scene fills."""
_BELOW = 0.12
"""Depth (m) below the robot's base that stays in the picture."""
_VIEW = (0.80, -0.55, 0.42)
"""Direction from the scene to the camera (world frame)."""
_BAR = 0.09
"""Height of the caption bar as a part of the frame."""
_LONGEST = 80
"""Longest caption (characters)."""
_ASPECT = 4 / 3 / (1 - _BAR)
_SKY = ((206, 219, 232), (240, 245, 249))
_PAPER, _INK, _FAINT = (250, 251, 252), (38, 44, 54), (120, 128, 140)
# A light nearer than 10 m gives a shadow map with stripes, one farther off gives no shadows.
_LIGHT = {
    "lightDirection": (0.3, -0.5, 2.0),
    "lightDistance": 10.0,
    "lightAmbientCoeff": 0.62,
    "lightDiffuseCoeff": 0.45,
    "lightSpecularCoeff": 0.05,
}
_COLOURS = 64
"""Colours of a GIF."""
_LIT = (1.05, 0.85, 0.7)
"""Brightness factors with which the colour of a model goes into the palette of a GIF."""


class Writer(Protocol):
    """Encodes frames, RGB images of `size` (width, height) in pixels, into a file."""

    size: tuple[int, int]

    def add(self, image: Any) -> None:
        """Add the next frame."""

    def close(self) -> None:
        """Finish the file."""


class Film:
    """A film of `scene` in the file `path` (.gif or .mp4), which appears when the film is closed.

    Raises ValueError for another file name and SimUnavailable without Pillow or imageio-ffmpeg.
    """

    def __init__(self, scene: Scene, path: str | Path) -> None:
        self._scene = scene
        self._path = Path(path)
        self._part = self._path.with_name(f".{self._path.stem}.part{self._path.suffix}")
        self._frames = 0
        self._camera: Camera | None = None
        self._seen: set[str] = set()
        makers: dict[str, Callable[[Path], Writer]] = {".gif": Gif, ".mp4": Mp4}
        if self._path.suffix.lower() not in makers:
            raise ValueError(f"cannot film into `{path}`: the name has to end with .gif or .mp4")
        _pillow()
        self._path.parent.mkdir(parents=True, exist_ok=True)
        self._writer: Writer = makers[self._path.suffix.lower()](self._part)

    def update(self) -> None:
        """Take a frame if one is due; to be called before each physics step."""
        if self._scene.time * RATE >= self._frames:
            self.take()

    def take(self) -> None:
        """Take a frame now."""
        self._frames += 1
        self._writer.add(self._frame())

    def _frame(self) -> Any:
        picture = draw(self._scene, self._fitted(), self._writer.size)
        return caption(picture, self._scene.caption, self._scene.time)

    def close(self) -> None:
        """Write the file; it holds all frames so far, also after a run that failed."""
        try:
            self.take()
            self._writer.close()
            os.replace(self._part, self._path)  # noqa: PTH105
        finally:
            with contextlib.suppress(OSError):
                self._part.unlink()

    def _fitted(self) -> Camera:
        """The camera; it is fitted again only when there are new bodies."""
        if self._camera is None or not self._seen >= self._scene.bodies.keys():
            self._seen = set(self._scene.bodies)
            self._camera = fit(self._scene)
        return self._camera


def fit(scene: Scene) -> Camera:
    """The nearest camera in the fixed direction that shows the robot and all bodies."""
    norm = math.hypot(*_VIEW)
    back = tuple(number / norm for number in _VIEW)
    flat = math.hypot(back[0], back[1])
    right = (-back[1] / flat, back[0] / flat, 0.0)
    up = (-back[2] * right[1], back[2] * right[0], flat)
    points = [
        (_dot(right, corner), _dot(up, corner), _dot(back, corner)) for corner in _corners(scene)
    ]
    tall = math.tan(math.radians(_FIELD) / 2) * _FILLED
    wide = tall * _ASPECT
    across = rise = 0.0
    away = math.inf
    # A sideways shift of the camera changes which point limits its distance: a few iterations.
    for _ in range(8):
        away = max(
            depth + max(abs(x - across) / wide, abs(y - rise) / tall) for x, y, depth in points
        )
        lefts = [(x - across) / (away - depth) for x, _, depth in points]
        downs = [(y - rise) / (away - depth) for _, y, depth in points]
        across += (min(lefts) + max(lefts)) / 2 * away * 0.8
        rise += (min(downs) + max(downs)) / 2 * away * 0.8
    target = [across * r + rise * u for r, u in zip(right, up, strict=True)]
    eye = [number + away * b for number, b in zip(target, back, strict=True)]
    bullet = pybullet()
    return (
        bullet.computeViewMatrix(eye, target, (0, 0, 1)),
        bullet.computeProjectionMatrixFOV(_FIELD, _ASPECT, 0.1, 10.0),
    )


def _dot(a: Iterable[float], b: Iterable[float]) -> float:
    return sum(x * y for x, y in zip(a, b, strict=True))


def _corners(scene: Scene) -> Iterator[Vector]:
    """The points that the picture has to show: corners of the bounding boxes of all links.

    Points more than 12 cm below the robot's base (the legs of tables) are raised to that height.
    """
    engine, floor = scene.engine, scene.robot.base[0][2] - _BELOW
    for body in (*scene.kinematics, *scene.bodies.values()):
        for link in range(-1, engine.getNumJoints(body)):
            low, high = engine.getAABB(body, link)
            for x in (low[0], high[0]):
                for y in (low[1], high[1]):
                    for z in (low[2], high[2]):
                        yield x, y, max(z, floor)


def draw(scene: Scene, camera: Camera, size: tuple[int, int]) -> Any:
    """An RGB image of the scene: a frame of `size` (pixels) without its caption bar."""
    import numpy

    pil = _pillow()
    width, height = size[0], round(size[1] * (1 - _BAR))
    _, _, pixels, _, things = scene.engine.getCameraImage(
        width,
        height,
        viewMatrix=camera[0],
        projectionMatrix=camera[1],
        renderer=scene.engine.ER_TINY_RENDERER,
        shadow=1,
        **_LIGHT,
    )
    # A PyBullet that was built without numpy support returns a plain tuple.
    picture = numpy.array(pixels, dtype=numpy.uint8).reshape(height, width, 4)[:, :, :3]
    nothing = numpy.asarray(things).reshape(height, width) < 0
    sky = numpy.linspace(_SKY[0], _SKY[1], height).astype(numpy.uint8)
    picture[nothing] = numpy.broadcast_to(sky[:, None, :], picture.shape)[nothing]
    return pil.fromarray(picture)


def caption(image: Any, text: str, clock: float) -> Any:
    """The image above a bar with `text` and the time `clock` (s).

    A text that is too long loses its beginning.
    """
    from PIL import ImageDraw, ImageFont

    width, height = image.size
    bar = round(height * _BAR / (1 - _BAR))
    whole = _pillow().new("RGB", (width, height + bar), _PAPER)
    whole.paste(image, (0, 0))
    pen = ImageDraw.Draw(whole)
    font = ImageFont.load_default(bar * 0.55)
    middle, margin = height + bar / 2, bar / 3
    now = f"{clock:.1f} s"
    room = width - 3 * margin - pen.textlength(now, font=font)
    whole_text, text = text, text[-_LONGEST:]
    while pen.textlength(text, font=font) > room:
        text = text[1:]
    if text != whole_text:
        text = "\u2026" + text[1:]
    pen.text((margin, middle), text, fill=_INK, font=font, anchor="lm")
    pen.text((width - margin, middle), now, fill=_FAINT, font=font, anchor="rm")
    return whole


def _pillow() -> Any:
    try:
        from PIL import Image
    except ImportError as error:
        raise SimUnavailable("films need Pillow; pip install 'smachac[sim]'") from error
    return Image


class Gif:
    """An animated GIF of few colours; without dither, so that still areas compress to nothing."""

    size: tuple[int, int] = (320, 240)

    def __init__(self, path: Path) -> None:
        self._path = path
        self._images: list[Any] = []
        self._palette: Any = None

    def add(self, image: Any) -> None:
        """Add the next frame."""
        if self._palette is None:
            self._palette = _palette(image)
        self._images.append(image.quantize(palette=self._palette, dither=_pillow().Dither.NONE))

    def close(self) -> None:
        """Write the file; the last frame is shown for 2 s."""
        first, *rest = self._images
        times = [1000 // SPEED] * len(rest) + [2000]
        first.save(
            self._path, save_all=True, append_images=rest, duration=times, loop=0, optimize=False
        )


def _palette(image: Any) -> Any:
    """The palette of a film: the colours of its first frame, and those of all models in several
    brightnesses, because bodies are small in the first frame or appear later."""
    paints = list(dict.fromkeys(paint for model in MODELS.values() for paint in model.colours))
    swatch = _pillow().new("RGB", (image.width, image.height + len(paints) * len(_LIT)))
    swatch.paste(image, (0, 0))
    for row, (paint, lit) in enumerate((paint, lit) for paint in paints for lit in _LIT):
        colour = tuple(min(255, round(255 * lit * number)) for number in paint)
        swatch.paste(colour, (0, image.height + row, image.width, image.height + row + 1))
    return swatch.quantize(_COLOURS)


class Mp4:
    """An MP4, written by the ffmpeg of imageio-ffmpeg. Raises SimUnavailable without it."""

    size: tuple[int, int] = (640, 480)

    def __init__(self, path: Path) -> None:
        try:
            import imageio_ffmpeg
        except ImportError as error:
            raise SimUnavailable(
                "films in MP4 need imageio-ffmpeg; pip install 'smachac[sim]', or film into a .gif"
            ) from error
        self._frames: Generator[None, bytes | None, None] = imageio_ffmpeg.write_frames(
            str(path), self.size, fps=SPEED
        )
        self._frames.send(None)

    def add(self, image: Any) -> None:
        """Add the next frame."""
        self._frames.send(image.tobytes())

    def close(self) -> None:
        """Finish the file."""
        self._frames.close()
