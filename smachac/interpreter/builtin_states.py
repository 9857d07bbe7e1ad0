"""What leaves of the built-in state types do in the interpreter; a stand-in for all others."""

from __future__ import annotations

import random
from collections.abc import Callable

from smachac.interpreter.result import Behaviour
from smachac.interpreter.userdata import BehaviourError, Userdata, called, python_data
from smachac.ir.builtin_states import CALLING, default_outcome, variable
from smachac.ir.nodes import Expression, Leaf, Struct
from smachac.ir.traversal import PREEMPTED, outcome_names, own_outcomes


def built_in(seed: int = 0) -> Behaviour:
    """The behaviour of every leaf by its state type.

    A leaf that a request to stop has reached ends as `preempted` where it declares that, unless it
    is of a built-in type that does not look for requests. `seed` settles what leaves draw that have
    no seed of their own; 0 is what generated programs take.
    """
    behaviours = {**_BEHAVIOURS, "RandomOutcomeState": _draws(seed)}

    def behave(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
        behaviour = behaviours.get(leaf.type, stopping_when_asked(_default))
        if leaf.type in CALLING:
            callbacks = _callbacks(leaf)
            for key in sorted(callbacks):
                userdata[key] = called(callbacks[key], userdata)
        return behaviour(path, leaf, visit, userdata)

    return behave


def stopping_when_asked(behaviour: Behaviour) -> Behaviour:
    """A behaviour that answers a request to stop with `preempted` where the leaf declares it."""

    def behave(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
        if userdata.preempted and PREEMPTED in outcome_names(leaf):
            userdata.service_preempt()
            return PREEMPTED
        return behaviour(path, leaf, visit, userdata)

    return behave


def _default(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
    return default_outcome(leaf)


def _scripted(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
    steps = python_data(variable(leaf, "steps"))
    if not isinstance(steps, list) or not steps:
        return next(iter(own_outcomes(leaf)), default_outcome(leaf))
    step = steps[min(visit, len(steps)) - 1]
    if not isinstance(step, dict):
        raise BehaviourError(f"step {visit} is no mapping of `outcome` and `set`")
    for key, value in (step.get("set") or {}).items():
        userdata[key] = value
    return str(step.get("outcome") or default_outcome(leaf))


def _callbacks(leaf: Leaf) -> dict[str, Expression]:
    """The functions of a leaf by key or outcome."""
    data = variable(leaf, "callbacks")
    if data is None:
        return {}
    if not isinstance(data, Struct):
        raise BehaviourError("`callbacks` is no mapping")
    found = {key: value for key, value in data.entries if isinstance(value, Expression)}
    for key, _ in data.entries:
        if key not in found:
            raise BehaviourError(f"the callback `{key}` is no expression")
    return found


def _first_true(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
    callbacks = _callbacks(leaf)
    for outcome in own_outcomes(leaf):
        if outcome in callbacks and called(callbacks[outcome], userdata):
            return _told(leaf, outcome, userdata)
    otherwise = variable(leaf, "default_outcome")
    if not isinstance(otherwise, str):
        raise BehaviourError("no condition holds, and there is no `default_outcome`")
    return _told(leaf, otherwise, userdata)


def _told(leaf: Leaf, outcome: str, userdata: Userdata) -> str:
    """An outcome, also under the key `outcome` where the leaf has that."""
    if any(key.name == "outcome" for key in leaf.outputs):
        userdata["outcome"] = outcome
    return outcome


def _draws(seed: int) -> Behaviour:
    sources: dict[str, random.Random] = {}

    def draw(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
        if path not in sources:
            own = variable(leaf, "seed")
            sources[path] = random.Random(own if isinstance(own, int) else seed)
        outcome = sources[path].choice(own_outcomes(leaf) or (default_outcome(leaf),))
        return _told(leaf, outcome, userdata)

    return draw


def _sleep(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
    time = variable(leaf, "time")
    seconds = called(time, userdata) if isinstance(time, Expression) else python_data(time)
    if not isinstance(seconds, int | float):
        raise BehaviourError("`time` is no number of seconds")
    userdata.sleep(seconds)
    return default_outcome(leaf)


_BEHAVIOURS: dict[str, Callable[[str, Leaf, int, Userdata], str]] = {
    "ScriptedState": stopping_when_asked(_scripted),
    "CallbacksState": _default,
    "ConditionalOutcomeState": _first_true,
    "SleepState": stopping_when_asked(_sleep),
}
"""By state type. PrintUserdataState prints nothing here, so the stand-in does."""
