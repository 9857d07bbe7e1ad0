"""Recordings: processes of `ros2 bag record`."""

from __future__ import annotations

import shutil
import signal
import subprocess
from collections.abc import Sequence

from smachac.runtime import smach

STOP_LIMIT = 10.0
"""Seconds that a recording has to close its bag, before its process is killed."""


class Recordings:
    """The recordings of a program, by the path of the bag."""

    def __init__(self) -> None:
        self._running: dict[str, subprocess.Popen[bytes]] = {}

    def start(self, file: str, topics: Sequence[str], storage: str | None = None) -> bool:
        """Record topics (none given: all) to a bag; whether the recording could start."""
        command = shutil.which("ros2")
        if command is None or file in self._running:
            cause = "no command ros2" if command is None else "it is recorded already"
            smach.logerr(f"bag '{file}' cannot be recorded: {cause}")
            return False
        options = ["--output", file, *(["--storage", storage] if storage else [])]
        self._running[file] = subprocess.Popen(
            [command, "bag", "record", *options, *(topics or ["--all"])],
            stdin=subprocess.DEVNULL,
            start_new_session=True,  # Ctrl-C in the terminal goes to the machine alone
        )
        return True

    def stop(self, file: str) -> bool:
        """End a recording and wait until its bag is closed; whether there was one."""
        process = self._running.pop(file, None)
        if process is None:
            smach.logerr(f"there is no recording to bag '{file}'")
            return False
        process.send_signal(signal.SIGINT)
        try:
            process.wait(STOP_LIMIT)
        except subprocess.TimeoutExpired:
            smach.logerr(f"the recording to bag '{file}' does not end: it is killed")
            process.kill()
            process.wait()
        return True

    def stop_all(self) -> None:
        """End all recordings."""
        for file in list(self._running):
            self.stop(file)
