"""The schema of scripts: each field with its long name, short name, shape and owners."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, NamedTuple, TypeAlias, get_args

from smachac.ir.nodes import ContainerKind, StateType

FieldOwner: TypeAlias = Literal["base", "state"] | ContainerKind
"""What has fields: the script itself, a state that is no container, or a container."""

CONTAINERS: Mapping[str, ContainerKind] = {kind: kind for kind in get_args(ContainerKind)}
"""The built-in container types by name."""

CONTAINER_TYPES: Mapping[ContainerKind, StateType] = {
    kind: StateType(name=kind, kind="container") for kind in CONTAINERS.values()
}
"""The state types of containers: they have no variables, keys or outcomes of their own."""

CONTAINER_DOCS: Mapping[ContainerKind, str] = {
    "StateMachine": "States that follow one another along transitions.",
    "Sequence": "States in a row, linked by one outcome.",
    "Concurrence": "States that run at once; an outcome map says what their outcomes mean.",
    "Iterator": "One state, run once for each item of a list.",
}
"""The descriptions of the container types, as `smachac states` prints them."""

_CONTAINERS = " ".join(CONTAINERS)
_ALL = f"base {_CONTAINERS} state"


class Field(NamedTuple):
    """A field of a script or state; `shape` names its reader in fields.py."""

    name: str
    short: str
    shape: str
    owners: frozenset[str]


def _row(name: str, short: str, shape: str, owners: str) -> Field:
    return Field(name, short, shape, frozenset(owners.split()))


VARIABLES: dict[str, Field] = {
    row.name: row
    for row in (
        _row("name", "n", "name", "base"),
        _row("manifest", "m", "text", "base"),
        _row("node_name", "nn", "text", "base"),
        _row("function_name", "", "text", "base"),
        _row("types", "", "map", "base"),
        _row("robot", "", "name", "base"),
        _row("scene", "", "name", "base"),
        _row("frames", "", "names", "base"),
        _row("properties", "", "value", "base"),
        _row("template", "T", "name", _ALL),
        _row("doc", "", "text", _ALL),
        _row("params", "p", "map", _ALL),
        _row("userdata", "ud", "userdata", _ALL),
        _row("input_keys", "ik", "keys", _ALL),
        _row("output_keys", "ok", "keys", _ALL),
        _row("outcomes", "o", "outcomes", _ALL),
        _row("states", "s", "value", f"base {_CONTAINERS}"),
        _row("remapping", "r", "pairs", f"{_CONTAINERS} state"),
        _row("transitions", "t", "pairs", f"{_CONTAINERS} state"),
        _row("claims", "", "names", f"{_CONTAINERS} state"),
        _row("tags", "", "names", f"{_CONTAINERS} state"),
        _row("autonomy", "", "pairs", f"{_CONTAINERS} state"),
        _row("timeout", "", "value", f"{_CONTAINERS} state"),
        _row("retry", "", "value", f"{_CONTAINERS} state"),
        _row("for_each", "", "value", f"{_CONTAINERS} state"),
        _row("callbacks", "cb", "map", ""),
        _row("default_outcome", "do", "name", "Concurrence"),
        _row("outcome_map", "om", "rules", "Concurrence"),
        _row("join", "", "name", "Concurrence"),
        _row("initial", "", "name", "base StateMachine Sequence"),
        _row("forever", "", "flag", "base StateMachine"),
        _row("on_error", "", "name", "base StateMachine Sequence"),
        _row("connector_outcome", "", "name", "Sequence"),
        _row("it", "", "items", "Iterator"),
        _row("it_label", "", "name", "Iterator"),
        _row("exhausted_outcome", "", "name", "Iterator"),
        _row("loop_outcomes", "", "names", "Iterator"),
        _row("break_outcomes", "", "names", "Iterator"),
        _row("final_outcome_map", "", "pairs", "Iterator"),
        _row("script", "S", "name", ""),
    )
}
"""The fields by long name. sugar.py reads `timeout`, `retry` and `for_each`. `callbacks`, and
`default_outcome` of a leaf, are variables of the state type. A state with `script` is a call of a
sub-script and may have each field that the called state may have."""

FIELD_DOCS: Mapping[str, str] = {
    "name": "The name of the machine, and of the files that are made of it.",
    "manifest": "The ROS package whose manifest is loaded (roslib).",
    "node_name": "The name of the ROS node.",
    "function_name": "The name of the function that the generated code defines.",
    "types": "Short names for types: {Joints: float[7]}.",
    "robot": "A built-in robot (panda, baxter, iiwa), or a description or URDF file below this"
    " one's folder.",
    "scene": "A file with the bodies that are in the simulated world from the start.",
    "frames": "Frames beside those of the robot, which something else provides.",
    "properties": "What must never or always happen in a run: a list, or a file with the list.",
    "template": "The state type, or the type of the container: StateMachine, Concurrence,"
    " Sequence, Iterator.",
    "doc": "What it does, in a sentence: shown in pictures.",
    "params": "Constants for look-ups ([params, x] or [[x]]) here and in everything inside.",
    "userdata": "Data that is there before the machine starts. Short form `key: value`,"
    " long form `key: {type: T, value: V}`; with `secret: true`, traces and pages hide the value.",
    "input_keys": "Userdata keys that are read: [a, b], or with types {a: float, b: Pose}.",
    "output_keys": "Userdata keys that are written: [a, b], or with types {a: float, b: Pose}.",
    "outcomes": "What it can end with.",
    "states": "The states, in order; the first is the initial one unless `initial` names another.",
    "remapping": "Which key of the container a key of the state stands for:"
    " {key of the state: key of the container}.",
    "transitions": "Where each outcome leads: {outcome: state or outcome of the container}."
    " An outcome without one leaves the container by its own name.",
    "claims": "Resources held while it runs: [arm.left].",
    "tags": "Names for properties: [moves, holds].",
    "autonomy": "For FlexBE: the level of autonomy that an outcome needs, below which an operator"
    " decides: {outcome: Low}.",
    "timeout": "A time limit, as `20s`, `500ms`, `1.5min`; it adds the outcome `timeout`."
    " Where the state type has a variable of that name, that is meant.",
    "retry": "Further tries: {on: [aborted], max: 3, delay: 1s}; it adds the outcome `exhausted`.",
    "for_each": "Once for each item of a list or of a userdata key: {item: wp, in: waypoints}.",
    "callbacks": "Code over userdata, by the name of the key or outcome it is for.",
    "default_outcome": "What it ends with when no rule holds.",
    "outcome_map": "The rules of a concurrence: {outcome: {CHILD: outcome of the child}}."
    " As a list, several rules can have one outcome: [{outcome: {CHILD: outcome of the child}}].",
    "join": "all: wait for every child. any: preempt the rest when the first has ended."
    " rule: preempt the rest when the first rule holds.",
    "initial": "The state to begin with.",
    "forever": "It is meant to loop without an end.",
    "on_error": "Where an exception in one of the states leads: a state, or an outcome.",
    "connector_outcome": "The outcome that leads from each state to the next.",
    "it": "What to run over: a list, or the userdata key that holds it.",
    "it_label": "The userdata key under which the child finds the item.",
    "exhausted_outcome": "What it ends with when there are no more items.",
    "loop_outcomes": "Outcomes of the child after which the next item comes.",
    "break_outcomes": "Outcomes of the child that end the iteration.",
    "final_outcome_map": "What the iterator ends with: {ending outcome: outcome of the iterator}.",
    "script": "The sub-script to call, without its ending; its variables can be overridden here.",
}
"""The descriptions of the fields, for editors."""

FIELD_CHOICES: Mapping[str, tuple[str, ...]] = {
    "join": ("all", "any", "rule"),
    "autonomy": ("Off", "Low", "High", "Full"),
}
"""The values of fields that have few, or of the entries of such a field."""

FIELD_DEFAULTS: Mapping[str, str] = {
    "join": "all",
    "it_label": "it_data",
    "exhausted_outcome": "exhausted",
}
"""The values of optional fields that have one."""

INTERFACE_FIELDS: Mapping[str, str] = {
    "name": "The name of the state type, which is that of the file.",
    "doc": "What it does, in a sentence.",
    "kind": "What it is: `state`, `container` or `base`.",
    "variables": "The variables that a script sets; one without a default is required.",
    "input_keys": "Userdata keys that it reads: {target: Pose}, or without types [target].",
    "output_keys": "Userdata keys that it writes: {width: float}, or without types [width].",
    "outcomes": "What it can end with: [succeeded, aborted], or with what they mean"
    " {succeeded: {}, aborted: {doc: Not reached in time.}}.",
    "writes": "The outputs that only some outcomes write: {succeeded: [width]}.",
    "claims": 'Resources held while it runs: ["arm.{limb}"]; a part in braces is a variable.',
    "blocking": "It waits for the outside world, so it needs a time limit.",
    "stand_in": "It takes the place of a state that does not exist yet.",
    "simulation": "Its Python code uses the simulated world.",
    "checks_grasp": "It succeeds only if the gripper of its limb holds a body.",
    "adds_frames": "The variables that name a frame which it adds to the simulated world.",
    "other_names": "Its names in other frameworks, each with the words there that have another name"
    " here: {WaitState: {wait_time: time}}.",
    "code": "Its code, by language: {python: my_robot.states:Grasp}.",
}
"""The fields of the interface of a state type, with their descriptions."""

VALUE_FACTS: Mapping[str, str] = {
    "min": "The least number allowed.",
    "max": "The greatest number allowed.",
    "exclusive": "`min` and `max` themselves are not allowed.",
    "unit": "The unit of the number: `m/s`.",
    "one_of": "The only words or numbers allowed.",
    "names": "What the value is the name of: a joint, frame, limb, model or body.",
}
"""What an interface can state about the values of a variable or key, with descriptions."""

VARIABLE_FACTS: Mapping[str, str] = {
    "type": "As float<rad>[7] or Pose.",
    "default": "The value without an entry of the script; without a default one is required.",
    "doc": "What it means, in a sentence.",
    "role": "What the value means to the state (docs/state_types.md, Facts).",
    "keys": "What the keys of the mapping are.",
    "arguments": "The arguments that a function in the variable gets: [userdata].",
    "returns": "What a function in the variable returns.",
    "called_first": "Programs call the functions before the state, which does not get them.",
    "unquoted": "Programs contain the text without quotes: the shape that it must have.",
    "ros": "The version of ROS that the variable needs, or each of its values: {x: 2}.",
    **VALUE_FACTS,
}
"""What an interface can state about a variable, with descriptions."""

KEY_FACTS: Mapping[str, str] = {
    "type": "As float<rad>[7] or Pose.",
    "doc": "What it means, in a sentence.",
    "role": "What the key means to the state (docs/state_types.md, Facts).",
    "frame": "The frame of the pose, or the variable that names it.",
    "optional": "The state has the key only if the script lists it.",
    "secret": "Whether its value is hidden in traces, pages and reports.",
    **VALUE_FACTS,
}
"""What an interface can state about a key, with descriptions."""

OUTCOME_FACTS: Mapping[str, str] = {
    "doc": "When it ends so, in a sentence.",
    "failure": "Whether it means failure; without it, the name decides.",
    "optional": "The state has the outcome only if the script names it.",
    "needs": "The variable, or one of the variables, without which it never ends so.",
}
"""What an interface can state about an outcome, with descriptions."""

LONG: dict[str, str] = {row.short: row.name for row in VARIABLES.values() if row.short}
"""Short name to long name."""

REQUIRED: Mapping[FieldOwner, tuple[str, ...]] = {
    "base": ("name", "outcomes", "states"),
    "StateMachine": ("outcomes", "states"),
    "Sequence": ("outcomes", "connector_outcome", "states"),
    "Concurrence": ("outcomes", "states"),
    "Iterator": ("it", "states"),
    "state": (),
}
"""The required fields of each owner."""


def names_for(owner: str) -> list[str]:
    """The long names of the fields of an owner, in the order of the schema."""
    return [row.name for row in VARIABLES.values() if owner in row.owners]


def special_owners(name: str) -> frozenset[str]:
    """The owners of a field that an ordinary state does not have; empty for any other name."""
    row = VARIABLES.get(name)
    return frozenset() if row is None or "state" in row.owners else row.owners


OWN_FIELDS: Mapping[str, frozenset[str]] = {
    owner: frozenset(names_for(owner)) for owner in {owner for row in VARIABLES.values()
                                                     for owner in row.owners}
}  # fmt: skip
"""The long names of the fields of each owner."""
