"""Behaviors of smachac on FlexBE 2.3: states with SMACH's interface, and containers.

The classes have the names of FlexBE's, so that the FlexBE App can read a behavior that uses them.
An `EventState` runs its state of SMACH in a thread and has no outcome until that has ended, so that
a tick never blocks. The containers have SMACH's rules: each has userdata of its own, with inputs
copied at its entry and outputs at its end; a concurrence waits for all its states; an exception
that nothing catches ends the behavior.

A request to stop (`request`, and FlexBE's preempt) reaches what runs, outer states before inner
ones. FlexBE ends a behavior at once if a state has the outcome `preempted`; so that outcome has
another name here, as has `None`, which FlexBE reads as no outcome.
"""

from __future__ import annotations

import threading
import traceback
from dataclasses import dataclass, field

import flexbe_core
from flexbe_core import Logger, PriorityContainer
from flexbe_core.core import PreemptableState, UserData

PREEMPTED = "preempted"
RENAMED = {PREEMPTED: "preempted_", "None": "None_"}
_WRITTEN = {to: name for name, to in RENAMED.items()}
_LOCK = threading.RLock()


@dataclass(frozen=True)
class Loop:
    """A container that runs its one state once for each item, which is in its key `item`.

    `items` is a list, or a function of the userdata of the container. Outcomes in `again` go on
    with the next item. `renamed` maps the last outcome, or `exhausted`, to that of the container.
    `is_sugar`: after a request to stop the outcome is `preempted`.
    """

    items: object
    item: str
    again: list
    exhausted: str
    renamed: dict = field(default_factory=dict)
    is_sugar: bool = False


@dataclass(frozen=True)
class Join:
    """The end of a concurrence beside its conditions, of which the first one that holds decides.

    `default` is the outcome if none does. `first_ends`: the end of one state is a request to stop
    for the others. `rule_ends`: so is the end after which a condition holds. `is_limit`: after a
    request to stop the outcome is `preempted`.
    """

    default: str | None = None
    first_ends: bool = False
    is_limit: bool = False
    rule_ends: bool = False


class Keys:
    """The userdata of a state, as SMACH has it: its declared keys in its container. `loop`: it may
    use every key there."""

    def __init__(self, state):
        parent = state.parent
        self.__dict__.update(
            _state=state,
            _path=state.where,
            _inputs=state.work.get_registered_input_keys(),
            _outputs=state.work.get_registered_output_keys(),
            _held=parent.userdata,
            _names=parent.names(state),
            _free=getattr(parent, "loop", None) is not None,
        )

    def __getitem__(self, key):
        if not self._free and key not in self._inputs:
            raise KeyError(f"{key!r} is not one of the input keys")
        name = self._names.get(key, key)
        if name not in self._held:
            raise KeyError(f"{key!r} holds nothing")
        return self._held[name]

    def __setitem__(self, key, value):
        if not self._free and key not in self._outputs:
            Logger.logerr("%r is not one of the output keys: the value is dropped", key)
            return
        self._held[self._names.get(key, key)] = value
        self._state.tell("write", key=key, value=value)

    def __contains__(self, key):
        return (self._free or key in self._inputs) and self._names.get(key, key) in self._held

    def __getattr__(self, key):
        return self[key]

    def __setattr__(self, key, value):
        self[key] = value

    def keys(self):
        """The keys that can be read."""
        known = list(self._held._data) if self._free else self._inputs
        return [key for key in known if key in self]


class _Node:
    """A state or container: its path in the script (`where`) and its requests to stop.

    `catches` is the outcome that an exception in it becomes, `result` the outcome of this tick.
    """

    where = ""
    root = None
    catches = ""
    result = None
    requested = False
    running = ()
    observer = None

    def request(self):
        """Send a request to stop to this state and to all that run in it."""
        with _LOCK:
            self.requested = True
            self.tell("preempt")
            for state in tuple(self.running):
                state.request()

    def serve(self):
        """Mark the request of this state as answered."""
        self.requested = False

    def recall(self):
        """Take back the requests of this state and of all states in it."""
        with _LOCK:
            self.serve()
            for state in getattr(self, "_states", ()):
                state.recall()

    def tell(self, event, **fields):
        """Pass an event of the trace to the observer of the run."""
        if self.observer is not None:
            self.observer({"event": event, "path": self.where, **fields})

    def ended(self, outcome):
        """Note the outcome of this visit. FlexBE raises an error for an outcome that is not
        declared in a state machine."""
        self.result = outcome
        self.tell("exit", outcome=_written(outcome))
        is_in_machine = isinstance(self.parent, OperatableStateMachine) and not self.parent.loop
        if is_in_machine and outcome not in (*self.outcomes, PREEMPTED):
            self.tell("error", message=f"{_written(outcome)!r} is not one of its outcomes")


class EventState(_Node, flexbe_core.EventState):
    """A state with SMACH's interface (`work`) as a state of FlexBE: a thread runs it.

    `native` is the state of FlexBE in `work`, if there is one. Its methods run as they are, with
    its own keys: an exception is logged, and it stays active, unless the script has a transition
    for that. After a request to stop it is left (`is_left`): it has no outcome of its own, but that
    of FlexBE, which ends all containers around it up to the one that has sent the request.
    """

    work = native = None
    is_left = has_failed = False

    def __init__(self, outcomes, input_keys=None, output_keys=None):
        # The App reads these arguments, which it gives as text where a class passes its own on.
        keys = {"input_keys": input_keys or [], "output_keys": output_keys or []}
        flexbe_core.EventState.__init__(self, outcomes=outcomes, **keys)
        self.visit = None
        # FlexBE's own base classes wrap `execute` in the same way.
        self._flexbe_execute, self.execute = self.execute, self._tick

    @property
    def sleep_duration(self):
        """The time between two ticks in s; the end of the work starts one earlier."""
        return self._desired_period_ns * 1e-9

    @property
    def requested(self):
        return self.work.preempt_requested()

    def take(self, work):
        """Take the state of SMACH whose work this is."""
        self.work, self.native = work, getattr(work, "native", None)
        if self.native is not None:
            self._desired_period_ns = self.native._desired_period_ns
            self.native.set_name(self.name)
            self.native.set_parent(self.parent)

    def request(self):
        self.tell("preempt")
        self.work.request_preempt()

    def serve(self):
        self.work.recall_preempt()

    def on_enter(self, userdata):
        self.parent.starts(self)
        self.tell("enter")
        if self.native is not None:
            self.is_left = False
            self._call(self.native.on_enter)
            return
        self.visit = _Visit(self, self.visit)
        self.visit.start()

    def execute(self, userdata):
        """None while the thread runs; then the outcome. Raises the exception of the state."""
        if self.native is not None:
            return self._native_outcome()
        if self.visit.is_running:
            return None
        if self.visit.error is not None:
            self._entering = True
            raise self.visit.error
        return self.visit.outcome

    def on_exit(self, userdata):
        if self.native is not None:
            if not (self.is_left and self.root.requested):  # else FlexBE ends all without it
                self._call(self.native.on_exit)
        elif self.visit.is_running:  # the operator has chosen an outcome
            self.visit.is_left = True
            self.request()

    def on_start(self):
        if self.native is not None:
            self.native.on_start()

    def on_stop(self):
        if self.native is not None:
            self.native.on_stop()
        elif self.visit is not None and self.visit.is_running:
            self.request()

    def on_pause(self):
        if self.native is not None:
            self.native.on_pause()

    def on_resume(self, userdata):
        if self.native is not None:
            self._call(self.native.on_resume)

    def _native_outcome(self):
        """One tick of a state of FlexBE: its outcome, or None."""
        if self.requested:
            if RENAMED[PREEMPTED] in self.outcomes:
                self.serve()
                return RENAMED[PREEMPTED]
            self.is_left = True
            return PREEMPTED
        execute, outcome = type(self.native).execute, None  # without the parts for an operator
        if not self.has_failed:
            outcome = self._call(lambda userdata: execute(self.native, userdata))
        if self.has_failed:
            self.has_failed = False
            return self.catches or None
        outcome = None if outcome == "None" else RENAMED.get(outcome, outcome)
        if outcome is None or outcome in self.outcomes:
            return outcome
        Logger.logerr("%r of %s has no transition", outcome, self.path)
        self._call(self.native.on_exit)
        self._entering = True
        return None

    def _call(self, method):
        """Call a method of the state of FlexBE with its userdata. An exception is logged."""
        native, parent = self.native, self.parent
        keys = UserData(
            reference=parent.userdata,
            remap=parent.names(self),
            input_keys=native.input_keys,
            output_keys=native.output_keys,
        )
        try:
            with keys as userdata:
                return method(userdata)
        except Exception as error:
            self.tell("error", message=f"{type(error).__name__}: {error}")
            Logger.logerr("%s", traceback.format_exc())
            self.has_failed = True
            return None

    def _tick(self, userdata):
        self.result = None
        outcome = self._flexbe_execute(userdata)
        if outcome == PREEMPTED and not self.is_left:  # from FlexBE, which has not left the state
            PreemptableState.preempt = False
            if self._paused:
                self._paused = False
                PriorityContainer.active_container = self._last_active_container
            self.root.request()
            return None
        if outcome is not None:
            self.ended(outcome)
        return outcome


class _Visit(threading.Thread):
    """One execution of the work of a state. It starts when the one before it has ended. If an
    operator has left that, its request to stop is not for this one."""

    def __init__(self, state, before):
        super().__init__(name=state.where, daemon=True)
        self.state, self.before = state, before
        self.outcome = self.error = None
        self.is_running, self.is_left = True, False

    def run(self):
        state, before = self.state, self.before
        self.before = None
        if before is not None:
            before.join()
            if before.is_left and not state.parent.requested:
                state.serve()
        try:
            outcome = getattr(state.work, "attempted", state.work.execute)(Keys(state))
            if not isinstance(outcome, str):
                raise TypeError(f"{outcome!r} is no outcome")
            self.outcome = RENAMED.get(outcome, outcome)
        except BaseException as error:
            state.tell("error", message=f"{type(error).__name__}: {error}")
            if state.catches and isinstance(error, Exception):
                Logger.logerr("%s", traceback.format_exc())
                self.outcome = state.catches
            else:
                self.error = error
        self.is_running = False
        state.root.wake.set()


class _Container(_Node):
    """What containers share: userdata of their own, ticks, and the end after an exception."""

    def starts(self, state):
        """A state starts: its container has passed a request on before."""

    def names(self, state):
        """The names of a state's keys in this container, where they differ."""
        return self._remappings[state.name]

    def set_up(self, machine, name, loops=None, joins=None, catches=None, labels=None):
        """Set up the outermost container, before states are added.

        `machine` is that of the SMACH program, whose states do the work, and `name` that of the
        script. The others are by path in FlexBE: loops, joins, the outcomes that exceptions become,
        and the names in the script of states that have another one here.
        """
        self.root, self.where = self, name
        self.wake = threading.Event()
        self.states, values = _parts(machine, name)
        self.values = values
        self.loops, self.joins = loops or {}, joins or {}
        self.caught, self.labels = catches or {}, labels or {}
        self.is_set_up = False
        self._hold(values[name])

    def observe(self, observer):
        """Call a function with each event of the trace of later runs."""
        self._set_up_states()
        todo = [self]
        while todo:
            node = todo.pop()
            node.observer = observer
            todo += getattr(node, "_states", ())

    def request_preempt(self):
        """Request a stop of the machine."""
        self.request()
        self.root.wake.set()

    def confirm(self, name, number):
        """Prepare the states for a run. FlexBE calls this before the first tick."""
        self._set_up_states()
        super().confirm(name, number)

    def wait(self, seconds=None):
        """Wait until a state has ended, at most for a time in s."""
        if seconds is not None and seconds > 0:
            self.root.wake.wait(seconds)
        self.root.wake.clear()

    def execute(self, userdata):
        """One tick: the outcome, or None. Raises the exception of a state that nothing catches."""
        self.result = None
        try:
            outcome = self._tick()
        except Exception as error:
            self._current_state, self.running = None, ()
            if not self.catches:
                raise
            Logger.logerr("%s", "".join(traceback.format_exception_only(type(error), error)))
            self.ended(self.catches)
            return self.catches
        if outcome is not None:
            self._leave(outcome)
        return outcome

    def _tick(self):
        if self._current_state is None:
            self._enter()
            outcome = self._begin()
            if outcome is not None:
                return outcome
        try:
            outcome = super().execute(self.userdata)
        except Exception as error:  # FlexBE cannot log a message with `%`
            self._last_exception = self._last_exception or error
        error, self._last_exception = self._last_exception, None
        if error is not None:
            raise error
        return outcome

    def _enter(self):
        if self is self.root:
            self._set_up_states()
            self.tell("start")
            return
        self.parent.starts(self)
        self.tell("enter")
        self._copy(self.input_keys, into=True)

    def _leave(self, outcome):
        if self is self.root:
            self.tell("finish", outcome=outcome)
            return
        self.ended(outcome)
        self._copy(self.output_keys, into=False)

    def _copy(self, keys, into):
        names, own, outer = self.parent.names(self), self.userdata, self.parent.userdata
        pairs = [(key, names.get(key, key)) for key in keys]
        if into:
            values = {key: outer[name] for key, name in pairs if name in outer}
            self._hold(values, own)
        else:
            self._hold({name: own[key] for key, name in pairs if key in own}, outer)

    def _hold(self, values, userdata=None):
        """Put values into userdata; without it, those that this container does not hold."""
        for key, value in values.items():
            if userdata is not None:
                userdata[key] = value
            elif key not in self.userdata:
                self.userdata[key] = value

    def _set_up_states(self):
        """Find the work of each state; the settings of each container."""
        if self.is_set_up:
            return
        self.is_set_up = True
        todo = [self]
        while todo:
            container = todo.pop()
            for state in container._states:
                path = state.path
                state.root = self
                state.where = f"{container.where}/{self.labels.get(path, state.name)}"
                state.catches = self.caught.get(path, "")
                if isinstance(state, EventState):
                    state.take(self.states[state.where])
                    continue
                state.loop, state.join = self.loops.get(path), self.joins.get(path, Join())
                state._hold(self.values[state.where])
                todo.append(state)


class OperatableStateMachine(_Container, flexbe_core.OperatableStateMachine):
    """A state machine, or with a `Loop` a state that is repeated."""

    loop = None
    previous = None

    def names(self, state):
        return {} if self.loop else self._remappings[state.name]

    def starts(self, state):
        """A state starts: it gets the request of the machine, unless the state before it has
        answered that."""
        if self.loop:
            return
        with _LOCK:
            before = self.previous
            if self.requested and before is not None and not before.requested:
                self.requested = False
            elif self.requested:
                if before is not None:
                    before.serve()
                state.request()
            self.running, self.previous = [state], state

    def _begin(self):
        self.previous = None
        if self.loop is None:
            return None
        try:
            items = self.loop.items
            self.items = list(items(_All(self.userdata)) if callable(items) else items)
        except Exception as error:
            self.tell("error", message=str(error))
            raise
        self.place = 0
        return self._next() if self.items else self._ended_loop(self.loop.exhausted, None)

    def _next(self):
        """Start the state with the next item."""
        state = self._states[0]
        self.userdata[self.loop.item] = self.items[self.place]
        with _LOCK:
            self.running = [state]
            if self.requested and not state.requested:
                state.request()

    def _execute_current_state(self):
        state = self._current_state
        target = super()._execute_current_state()
        if state.result is None or self._last_exception is not None:
            return target
        self.root.wake.set()
        if self.loop is not None:
            return self._looped(state)
        if target is None:
            self._moved(state, self._current_state.where)
            return None
        with _LOCK:
            self.running = ()
            if not state.requested:
                self.requested = False
        self._moved(state, f"{self.where}:{_written(target)}")
        return target

    def _moved(self, state, to):
        state.tell("transition", outcome=_written(state.result), to=to)

    def _looped(self, state):
        """What follows an outcome of the state that is repeated: the next item, or the end."""
        self._current_state = state
        outcome = state.result
        if self.requested or outcome not in self.loop.again:
            return self._ended_loop(outcome, state)
        self.place += 1
        if self.place == len(self.items):
            return self._ended_loop(self.loop.exhausted, state)
        self._moved(state, state.where)
        return self._next()

    def _ended_loop(self, result, state):
        loop = self.loop
        self._current_state = None
        with _LOCK:
            self.running = ()
            result = loop.renamed.get(result, result)
            if self.requested and (loop.is_sugar or state is not None):
                self.recall()
                result = RENAMED[PREEMPTED] if loop.is_sugar else result
        if state is not None:
            self._moved(state, f"{self.where}:{_written(result)}")
        return result


class ConcurrencyContainer(_Container, flexbe_core.ConcurrencyContainer):
    """States that run at the same time. All have ended before the conditions are read."""

    join = Join()

    @property
    def sleep_duration(self):
        return min((state.sleep_duration for state in self.running), default=0.0)

    def _begin(self):
        self._returned_outcomes, self.errors, self.stopping = {}, [], False
        with _LOCK:
            self.running = list(self._states)
            for state in self.running:
                if self.requested and not state.requested:
                    state.request()

    def _execute_current_state(self):
        self._inner_sync_request = False
        for state in tuple(self.running):
            if not self._is_skipped(state):
                self._run(state)
                self._inner_sync_request |= state._inner_sync_request
        if self.join.rule_ends and self._decided() is not None:  # after all, as FlexBE
            with _LOCK:
                self._stop()
        if self.running:
            return None
        self._current_state = None
        self._inner_sync_request = True  # as FlexBE's, whose mirror loses track at the end
        return self._joined()

    def _is_skipped(self, state):
        """Whether a container with priority, or a state that is paused, runs alone."""
        active = PriorityContainer.active_container
        if active is None:
            return False
        theirs, ours = active.split("/"), state.path.split("/")
        count = min(len(theirs), len(ours))
        if theirs[:count] == ours[:count]:
            return False
        deep = state if isinstance(state, EventState) else state.get_deep_state()
        if deep is not None:
            deep._notify_skipped()
        return True

    def _run(self, state):
        """One tick of a state."""
        outcome = None
        try:
            outcome = self._execute_single_state(state)
        except Exception as error:
            self._last_exception = self._last_exception or error
        error, self._last_exception = self._last_exception, None
        if outcome is None and error is None:
            return
        with _LOCK:
            self.running.remove(state)
            if error is None:
                self._returned_outcomes[state.name] = outcome
            else:
                self.errors.append(error)
            if self.join.first_ends or error is not None:
                self._stop()

    def _stop(self):
        """Send a request to stop to the states that run, once."""
        if self.stopping:
            return
        self.stopping = True
        if not self.requested:
            for other in tuple(self.running):
                other.request()

    def _joined(self):
        """The outcome. Raises the first exception of a state."""
        with _LOCK:
            stopped = self.join.is_limit and self.requested
            unserved = [state for state in self._states if state.requested]
            for state in unserved:
                state.recall()
            if not unserved or stopped:
                self.requested = False
        if self.errors:
            raise self.errors[0]
        if stopped:
            return RENAMED[PREEMPTED]
        if self.requested and PREEMPTED in self._returned_outcomes.values():
            return PREEMPTED
        outcome = self._decided()
        return self.join.default if outcome is None else outcome

    def _decided(self):
        """The outcome of the first condition that holds, or None."""
        ended = self._returned_outcomes
        for outcome, conditions in self._conditions:
            if all(ended.get(name) == wanted for name, wanted in conditions):
                return outcome
        return None


class _All:
    """The userdata of a container, for the function that computes the items of a loop."""

    def __init__(self, held):
        self._held = held

    def __getitem__(self, key):
        if key not in self._held:
            raise KeyError(f"{key!r} holds nothing")
        return self._held[key]

    def __getattr__(self, key):
        return self[key]


def _written(outcome):
    """The name of an outcome in the script."""
    return _WRITTEN.get(outcome, outcome)


def _parts(machine, name):
    """The states of a machine of SMACH, and the initial values of its containers, both by path. A
    class of the user can be a container: it is used as a state."""
    states, values = {}, {}
    todo = [(name, machine)]
    while todo:
        path, state = todo.pop()
        states[path] = state
        children = getattr(state, "get_children", None)
        if children is not None:
            held = state.userdata
            values[path] = {key: held[key] for key in sorted(held.keys())}
            todo += [(f"{path}/{label}", one) for label, one in children().items()]
    return states, values
