"""PyBullet found, missed and silenced."""

from __future__ import annotations

import os
import sys

import pytest

from smachac import sim
from smachac.sim import physics, video

pytest.importorskip("pybullet")


def test_what_is_written_below_python_stays_inside(capfd: pytest.CaptureFixture[str]) -> None:
    print("before")
    with physics.quiet():
        os.write(1, b"noise")
        os.write(2, b"noise")
    print("after")
    written = capfd.readouterr()
    assert written.out == "before\nafter\n"
    assert written.err == ""


def test_a_world_writes_nothing(capfd: pytest.CaptureFixture[str]) -> None:
    with sim.World(seed=0) as world:
        world.load("cube", [1, 1, 1], path="cube_small.urdf")
        world.load("duck", [1, 2, 1], path="duck_vhacd.urdf")
        world.sleep(0.1)
    written = capfd.readouterr()
    assert (written.out, written.err) == ("", "")


@pytest.mark.parametrize("missing", ["pybullet", "numpy", "pybullet_data"])
def test_a_missing_package_is_named_with_its_cure(
    missing: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, missing, None)
    physics.pybullet.cache_clear()
    with pytest.raises(sim.SimUnavailable, match=r"pip install 'smachac\[sim\]'"):
        sim.World()
    physics.pybullet.cache_clear()


def test_no_film_without_pillow(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "PIL", None)
    with pytest.raises(sim.SimUnavailable, match="Pillow"):
        video._pillow()


def test_no_window_without_a_display(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.delenv("DISPLAY", raising=False)
    with pytest.raises(sim.SimUnavailable, match="DISPLAY is not set"):
        sim.World(gui=True)


def test_a_client_is_freed_once() -> None:
    client = physics.Engine()
    assert client.getNumBodies() == 0
    client.close()
    client.close()
    assert client.client == -1


def test_files_are_looked_for_on_disk_and_in_pybullets_data() -> None:
    found = physics.data_file("franka_panda/panda.urdf")
    assert found is not None
    assert physics.data_file(found) == found
    assert physics.data_file("no/such/file.urdf") is None
