"""The one stepper: it alone moves simulated time, and only when every live branch waits for it.

A skill is a generator that yields once per physics step. A thread hands its skill over with `run`
and waits; the thread that finds everybody waiting does the stepping for all. So what happens, and
when in simulated time, does not depend on how the threads are scheduled.
"""

import contextlib
import threading
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from typing import Any, TypeAlias, TypeVar

T = TypeVar("T")

Skill: TypeAlias = Generator[None, None, T]
Key: TypeAlias = tuple[int, ...]
"""A branch: its place among its siblings, after the key of the branch they fork from. Skills
advance in the order of the keys."""

_GUEST = 1 << 30
_SLICES = 10


class _Job:
    """A skill handed over, and in the end its value or its error."""

    __slots__ = ("advanced", "done", "error", "skill", "value")

    def __init__(self, skill: Skill[Any]) -> None:
        self.skill = skill
        self.advanced = False
        self.done = False
        self.value: Any = None
        self.error: BaseException | None = None

    def advance(self) -> None:
        """Go on to the next yield, or to the end."""
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
    """Branches that run together while the branch they come from stands still."""

    def __init__(self, parent: Key | None, keys: Sequence[Key]) -> None:
        self.parent = parent
        self.open = set(keys)
        self.told: set[Key] = set()


class Clock:
    """Lockstep over threads. `step` makes one physics step.

    A thread without a branch is a guest: time waits for it only while a skill of its own runs.
    A live branch that stays away for `patience` wall seconds (it sleeps, or waits for something
    that is not simulated) is left behind and named to `left_behind`; it counts again as soon as it
    hands over a skill. Waiting for it would stop the world for good.
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
        self._promised: set[Key] = set()
        self._starting: set[Key] = set()
        self._stepping = False
        self._guests = 0
        self._beats = 0
        self._mine = threading.local()

    # Skills

    def run(self, skill: Skill[T]) -> T:
        """Run a skill to its end in simulated time and return its value, or raise its error."""
        job = _Job(skill)
        key = self._hand_over(job)
        try:
            while not job.done:
                if self._take_turn(job):
                    self._drive(job)
        finally:
            self._take_back(key)
            # Another thread may be in it just now, when this one was interrupted.
            with contextlib.suppress(ValueError):
                skill.close()
        if job.error is not None:
            raise job.error
        value: T = job.value
        return value

    def _hand_over(self, job: _Job) -> Key:
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

    def _take_back(self, key: Key) -> None:
        with self._changed:
            self._waiting.pop(key, None)
            self._changed.notify_all()

    def _take_turn(self, job: _Job) -> bool:
        """Wait for something to do; true when this thread is to step for all."""
        with self._changed:
            if job.done:
                return False
            if not self._stepping and self._ready():
                self._stepping = True
                return True
            self._wait()
            return False

    def _ready(self) -> bool:
        return not self._promised and self._live <= self._waiting.keys()

    def _absent(self) -> list[Key]:
        return sorted(self._live - self._waiting.keys())

    def _wait(self) -> None:
        """Wait for a change; when there is none for too long, leave behind whom all wait for."""
        beat = self._beats
        # In slices: a process that was stopped meanwhile has not waited, it only looks so.
        for _ in range(_SLICES):
            woken = self._changed.wait(self._patience / _SLICES)
            if woken or beat != self._beats or self._stepping:
                return
        lost = [key for key in self._absent() if key not in self._starting]
        self._live.difference_update(lost)
        self._promised.clear()
        self._changed.notify_all()
        for key in lost:
            self._left_behind(key)

    def _drive(self, mine: _Job) -> None:
        try:
            while not mine.done:
                jobs = self._crew()
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
        """Take every skill to its next yield; false as soon as one ends instead.

        Then its thread goes first: what it does next comes before the branches after it.
        """
        for job in jobs:
            if not job.advanced:
                job.advance()
                if job.done:
                    self._dismiss()
                    return False
        return True

    def _crew(self) -> list[_Job]:
        """The skills that run, in the order of their branches; none while somebody is missing."""
        with self._changed:
            self._beats += 1
            if not self._ready():
                return []
            return [job for _, job in sorted(self._waiting.items(), key=lambda item: item[0])]

    def _dismiss(self) -> None:
        """Let the threads of ended skills go on."""
        with self._changed:
            for key in [key for key, job in self._waiting.items() if job.done]:
                del self._waiting[key]
            self._changed.notify_all()

    # Branches

    @property
    def current(self) -> Key | None:
        """The branch this thread is in, None for a guest."""
        key: Key | None = getattr(self._mine, "key", None)
        return key

    @contextlib.contextmanager
    def fork(self, count: int) -> Iterator[tuple[Key, ...]]:
        """Split this thread's branch into `count` branches until the end of the block.

        Time stands still until each of them waits in a skill or has left.
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
        """This thread is the branch `key` from now on.

        It goes on when the branches before it wait in a skill or have left: so branches also begin
        one after the other, and what they share they touch in a fixed order.
        """
        self._mine.key = key
        with self._changed:
            self._starting.add(key)
            try:
                while any(each < key for each in self._absent()):
                    self._wait()
            finally:
                self._starting.discard(key)

    def leave(self, key: Key) -> None:
        """The branch `key` has ended; after the last of a fork the one before lives on."""
        if self.current == key:
            self._mine.key = None
        with self._changed:
            fork = self._forks.pop(key, None)
            if fork is None:
                return
            self._live.discard(key)
            self._promised.discard(key)
            fork.open.discard(key)
            if not fork.open and fork.parent in self._forks:
                self._live.add(fork.parent)
            self._changed.notify_all()

    # Preemption

    def expect_preempts(self, keys: Iterable[Key]) -> None:
        """Stand still until each of these branches has been told to stop, or has left.

        A container asks its children to stop from a thread of its own; without this, how far they
        get until then would be a matter of luck.
        """
        with self._changed:
            for key in keys:
                fork = self._forks.get(key)
                if fork is not None and key not in fork.told and key != self.current:
                    self._promised.add(key)

    def preempted(self, key: Key) -> None:
        """The branch `key` has been told to stop."""
        with self._changed:
            fork = self._forks.get(key)
            if fork is not None:
                fork.told.add(key)
            self._promised.discard(key)
            self._changed.notify_all()
