"""SMACH containers on the simulated clock, by their public interface and without their help.

`attach` is called once on the finished root container. It tells the clock when a Concurrence
splits into threads and when each of them ends, and the world which states are active.
"""

import functools
import threading
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from smachac.sim.clock import Clock, Key


def attach(root: Any, clock: Clock, show: Callable[[tuple[str, ...]], None], name: str) -> None:
    """Put all states below `root`, a container of any SMACH, on `clock`.

    `show` gets the paths of the active leaves, in the order of their branches, whenever one
    begins. Each state's `execute` is replaced on the instance.
    """
    active = Active(show)
    # Children first: a branch has to be entered before what its state does at the start.
    for path, state in reversed(list(_walk(root, name))):
        if not hasattr(state, "get_children"):
            _wrap(state, "execute", clock, functools.partial(_leaf, clock, active, path))
        elif _is_concurrence(state):
            Split(clock, active, state)


class Active:
    """The active leaf of every branch."""

    def __init__(self, show: Callable[[tuple[str, ...]], None]) -> None:
        self._show = show
        self._lock = threading.Lock()
        self._paths: dict[Key, str] = {}

    def begin(self, key: Key, path: str) -> None:
        """The branch `key` is in the leaf `path` now."""
        with self._lock:
            self._paths[key] = path
            self._show(tuple(self._paths[each] for each in sorted(self._paths)))

    def end(self, key: Key) -> None:
        """The branch `key` is over, or is split further."""
        with self._lock:
            for each in [each for each in self._paths if each[: len(key)] == key]:
                del self._paths[each]


class Split:
    """One Concurrence: its children's threads are branches of the clock."""

    def __init__(self, clock: Clock, active: Active, container: Any) -> None:
        self._clock = clock
        self._active = active
        self._container = container
        self._keys: dict[int, list[Key]] = {}
        self._unclaimed: dict[int, list[Key]] = {}
        # The one private name: where it is missing, preemption by a sibling still works, but how
        # far the others get until then depends on the threads.
        self._judged = getattr(container, "_child_termination_cb", None) is not None
        for child in _different(container.get_children().values()):
            _wrap(child, "execute", clock, functools.partial(self._child, child))
            if hasattr(child, "request_preempt"):
                _wrap(child, "request_preempt", clock, functools.partial(self._preempt, child))
        _wrap(container, "execute", clock, self._execute)
        if self._judged:
            _wrap(container, "_child_termination_cb", clock, self._judge)

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
            # With an outcome the container's own verdict comes next, in this thread.
            if outcome is None or not self._judged:
                self._leave(key)

    def _claim(self, child: Any) -> Key | None:
        keys = self._unclaimed.get(id(child))
        if not keys or self._clock.current in self._keys.get(id(child), ()):
            return None
        return keys.pop(0)

    def _judge(self, original: Callable[..., Any], *args: Any, **kwargs: Any) -> Any:
        key = self._clock.current
        verdict: Any = True
        try:
            verdict = original(*args, **kwargs)
            return verdict
        finally:
            if key is not None:
                if verdict:
                    self._expect_preempts()
                self._leave(key)

    def _expect_preempts(self) -> None:
        for child in _different(self._container.get_children().values()):
            # A container tells nobody twice.
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
    """Call each in a thread of its own as a branch; see World.together."""
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
        threads = [threading.Thread(target=work, args=each) for each in enumerate(keys)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    for number in sorted(errors):
        raise errors[number]
    return values


def _leaf(clock: Clock, active: Active, path: str, original: Callable[..., Any], *args: Any) -> Any:
    active.begin(clock.current or (), path)
    return original(*args)


def _wrap(state: Any, method: str, clock: Clock, around: Callable[..., Any]) -> None:
    """Put `around` about a method of this one object; what an earlier world put there goes."""
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


def _different(states: Any) -> list[Any]:
    return list({id(state): state for state in states}.values())


def _is_concurrence(state: Any) -> bool:
    return any(each.__name__ == "Concurrence" for each in type(state).__mro__)
