"""SMACH machines on the simulated clock, through the public interface of SMACH's containers.

`attach` wraps the methods of the states below a finished root container: the clock is informed when
a Concurrence forks into threads and when each of them ends, and the world when a state begins. No
SMACH is imported, so machines of SMACH itself and of the bundled runtime work.
"""

import functools
import threading
from collections.abc import Callable, Iterator, Sequence
from typing import Any, TypeAlias

from smachac.sim.clock import TIME_STEP, Clock, Key, Skill

Show: TypeAlias = Callable[[tuple[str, ...], str], None]


def attach(root: Any, clock: Clock, show: Show, name: str) -> None:
    """Put all states below `root`, a container of any SMACH, on `clock`.

    `show` is called with the paths of the active leaves, in the order of their branches, and the
    path of the one that begins, whenever a leaf begins. A leaf with an event `end_of_wait`, as
    SleepState, waits in simulated time. `name` is the path of `root`. The methods are replaced on
    each instance.
    """
    active = _ActiveLeaves(show)
    # Children first: the branch of a child is entered before any other wrapper of its state runs.
    for path, state in reversed(list(_walk(root, name))):
        if isinstance(getattr(state, "end_of_wait", None), threading.Event | _SimulatedWait):
            state.end_of_wait = _SimulatedWait(clock)
        if not hasattr(state, "get_children"):
            _wrap(state, "execute", clock, functools.partial(_leaf, clock, active, path))
        elif _is_concurrence(state):
            _ConcurrenceBranches(clock, active, state)


class _SimulatedWait:
    """An event, as threading.Event, whose `wait` lasts in simulated time."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._is_set = False

    def set(self) -> None:
        """End the wait at the next physics step."""
        self._is_set = True

    def clear(self) -> None:
        """Undo `set`."""
        self._is_set = False

    def wait(self, seconds: float) -> bool:
        """Wait for `seconds` of simulated time or for `set`; whether it was set."""
        return self._clock.run(self._wait(seconds))

    def _wait(self, seconds: float) -> Skill[bool]:
        steps = 0
        while not self._is_set and steps * TIME_STEP < seconds:
            steps += 1
            yield
        return self._is_set


class _ActiveLeaves:
    """The path of the active leaf of every branch."""

    def __init__(self, show: Show) -> None:
        self._show = show
        self._lock = threading.Lock()
        self._paths: dict[Key, str] = {}

    def begin(self, key: Key, path: str) -> None:
        """Record that the branch `key` is in the leaf `path`."""
        with self._lock:
            self._paths[key] = path
            self._show(tuple(self._paths[path] for path in sorted(self._paths)), path)

    def end(self, key: Key) -> None:
        """Remove the branch `key`, which has ended or forks, and all branches below it."""
        with self._lock:
            for row in [path for path in self._paths if path[: len(key)] == key]:
                del self._paths[row]


class _ConcurrenceBranches:
    """A Concurrence, the threads of whose children are branches of the clock.

    Branches and children are matched by the identity of the child, as one state may be the child
    under several labels.
    """

    def __init__(self, clock: Clock, active: _ActiveLeaves, container: Any) -> None:
        self._clock = clock
        self._active = active
        self._container = container
        self._keys: dict[int, list[Key]] = {}
        self._unclaimed: dict[int, list[Key]] = {}
        # The only private name of SMACH used here. In a SMACH without it preemption by a sibling
        # still works, but its simulated time depends on how the threads are scheduled.
        self._has_termination_cb = getattr(container, "_child_termination_cb", None) is not None
        for child in _distinct(container.get_children().values()):
            _wrap(child, "execute", clock, functools.partial(self._child, child))
            if hasattr(child, "request_preempt"):
                _wrap(child, "request_preempt", clock, functools.partial(self._preempt, child))
        _wrap(container, "execute", clock, self._execute)
        if self._has_termination_cb:
            _wrap(container, "_child_termination_cb", clock, self._terminate)

    def _execute(self, original: Callable[..., Any], *args: Any, **kwargs: Any) -> Any:
        children = list(self._container.get_children().values())
        self._active.end(self._clock.current or ())
        with self._clock.fork(len(children)) as keys:
            self._keys, self._unclaimed = {}, {}
            for child, key in zip(children, keys, strict=True):
                self._keys.setdefault(id(child), []).append(key)
                self._unclaimed.setdefault(id(child), []).append(key)
            try:
                return original(*args, **kwargs)
            finally:
                self._active.end(self._clock.current or ())

    def _child(self, child: Any, original: Callable[..., Any], *args: Any, **kwargs: Any) -> Any:
        key = self._claim(child)
        if key is None:
            return original(*args, **kwargs)
        self._clock.enter(key)
        outcome = None
        try:
            outcome = original(*args, **kwargs)
            return outcome
        except BaseException:
            self._expect_preempts()
            raise
        finally:
            # After an outcome the container calls its termination callback next in this thread.
            if outcome is None or not self._has_termination_cb:
                self._leave(key)

    def _claim(self, child: Any) -> Key | None:
        keys = self._unclaimed.get(id(child))
        if not keys or self._clock.current in self._keys.get(id(child), ()):
            return None
        return keys.pop(0)

    def _terminate(self, original: Callable[..., Any], *args: Any, **kwargs: Any) -> Any:
        key = self._clock.current
        stop_others: Any = True
        try:
            stop_others = original(*args, **kwargs)
            return stop_others
        finally:
            if key is not None:
                if stop_others:
                    self._expect_preempts()
                self._leave(key)

    def _expect_preempts(self) -> None:
        for child in _distinct(self._container.get_children().values()):
            # A container does not preempt a child that has a request already.
            if not (hasattr(child, "preempt_requested") and child.preempt_requested()):
                self._clock.expect_preempts(self._keys.get(id(child), ()))

    def _leave(self, key: Key) -> None:
        self._active.end(key)
        self._clock.leave(key)

    def _preempt(self, child: Any, original: Callable[..., Any], *args: Any) -> Any:
        try:
            return original(*args)
        finally:
            for key in self._keys.get(id(child), ()):
                self._clock.preempted(key)


def together(clock: Clock, calls: Sequence[Callable[[], Any]]) -> list[Any]:
    """Call each in a thread of its own as a branch of the clock; see `World.together`."""
    values: list[Any] = [None] * len(calls)
    errors: dict[int, BaseException] = {}

    def work(number: int, key: Key) -> None:
        clock.enter(key)
        try:
            values[number] = calls[number]()
        except BaseException as error:
            errors[number] = error
        finally:
            clock.leave(key)

    with clock.fork(len(calls)) as keys:
        threads = [threading.Thread(target=work, args=pair) for pair in enumerate(keys)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    for number in sorted(errors):
        raise errors[number]
    return values


def _leaf(
    clock: Clock, active: _ActiveLeaves, path: str, original: Callable[..., Any], *args: Any
) -> Any:
    active.begin(clock.current or (), path)
    return original(*args)


def _wrap(state: Any, method: str, clock: Clock, around: Callable[..., Any]) -> None:
    """Wrap a method of this object with `around`; a wrapper of another clock is removed."""
    original = getattr(state, method)
    while getattr(original, "clock", clock) is not clock:
        original = original.__wrapped__
    wrapped = functools.wraps(original)(functools.partial(around, original))
    wrapped.clock = clock  # type: ignore[attr-defined]
    setattr(state, method, wrapped)


def _walk(state: Any, path: str) -> Iterator[tuple[str, Any]]:
    yield path, state
    if hasattr(state, "get_children"):
        for label, child in dict(state.get_children()).items():
            yield from _walk(child, f"{path}/{label}")


def _distinct(states: Any) -> list[Any]:
    return list({id(state): state for state in states}.values())


def _is_concurrence(state: Any) -> bool:
    return any(type_.__name__ == "Concurrence" for type_ in type(state).__mro__)
