"""The class of the leaves of recorded machines: they perform steps and note their inputs."""

from __future__ import annotations

import copy
from typing import Any

import smachac.runtime.smach as smach
from tests.conformance_ir.ir_vectors import Replay

PERFORMED: dict[str, Any] = {"events": [], "request": lambda: None}
"""The events of the run, and the function that requests a stop of the machine."""


class _Userdata:
    """Userdata as the interpreter has it, with the requests of its state."""

    def __init__(self, state: Any, userdata: Any) -> None:
        self.state, self.userdata = state, userdata

    def __getitem__(self, key: str) -> Any:
        return self.userdata[key]

    def __setitem__(self, key: str, value: Any) -> None:
        self.userdata[key] = value

    def __contains__(self, key: str) -> bool:
        return key in self.userdata

    def keys(self) -> list[str]:
        return sorted(self.userdata.keys())

    @property
    def preempted(self) -> bool:
        return bool(self.state.preempt_requested())

    def service_preempt(self) -> None:
        self.state.service_preempt()


class Steps(Replay):
    """What a step needs of the replay of a case: requests to stop of the machine."""

    def __init__(self) -> None:
        self.interpreter: Any = self
        self.preemption = self

    def request(self, path: str) -> None:
        assert path == ""
        PERFORMED["request"]()


class Vector(smach.State):
    """A leaf of a recorded machine."""

    def __init__(self, outcomes: Any, node: Any, input_keys: Any = (), output_keys: Any = ()):
        smach.State.__init__(self, outcomes, list(input_keys), list(output_keys))
        self.node, self.visit = node, 0

    def execute(self, userdata: Any) -> Any:
        node, self.visit = self.node, self.visit + 1
        found: Any = _Userdata(self, userdata)
        for key in [*node.get("in", []), *node.get("io", [])]:
            if key in found and found[key] is not None:
                value = copy.deepcopy(found[key])
                event = {"event": "read", "path": userdata._path, "key": key, "value": value}
                PERFORMED["events"].append(event)
        step = node["steps"][min(self.visit, len(node["steps"])) - 1]
        return Steps()._perform(step, found)
