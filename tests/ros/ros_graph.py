"""A ROS graph of its own for a test: a master, and programs as processes."""

from __future__ import annotations

import contextlib
import ctypes
import functools
import os
import signal
import subprocess
import threading
import xmlrpc.client
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
NODES = Path(__file__).with_name("nodes")

PYTHON = os.environ.get("SMACHAC_ROS_PYTHON", "/usr/bin/python3")
"""The Python that Debian's ROS belongs to: its compiled parts fit no other version."""

PATIENCE = 120.0
"""Seconds after which what a test waits for will not come, on the slowest machine."""

FAILED_CONNECTIONS = (
    "Could not process inbound connection",
    "Inbound TCP/IP connection failed",
    "Failed to handle inbound connection",
)
"""Warnings of rospy: a subscriber connects after the end of the publisher that the master named, or
ends while it connects. They come at any time, and are not about the program."""

MODULES = "rospy, rosmaster, rosgraph, actionlib, std_srvs.srv, tf2_ros, tf2_geometry_msgs, rosbag"


@functools.cache
def missing() -> str:
    """What keeps live tests from running; '' if nothing does."""
    asked = subprocess.run(
        [PYTHON, "-c", f"import {MODULES}"], capture_output=True, text=True, check=False
    )
    return asked.stderr.strip().rpartition("\n")[2] if asked.returncode else ""


class Program:
    """A process in a group of its own, and the lines that it has printed."""

    def __init__(self, command: list[str], environment: Mapping[str, str]) -> None:
        self.command = " ".join(command)
        self._process = subprocess.Popen(
            command,
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            bufsize=1,
            start_new_session=True,
        )
        self._news = threading.Condition()
        self._lines: list[str] = []
        self._seen = 0
        self._over = False
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    @property
    def pid(self) -> int:
        return self._process.pid

    @property
    def output(self) -> str:
        return "".join(self._lines)

    def _read(self) -> None:
        assert self._process.stdout is not None
        for line in self._process.stdout:
            if any(warning in line for warning in FAILED_CONNECTIONS):
                continue
            with self._news:
                self._lines.append(line)
                self._news.notify_all()
        with self._news:
            self._over = True
            self._news.notify_all()

    def _find(self, text: str) -> str | None:
        while self._seen < len(self._lines):
            self._seen += 1
            if text in self._lines[self._seen - 1]:
                return self._lines[self._seen - 1].strip()
        return None

    def expect(self, text: str) -> str:
        """The next line with this text, waited for."""
        with self._news:
            found: list[str] = []

            def there() -> bool:
                line = self._find(text)
                found.extend([] if line is None else [line])
                return bool(found) or self._over

            self._news.wait_for(there, PATIENCE)
        assert found, f"`{text}` does not come:\n{self.output}"
        return found[0]

    def say(self, text: str) -> None:
        """Write a line to the program."""
        assert self._process.stdin is not None
        self._process.stdin.write(f"{text}\n")
        self._process.stdin.flush()

    def send(self, number: signal.Signals) -> None:
        self._process.send_signal(number)

    def send_aside(self, number: signal.Signals) -> None:
        """Send a signal to another thread than the main one. That goes on waiting then, as it does
        when a signal comes just before it begins to."""
        threads = (int(path.name) for path in Path(f"/proc/{self.pid}/task").iterdir())
        other = next(thread for thread in threads if thread != self.pid)
        assert ctypes.CDLL(None).tgkill(self.pid, other, number) == 0

    def halt(self) -> None:
        """Stop it as it is until it is sent SIGCONT; it has stopped when this returns."""
        self.send(signal.SIGSTOP)
        os.waitid(os.P_PID, self.pid, os.WSTOPPED)

    def end(self) -> int:
        """The exit code, waited for; and all output is there."""
        try:
            code = self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            raise AssertionError(f"the program does not end:\n{self.output}") from None
        self._reader.join(PATIENCE)
        return code

    def kill(self) -> None:
        """End it and all that it started, whatever it does."""
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()
        self._reader.join(PATIENCE)
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        with contextlib.suppress(BrokenPipeError):
            self._process.stdin.close()
        self._process.stdout.close()


class Graph:
    """A master on a port of its own, and the programs that a test starts below it."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._programs: list[Program] = []
        self.environment = {
            name: value
            for name, value in os.environ.items()
            if not name.startswith(("ROS_", "PYTHON"))
        }
        self.environment |= {
            "ROS_IP": "127.0.0.1",
            "ROS_HOME": str(folder / "home"),
            "ROS_LOG_DIR": str(folder / "log"),
            "PYTHONPATH": f"{ROOT}{os.pathsep}{NODES}",
            "PYTHONUNBUFFERED": "1",
            "PYTHONDONTWRITEBYTECODE": "1",
        }
        self._start_master()

    def _start_master(self) -> None:
        """Start the master and wait for its address. `rosmaster -p` takes a port that is free now;
        a node of another test can take it first, and then waits for the rest of a message that a
        client of the master began."""
        self.master = self._launch([PYTHON, str(NODES / "master.py")])
        self.environment["ROS_MASTER_URI"] = self.master.expect("ready").split()[1]

    def ask(self, question: str, *arguments: Any) -> Any:
        """What the master answers."""
        with xmlrpc.client.ServerProxy(self.environment["ROS_MASTER_URI"]) as master:
            code, text, value = getattr(master, question)("/test", *arguments)
        assert code == 1, text
        return value

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

    def simulate(self) -> None:
        """Let the time of nodes that start from now on stand still until `clock` runs."""
        self.ask("setParam", "/use_sim_time", True)

    def run(self, text: str) -> str:
        """Run a program to its end; its output."""
        program = self.start(text)
        assert program.end() == 0, program.output
        return program.output

    def stop(self) -> None:
        """Kill everything; the master, which came first, last. Print what each has printed: pytest
        shows it if the test fails."""
        while self._programs:
            program = self._programs.pop()
            program.kill()
            print(f"--- output of {program.command}:\n{program.output}")


def wait_for(condition: Callable[[], str]) -> str:
    """The first answer that is not empty."""
    pause = threading.Event()
    for _ in range(int(PATIENCE / 0.02)):
        if answer := condition():
            return answer
        pause.wait(0.02)
    raise AssertionError("what was waited for does not come")
