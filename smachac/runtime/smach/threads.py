"""The threads of one execution of a concurrence, and what they share."""

from __future__ import annotations

import threading
import traceback
from collections.abc import Callable, Iterable

from smachac.runtime import smach

_POLL = 0.1
"""Seconds between two looks at the shutdown check while children run."""


class Branches:
    """One thread for each child, all released together.

    Attributes:
        outcomes: label -> outcome; None while the child runs, or if it ended with none.
        active: the labels of the children that have not ended with an outcome.
        failure: the first (label, error) that left a branch, or None.
        ending: held while a child's end is recorded and judged, so one at a time.
        told: whether preempt requests from outside reached the children.
    """

    def __init__(self, labels: Iterable[str], run: Callable[[Branches, str], None]) -> None:
        self.outcomes: dict[str, str | None] = dict.fromkeys(labels)
        self.active = dict.fromkeys(self.outcomes)
        self.failure: tuple[str, BaseException] | None = None
        self.ending = threading.Lock()
        self.told = False
        self._run = run
        self._threads: list[threading.Thread] = []
        self._gate = threading.Event()
        self._aborted = False
        self._changed = threading.Condition()
        self._alive = 0
        self._requested = False
        self._stopping = self._stopped = False

    def start(self) -> None:
        """Make the threads; they wait until `release` or `abort`."""
        for label in self.outcomes:
            thread = threading.Thread(target=self._branch, args=(label,), name=f"branch {label}")
            thread.start()
            self._threads.append(thread)
            self._alive += 1

    def release(self) -> None:
        """Let the children run."""
        self._gate.set()

    def abort(self) -> bool:
        """End the threads if they still wait; whether the children had been released before."""
        released = self._gate.is_set()
        self._aborted = not released
        self._gate.set()
        return released

    def join(self) -> None:
        """Wait for the threads to be gone."""
        for thread in self._threads:
            thread.join()

    def _branch(self, label: str) -> None:
        self._gate.wait()
        try:
            if not self._aborted:
                self._run(self, label)
        except BaseException as error:
            self._fail(label, error)
        finally:
            with self._changed:
                self._alive -= 1
                self._changed.notify_all()

    def _fail(self, label: str, error: BaseException) -> None:
        smach.logerr(f"branch '{label}' failed:\n{traceback.format_exc()}")
        with self._changed:
            if self.failure is None:
                self.failure = (label, error)
        self.stop()

    def request(self) -> None:
        """Have the running children preempted, as somebody outside asks."""
        with self._changed:
            self._requested = True
            self._changed.notify_all()

    def stop(self) -> None:
        """Have the running children preempted, once, as the concurrence itself ends them."""
        with self._changed:
            self._stopping = True
            self._changed.notify_all()

    def take(self) -> bool:
        """Whether the children are to be preempted now; the request counts as passed on."""
        with self._changed:
            return self._take()

    def wait(self) -> bool:
        """Wait until the children are to be preempted (True) or all have ended (False)."""
        with self._changed:
            while self._alive:
                if smach.is_shutdown():
                    self._stopping = True
                if self._take():
                    return True
                self._changed.wait(_POLL)
            return False

    def _take(self) -> bool:
        due = self._requested or (self._stopping and not self._stopped)
        self.told = self.told or self._requested
        self._requested = False
        self._stopped = self._stopping
        return due

    def answered(self) -> bool:
        """Whether every request from outside was passed on to children."""
        return self.told and not self._requested
