"""The threads of one execution of a concurrence, and their shared state."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable

from smachac.runtime.smach import settings
from smachac.runtime.smach.failures import one_line

_POLL_INTERVAL = 0.1
"""Seconds between two calls of the shutdown check while children run."""


class Branches:
    """The branches of a concurrence: one thread for each child, all released together.

    Attributes:
        outcomes: label -> outcome; None while the child runs, or if it ended with none.
        active: the labels of the children that have not ended with an outcome.
        failure: (label, exception) of the first branch that raised, or None.
        ending: held while the end of a child is recorded and the termination callback runs.
        passed_on: whether a preempt request from outside was passed on to the children.
    """

    def __init__(self, labels: Iterable[str], run: Callable[[Branches, str], None]) -> None:
        self.outcomes: dict[str, str | None] = dict.fromkeys(labels)
        self.active = dict.fromkeys(self.outcomes)
        self.failure: tuple[str, BaseException] | None = None
        self.ending = threading.Lock()
        self.passed_on = False
        self._run = run
        self._threads: list[threading.Thread] = []
        self._gate = threading.Event()
        self._aborted = False
        self._changed = threading.Condition()
        self._alive = 0
        self._requested = False
        self._stopping = self._stopped = False

    def start(self) -> None:
        """Start the threads; they wait for `release` or `abort`."""
        for label in self.outcomes:
            thread = threading.Thread(target=self._branch, args=(label,), name=f"branch {label}")
            thread.start()
            self._threads.append(thread)
            self._alive += 1

    def release(self) -> None:
        """Let the threads run the children."""
        self._gate.set()

    def abort(self) -> bool:
        """End the threads if they were not released; whether they were."""
        released = self._gate.is_set()
        self._aborted = not released
        self._gate.set()
        return released

    def join(self) -> None:
        """Wait for the end of all threads."""
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
        with self._changed:
            is_first = self.failure is None
            if self.failure is None:
                self.failure = (label, error)
        if not is_first or settings.compat:
            settings.logerr(f"branch '{label}' failed: {one_line(error)}")
        else:
            settings.loginfo(f"branch '{label}' failed: the others are requested to end")
        self.stop()

    def request(self) -> None:
        """Add a preempt request from outside for the running children."""
        with self._changed:
            self._requested = True
            self._changed.notify_all()

    def take_over(self) -> bool:
        """Whether the children run, so that a request from outside can be passed on at once; it
        then counts as passed on."""
        with self._changed:
            released = self._gate.is_set() and not self._aborted
            self.passed_on = self.passed_on or released
            return released

    def stop(self) -> None:
        """Add a preempt request of the concurrence itself; only the first one counts, and none
        after a request from outside, which has reached all children."""
        with self._changed:
            self._stopping = not self.passed_on
            self._changed.notify_all()

    def take_request(self) -> bool:
        """Whether there is a request to pass on to the children; it then counts as passed on."""
        with self._changed:
            return self._take_request()

    def wait(self) -> bool:
        """Wait for a request to pass on (True) or the end of all children (False)."""
        with self._changed:
            while self._alive:
                if settings.is_shutdown():
                    self._stopping = True
                if self._take_request():
                    return True
                self._changed.wait(_POLL_INTERVAL)
            return False

    def _take_request(self) -> bool:
        due = self._requested or (self._stopping and not self._stopped)
        self.passed_on = self.passed_on or self._requested
        self._requested = False
        self._stopped = self._stopping
        return due

    def answered(self) -> bool:
        """Whether there were requests from outside and all were passed on to the children."""
        return self.passed_on and not self._requested
