"""The messages that a state sends and receives: from userdata and callbacks, and back to them."""

from __future__ import annotations

import copy
import traceback
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from smachac.runtime import smach
from smachac.runtime.smach import State
from smachac.runtime.smach_ros2.message_fields import FieldError, checked, filled
from smachac.runtime.state_callbacks import Callback, is_outcome


@dataclass(frozen=True, slots=True, kw_only=True)
class Outgoing:
    """A goal or a request: a default message, a key, slots and a callback, in this order.

    `name` is that of the server, `part` the word `goal` or `request`, `kind` the class.
    """

    name: str
    part: str
    kind: type[Any]
    default: Any
    key: str | None
    slots: Sequence[str]
    callback: Callback | None

    def keys(self) -> list[str]:
        """The userdata keys that are read."""
        return [*filter(None, [self.key]), *self.slots]

    def build(self, ud: Any) -> Any:
        """The message to send, a new one at each call; None if there is none, which is logged."""
        absent = [key for key in self.keys() if key not in ud]
        if absent:
            smach.logerr(f"nothing is sent to '{self.name}': keys {absent} are absent")
            return None
        try:
            message = copy.deepcopy(self.default if self.key is None else ud[self.key])
            message = checked(message, self.kind, self.part)
            message = filled(message, {slot: ud[slot] for slot in self.slots}, self.part)
            changed = None if self.callback is None else self.callback(ud, message)
            return checked(message if changed is None else changed, self.kind, self.part)
        except FieldError as error:
            smach.logerr(f"nothing is sent to '{self.name}': {error}")
        except Exception:
            smach.logerr(f"nothing is sent to '{self.name}':\n{traceback.format_exc()}")
        return None


@dataclass(frozen=True, slots=True, kw_only=True)
class Incoming:
    """A result or a response: it goes to a callback, a key and slots."""

    name: str
    key: str | None
    slots: Sequence[str]
    callback: Callback | None

    def keys(self) -> list[str]:
        """The userdata keys that are written."""
        return [*filter(None, [self.key]), *self.slots]

    def take(self, state: State, ud: Any, message: Any, *status: Any) -> str | None:
        """Pass the message on; the outcome that the callback gives, `aborted` if it fails."""
        outcome = None
        if self.callback is not None:
            try:
                outcome = self.callback(ud, *status, message)
            except Exception:
                smach.logerr(f"a callback of '{self.name}' failed:\n{traceback.format_exc()}")
                return "aborted"
            if outcome is not None and not is_outcome(state, outcome, self.name):
                return "aborted"
        if self.key is not None:
            ud[self.key] = message
        for slot in self.slots:
            ud[slot] = getattr(message, slot)
        return outcome
