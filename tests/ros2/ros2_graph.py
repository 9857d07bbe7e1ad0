"""A ROS 2 graph of its own for a test: a free domain, and programs as processes."""

from __future__ import annotations

import contextlib
import fcntl
import functools
import os
import subprocess
import tempfile
from pathlib import Path
from typing import IO

from tests.ros.ros_graph import Program as Program

ROOT = Path(__file__).parents[2]
NODES = Path(__file__).with_name("nodes")

PYTHON = os.environ.get("SMACHAC_ROS2_PYTHON", str(ROOT / ".venv-ros2" / "bin" / "python"))
"""The Python of the virtual environment that has rclpy, as `make test-ros2` makes it."""

MODULES = "rclpy, std_srvs.srv, std_msgs.msg, test_msgs.action, lifecycle_msgs.srv"

DOMAINS = range(1, 102)
"""The domain ids whose ports are free on Linux; 0 is left to the people who work there."""


@functools.cache
def missing() -> str:
    """What keeps live tests from running; '' if nothing does."""
    if not Path(PYTHON).exists():
        return f"no {PYTHON}"
    asked = subprocess.run(
        [PYTHON, "-c", f"import {MODULES}"], capture_output=True, text=True, check=False
    )
    return asked.stderr.strip().rpartition("\n")[2] if asked.returncode else ""


def _free_domain() -> tuple[int, IO[str]]:
    """A domain that no other test on this machine uses, and the open file that reserves it."""
    for domain in DOMAINS:
        path = Path(tempfile.gettempdir()) / f"smachac-ros2-domain-{domain}.lock"
        lock = path.open("w", encoding="utf-8")
        with contextlib.suppress(BlockingIOError):
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return domain, lock
        lock.close()
    raise AssertionError("no free domain")


class Graph:
    """A domain, and the programs that a test starts in it."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._programs: list[Program] = []
        self._domain, self._lock = _free_domain()
        self.environment = {
            name: value
            for name, value in os.environ.items()
            if not name.startswith(("ROS_", "PYTHON", "AMENT_", "FASTDDS_", "FASTRTPS_"))
        }
        self.environment |= {
            "ROS_DOMAIN_ID": str(self._domain),
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
            "ROS_LOG_DIR": str(folder / "log"),
            # A killed process leaves no shared memory behind, and is missed after 2 s, not 20.
            "FASTDDS_DEFAULT_PROFILES_FILE": str(NODES / "short_lease.xml"),
            "PYTHONPATH": f"{ROOT}{os.pathsep}{NODES}",
            "PYTHONUNBUFFERED": "1",
            "PYTHONDONTWRITEBYTECODE": "1",
        }

    def use_interfaces(self) -> None:
        """Let programs that start from now on import the interface packages of the tests."""
        folder = Path(PYTHON).parents[1] / "interfaces"
        (packages,) = folder.glob("lib/python3*/site-packages")
        self.environment["PYTHONPATH"] += f"{os.pathsep}{packages}"
        self.environment["LD_LIBRARY_PATH"] = str(folder / "lib")

    def _launch(self, command: list[str]) -> Program:
        program = Program(command, self.environment)
        self._programs.append(program)
        return program

    def node(self, name: str, *arguments: str) -> Program:
        """Start one of the nodes beside this file; it is ready."""
        program = self._launch([PYTHON, str(NODES / f"{name}.py"), *arguments])
        program.expect("ready")
        return program

    def start(self, text: str, *arguments: str) -> Program:
        """Start a program."""
        path = self._folder / f"program{len(self._programs)}.py"
        path.write_text(text, encoding="utf-8")
        return self._launch([PYTHON, str(path), *arguments])

    def run(self, text: str, *arguments: str) -> str:
        """Run a program to its end; its output. It leaves no thread behind."""
        program = self.start(text, *arguments)
        assert program.end() == 0, program.output
        assert "threads left: []" in program.output, program.output
        return program.output

    def stop(self) -> None:
        """Kill everything and give the domain back. The output of the programs is shown if the test
        fails."""
        for program in self._programs:
            program.kill()
            print(f"--- output of process {program.pid}\n{program.output}")
        self._programs.clear()
        self._lock.close()
