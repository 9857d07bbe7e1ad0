"""Process-wide settings of the runtime: the loggers, the shutdown check, and `compat`.

They are process-wide as in SMACH: `set_loggers` and `set_shutdown_check` hold for all machines. The
package `smach` shows them under the same names; a value set there is set here.
"""

from __future__ import annotations

import os
from collections.abc import Callable

from smachac.runtime.smach import log

compat: bool = os.environ.get("SMACHAC_COMPAT", "") == "1"
"""Whether to behave as SMACH also where a script should not depend on it:

Ctrl-C and SystemExit become errors of the state; an exception of the items of an Iterator ends it
as if there were no more items; `keys` of remapped userdata gives the container's names, and
`update` writes undeclared keys too; Concurrences and Iterators do not pass on a preempt request
that came before their children ran; a container does not pass on a second request while the same
child runs; a child that did not answer a request starts its next visit with it; errors are logged
where they are raised.
To be set before a machine runs. The rules are listed in docs/semantics.md, section "Where the
bundled runtime differs from SMACH".
"""

loginfo: log.Logger = log.loginfo
logwarn: log.Logger = log.logwarn
logdebug: log.Logger = log.logdebug if compat else log.quiet
logerr: log.Logger = log.logerr
is_shutdown: Callable[[], bool] = log.is_shutdown


def log_raised(message: str) -> None:
    """Log the message of an error that is raised, as SMACH does, if `compat` is set. Otherwise only
    the code that handles the error reports it."""
    if compat:
        logerr(message)


def set_loggers(info: log.Logger, warn: log.Logger, debug: log.Logger, error: log.Logger) -> None:
    """Replace the four loggers. For a logger that does nothing, info lines are not built."""
    global loginfo, logwarn, logdebug, logerr
    loginfo, logwarn, logdebug, logerr = log.audible(info), warn, debug, error


log.set_loggers = set_loggers


def set_shutdown_check(cb: Callable[[], bool]) -> None:
    """Replace the function that running containers call to find out whether to stop."""
    global is_shutdown
    is_shutdown = cb
