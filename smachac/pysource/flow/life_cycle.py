"""The methods of a state class that a framework calls, and what they do together."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import replace

from smachac.diagnostics.source import Word
from smachac.pysource.flow.flow import Flow, Flows
from smachac.pysource.modules.functions import is_plain
from smachac.pysource.modules.modules import OwnClass
from smachac.pysource.modules.user_code import UserCode
from smachac.records import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class LifeCycle:
    """The methods with userdata that a framework calls around `execute`: `before` and `after` it,
    and `others` at other moments. `repeated`: `execute` is called again until it returns an
    outcome, and None is none."""

    before: tuple[str, ...] = ()
    after: tuple[str, ...] = ()
    others: tuple[str, ...] = ()
    repeated: bool = False


EXECUTE_ONLY = LifeCycle()
"""The life cycle of states of which only `execute` gets the userdata, once."""


def in_cycle(flow: Flow, own: OwnClass, library: UserCode, cycle: LifeCycle) -> Flow:
    """The flow of `execute` together with those of the methods around it. A state can read what its
    code has set before, also if it is no input: such reads are left out. So are writes by item,
    `userdata["key"] = ...`, for which the key need not be an output. The keys that are set before
    an outcome are not known, as earlier calls can have set them."""
    if not cycle.repeated:
        return flow
    flows = Flows(own, library)
    parts = [(name, _flow_of(flows, own, name)) for name in (*cycle.before, *cycle.after)]
    parts.insert(len(cycle.before), ("execute", flow))
    reads: list[Word] = []
    known: set[str] = set()
    for name, part in parts:
        reads += _reads_before_writes(part, known, _lines(own, name))
        known |= {word.text for word in part.writes} | (part.written or frozenset())
    others = [_flow_of(flows, own, name) for name in cycle.others]
    writes = [word for part in (*(part for _, part in parts), *others) for word in part.writes
              if word.span.text == word.text]  # fmt: skip
    endings = [replace(ending, written=None, skipped=())
               for ending in flow.endings if ending.outcome.text != "None"]  # fmt: skip
    return replace(
        flow, endings=tuple(endings), silent=False, always_silent=False, open_end=None,
        in_loop=None, reads=tuple(reads), writes=tuple(writes),
    )  # fmt: skip


def _flow_of(flows: Flows, own: OwnClass, name: str) -> Flow:
    """The flow of a method that gets the userdata."""
    found = own.method(name)
    if found is None or not is_plain(found[1]) or len(found[1].args.args) != 2:
        return Flow()
    module, function = found
    return flows.of(module, function, function.args.args[1].arg) or Flow()


def _reads_before_writes(flow: Flow, known: Collection[str], lines: range) -> Iterator[Word]:
    """The reads of keys that no code before can set: neither an earlier method, which sets those in
    `known`, nor a line before in the method, which has some `lines`, nor code that it calls."""
    if flow.written is None:
        return
    for word in flow.reads:
        set_at = [other.span.line for other in flow.writes if other.text == word.text]
        is_here = all(line in lines for line in (word.span.line, *set_at))
        is_first = is_here and word.span.line <= min(set_at, default=0)
        if word.text not in known and (is_first or word.text not in flow.written):
            yield word


def _lines(own: OwnClass, name: str) -> range:
    """The lines of a method."""
    found = own.method(name)
    return range(found[1].lineno, (found[1].end_lineno or 0) + 1) if found else range(0)
