"""Films: a GIF or an MP4 that is there whole or not at all, with everything in the picture."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest

from smachac import sim
from smachac.sim import video

pytest.importorskip("pybullet")
Image = pytest.importorskip("PIL.Image")

TABLE = [[0.6, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]


def frames(path: Path) -> int:
    with Image.open(path) as image:
        return int(getattr(image, "n_frames", 1))


def test_a_gif_holds_the_run_and_is_small(tmp_path: Path) -> None:
    path = tmp_path / "films" / "run.gif"
    with sim.World(seed=0, record=path) as world:
        world.load("table", TABLE, frame="world")
        world.enter(["sm/MOVE"])
        arm = world.arm()
        arm.move_to_joints(arm.solve_ik([[0.5, 0.0, 0.2], [1, 0, 0, 0]]) or [])
        count = int(world.time * video.RATE)
        assert not path.exists()
    assert [item.name for item in path.parent.iterdir()] == ["run.gif"]
    assert frames(path) >= count - 1
    assert path.stat().st_size < 10_000 * count
    with Image.open(path) as image:
        assert image.size == (320, 240)


def test_an_interrupted_run_leaves_its_film(tmp_path: Path) -> None:
    def run() -> None:
        with sim.World(seed=0, record=path) as world:
            world.sleep(0.2)
            raise KeyboardInterrupt

    path = tmp_path / "run.gif"
    with pytest.raises(KeyboardInterrupt):
        run()
    assert frames(path) >= 2
    assert [item.name for item in tmp_path.iterdir()] == ["run.gif"]


def test_an_mp4(tmp_path: Path) -> None:
    pytest.importorskip("imageio_ffmpeg")
    path = tmp_path / "run.mp4"
    with sim.World(seed=0, record=path) as world:
        world.caption = "sm/IDLE"
    assert path.read_bytes()[4:8] == b"ftyp"
    assert [item.name for item in tmp_path.iterdir()] == ["run.mp4"]


def test_no_mp4_without_ffmpeg(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    with pytest.raises(sim.SimUnavailable, match=r"imageio-ffmpeg; pip install 'smachac\[sim\]'"):
        sim.World(record=tmp_path / "run.mp4")
    assert list(tmp_path.iterdir()) == []


def test_a_film_is_a_gif_or_an_mp4(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"has to end with \.gif or \.mp4"):
        sim.World(record=tmp_path / "run.avi")


def test_the_robot_and_all_bodies_are_in_the_picture() -> None:
    numpy = pytest.importorskip("numpy")
    with sim.World(seed=0) as world:
        world.load("table", TABLE, frame="world")
        world.load("block", [[0.4, -0.3, 0.025], [0, 0, 0, 1]])
        world.load("goal", [[0.6, 0.3, 0.025], [0, 0, 0, 1]])
        view, projection = video.fit(world)
        seen: Any = world.engine.getCameraImage(
            160, 110, view, projection, renderer=world.engine.ER_TINY_RENDERER
        )[4]
        things = numpy.asarray(seen).reshape(110, 160)
        for body in (world.arm().body, *world.bodies.values()):
            rows, columns = numpy.nonzero(things == body)
            assert len(rows) > 3
            if body != world.bodies["table"]:
                assert rows.min() > 0
                assert rows.max() < 109
            assert columns.min() > 0
            assert columns.max() < 159
        width = numpy.ptp(numpy.nonzero(things == world.bodies["table"])[1])
        assert width > 60


def test_a_long_caption_keeps_its_end() -> None:
    image = Image.new("RGB", (320, 218))
    short = video.caption(image, "sm/A", 1.0)
    assert short.size == (320, 240)
    cut = video.caption(image, "x" * 300 + "/LAST", 1.0)
    longer = video.caption(image, "x" * 900 + "/LAST", 1.0)
    assert cut.tobytes() == longer.tobytes()
    assert cut.tobytes() != short.tobytes()
