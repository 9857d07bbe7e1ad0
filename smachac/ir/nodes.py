"""Nodes of the typed state graph: the meaning of a script, independent of its notation.

Values are frozen; spans refer to the script and do not count in equality. The path of a node,
`sm/PICK_BLOCK/OPEN_GRIPPER`, identifies it (traversal.py). The graph is total: a transition without
a valid target stays in it and is found by a rule.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import ClassVar, Literal, NamedTuple, NewType, TypeAlias, TypeGuard

from smachac.diagnostics.source import NOWHERE, Span, Word
from smachac.ir.types import ANY, Type
from smachac.records import dataclass, field

TYPE_CHECKING = False  # annotations only: few machines have classes, messages or a robot
if TYPE_CHECKING:
    from smachac.ir.class_facts import ClassFacts
    from smachac.ir.function_facts import FunctionFacts
    from smachac.ir.message_types import DefinitionKind, Definitions, MissingDefinitions, OtherTypes
    from smachac.ir.properties import Property
    from smachac.ir.robot import Robot


@dataclass(frozen=True, slots=True, kw_only=True)
class Expression:
    """Code over userdata, as written: a portable expression or Python (docs/language.md)."""

    text: str
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Struct:
    """A mapping inside a value, in the order of the script."""

    entries: tuple[tuple[str, Data], ...]


Data: TypeAlias = "bool | int | float | str | Expression | Struct | tuple[Data, ...] | None"
"""The data of a value; a YAML list is a tuple."""


def is_number(data: object) -> TypeGuard[int | float]:
    """Whether data is a number. A boolean, which is an `int` for Python, is none."""
    return isinstance(data, int | float) and not isinstance(data, bool)


@dataclass(frozen=True, slots=True, kw_only=True)
class LookUp:
    """A part of a value that is made of params.

    `path` leads to it: the keys and indexes in the value. `span` is the place of the param's value,
    or of the string construct, whose `parts` are texts and look-ups. `data` is the result.
    """

    path: tuple[str | int, ...] = ()
    span: Span
    data: Data
    parts: tuple[str | LookUp, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Value:
    """A constant of the script; it may contain expressions.

    A value that is one param has the span of that param's value. `look_ups` are the other params in
    it.
    """

    data: Data
    span: Span = field(compare=False, repr=False)
    look_ups: tuple[LookUp, ...] = field(default=(), compare=False, repr=False)


VariableRole = Literal[
    "", "callbacks", "conditions", "function", "duration", "steps", "grasp", "output_function",
    "service_type", "action_type", "message_type", "request", "response", "goal", "result",
    "joint_speed", "grip", "qos", "tries",
    "limb", "joint", "frame", "model", "body", "model_file",
]  # fmt: skip
"""The meaning of a variable's value for a state (docs/state_types.md, Facts)."""

DEFINITION_KINDS: Mapping[VariableRole, DefinitionKind] = {
    "service_type": "srv",
    "action_type": "action",
    "message_type": "msg",
}
"""The kinds of the definitions of ROS that variables name, by their roles."""

KeyRole = Literal[
    "", "argument", "result", "listed", "joint_positions", "goal_pose", "goal_offset",
    "message", "key_names", "limb", "joint", "frame", "model", "body",
]  # fmt: skip
"""The meaning of a userdata key for a state (docs/state_types.md, Facts)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """The numbers that a variable or key may have; for a list or mapping, those of its items.

    `exclusive`: the bounds themselves are not allowed. `choices` are the only numbers allowed, if
    there are any.
    """

    least: float = -math.inf
    most: float = math.inf
    exclusive: bool = False
    choices: tuple[int | float, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Variable:
    """A variable of a state type with its value in the script, and its type and role in the
    interface.

    `takes_userdata`: the value is a function whose first argument is the userdata of the state.
    """

    name: str
    value: Value
    type: Type = ANY
    role: VariableRole = field(default="", compare=False, repr=False)
    takes_userdata: bool = field(default=False, compare=False, repr=False)
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Key:
    """A typed userdata key that a state or container declares; its role and limits in the
    interface.

    `frame` is the frame of its poses, if the interface names one.
    """

    name: str
    type: Type = ANY
    doc: str = ""
    role: KeyRole = field(default="", compare=False, repr=False)
    frame: str = field(default="", compare=False, repr=False)
    limits: Limits | None = field(default=None, compare=False, repr=False)
    secret: bool = field(default=False, compare=False, repr=False)
    span: Span = field(compare=False, repr=False)


class Given(NamedTuple):
    """A value that a state presets for a key of its container. `own`: the container itself presets
    it."""

    state: Word
    value: Value
    span: Span
    own: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Preset:
    """Initial userdata of a container: `sm.userdata.key = value`.

    `given` holds all values in order if the key is preset more than once; the last one counts.
    """

    key: str
    value: Value
    type: Type = ANY
    span: Span = field(compare=False, repr=False)
    given: tuple[Given, ...] = field(default=(), compare=False, repr=False)
    secret: bool = field(default=False, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """A declared outcome of a state or container. `failure`: whether it is declared to be one of
    failure; None: its name decides."""

    name: str
    doc: str = ""
    failure: bool | None = field(default=None, compare=False, repr=False)
    span: Span = field(compare=False, repr=False)


Sugar = Literal["", "timeout", "retry", "for_each"]
"""Fields of a state that are lowered to a container around it (docs/language.md)."""

Origin = Literal["written", "implicit", "connector"]
"""The origin of a transition: written in the script; implied by an outcome of the container with
the same name; or the link between two states of a Sequence (docs/semantics.md, Steps and
transitions), or of a machine in Python whose framework goes on to a state of that name."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Transition:
    """An edge: on `outcome`, go to the sibling `target` or leave with the outcome `target`.

    If a sibling and an outcome have the name of the target, the target is the sibling, except for
    implicit transitions. `span` is the place of the outcome, `target_span` that of the target.
    """

    outcome: str
    target: str
    origin: Origin = "written"
    span: Span = field(compare=False, repr=False)
    target_span: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Autonomy:
    """The level of autonomy of FlexBE that an outcome needs: below it an operator decides."""

    outcome: str
    level: str
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Remap:
    """A key of a state refers to another key of its container; `to_span` is the place of that."""

    key: str
    to: str
    span: Span = field(compare=False, repr=False)
    to_span: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Condition:
    """A condition of a concurrence's rule: this child ended with this outcome."""

    child: str
    outcome: str
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class OutcomeRule:
    """A concurrence ends with `outcome` if all conditions hold.

    `ignored` are the children that the rule lists with `any`: it holds for all outcomes of them.
    """

    outcome: str
    when: tuple[Condition, ...]
    ignored: tuple[Word, ...] = field(default=(), compare=False, repr=False)
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class _State:
    """Fields of every node: its interface and its connections in the container around it.

    `keyword` is that of the class in the text form. `type` is the state type (the name of the
    template). `via` are the calls of sub-scripts that lead to the node, outermost first. `inputs`
    and `outputs` are its userdata keys. `tags` are names for properties, `autonomy` the levels that
    outcomes need in FlexBE. `catches` is the outcome
    that exceptions in the state become: it is one of `outcomes`, the state's own code never returns
    it, and it is empty if exceptions are not caught. `written` are the fields of the script, for
    templates that print them; empty for all others.
    """

    keyword: ClassVar[str]
    name: str
    type: str
    doc: str = ""
    outcomes: tuple[Outcome, ...] = ()
    inputs: tuple[Key, ...] = ()
    outputs: tuple[Key, ...] = ()
    transitions: tuple[Transition, ...] = ()
    remaps: tuple[Remap, ...] = ()
    claims: tuple[str, ...] = ()
    tags: tuple[str, ...] = ()
    autonomy: tuple[Autonomy, ...] = field(default=(), compare=False, repr=False)
    catches: str = ""
    span: Span = field(compare=False, repr=False)
    via: tuple[Span, ...] = field(default=(), compare=False, repr=False)
    written: tuple[Variable, ...] = field(default=(), compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Leaf(_State):
    """One skill of a state type.

    `open`: the state type has no interface, so its keys and outcomes are unknown. `blocking`: it
    waits for the outside world, as its interface declares. `writes` are pairs of an outcome and
    output keys: an output in it is written on those outcomes only, any other output on all outcomes
    except `preempted`. `class_facts` are those of its Python class, if it was read.

    The other fields are facts of the state type (docs/state_types.md, Facts). `built_in` is the
    name of the built-in state type; it is empty for a type of the user, also for one of that name.
    `any_key`: it is a state of another framework; it is open, but its outcomes are known.
    `misplaced_keys` are the input keys that the script writes as variables of the state (SM003).
    `synthetic`: no such state is written; it stands for what is not known of its container.
    """

    keyword: ClassVar[str] = "state"
    variables: tuple[Variable, ...] = ()
    writes: tuple[tuple[str, tuple[str, ...]], ...] = ()
    open: bool = False
    synthetic: bool = field(default=False, compare=False, repr=False)
    blocking: bool = False
    class_facts: ClassFacts | None = field(default=None, compare=False, repr=False)
    built_in: str = field(default="", compare=False, repr=False)
    stand_in: bool = field(default=False, compare=False, repr=False)
    any_key: bool = field(default=False, compare=False, repr=False)
    adds_frames: tuple[str, ...] | None = field(default=None, compare=False, repr=False)
    misplaced_keys: tuple[str, ...] = field(default=(), compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Container(_State):
    """Fields of every container: children in the order of the script, and presets of userdata.

    `sugar`: the field of its state that it was made for; empty if the script has the container.
    """

    children: tuple[Node, ...] = ()
    userdata: tuple[Preset, ...] = ()
    sugar: Sugar = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class StateMachine(_Container):
    """States that follow one another along transitions.

    `initial` is empty if there is no state. `forever`: the machine is declared to have no end.
    """

    keyword: ClassVar[str] = "machine"
    initial: str = ""
    forever: bool = False
    initial_span: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Sequence(_Container):
    """A state machine whose states are linked in order by one outcome."""

    keyword: ClassVar[str] = "sequence"
    connector_outcome: str = ""
    connector_span: Span = field(default=NOWHERE, compare=False, repr=False)
    initial: str = ""
    initial_span: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Concurrence(_Container):
    """Children that start together; rules over their outcomes determine the outcome of the
    container.

    `join`: "all" waits for every child, "any" preempts the others when the first child ends. Of
    several matching rules the one with most conditions applies. "rule" preempts the others when the
    first rule matches what has ended; of several matching rules the first in their order applies.
    """

    keyword: ClassVar[str] = "concurrence"
    default_outcome: str = ""
    rules: tuple[OutcomeRule, ...] = ()
    join: Literal["all", "any", "rule"] = "all"
    default_span: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Iterator(_Container):
    """A container that runs its child once for each item; the item is in the key `item_key`, which
    is empty where the script does not name it.

    The items are the value `items`, or the userdata of the container in `items_key`; `items_span`
    is their place, and `item_span` that of the name `item_key`. Outcomes in `loop_outcomes`
    continue with the next item; other outcomes end the iteration. The last outcome, or
    `exhausted_outcome`, is mapped by `final_map` (pairs from, to). `exhausted_span` is its place,
    or the iterator's if the script does not name it. `loop_spans` and `final_spans`
    are the places of `loop_outcomes` and of the entries of `final_map` in the script; empty if it
    does not name them.
    """

    keyword: ClassVar[str] = "iterator"
    items: Value | None = None
    items_key: str = ""
    items_span: Span = field(default=NOWHERE, compare=False, repr=False)
    item_key: str = "it_data"
    item_span: Span = field(default=NOWHERE, compare=False, repr=False)
    exhausted_outcome: str = "exhausted"
    exhausted_span: Span = field(default=NOWHERE, compare=False, repr=False)
    loop_outcomes: tuple[str, ...] = ()
    loop_spans: tuple[Span, ...] = field(default=(), compare=False, repr=False)
    final_map: tuple[tuple[str, str], ...] = ()
    final_spans: tuple[Span, ...] = field(default=(), compare=False, repr=False)


Container: TypeAlias = StateMachine | Sequence | Concurrence | Iterator
Node: TypeAlias = Leaf | Container

ContainerKind = Literal["StateMachine", "Sequence", "Concurrence", "Iterator"]
"""The names of the classes of `Container`, which are also those in scripts and in SMACH."""


class Unused(NamedTuple):
    """A declaration of the script that is not used, and the calls of sub-scripts that lead to it.
    `known` are the params that the state with an unused one uses and does not define, `kept` the
    values that a called sub-script has for some of them."""

    what: Literal["param", "type"]
    word: Word
    via: tuple[Span, ...] = ()
    known: tuple[str, ...] = ()
    kept: Mapping[str, Span] = {}


class FixedParam(NamedTuple):
    """A look-up in a field that a program has no parameter for: the field, the name of the param,
    and the place of the param's value."""

    field: str
    word: Word
    value: Span


StateKind = Literal["base", "container", "state"]
"""What a state type describes: a script's base, a container or a state."""


FunctionResult = Literal["", "value", "outcome"]
"""What a function in a variable must return: anything; something other than None; an outcome of the
state or None."""


@dataclass(frozen=True, slots=True, kw_only=True)
class VariableType:
    """A variable of a state type. `keys`: it lists userdata keys, "input" or "output" ones.

    `called_first`: generated programs call its functions before the state, whose class does not
    receive the variable. `unquoted`: the shape of a text that programs contain without quotes.
    `arguments`: the arguments with which the state calls its functions; None: not known. `returns`:
    what they must return.
    """

    name: str
    type: Type = ANY
    role: VariableRole = ""
    required: bool = True
    doc: str = ""
    default: Value | None = None
    keys: str = ""
    called_first: bool = False
    unquoted: str = ""
    arguments: tuple[str, ...] | None = None
    returns: FunctionResult = ""
    ros: Mapping[str, int] = field(default_factory=dict, compare=False, repr=False)
    limits: Limits | None = None


NATIVE: Mapping[str, str] = {"yasmin": "YASMIN", "flexbe": "FlexBE"}
"""The keys of the `code` of state types whose classes are states of another framework, with its
name; the target of the same name runs them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StateType:
    """The interface of all states with one `template`.

    `given` names the parts that a script adds to the interface: any of "variables", "input_keys",
    "output_keys", "outcomes" (`"*": {}` in the interface). `code` maps a language to the file of a
    template or to a reference to code; `classes` maps a language to a class: `header`, `class`,
    `with`; `class_spans` are the places of these texts, by language and field, and those of
    `code`, with an empty field. `class_facts` are those of its Python class. `open`: there is no
    interface.
    `prints_itself`: the Python template adds the state to its container, as SMACHA's templates do.
    A state has an outcome of `optional` only if its container or one of its transitions names it.
    `needs` are the variables of an outcome, by outcome: without a value of one of them a state
    never ends with it.
    `used` are the words in the template of a type that accepts any variable; None: not known.
    `default_keys` are the keys of a state for which the script lists none, by `input_keys` and
    `output_keys`.

    Facts (docs/state_types.md): `built_in` is the name of a built-in type and empty for all others.
    `stand_in`: it takes the place of a state that does not exist yet. `simulation`: its code uses
    the simulated world.
    `checks_grasp`: it succeeds only if its gripper holds a body.
    `adds_frames`: the variables of which the first that has a value names a
    frame that the state adds to that world; None: not known. `other_names` are its names in other
    frameworks, each with the words there that have another name here. `listed_inputs`
    and `listed_outputs` are the roles of keys that a script adds, by name; `"*"` is any other name.
    `secret_keys` are the names of the keys with `secret: true`, also of those that a script adds.
    """

    name: str
    kind: StateKind = "state"
    doc: str = ""
    variables: Mapping[str, VariableType] = field(default_factory=dict)
    input_keys: tuple[Key, ...] = ()
    output_keys: tuple[Key, ...] = ()
    outcomes: tuple[Outcome, ...] = ()
    needs: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    writes: tuple[tuple[str, tuple[str, ...]], ...] = ()
    given: frozenset[str] = frozenset()
    claims: tuple[str, ...] = ()
    blocking: bool = False
    code: Mapping[str, str] = field(default_factory=dict)
    classes: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    class_spans: Mapping[tuple[str, str], Span] = field(
        default_factory=dict, compare=False, repr=False
    )
    class_facts: ClassFacts | None = None
    open: bool = False
    prints_itself: bool = False
    optional: frozenset[str] = frozenset()
    used: frozenset[str] | None = None
    built_in: str = ""
    stand_in: bool = False
    simulation: bool = False
    checks_grasp: bool = False
    adds_frames: tuple[str, ...] | None = None
    other_names: Mapping[str, Mapping[str, str]] = field(
        default_factory=dict, compare=False, repr=False
    )
    listed_inputs: Mapping[str, KeyRole] = field(default_factory=dict)
    listed_outputs: Mapping[str, KeyRole] = field(default_factory=dict)
    default_keys: Mapping[str, tuple[Key, ...]] = field(default_factory=dict)
    secret_keys: frozenset[str] = frozenset()

    @property
    def any_variable(self) -> bool:
        """Whether a script can set variables that neither the interface nor the constructor of
        the class names."""
        known = self.class_facts is not None and self.class_facts.parameters is not None
        return "variables" in self.given or (self.open and not known)

    @property
    def any_key(self) -> bool:
        """Whether the states can use keys that the interface does not list, as a class of YASMIN or
        FlexBE can whose interface has `input_keys: {"*": {}}`."""
        return not self.code.keys().isdisjoint(NATIVE) and "input_keys" in self.given


@dataclass(frozen=True, slots=True, kw_only=True)
class Param:
    """A param of a script. The values that look it up have its span."""

    name: str
    value: Value


@dataclass(frozen=True, slots=True, kw_only=True)
class Machine:
    """A whole program: the outermost container and the data of the base template.

    `base` is the base template, empty for a machine in Python; `variables` are its variables
    (`node_name`, `function_name`, `manifest`, and those of its interface). `source` is the name of
    the script without its folder, `digest` a SHA-256 over the texts of the script and its
    sub-scripts. `robot`, `unused`,
    `properties`, `definitions`, those of messages of ROS, `missing_definitions` and
    `other_types` are for rules; of the targets only `dot` uses properties. `params` are those of
    the main script,
    `fixed_params` the look-ups of params in time limits and retries. `functions` are those of the
    user that the script names, by the text in the script. `state_types` are the interfaces of its
    states and of its base, by name. `aliases` are the types that the script names, for messages.
    `unknown` are the states that are not known exactly, by path, with the reason: a machine that is
    read from Python can have some, and pictures show them dashed.
    """

    root: StateMachine
    base: str = "Base"
    variables: tuple[Variable, ...] = ()
    source: str = ""
    digest: str = field(default="", compare=False)
    robot: Robot | None = field(default=None, compare=False, repr=False)
    unused: tuple[Unused, ...] = field(default=(), compare=False, repr=False)
    properties: tuple[Property, ...] = field(default=(), compare=False, repr=False)
    definitions: Definitions = field(default_factory=dict, compare=False, repr=False)
    missing_definitions: MissingDefinitions = field(default_factory=dict, compare=False, repr=False)
    other_types: OtherTypes = field(default_factory=dict, compare=False, repr=False)
    params: tuple[Param, ...] = field(default=(), compare=False, repr=False)
    fixed_params: tuple[FixedParam, ...] = field(default=(), compare=False, repr=False)
    functions: Mapping[str, FunctionFacts] = field(default_factory=dict, compare=False, repr=False)
    state_types: Mapping[str, StateType] = field(default_factory=dict, compare=False, repr=False)
    aliases: Mapping[str, str] = field(default_factory=dict, compare=False, repr=False)
    unknown: Mapping[str, str] = field(default_factory=dict, compare=False, repr=False)


Checked = NewType("Checked", Machine)
"""A machine that passed every rule without an error: the input of targets. Only the driver's
`check` makes one."""
