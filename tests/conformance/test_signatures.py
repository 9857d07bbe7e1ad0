"""The signatures of the public API: those of SMACH, as they were read on both of its branches.

`smach-signatures.json` holds names, kinds of parameters, and which are required. Code that uses a
keyword, or leaves an argument out, then works on the bundled runtime exactly if it works on SMACH.
"""

from __future__ import annotations

import inspect
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from smachac.runtime import smach, smach_ros

TABLE = json.loads(Path(__file__).with_name("smach-signatures.json").read_text())

BRANCHES = {
    ("ros2", "StateMachine.add"),
    ("ros2", "StateMachine.add_auto"),
    ("ros2", "Sequence.add_auto"),
}
"""Where the branches differ, the runtime has the parameters of the newer noetic: `constants`."""

ABSTRACT = {"State.execute", "Container.execute"}
"""Methods that only raise: their parameter has no keyword, so that overrides may name it freely."""

ROS = {
    "ActionServerWrapper": (
        "server_name action_spec wrapped_container",
        "succeeded_outcomes aborted_outcomes preempted_outcomes goal_key feedback_key result_key "
        "goal_slots_map feedback_slots_map result_slots_map expand_goal_slots pack_result_slots",
    ),
    "ActionServerWrapper.run_server": ("", ""),
    "ActionServerWrapper.execute_cb": ("goal", ""),
    "ActionServerWrapper.preempt_cb": ("", ""),
    "ActionServerWrapper.transition_cb": ("userdata active_states", ""),
    "ActionServerWrapper.termination_cb": ("userdata terminal_states container_outcome", ""),
    "ActionServerWrapper.publish_feedback": ("userdata", ""),
    "ConditionState": ("cond_cb", "input_keys poll_rate timeout max_checks"),
    "ConditionState.execute": ("ud", ""),
    "ContainerProxy": ("server_name container path", "update_rate"),
    "ContainerProxy.start": ("", ""),
    "ContainerProxy.stop": ("", ""),
    "IntrospectionClient": ("", ""),
    "IntrospectionClient.get_servers": ("", ""),
    "IntrospectionClient.set_initial_state": (
        "server path initial_states",
        "initial_userdata timeout",
    ),
    "IntrospectionServer": ("server_name state path", "unpickle"),
    "IntrospectionServer.start": ("", ""),
    "IntrospectionServer.stop": ("", ""),
    "IntrospectionServer.construct": ("server_name state path", ""),
    "IntrospectionServer.clear": ("", ""),
    "MonitorState": ("topic msg_type cond_cb", "max_checks input_keys output_keys"),
    "MonitorState.execute": ("ud", ""),
    "ServiceState": (
        "service_name service_spec",
        "request request_cb request_cb_args request_cb_kwargs request_key request_slots "
        "response_cb response_cb_args response_cb_kwargs response_key response_slots "
        "input_keys output_keys outcomes",
    ),
    "ServiceState.execute": ("ud", ""),
    "SimpleActionState": (
        "action_name action_spec",
        "goal goal_key goal_slots goal_cb goal_cb_args goal_cb_kwargs result_key result_slots "
        "result_cb result_cb_args result_cb_kwargs input_keys output_keys outcomes exec_timeout "
        "preempt_timeout server_wait_timeout feedback_cb feedback_cb_args feedback_cb_kwargs",
    ),
    "SimpleActionState.execute": ("ud", ""),
    "set_preempt_handler": ("sc", ""),
}
"""smach_ros for ROS 1: the required parameters, and the others; all may be given by position.

`unpickle` is the runtime's own: without it userdata from the network is not unpickled.
"""

Parameters = list[tuple[str, str, bool]]


def of_table() -> Iterator[tuple[str, str, Parameters]]:
    """(branch, name, parameters) of every public callable of SMACH."""
    for branch in ("both", "ros2", "noetic"):
        for name, entry in TABLE[branch].items():
            error = name.endswith("Error")
            if not error:
                yield branch, name, listed(entry.get("init", entry.get("params", [])))
            for method, parameters in entry.get("methods", {}).items():
                if not (error or method.startswith("_")):
                    yield branch, f"{name}.{method}", listed(parameters)


def listed(parameters: list[dict[str, Any]]) -> Parameters:
    return [(one["name"], one["kind"], one["required"]) for one in parameters]


def signature(library: object, name: str) -> Parameters:
    """The parameters of a class, method or function, without `self`."""
    owner, _, method = name.rpartition(".")
    found: Any = getattr(library, owner) if owner else library
    function = getattr(found, method)
    parameters = list(inspect.signature(function).parameters.values())
    if owner and not isinstance(inspect.getattr_static(found, method), staticmethod):
        parameters = parameters[1:]
    variadic = (inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD)
    return [
        (one.name, one.kind.name.lower(), one.default is one.empty and one.kind not in variadic)
        for one in parameters
    ]


def test_the_table_is_that_of_the_whole_api() -> None:
    names = {name for _, name, _ in of_table()}
    assert {"Iterator", "Concurrence.add", "Sequence.add", "UserData.update", "loginfo"} <= names
    assert len(names) > 150


@pytest.mark.parametrize(("branch", "name", "parameters"), list(of_table()))
def test_signature(branch: str, name: str, parameters: Parameters) -> None:
    found = signature(smach, name)
    if (branch, name) in BRANCHES:
        assert found == [*parameters, ("constants", "positional_or_keyword", False)]
    elif name in ABSTRACT:
        assert [item[0] for item in found] == [parameter[0] for parameter in parameters]
    else:
        assert found == parameters


@pytest.mark.parametrize("name", ROS)
def test_signature_of_smach_ros(name: str) -> None:
    required, optional = ROS[name]
    kind = "positional_or_keyword"
    assert signature(smach_ros, name) == [
        *((part, kind, True) for part in required.split()),
        *((part, kind, False) for part in optional.split()),
    ]


def test_the_table_of_smach_ros_is_that_of_its_names() -> None:
    classes = {name.partition(".")[0] for name in ROS}
    modules = {name for name in smach_ros.__all__ if inspect.ismodule(getattr(smach_ros, name))}
    assert classes == set(smach_ros.__all__) - modules
