"""Sweeps on a real Ray cluster of this computer, with two workers."""

from __future__ import annotations

import json
import sqlite3
from importlib.util import find_spec
from pathlib import Path

import pytest

from tests.support.sweeps import ONCE, smachac, work_folder

WORDS = ("sweep", "main.yml", "--runs", "20", "--jobs", "2", "--format", "json")


@pytest.fixture
def quiet_ray(monkeypatch: pytest.MonkeyPatch) -> None:
    if find_spec("ray") is None:
        pytest.skip("ray is not installed")
    monkeypatch.setenv("RAY_AUTH_MODE", "disabled")  # else it writes a file to the home folder
    monkeypatch.setenv("RAY_USAGE_STATS_ENABLED", "0")
    monkeypatch.delenv("RAY_ADDRESS", raising=False)


@pytest.mark.nightly
@pytest.mark.usefixtures("quiet_ray")
def test_a_worker_that_is_killed_half_way_loses_no_run(tmp_path: Path) -> None:
    work_folder(tmp_path, ONCE.format("os.kill(os.getpid(), signal.SIGKILL)"), seed=9)
    words = (*WORDS, "--database", "sweep.db")
    found = smachac(*words, "--engine", "ray", folder=tmp_path)
    assert found.returncode == 0, found.stderr
    assert (tmp_path / "once").exists()
    assert len((tmp_path / "begun").read_text().split()) == 21
    summary = json.loads(found.stdout)
    assert summary["success"]["count"] == summary["runs"] == 20
    connection = sqlite3.connect(tmp_path / "sweep.db")
    rows = connection.execute("SELECT seed, outcome FROM runs ORDER BY seed").fetchall()
    connection.close()
    assert rows == [(seed, "succeeded") for seed in range(20)]


@pytest.mark.nightly
@pytest.mark.usefixtures("quiet_ray")
def test_a_run_that_always_kills_its_worker_has_failed(tmp_path: Path) -> None:
    work_folder(tmp_path, "os.kill(os.getpid(), signal.SIGKILL)", seed=9)
    found = smachac(*WORDS, "--engine", "ray", folder=tmp_path)
    assert found.returncode == 0, found.stderr
    (group,) = json.loads(found.stdout)["failures"]
    assert group["seeds"] == [9]
    assert group["error"].startswith("the process of the run ended: ")


def test_without_ray_the_message_has_help(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from smachac.commands import sweep
    from smachac.commands.cli import main

    monkeypatch.setattr(sweep, "_has_ray", lambda: False)
    assert main(["sweep", str(tmp_path / "main.yml"), "--engine", "ray"]) == 2
    assert "pip install 'smachac[ray]'" in capsys.readouterr().err
