"""Stop signals: machines are preempted while the node still works."""

from __future__ import annotations

import signal
import sys
import threading
import time
from typing import Any

from smachac.runtime import smach
from smachac.runtime.signals import StopSignals, end_now
from smachac.runtime.smach_ros2 import ros

GRACE = 5.0
"""Seconds that a machine has to end after a stop request, before rclpy is shut down."""


class PreemptHandler(StopSignals):
    """The handler of the stop signals that preempts machines.

    The first signal preempts the machines, also those that are added later; the second one ends
    the program at once.

    Attributes:
        grace: seconds that the machines have to end.
        shuts_down: whether rclpy is shut down when machines have ended that other threads execute.
        is_executing: whether the program is about to execute a machine, or executes one.
    """

    def __init__(self, context: Any, shuts_down: bool = False) -> None:
        super().__init__(self._stop_machines, end_now)
        self.grace = GRACE
        self.is_executing = False
        self._machines: list[Any] = []
        self._signalled = False
        self._changing = threading.Lock()
        self._context = context
        self.shuts_down = shuts_down

    def add(self, machine: Any) -> None:
        """Preempt this machine too; at once if a signal came before."""
        with self._changing:
            self._machines.append(machine)
            is_late = self._signalled
        if is_late:
            machine.request_preempt()

    def discard(self, machine: Any) -> None:
        """Do not preempt this machine any more."""
        with self._changing:
            self._machines = [other for other in self._machines if other is not machine]

    def remove(self, limit: float | None = None) -> None:
        """Restore the handlers that were there before, and wait for the end of the machines."""
        super().remove(2 * self.grace if limit is None else limit)

    def _stop_machines(self) -> None:
        """Preempt the machines, and shut rclpy down if nothing else does."""
        with self._changing:
            self._signalled = True
            machines = list(self._machines)
        main = threading.main_thread().ident
        is_main = any(is_executed_by(main, machine) for machine in machines)
        self._preempt(machines)
        if self.shuts_down and not is_main:
            self._context.try_shutdown()

    def _preempt(self, machines: list[Any]) -> None:
        """Preempt the machines and wait for their end; shut rclpy down after the grace time."""
        for machine in machines:
            machine.request_preempt()
        end = time.monotonic() + self.grace
        while self._context.ok() and (self.is_executing or any(map(_is_running, machines))):
            if time.monotonic() > end:
                smach.logwarn(
                    f"the state machine did not end within {self.grace:g} s: the node shuts down"
                )
                self._context.try_shutdown()
                return
            time.sleep(0.02)


def _is_running(machine: Any) -> bool:
    return bool(machine.is_running())


def is_executed_by(thread: int | None, container: Any) -> bool:
    """Whether a thread executes the container, somewhere in its stack."""
    frame: Any = sys._current_frames().get(thread or 0)
    while frame is not None:
        if frame.f_code.co_name == "execute" and frame.f_locals.get("self") is container:
            return True
        frame = frame.f_back
    return False


def set_preempt_handler(sc: Any) -> None:
    """Preempt a container at a stop signal, and when rclpy is shut down.

    At a signal the container is preempted while the node still works, so that goals are cancelled.
    rclpy is shut down after its end, which ends `rclpy.spin`; if the main thread itself executes
    the container, the program continues after `execute` instead. The handlers of rclpy, which shut
    it down at once, are removed. A handler that the program set for SIGINT is kept.
    """
    context = ros.rclpy.get_default_context()

    def at_shutdown() -> None:
        if sc.is_running():
            sc.request_preempt()

    context.on_shutdown(at_shutdown)
    known = signal.getsignal(signal.SIGINT)
    if isinstance(known, PreemptHandler):
        known.add(sc)
    elif (
        known is signal.default_int_handler
        and threading.current_thread() is threading.main_thread()
    ):
        ros.load("rclpy.signals").uninstall_signal_handlers()
        handler = PreemptHandler(context, shuts_down=True)
        handler.add(sc)
        handler.install()
