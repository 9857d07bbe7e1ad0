"""The state machines of SMACH, under its public names, without ROS.

Code written for `import smach` runs on this package unchanged:
`from smachac.runtime import smach`. It differs from SMACH where SMACH hangs or is unreliable: a
container that cannot run raises an error, an exception during construction leaves no container
open, the caller's dicts and lists are not modified, Ctrl-C stops a machine, and values in userdata
are never wrapped. docs/semantics.md, section "Where the bundled runtime differs from SMACH", lists
every difference. `compat` (see `settings`) restores those that a script may depend on.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from types import ModuleType

from smachac.runtime.smach import (
    concurrence,
    container,
    exceptions,
    iterator,
    log,
    sequence,
    settings,
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
from smachac.runtime.smach.settings import set_loggers, set_shutdown_check
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

compat: bool
loginfo: log.Logger
logwarn: log.Logger
logdebug: log.Logger
logerr: log.Logger
is_shutdown: Callable[[], bool]


def _setting(name: str) -> property:
    """A property that reads and sets a value in `settings`."""
    return property(
        lambda package: getattr(settings, name),
        lambda package, value: setattr(settings, name, value),
    )


class _Package(ModuleType):
    """This package. Its settings are those of `settings`, so that its modules need not import it.

    A script may set them here, as `smach.compat = True`.
    """

    compat = _setting("compat")
    loginfo = _setting("loginfo")
    logwarn = _setting("logwarn")
    logdebug = _setting("logdebug")
    logerr = _setting("logerr")
    is_shutdown = _setting("is_shutdown")


sys.modules[__name__].__class__ = _Package
