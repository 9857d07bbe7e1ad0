"""The methods of a state class that a framework calls, and what they do together."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from smachac.pysource.flow import Flow, Flows
from smachac.pysource.functions import is_plain
from smachac.pysource.modules import OwnClass
from smachac.pysource.user_code import UserCode
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
    """The flow of `execute` together with those of the methods around it. A key that an earlier
    method sets is no read of a later one. The keys that are set before an outcome are not known, as
    earlier calls can have set them."""
    if not cycle.repeated:
        return flow
    flows = Flows(own, library)
    before = [*_flows_of(flows, own, cycle.before)]
    after = [*_flows_of(flows, own, cycle.after)]
    others = [*_flows_of(flows, own, cycle.others)]
    reads = [word for part in before for word in part.reads]
    known = {word.text for part in before for word in part.writes}
    reads += [word for word in flow.reads if word.text not in known]
    known |= {word.text for word in flow.writes}
    reads += [word for part in after for word in part.reads if word.text not in known]
    return replace(
        flow,
        endings=tuple(replace(ending, written=None, skipped=()) for ending in flow.endings
                      if ending.outcome.text != "None"),
        complete=flow.complete,
        silent=False,
        always_silent=False,
        open_end=None,
        in_loop=None,
        reads=tuple(reads),
        writes=(*flow.writes, *(word for part in (*before, *after, *others)
                                for word in part.writes)),
    )  # fmt: skip


def _flows_of(flows: Flows, own: OwnClass, names: Sequence[str]) -> Iterator[Flow]:
    """The flows of some methods that get the userdata."""
    for name in names:
        found = own.method(name)
        if found is None or not is_plain(found[1]) or len(found[1].args.args) != 2:
            continue
        module, function = found
        flow = flows.of(module, function, function.args.args[1].arg)
        if flow is not None:
            yield flow
