"""Random scripts with time limits, retries and loops, and the states that are written in them."""

from __future__ import annotations

import random
from typing import Any, NamedTuple

import yaml

from smachac.diagnostics.source import Source
from smachac.driver import analyse_script
from smachac.ir.nodes import Machine

NAMES = ("DRIVE", "TIMER", "PAUSE", "TRY", "TIMED", "TRIES", "GO_HOME", "DOCK", "LOOK")
"""Names of states, also those that containers made of fields have."""


class SugaredScript(NamedTuple):
    """A script, and the paths of the states that are written in it, in their order."""

    text: str
    states: tuple[str, ...]

    def machine(self) -> Machine:
        found = analyse_script(Source("sm.yml", self.text)).machine
        assert found is not None
        return found


def random_script(seed: int, *, most: int = 12) -> SugaredScript:
    """A script of up to about `most` states with random fields; it may have findings."""
    chance = random.Random(seed)
    states = ["sm"]
    content = _content(chance, "sm", states, most, 0)
    script = {"name": "sm", "template": "Base", "outcomes": ["succeeded", "aborted"], **content}
    script["userdata"] = {"places": [1, 2]}
    return SugaredScript(yaml.safe_dump(script, sort_keys=False), tuple(states))


def _content(
    chance: random.Random, path: str, found: list[str], most: int, depth: int
) -> dict[str, Any]:
    names = chance.sample(NAMES, chance.randint(1, 4))
    states = []
    for number, name in enumerate(names):
        here = f"{path}/{name}"
        found.append(here)
        follower = names[number + 1] if number + 1 < len(names) else "succeeded"
        fields: dict[str, Any] = {
            "template": "ScriptedState",
            "outcomes": ["succeeded", "aborted"],
            **_sugar(chance),
        }
        if depth < 3 and len(found) < most and chance.random() < 0.3:
            fields["template"] = "StateMachine"
            fields |= _content(chance, here, found, most, depth + 1)
        ends = ["aborted", "timeout", "exhausted", "preempted"]
        own = {"succeeded", "aborted"} | {
            end
            for field, end in (("timeout", "timeout"), ("retry", "exhausted"))
            if field in fields
        }
        if own & {"timeout", "exhausted"} or "for_each" in fields:
            own.add("preempted")
        fields["transitions"] = {"succeeded": follower} | {
            end: "aborted" for end in ends if end in own
        }
        states.append({name: fields})
    return {"states": states}


def _sugar(chance: random.Random) -> dict[str, Any]:
    fields: dict[str, Any] = {}
    if chance.random() < 0.4:
        fields["timeout"] = chance.choice([2, "90 s", "2 h", "50 ms"])
    if chance.random() < 0.4:
        fields["retry"] = {"on": ["aborted"], "max": chance.randint(1, 4)}
        if chance.random() < 0.5:
            fields["retry"]["delay"] = "10 ms"
    if chance.random() < 0.3:
        fields["for_each"] = {"item": "place", "in": "places"}
    return fields
