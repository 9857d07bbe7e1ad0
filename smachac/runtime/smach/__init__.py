"""SMACH's public names, for machines without ROS.

Code written for `import smach` runs on this package unchanged:
`from smachac.runtime import smach`. What differs from SMACH is what could not be relied on there:
hangs raise, an exception while building leaves nothing open, the caller's dicts and lists are not
written to, Ctrl-C stops a machine, and values in userdata are never wrapped. docs/semantics.md
lists every difference; `compat` takes back those that a script may depend on.
"""

from __future__ import annotations

import os
from collections.abc import Callable

from smachac.runtime.smach import (
    concurrence,
    container,
    exceptions,
    iterator,
    log,
    sequence,
    state,
    state_machine,
    user_data,
    util,
)
from smachac.runtime.smach.concurrence import Concurrence
from smachac.runtime.smach.container import Container
from smachac.runtime.smach.exceptions import (
    InvalidConstructionError,
    InvalidStateError,
    InvalidTransitionError,
    InvalidUserCodeError,
)
from smachac.runtime.smach.iterator import Iterator
from smachac.runtime.smach.sequence import Sequence
from smachac.runtime.smach.state import CBState, State
from smachac.runtime.smach.state_machine import StateMachine
from smachac.runtime.smach.user_data import Remapper, UserData
from smachac.runtime.smach.util import CBInterface, cb_interface, has_smach_interface

__all__ = [
    "CBInterface",
    "CBState",
    "Concurrence",
    "Container",
    "InvalidConstructionError",
    "InvalidStateError",
    "InvalidTransitionError",
    "InvalidUserCodeError",
    "Iterator",
    "Remapper",
    "Sequence",
    "State",
    "StateMachine",
    "UserData",
    "cb_interface",
    "compat",
    "concurrence",
    "container",
    "exceptions",
    "has_smach_interface",
    "is_shutdown",
    "iterator",
    "log",
    "logdebug",
    "logerr",
    "loginfo",
    "logwarn",
    "sequence",
    "set_loggers",
    "set_shutdown_check",
    "state",
    "state_machine",
    "user_data",
    "util",
]

compat: bool = os.environ.get("SMACHAC_COMPAT", "") == "1"
"""Whether to do as SMACH does also where a script should not depend on it:

Ctrl-C and SystemExit become errors of the state; what the items of an Iterator raise ends them;
`keys` of remapped userdata gives the container's names, `update` writes them, declared or not; a
Concurrence keeps its children from a request that came before they ran, and leaves one that they
did not answer to their next visit. To be set before a machine runs.
"""

loginfo: log.Logger = log.loginfo
logwarn: log.Logger = log.logwarn
logdebug: log.Logger = log.logdebug
logerr: log.Logger = log.logerr
is_shutdown: Callable[[], bool] = log.is_shutdown


def set_loggers(info: log.Logger, warn: log.Logger, debug: log.Logger, error: log.Logger) -> None:
    """Replace the four loggers. Info lines of a run are not built for one that does nothing."""
    global loginfo, logwarn, logdebug, logerr
    loginfo, logwarn, logdebug, logerr = log.audible(info), warn, debug, error


def set_shutdown_check(cb: Callable[[], bool]) -> None:
    """Replace the function that running containers ask whether to stop."""
    global is_shutdown
    is_shutdown = cb
