"""A resolved script: its states with typed fields, and the state types that they have.

`resolve` makes it of a tree and reports what is wrong with it; `lower` makes a machine of it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from smachac.diagnostics.source import Source, Span, Word
from smachac.frontend.schema import FieldOwner
from smachac.frontend.text.fields import Keys, Pairs, Rules
from smachac.ir.nodes import (
    FixedParam,
    Outcome,
    Param,
    Preset,
    StateType,
    Unused,
    Value,
    Variable,
)
from smachac.records import dataclass, field

TYPE_CHECKING = False  # annotations only: few scripts have functions, messages or a robot
if TYPE_CHECKING:
    from smachac.ir.function_facts import FunctionFacts
    from smachac.ir.message_types import Definitions, MissingDefinitions, OtherTypes
    from smachac.ir.properties import Property
    from smachac.ir.robot import Robot

TIMEOUT, EXHAUSTED = "timeout", "exhausted"
"""The outcomes that a time limit and retries add."""

ERROR = "error"
"""The name by which a script refers to the exceptions of a state without an outcome `error`."""

ANY_OUTCOME = "any"
"""The word for every outcome of a state, in a rule of an outcome map."""

TIMER = "SleepState"
"""The state type that sugar uses to let time pass."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Timeout:
    """A time limit in seconds. `span` is that of the field's name, in all sugar; `value_span` that
    of the limit."""

    seconds: float
    span: Span
    value_span: Span


@dataclass(frozen=True, slots=True, kw_only=True)
class Retry:
    """At most `most` tries; another one follows, after `delay` seconds, an outcome in `on`."""

    on: tuple[Word, ...]
    most: int
    delay: float
    span: Span


@dataclass(frozen=True, slots=True, kw_only=True)
class ForEach:
    """One run for each item of `items`, under the key `item`, while the outcome is in `on`.

    In a wrong loop the item can be empty, and `preempted`, whether the loop adds that outcome,
    false.
    """

    item: str
    item_span: Span
    items: Value
    on: tuple[Word, ...]
    span: Span
    preempted: bool = True


@dataclass(frozen=True, slots=True, kw_only=True)
class Sugar:
    """The sugar of one state; desugar.py makes containers of it."""

    timeout: Timeout | None = None
    retry: Retry | None = None
    for_each: ForEach | None = None


class State(NamedTuple):
    """A state or container of a script, or the script's base.

    `owner` selects the fields of the schema: "base", a container type or "state". `via`: the calls
    of sub-scripts that lead to it, outermost first. `variables` are those of the state type,
    `written` all fields as a template of SMACHA's kind needs them, `misplaced_keys` the input keys
    that are written as variables. The other fields have the names of the schema; None and empty
    values mean that the script has no such field, or a wrong one, which was reported. A tuple,
    because a frozen dataclass of so many fields is slow to make.
    """

    name: Word
    owner: FieldOwner
    type: StateType
    via: tuple[Span, ...] = ()
    states: tuple[State, ...] = ()
    variables: tuple[Variable, ...] = ()
    written: tuple[Variable, ...] = ()
    sugar: Sugar = Sugar()
    doc: str = ""
    outcomes: tuple[Outcome, ...] = ()
    input_keys: Keys = ()
    output_keys: Keys = ()
    userdata: tuple[Preset, ...] = ()
    transitions: Pairs = ()
    remapping: Pairs = ()
    claims: tuple[Word, ...] = ()
    tags: tuple[Word, ...] = ()
    autonomy: Pairs = ()
    initial: Word | None = None
    forever: bool = False
    on_error: Word | None = None
    connector_outcome: Word | None = None
    default_outcome: Word | None = None
    outcome_map: Rules = ()
    join: Word | None = None
    it: Value | None = None
    it_label: Word | None = None
    exhausted_outcome: Word | None = None
    loop_outcomes: tuple[Word, ...] = ()
    break_outcomes: tuple[Word, ...] = ()
    final_outcome_map: Pairs = ()
    robot: Word | None = None
    scene: Word | None = None
    frames: tuple[Word, ...] = ()
    misplaced_keys: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Script:
    """A whole script.

    `sources` are its text and those of its sub-scripts, in the order of use; `state_types` the
    types that its states and their sugar have, by name.
    """

    base: State
    sources: tuple[Source, ...]
    robot: Robot | None = None
    definitions: Definitions = field(default_factory=dict)
    missing_definitions: MissingDefinitions = field(default_factory=dict)
    other_types: OtherTypes = field(default_factory=dict)
    unused: tuple[Unused, ...] = ()
    properties: tuple[Property, ...] = ()
    params: tuple[Param, ...] = ()
    fixed_params: tuple[FixedParam, ...] = ()
    functions: Mapping[str, FunctionFacts] = field(default_factory=dict)
    state_types: Mapping[str, StateType] = field(default_factory=dict)
    aliases: Mapping[str, str] = field(default_factory=dict)


def unknown_state(name: Word, transitions: Pairs, via: tuple[Span, ...]) -> State:
    """A state that cannot be read: only its name and its transitions are known."""
    type_ = StateType(name="", open=True)
    return State(name=name, owner="state", type=type_, transitions=transitions, via=via)


def no_states(container: Word, via: tuple[Span, ...]) -> State:
    """An unknown state in place of the states of a container, which were reported as missing or
    wrong: then no consequence of it is reported."""
    return unknown_state(Word("STATES", container.span), (), via)
