"""Behaviours of leaves: those of the built-in state types, and a default for all others."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Literal

from smachac.interpreter.result import Behaviour
from smachac.interpreter.userdata import BehaviourError, Userdata, call_function, python_data
from smachac.ir.leaf import default_outcome, variable, variable_of
from smachac.ir.nodes import Expression, Leaf, Struct, VariableRole
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import outcome_names, own_outcomes


def builtin_behaviour(seed: int = 0) -> Behaviour:
    """The behaviour of every leaf, selected by its state type.

    A preempted leaf ends as `preempted` if it declares that outcome, unless its built-in type
    ignores requests. `seed` is the seed of random leaves without a seed of their own; each has
    random numbers of its own.
    """
    behaviours = {**_BEHAVIOURS, "RandomOutcomeState": _random_outcome(seed)}

    def behave(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
        behaviour = behaviours.get(leaf.built_in, preemptible(_default))
        if variable_of(leaf, "callbacks") is not None:
            callbacks = _functions(leaf, "callbacks")
            for key in sorted(callbacks):
                userdata[key] = call_function(callbacks[key], userdata)
        return behaviour(path, leaf, visit, userdata)

    return behave


def preemptible(behaviour: Behaviour) -> Behaviour:
    """Wrap a behaviour: a preempted leaf that declares `preempted` ends with it."""

    def behave(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
        if userdata.preempted and PREEMPTED in outcome_names(leaf):
            userdata.service_preempt()
            return PREEMPTED
        return behaviour(path, leaf, visit, userdata)

    return behave


def _default(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
    """End with the default outcome."""
    return default_outcome(leaf)


def _scripted(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
    """ScriptedState: visit n performs step n; the last step repeats."""
    steps = python_data(variable(leaf, "steps"))
    if not isinstance(steps, list) or not steps:
        return next(iter(own_outcomes(leaf)), default_outcome(leaf))
    step = steps[min(visit, len(steps)) - 1]
    if not isinstance(step, dict):
        raise BehaviourError(f"step {visit} is no mapping of `outcome` and `set`")
    for key, value in (step.get("set") or {}).items():
        userdata[key] = value
    return str(step.get("outcome") or default_outcome(leaf))


def _functions(leaf: Leaf, role: VariableRole) -> dict[str, Expression]:
    """The functions of a leaf by key or outcome."""
    held = variable_of(leaf, role)
    data = held.value.data if held is not None else None
    if held is None or data is None:
        return {}
    if not isinstance(data, Struct):
        raise BehaviourError(f"`{held.name}` is no mapping")
    found = {key: value for key, value in data.entries if isinstance(value, Expression)}
    for key, _ in data.entries:
        if key not in found:
            raise BehaviourError(f"the callback `{key}` is no expression")
    return found


def _conditional(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
    """ConditionalOutcomeState: the first outcome whose condition holds, else `default_outcome`."""
    conditions = _functions(leaf, "conditions")
    for outcome in own_outcomes(leaf):
        if outcome in conditions and call_function(conditions[outcome], userdata):
            return _publish_outcome(leaf, outcome, userdata)
    otherwise = variable(leaf, "default_outcome")
    if not isinstance(otherwise, str):
        raise BehaviourError("no condition holds, and there is no `default_outcome`")
    return _publish_outcome(leaf, otherwise, userdata)


def _publish_outcome(leaf: Leaf, outcome: str, userdata: Userdata) -> str:
    """Return an outcome; if the leaf has the output key `outcome`, write it there too."""
    if any(key.name == "outcome" for key in leaf.outputs):
        userdata["outcome"] = outcome
    return outcome


def _random_outcome(seed: int) -> Behaviour:
    """RandomOutcomeState: a random outcome, from one random generator for each leaf."""
    sources: dict[str, random.Random] = {}

    def draw(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
        if path not in sources:
            own = variable(leaf, "seed")
            sources[path] = random.Random(own if isinstance(own, int) else f"{seed}/{path}")
        outcome = sources[path].choice(own_outcomes(leaf) or (default_outcome(leaf),))
        return _publish_outcome(leaf, outcome, userdata)

    return draw


def _sleep(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
    """SleepState: let `time` seconds of virtual time pass."""
    time = variable(leaf, "time")
    seconds = call_function(time, userdata) if isinstance(time, Expression) else python_data(time)
    if not isinstance(seconds, int | float):
        raise BehaviourError("`time` is no number of seconds")
    userdata.sleep(seconds)
    return default_outcome(leaf)


_BEHAVIOURS: dict[str, Callable[[str, Leaf, int, Userdata], str]] = {
    "ScriptedState": preemptible(_scripted),
    "CallbacksState": _default,
    "ConditionalOutcomeState": _conditional,
    "SleepState": preemptible(_sleep),
}
"""By built-in state type. PrintUserdataState uses the default: the interpreter prints nothing."""

_MADE_OF_FUNCTIONS = frozenset(["CallbacksState", "ConditionalOutcomeState"])
"""The built-in state types that do nothing but call functions of the script."""


def own_code(leaf: Leaf) -> Literal["functions", "time", "steps", ""]:
    """What the interpreter runs of a leaf; empty for one that only ends."""
    if is_made_of_functions(leaf) or variable_of(leaf, "callbacks") is not None:
        return "functions"
    if leaf.built_in == "SleepState":
        return "time"
    return "steps" if leaf.built_in == "ScriptedState" and variable(leaf, "steps") else ""


def is_made_of_functions(leaf: Leaf) -> bool:
    """Whether a leaf of a built-in type does nothing but call functions of the script."""
    return leaf.built_in in _MADE_OF_FUNCTIONS
