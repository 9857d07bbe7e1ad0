"""The typed state graph: what a script means, whatever the text looked like.

Values are frozen; spans say where a thing was written and do not count in equality. A node is
named by its path, `sm/PICK_BLOCK/OPEN_GRIPPER` (see walk.py). The graph is total: a transition to
nowhere stays in it, for the rules to find.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal, NamedTuple, NewType, TypeAlias

from smachac.diagnostics.source import NOWHERE, Span, Word
from smachac.ir.robot import Robot
from smachac.ir.types import ANY, Type


@dataclass(frozen=True, slots=True, kw_only=True)
class Expression:
    """Code over userdata, kept as written: a portable expression or Python (language.md)."""

    text: str
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Struct:
    """A mapping inside a value, in the order of the script."""

    entries: tuple[tuple[str, Data], ...]


Data: TypeAlias = "bool | int | float | str | Expression | Struct | tuple[Data, ...] | None"
"""What a value is made of; a YAML list is a tuple."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Value:
    """A constant of the script, with expressions anywhere in it."""

    data: Data
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Variable:
    """A variable of a state type, as the script sets it, with the type that the interface says."""

    name: str
    value: Value
    type: Type = ANY
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Key:
    """A typed userdata key that a state or container declares."""

    name: str
    type: Type = ANY
    doc: str = ""
    span: Span = field(compare=False, repr=False)


class Given(NamedTuple):
    """A value that a state gives a key of its container, or `own`: the container itself."""

    state: Word
    value: Value
    span: Span
    own: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Preset:
    """Userdata that a container holds before it runs: `sm.userdata.key = value`.

    `given` is all that was given, in order, where that was more than once; the last one counts.
    """

    key: str
    value: Value
    type: Type = ANY
    span: Span = field(compare=False, repr=False)
    given: tuple[Given, ...] = field(default=(), compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """A declared outcome of a state or container."""

    name: str
    doc: str = ""
    span: Span = field(compare=False, repr=False)


Sugar = Literal["", "timeout", "retry", "for_each"]
"""The variables of a state that are lowered to a container around it (language.md)."""

Origin = Literal["written", "implicit", "connector"]
"""Why a transition exists: the script says so; the container has an outcome of that name
(smach-semantics M6); or a Sequence links its states (Q1)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Transition:
    """An edge: on `outcome`, go to the sibling `target` or leave with the outcome `target`.

    Where a sibling and an outcome share the name the sibling is meant, but never by an implicit
    edge (M7). `span` is the outcome's place, `target_span` the target's.
    """

    outcome: str
    target: str
    origin: Origin = "written"
    span: Span = field(compare=False, repr=False)
    target_span: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Remap:
    """A state's key stands for a key of its container."""

    key: str
    to: str
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Condition:
    """Part of a rule of a concurrence: this child ended with this outcome."""

    child: str
    outcome: str
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class OutcomeRule:
    """A concurrence ends with `outcome` when all conditions hold."""

    outcome: str
    when: tuple[Condition, ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class _State:
    """What every node has: its interface and its place in the container around it.

    `type` is the state type (the template's name). `via` are the calls of sub-scripts that led
    here, outermost first. `in`/`out` keys are `inputs`/`outputs`. `catches` names the outcome that
    an exception in the state becomes; it is one of `outcomes`, never one of the state's own, and
    empty where exceptions go on. `written` is what the script says of the
    state, for templates that print it themselves; empty for all others.
    """

    name: str
    type: str
    doc: str = ""
    outcomes: tuple[Outcome, ...] = ()
    inputs: tuple[Key, ...] = ()
    outputs: tuple[Key, ...] = ()
    transitions: tuple[Transition, ...] = ()
    remaps: tuple[Remap, ...] = ()
    claims: tuple[str, ...] = ()
    catches: str = ""
    span: Span = field(compare=False, repr=False)
    via: tuple[Span, ...] = field(default=(), compare=False, repr=False)
    written: tuple[Variable, ...] = field(default=(), compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Body:
    """What the Python code of a state type does, as far as it can be told from the text.

    `returns` are the constants that it returns, as text; `silent` is the function's name where some
    way through it returns nothing, and `always_silent` where none returns anything. `reads` and
    `writes` are keys of the userdata. What the script declares for itself is not in it.
    """

    returns: tuple[Word, ...] = ()
    silent: Span | None = None
    always_silent: bool = False
    reads: tuple[Word, ...] = ()
    writes: tuple[Word, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Leaf(_State):
    """One skill of a state type.

    `open`: the state type has no interface, so nothing is known of its keys and outcomes.
    `blocking`: it waits for the outside world (the interface says so). `writes` are pairs of an
    outcome and the outputs it comes with: an output named there is written on those outcomes
    only, any other on all but `preempted`. `body` is the type's code, where it was read.
    """

    variables: tuple[Variable, ...] = ()
    writes: tuple[tuple[str, tuple[str, ...]], ...] = ()
    open: bool = False
    blocking: bool = False
    body: Body | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Container(_State):
    """What every container has: states in the order of the script, and presets of userdata.

    `sugar`: the variable of its state that it was made for, empty where the script has it.
    """

    children: tuple[Node, ...] = ()
    userdata: tuple[Preset, ...] = ()
    sugar: Sugar = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class StateMachine(_Container):
    """States that follow one another along transitions.

    `initial` is empty when there is no state. `forever`: meant to loop without an end.
    """

    initial: str = ""
    forever: bool = False
    initial_span: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Sequence(_Container):
    """A state machine whose states are linked in order by one outcome."""

    connector_outcome: str = ""
    initial: str = ""
    initial_span: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Concurrence(_Container):
    """Children that start together; rules over their outcomes give the container's.

    `join`: "all" waits for every child, "any" preempts the rest when the first has ended.
    Of several matching rules the one with most conditions wins.
    """

    default_outcome: str = ""
    rules: tuple[OutcomeRule, ...] = ()
    join: Literal["all", "any"] = "all"
    default_span: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Iterator(_Container):
    """One child run once for each item, which it finds under the key `item_key`.

    The items are the value `items`, or what the container's userdata holds under `items_key`.
    Outcomes of the child in `loop_outcomes` go on; every other one ends the iteration. The ending
    outcome, or `exhausted_outcome`, goes through `final_map` (pairs from, to).
    """

    items: Value | None = None
    items_key: str = ""
    item_key: str = "it_data"
    exhausted_outcome: str = "exhausted"
    loop_outcomes: tuple[str, ...] = ()
    final_map: tuple[tuple[str, str], ...] = ()


Container: TypeAlias = StateMachine | Sequence | Concurrence | Iterator
Node: TypeAlias = Leaf | Container


class Unused(NamedTuple):
    """What the script declares and nothing uses, and the calls of sub-scripts that led there."""

    what: Literal["param", "type"]
    word: Word
    via: tuple[Span, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Machine:
    """A whole program: the outermost container and what the base template needs to know.

    `base` is the base template; `variables` are the base's own variables (`node_name`,
    `function_name`, `manifest`, those of the base's interface). `source` is the name of the script
    without its folder and `digest` a SHA-256 over the texts of the script and its sub-scripts.
    `robot` is what rules know of the robot, `unused` what the script declared in vain; no target
    prints them.
    """

    root: StateMachine
    base: str = "Base"
    variables: tuple[Variable, ...] = ()
    source: str = ""
    digest: str = field(default="", compare=False)
    robot: Robot | None = field(default=None, compare=False, repr=False)
    unused: tuple[Unused, ...] = field(default=(), compare=False, repr=False)


Checked = NewType("Checked", Machine)
"""A machine that passed every rule without an error: what targets accept. Only the driver's
`check` makes one."""
