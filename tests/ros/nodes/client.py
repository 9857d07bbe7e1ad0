"""What the programs of the tests share: a node, a machine that runs and can be preempted."""

from __future__ import annotations

import os
import sys
import threading
from typing import Any

import rospy


def node(name: str = "client") -> None:
    """Begin to be a node.

    Its log does not go to /rosout: rospy asks the master before each line of that, and a signal
    that comes meanwhile blocks it for ever.
    """
    rospy.init_node(name, disable_rosout=True)


def say(text: str) -> None:
    """Print a line in one piece, whatever other threads print: `print` writes its end apart."""
    sys.stdout.write(f"{text}\n")


def heed_preempt_requests(machine: Any) -> None:
    """Preempt a machine at each line on stdin."""

    def listen() -> None:
        while line := os.read(0, 100):  # not sys.stdin, whose lock would be held at the end
            if line.strip():
                machine.request_preempt()

    threading.Thread(target=listen, daemon=True).start()


def run(machine: Any, *keys: str) -> None:
    """Run a machine that can be preempted; tell its outcome and what is under these keys."""
    heed_preempt_requests(machine)
    again(machine, *keys)


def again(machine: Any, *keys: str) -> None:
    """Run a machine; tell its outcome and what is under these keys."""
    outcome = machine.execute()
    for key in keys:
        say(f"{key}: {machine.userdata[key]}")
    say(f"outcome: {outcome}")


def wait_for_line() -> None:
    """Wait for a line on stdin."""
    os.read(0, 100)
