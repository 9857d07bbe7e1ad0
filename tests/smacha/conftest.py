"""The project file of scripts in temporary folders: their programs are for ROS 1."""

from __future__ import annotations

from pathlib import Path

import pytest


@pytest.fixture(autouse=True)
def _ros_1(tmp_path: Path) -> None:
    (tmp_path / "smachac.toml").write_text("ros = 1\n", encoding="utf-8")
