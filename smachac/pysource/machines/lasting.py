"""Objects that outlast one turn of a loop: the next turn can find them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from smachac.pysource.machines.heap import Added, Children
from smachac.pysource.machines.values import (
    Arguments,
    Class,
    DictValue,
    Frame,
    Function,
    Instance,
    ListValue,
    Method,
    OneOf,
    OwnSlots,
    Partial,
    Slots,
    Super,
    TupleValue,
)


class Lasting:
    """The slots that the next turn of a loop can find: those that are older than the turn, and
    those of objects to which these lead. `start` is the birth of the turn, `written` what it has
    written: slots, key, the value before and the present one."""

    def __init__(self, start: int, written: Iterable[tuple[Slots, Any, Any, Any]]) -> None:
        self.start = start
        self.todo = [now for slots, _, _, now in written if not self._is_new(slots)]
        self.seen: set[int] = set()
        self.is_complete = False

    def __contains__(self, slots: Slots) -> bool:
        if not self._is_new(slots):
            return True
        if not self.is_complete:
            self._follow()
            self.is_complete = True
        return id(slots) in self.seen

    def _is_new(self, slots: Slots) -> bool:
        return isinstance(slots, OwnSlots) and slots.born > self.start

    def _follow(self) -> None:
        """Visits what older slots lead to. Older objects lead to new ones only by what was
        written."""
        while self.todo:
            part = self.todo.pop()
            match part:
                case OwnSlots():
                    if self._is_new(part) and id(part) not in self.seen:
                        self.seen.add(id(part))
                        self.todo += part.values()
                case ListValue() | DictValue() | Instance():
                    self.todo.append(part.slots)
                case Class() if id(part) not in self.seen:
                    self.seen.add(id(part))
                    self.todo += (*part.slots.values(), part.frame)
                case Function() if id(part) not in self.seen:
                    self.seen.add(id(part))
                    self.todo += (part.frame, *part.defaults, *part.keyword_defaults.values())
                case Frame():
                    self.todo += (part.slots, part.around, part.me)
                case TupleValue(items=items) | OneOf(values=items):
                    self.todo += items
                case Method() | Super():
                    self.todo += (getattr(part, "function", None), part.me)
                case Partial(function=function, arguments=arguments):
                    self.todo += (function, arguments)
                case Arguments(positional=positional, named=named):
                    self.todo += (*positional, *(value for _, value in named))
                case Children(added=added):
                    self.todo += added
                case Added():
                    self.todo += (part.label, part.state, part.transitions, part.remapping)
                case tuple():
                    self.todo += part
                case Mapping():
                    self.todo += part.values()
