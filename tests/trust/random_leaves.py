"""The leaves of random correct projects: states that read only keys that are set."""

from __future__ import annotations

import random
from dataclasses import dataclass, field
from typing import Any

from tests.trust.project_text import Data, Project, Quoted
from tests.trust.project_vocabulary import CHANGES, CONDITIONS, LITERALS, literal, long_type

Body = dict[str, Data]
Known = dict[str, str]
"""Keys that are set, with their types."""

GOOD, BAD = "succeeded", "aborted"
VERBS = ("LOOK", "MOVE", "GRASP", "LIFT", "PLACE", "CHECK", "OPEN", "WAIT", "ASK", "PARK")
WORDS = ("pose", "width", "part", "goal", "speed", "level", "side", "route", "count", "found")


@dataclass
class State:
    """A state to be put into a container: its body, and what is set after each of its outcomes.

    The keys are those of the container. `perhaps` may be set as well.
    """

    name: str
    body: Body
    sets: dict[str, Known] = field(default_factory=dict)
    reads: set[str] = field(default_factory=set)
    perhaps: Known = field(default_factory=dict)

    def writes(self) -> Known:
        """Whatever it may set."""
        found = dict(self.perhaps)
        for known in self.sets.values():
            found |= known
        return found


class Leaves:
    """Draws leaves. Names of states and keys are never used twice but where scopes meet."""

    def __init__(self, seed: int) -> None:
        self.draw = random.Random(f"correct/{seed}")
        self.files: Project = {}
        self.made = 0
        self.presets: list[Body] = []

    def number(self) -> int:
        self.made += 1
        return self.made

    def state_name(self) -> str:
        return f"{self.draw.choice(VERBS)}_{self.number()}"

    def key_name(self) -> str:
        return f"{self.draw.choice(WORDS)}_{self.number()}"

    def chance(self, likely: float) -> bool:
        return self.draw.random() < likely

    def listed(self, keys: Known) -> Data:
        """Keys as a list of names, or with their types."""
        if self.chance(0.5):
            return {key: long_type(type_) for key, type_ in keys.items()}
        return list(keys)

    def some(self, known: Known) -> Known:
        keys = self.draw.sample(sorted(known), min(len(known), self.draw.choice([0, 1, 2, 2, 3])))
        return {key: known[key] for key in keys}

    def given(self, known: Known) -> Known:
        """Some keys that are set, and perhaps one that is a preset of the container."""
        reads = self.some(known)
        if self.chance(0.3):
            key, type_ = self.reading({}, LITERALS)
            reads[key] = type_
        return reads

    def reading(self, known: Known, types: dict[str, Any]) -> tuple[str, str]:
        """A key of one of these types: one that is set, or a preset of the container."""
        keys = sorted(key for key, type_ in known.items() if type_ in types)
        if keys and self.chance(0.8):
            key = self.draw.choice(keys)
            return key, known[key]
        type_ = self.draw.choice(sorted(types))
        key = self.key_name()
        value = literal(self.draw, type_)
        long = type_ not in ("int", "str", "bool") or self.chance(0.5)
        self.presets[-1][key] = {"type": long_type(type_), "value": value} if long else value
        return key, type_

    def scripted(self, name: str, depth: int, known: Known) -> State:
        outcomes = [GOOD, *(item for item in (BAD, "skipped") if self.chance(0.5))]
        body: Body = {"template": "ScriptedState", "outcomes": outcomes}
        state = State(name, body, {outcome: {} for outcome in outcomes})
        reads = self.given(known)
        if reads:
            body["input_keys"] = self.listed(reads)
            state.reads = set(reads)
        if self.chance(0.6):
            type_ = self.draw.choice(sorted(LITERALS))
            key, inner = self.key_name(), self.key_name()
            body["output_keys"] = {inner: long_type(type_)}
            body["remapping"] = {inner: key}
            steps: list[Body] = [{"outcome": outcome} for outcome in outcomes]
            steps[0]["set"] = {inner: literal(self.draw, type_)}
            body["steps"] = steps
            state.sets[GOOD] = {key: type_}
        return state

    def skill(self, name: str, depth: int, known: Known) -> State:
        """A state type of its own, with an interface."""
        type_name = f"Skill{self.number()}"
        reads, remaps, inputs = {}, {}, {}
        for key, type_ in self.given(known).items():
            inner = self.key_name()
            reads[key], remaps[inner], inputs[inner] = type_, key, long_type(type_)
        type_, key, inner = self.draw.choice(sorted(LITERALS)), self.key_name(), self.key_name()
        remaps[inner] = key
        always = self.chance(0.3)
        self.files[f"templates/{type_name}.yml"] = {
            "name": type_name,
            "input_keys": inputs,
            "output_keys": {inner: long_type(type_)},
            "outcomes": {GOOD: {}, BAD: {}, "preempted": {}},
            **({} if always else {"writes": {GOOD: [inner]}}),
            "variables": {
                "speed": {"type": "float", "unit": "m/s", "min": 0, "exclusive": True, "default": 1}
            },
            "code": {"python": f"my_robot.states:{type_name}"},
        }
        body: Body = {"template": type_name, "remapping": remaps}
        if self.chance(0.5):
            body["speed"] = 0.5
        sets = {GOOD: {key: type_}, BAD: {key: type_} if always else {}, "preempted": {}}
        return self.sweetened(State(name, body, sets, set(reads)))

    def sweetened(self, state: State) -> State:
        """Perhaps with a time limit, or with retries."""
        if self.chance(0.2):
            state.body["timeout"] = "20s"
            state.sets["timeout"] = {}
        if self.chance(0.2):
            state.body["retry"] = {"on": [BAD], "max": 3, "delay": "100ms"}
            del state.sets[BAD]
            state.sets["exhausted"] = {}
        if len(state.sets) > 3 or "retry" in state.body:
            # Keys leave such a container with every outcome or not at all: judge with care.
            state.sets = {o: known if o == GOOD else {} for o, known in state.sets.items()}
        return state

    def printing(self, name: str, depth: int, known: Known) -> State:
        reads = self.some(known)
        body: Body = {"template": "PrintUserdataState"}
        if reads:
            body["input_keys"] = list(reads)
        return State(name, body, {GOOD: {}}, set(reads))

    def changing(self, name: str, depth: int, known: Known) -> State:
        key, type_ = self.reading(known, CHANGES)
        new = self.key_name()
        body: Body = {
            "template": "CallbacksState",
            "input_keys": [key],
            "output_keys": [new],
            "callbacks": {new: Quoted(CHANGES[type_].format(key))},
        }
        return State(name, body, {GOOD: {new: type_}}, {key})

    def deciding(self, name: str, depth: int, known: Known) -> State:
        key, type_ = self.reading(known, CONDITIONS)
        body: Body = {
            "template": "ConditionalOutcomeState",
            "input_keys": [key],
            "outcomes": [GOOD],
            "callbacks": {GOOD: Quoted(CONDITIONS[type_].format(key))},
            "default_outcome": BAD,
        }
        return State(name, body, {GOOD: {}, BAD: {}}, {key})

    def waiting(self, name: str, depth: int, known: Known) -> State:
        body: Body = {"template": "SleepState", "time": 0.01}
        return State(name, body, {GOOD: {}, "preempted": {}})
