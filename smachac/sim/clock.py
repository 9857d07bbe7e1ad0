"""The simulated clock: skills in several threads advance in lockstep with the physics.

A skill is a generator that yields once per physics step. A thread submits its skill with `run` and
waits. As soon as every live branch waits, one of the waiting threads steps the physics and advances
all skills. So events and their simulated times do not depend on how the threads are scheduled.
"""

import contextlib
import threading
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from typing import Any, TypeAlias, TypeVar

T = TypeVar("T")

TIME_STEP = 1 / 240
"""Length of a physics step (s); 1/120 to 1/1000 work, with 1/60 grasps are lost."""

Skill: TypeAlias = Generator[None, None, T]
Key: TypeAlias = tuple[int, ...]
"""A branch: the key of the branch that it forks from, then its number among its siblings. Skills
advance in the order of the keys."""

_GUEST = 1 << 30
"""First number in the key of a thread without a branch: such threads come after all branches."""
_SLICES = 10
"""Number of waits that `patience` is divided into."""


class _Job:
    """A submitted skill, and once it is done its value or its error."""

    __slots__ = ("advanced", "done", "error", "skill", "value")

    def __init__(self, skill: Skill[Any]) -> None:
        self.skill = skill
        self.advanced = False
        self.done = False
        self.value: Any = None
        self.error: BaseException | None = None

    def advance(self) -> None:
        """Run the skill to its next yield, or to its end."""
        try:
            next(self.skill)
            self.advanced = True
        except StopIteration as end:
            self.value, self.done = end.value, True
        except BaseException as error:
            self.error, self.done = error, True
            if not isinstance(error, Exception):
                raise


class _Fork:
    """Branches that run together while the branch `parent` waits for them.

    Attributes:
        open: the branches that have not left.
        preempted: the branches that have a preempt request.
    """

    def __init__(self, parent: Key | None, keys: Sequence[Key]) -> None:
        self.parent = parent
        self.open = set(keys)
        self.preempted: set[Key] = set()


class Clock:
    """Lockstep of threads. `step` makes one physics step.

    Simulated time waits for a thread without a branch (a guest) only while its own skill runs.
    A live branch that submits no skill for `patience` seconds of wall time (it sleeps, or waits for
    something outside the simulation) is left behind: time no longer waits for it, and `left_behind`
    is called with its key. It counts again as soon as it submits a skill. Without this limit the
    simulation would stop for ever.
    """

    def __init__(
        self,
        step: Callable[[], None],
        *,
        patience: float = 5.0,
        left_behind: Callable[[Key], None] = lambda key: None,
    ) -> None:
        self._step = step
        self._patience = patience
        self._left_behind = left_behind
        self._changed = threading.Condition()
        self._live: set[Key] = set()
        self._waiting: dict[Key, _Job] = {}
        self._forks: dict[Key, _Fork] = {}
        self._expected_preempts: set[Key] = set()
        self._starting: set[Key] = set()
        self._stepping = False
        self._guests = 0
        self._rounds = 0
        self._thread = threading.local()

    # Skills

    def run(self, skill: Skill[T]) -> T:
        """Run a skill to its end in simulated time and return its value, or raise its error."""
        job = _Job(skill)
        key = self._submit(job)
        try:
            while not job.done:
                if self._take_turn(job):
                    self._step_for_all(job)
        finally:
            self._withdraw(key)
            # After an interrupt of this thread another one may be running the generator.
            with contextlib.suppress(ValueError):
                skill.close()
        if job.error is not None:
            raise job.error
        value: T = job.value
        return value

    def _submit(self, job: _Job) -> Key:
        with self._changed:
            key = self.current
            if key is None:
                self._guests += 1
                key = (_GUEST, self._guests)
            elif key in self._forks:
                self._live.add(key)
            self._waiting[key] = job
            self._changed.notify_all()
            return key

    def _withdraw(self, key: Key) -> None:
        with self._changed:
            self._waiting.pop(key, None)
            self._changed.notify_all()

    def _take_turn(self, job: _Job) -> bool:
        """Wait for a change; True if this thread is to step for all threads."""
        with self._changed:
            if job.done:
                return False
            if not self._stepping and self._ready():
                self._stepping = True
                return True
            self._wait()
            return False

    def _ready(self) -> bool:
        return not self._expected_preempts and self._live <= self._waiting.keys()

    def _absent(self) -> list[Key]:
        return sorted(self._live - self._waiting.keys())

    def _wait(self) -> None:
        """Wait for a change; after `patience` without one, leave the absent branches behind."""
        round_ = self._rounds
        # In slices: the time in which the whole process was suspended counts as one slice only.
        for _ in range(_SLICES):
            woken = self._changed.wait(self._patience / _SLICES)
            if woken or round_ != self._rounds or self._stepping:
                return
        lost = [key for key in self._absent() if key not in self._starting]
        self._live.difference_update(lost)
        self._expected_preempts.clear()
        self._changed.notify_all()
        for key in lost:
            self._left_behind(key)

    def _step_for_all(self, own: _Job) -> None:
        """Step the physics and advance all skills, until the skill `own` of this thread is done."""
        try:
            while not own.done:
                jobs = self._runnable_jobs()
                if not jobs:
                    return
                if self._advance(jobs):
                    self._step()
                    for job in jobs:
                        job.advanced = False
        finally:
            with self._changed:
                self._stepping = False
                self._changed.notify_all()

    def _advance(self, jobs: list[_Job]) -> bool:
        """Advance every skill to its next yield; False as soon as one ends.

        The thread of an ended skill then continues before the skills of later branches advance.
        """
        for job in jobs:
            if not job.advanced:
                job.advance()
                if job.done:
                    self._release_finished()
                    return False
        return True

    def _runnable_jobs(self) -> list[_Job]:
        """The submitted skills in the order of their branches; none while a branch is absent."""
        with self._changed:
            self._rounds += 1
            if not self._ready():
                return []
            return [job for _, job in sorted(self._waiting.items(), key=lambda item: item[0])]

    def _release_finished(self) -> None:
        """Wake the threads whose skills have ended."""
        with self._changed:
            for key in [key for key, job in self._waiting.items() if job.done]:
                del self._waiting[key]
            self._changed.notify_all()

    # Branches

    @property
    def current(self) -> Key | None:
        """The branch of this thread; None for a guest."""
        key: Key | None = getattr(self._thread, "key", None)
        return key

    @contextlib.contextmanager
    def fork(self, count: int) -> Iterator[tuple[Key, ...]]:
        """Split this thread's branch into `count` branches until the end of the block.

        Simulated time does not advance until each of them has submitted a skill or has left.
        """
        parent = self.current
        keys = tuple((*(parent or ()), k) for k in range(count))
        fork = _Fork(parent, keys)
        with self._changed:
            self._forks.update(dict.fromkeys(keys, fork))
            self._live.update(keys)
            self._live.discard(parent or ())
        try:
            yield keys
        finally:
            for key in keys:
                self.leave(key)

    def enter(self, key: Key) -> None:
        """Make this thread the branch `key`.

        Returns when every earlier branch has submitted a skill or has left. So branches begin one
        after the other, and access what they share in a fixed order.
        """
        self._thread.key = key
        with self._changed:
            self._starting.add(key)
            try:
                while any(row < key for row in self._absent()):
                    self._wait()
            finally:
                self._starting.discard(key)

    def leave(self, key: Key) -> None:
        """End the branch `key`; the parent branch is live again after its last child."""
        if self.current == key:
            self._thread.key = None
        with self._changed:
            fork = self._forks.pop(key, None)
            if fork is None:
                return
            self._live.discard(key)
            self._expected_preempts.discard(key)
            fork.open.discard(key)
            if not fork.open and fork.parent in self._forks:
                self._live.add(fork.parent)
            self._changed.notify_all()

    # Preemption

    def expect_preempts(self, keys: Iterable[Key]) -> None:
        """Stop simulated time until each of these branches has a preempt request, or has left.

        A container preempts its children from a thread of its own. Without this wait, the simulated
        time of the request would depend on how the threads are scheduled.
        """
        with self._changed:
            for key in keys:
                fork = self._forks.get(key)
                if fork is not None and key not in fork.preempted and key != self.current:
                    self._expected_preempts.add(key)

    def preempted(self, key: Key) -> None:
        """Record that the branch `key` has a preempt request."""
        with self._changed:
            fork = self._forks.get(key)
            if fork is not None:
                fork.preempted.add(key)
            self._expected_preempts.discard(key)
            self._changed.notify_all()
