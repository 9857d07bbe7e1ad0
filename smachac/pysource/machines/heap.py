"""The store of the partial evaluator: all changes are in a log, so that they can be undone and the
states after the branches of an unknown condition joined."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any, TypeAlias, TypeVar

from smachac.pysource.machines.values import (
    UNKNOWN,
    Const,
    OneOf,
    OwnSlots,
    Slots,
    Value,
    newest,
    one_of,
)
from smachac.records import dataclass, replace

T = TypeVar("T")

_Written: TypeAlias = "dict[tuple[int, Any], tuple[Slots, Any, Any]]"

ABSENT = object()
"""In place of a slot that does not exist."""

Births: TypeAlias = tuple[int, int]
"""The objects that are younger than the first number, and not than the second one."""


class Changes(dict[tuple[int, Any], tuple[Slots, Any, Any]]):
    """The slots that were written, each with its owner, its key and its value. `end` is the birth
    of the youngest object that there is, `others` are those of objects that other branches of
    unknown conditions have made."""

    __slots__ = ("end", "others")

    def __init__(self, end: int, others: tuple[Births, ...]) -> None:
        super().__init__()
        self.end = end
        self.others = others

    def has(self, slots: Slots) -> bool:
        """Whether the object of some slots exists."""
        if not isinstance(slots, OwnSlots):
            return True
        born = slots.born
        return born <= self.end and not any(low < born <= high for low, high in self.others)


@dataclass(frozen=True, slots=True, kw_only=True)
class Added:
    """A state that was added to a container: the arguments of the call, as they were then.
    `possible`: an unknown condition decides whether it is added. `autonomy` are the outcomes for
    which an operator has to decide, each with the level below which that is so."""

    label: Value
    state: Value
    transitions: Value | None
    remapping: Value | None
    span: Any
    kind: str = "add"
    connector: Value | None = None
    loop: Value | None = None
    breaks: Value | None = None
    final: Value | None = None
    possible: bool = False
    autonomy: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class Children:
    """The states of a container, in order; `complete`: there are no others."""

    added: tuple[Added, ...] = ()
    complete: bool = True


class Heap:
    """The log of all writes: the owner of each slot, its key and its value before. `work` is the
    size of what was written, in steps of the evaluator: large collections are copied."""

    def __init__(self) -> None:
        self.log: list[tuple[Slots, Any, Any]] = []
        self.work = 0
        self._logged: dict[tuple[int, Any], list[int]] = {}
        self._marks = [0]
        self._watches: list[Watch] = []
        self.others: list[Births] = []

    def set(self, slots: Slots, key: Any, value: Any) -> None:
        before = slots.get(key, ABSENT)
        self._note(slots, key, before)
        for watch in self._watches:
            watch.see(slots, key, before, value)
        if isinstance(value, tuple | Mapping):
            self.work += len(value) // 64
        slots[key] = value

    def delete(self, slots: Slots, key: Any) -> None:
        if key in slots:
            self._note(slots, key, slots[key])
            del slots[key]

    def _note(self, slots: Slots, key: Any, before: Any) -> None:
        """Logs a write, but only the first one since the last mark."""
        places = self._logged.setdefault((id(slots), key), [])
        while places and not self._is_at(places[-1], slots, key):
            places.pop()
        if not places or places[-1] < self._marks[-1]:
            places.append(len(self.log))
            self.log.append((slots, key, before))

    def _is_at(self, at: int, slots: Slots, key: Any) -> bool:
        return at < len(self.log) and self.log[at][0] is slots and self.log[at][1] == key

    def watch(self, run: Callable[[], T]) -> tuple[T, _Written]:
        """Runs a part of code that can end anywhere: its result, and of each slot of an object that
        was there before all values that it has had."""
        watch = Watch()
        self._watches.append(watch)
        try:
            found = run()
        finally:
            self._watches.remove(watch)
        return found, watch.changes

    def apart(self, run: Callable[[], T]) -> T:
        """Runs code whose writes stay, whatever is undone later: modules are loaded once."""
        kept = self.log, self._logged, self._marks, self._watches
        self.log, self._logged, self._marks, self._watches = [], {}, [0], []
        try:
            return run()
        finally:
            self.log, self._logged, self._marks, self._watches = kept

    def mark(self) -> int:
        """A place in the log to which writes can be undone, until it is released."""
        self._marks.append(len(self.log))
        return len(self.log)

    def release(self, mark: int) -> None:
        """Gives up the last mark: of each slot, the log keeps the first write since the mark
        before it."""
        self._marks.pop()
        since = self.log[mark:]
        del self.log[mark:]
        for slots, key, before in since:
            self._note(slots, key, before)

    def reset(self) -> None:
        """Gives up all marks."""
        self._marks[1:] = []
        self._watches.clear()
        self.others.clear()

    def changes(self, mark: int) -> Changes:
        """The slots that were written since a mark, with their present values."""
        found = Changes(newest(), tuple(self.others))
        for slots, key, _ in self.log[mark:]:
            found[id(slots), key] = slots, key, slots.get(key, ABSENT)
        return found

    def since(self, mark: int) -> Iterator[tuple[Slots, Any, Any, Any]]:
        """The slots that were written since a mark, with the values at the mark and now."""
        seen: set[tuple[int, Any]] = set()
        for slots, key, before in self.log[mark:]:
            if (id(slots), key) not in seen:
                seen.add((id(slots), key))
                yield slots, key, before, slots.get(key, ABSENT)

    def undo(self, mark: int) -> Changes:
        """Restores the state at a mark; the changes since then."""
        found = self.changes(mark)
        for slots, key, before in reversed(self.log[mark:]):
            if before is ABSENT:
                slots.pop(key, None)
            else:
                slots[key] = before
        del self.log[mark:]
        return found

    def apply(self, changes: _Written) -> None:
        for slots, key, value in changes.values():
            if value is ABSENT:
                self.delete(slots, key)
            else:
                self.set(slots, key, value)

    def join(self, states: Iterable[Changes]) -> None:
        """Writes the state that is one of several, each given by its changes of the present one."""
        states = [*states]
        if len(states) == 1:
            self.apply(states[0])
            return
        written: dict[tuple[int, Any], tuple[Slots, Any]] = {}
        for state in states:
            written |= {which: (slots, key) for which, (slots, key, _) in state.items()}
        for which, (slots, key) in written.items():
            now = slots.get(key, ABSENT)
            values = [state[which][2] if which in state else now for state in states
                      if which in state or state.has(slots)]  # fmt: skip
            values = [present(slots, key, value) for value in values]
            self.work += sum(len(v.added) for v in values if isinstance(v, Children)) // 16
            whole = joined(values)
            if whole is ABSENT:
                self.delete(slots, key)
            else:
                self.set(slots, key, whole)


class Watch:
    """The values that slots get in a part of code, those before it included."""

    def __init__(self) -> None:
        self.start = OwnSlots({}).born
        self.changes: _Written = {}

    def see(self, slots: Slots, key: Any, before: Any, value: Any) -> None:
        if isinstance(slots, OwnSlots) and slots.born > self.start:
            return
        which = id(slots), key
        known = self.changes[which][2] if which in self.changes else before
        known = present(slots, key, known)
        self.changes[which] = slots, key, joined([known, value])


def present(slots: Slots, key: Any, value: Any) -> Any:
    """A value; for an attribute that an object lacks, that of its class."""
    if value is ABSENT and isinstance(slots, OwnSlots):
        return slots.inherited(key, ABSENT)
    return value


def joined(values: Iterable[Any]) -> Any:
    """The contents of a slot that are one of several: of containers, all states that one of them
    has; of others, one of the values, or unknown."""
    values = [*values]
    first = values[0]
    if all(value is first or value == first for value in values[1:]):
        return first
    if any(value is ABSENT for value in values):  # a name is used only where it has a value
        return joined([value for value in values if value is not ABSENT])
    if all(isinstance(value, Children) for value in values):
        return _joined_children(values)
    if all(isinstance(value, tuple) for value in values):
        return OneOf(tuple(values)) if len(values) <= 8 else UNKNOWN  # the items of a list
    if all(isinstance(value, Mapping) for value in values):
        return _joined_pairs(values)
    if any(isinstance(value, tuple | Mapping) for value in values):
        return UNKNOWN
    if any(isinstance(value, OneOf) and isinstance(value.values[0], tuple) for value in values):
        return UNKNOWN
    return one_of(value if not isinstance(value, bool) else Const(value) for value in values)


def _joined_pairs(values: list[Mapping[Any, tuple[Value, Value]]]) -> Any:
    """The entries of a dictionary that are one of several: an entry that one of them lacks may be
    absent, so that the whole is not known."""
    keys = values[0].keys()
    if any(value.keys() != keys for value in values[1:]):
        return UNKNOWN
    return {
        key: (pair[0], one_of(value[key][1] for value in values)) for key, pair in values[0].items()
    }


def _joined_children(values: list[Children]) -> Children:
    """The states of all; those that one of the containers lacks are possible."""
    lists = [value.added for value in values]
    same = 0
    for row in zip(*lists, strict=False):
        if any(added is not row[0] for added in row):
            break
        same += 1
    found: dict[int, Added] = {}
    counts: Counter[int] = Counter()
    for added in (added for some in lists for added in some[same:]):
        found[id(added)] = added
        counts[id(added)] += 1
    rest = (
        added if counts[which] == len(values) else replace(added, possible=True)
        for which, added in found.items()
    )
    return Children((*lists[0][:same], *rest), all(value.complete for value in values))
