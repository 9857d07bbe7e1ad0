"""Machines of smachac on YASMIN 6.1: states with SMACH's interface, and containers.

A `Machine` is a state machine of YASMIN. `Concurrence` and `Repeat` are states of YASMIN, because
its own concurrence has no remapping for a branch, no end with the first branch and one rule for an
outcome. Every container has keys of its own on the blackboard, whose names start with its path:
declared inputs are copied at its entry, declared outputs at its end.

A request to stop (`request`) reaches what runs, outer states before inner ones. One that comes
between two states reaches the next state. `cancel_state` of YASMIN is such a request to one state.
"""

from __future__ import annotations

import inspect
import logging
import threading
import traceback
from types import MappingProxyType

from yasmin import Blackboard, State, StateMachine

PREEMPTED = "preempted"
_LOCK = threading.RLock()
_LOG = logging.getLogger("yasmin")


class Keys:
    """The userdata of a `Skill`, as SMACH has it: its declared keys on the blackboard. `prefix` is
    that of its container where it may use every key there."""

    def __init__(self, blackboard, skill, prefix=None):
        self.__dict__.update(
            _blackboard=blackboard,
            _skill=skill,
            _state=skill.state,
            _prefix=prefix,
            _path=skill.path,
        )

    def _name(self, key):
        return key if self._prefix is None else self._prefix + key

    def __getitem__(self, key):
        if self._prefix is None and key not in self._state.get_registered_input_keys():
            raise KeyError(f"{key!r} is not one of the input keys")
        if self._name(key) not in self._blackboard:
            raise KeyError(f"{key!r} holds nothing")
        return self._blackboard[self._name(key)]

    def __setitem__(self, key, value):
        if self._prefix is None and key not in self._state.get_registered_output_keys():
            _LOG.error("%r is not one of the output keys: the value is dropped", key)
            return
        self._blackboard[self._name(key)] = value
        self._skill.tell("write", key=key, value=value)

    def __contains__(self, key):
        inputs = self._state.get_registered_input_keys()
        known = self._prefix is not None or key in inputs
        return known and self._name(key) in self._blackboard

    def __getattr__(self, key):
        return self[key]

    def __setattr__(self, key, value):
        self[key] = value

    def keys(self):
        """The keys that can be read."""
        if self._prefix is None:
            return [key for key in self._state.get_registered_input_keys() if key in self]
        names = self._blackboard.keys()
        return [name[len(self._prefix) :] for name in names if name.startswith(self._prefix)]


class _Node:
    """A state or container: its path, the container around it, its requests to stop.

    `catches` is the outcome that an exception in it becomes, `last` the outcome of its last visit.
    """

    path = ""
    parent = None
    catches = ""
    last = ""
    requested = False
    remapping = MappingProxyType({})
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
            for state in getattr(self, "children", {}).values():
                state.recall()

    def tell(self, event, **fields):
        """Pass an event of the trace to the observer of the run."""
        if self.observer is not None:
            self.observer({"event": event, "path": self.path, **fields})

    def ended(self, outcome):
        """Note the outcome of this visit. YASMIN raises an error for one that is not declared."""
        self.last = outcome
        self.tell("exit", outcome=outcome)
        declared = {*self.get_outcomes(), self.catches}
        if isinstance(self.parent, Machine) and outcome not in declared:
            self.tell("error", message=f"{outcome!r} is not one of its outcomes")
        return outcome


class Skill(_Node, State):
    """A state with SMACH's interface as a state of YASMIN."""

    def __init__(self, state, catches=""):
        State.__init__(self, list(state.get_registered_outcomes()))
        self.state = state
        self.catches = catches

    @property
    def requested(self):
        return self.state.preempt_requested()

    def request(self):
        self.tell("preempt")
        self.state.request_preempt()

    def serve(self):
        self.state.recall_preempt()

    def cancel_state(self):
        self.request()
        State.cancel_state(self)

    def execute(self, blackboard):
        self.parent.starts(self)
        self.tell("enter")
        prefix = self.parent.prefix if isinstance(self.parent, Repeat) else None
        try:
            execute = getattr(self.state, "attempted", self.state.execute)
            outcome = execute(Keys(blackboard, self, prefix))
        except Exception as error:
            self.tell("error", message=f"{type(error).__name__}: {error}")
            if not self.catches:
                raise
            _LOG.error(traceback.format_exc())
            outcome = self.catches
        return self.ended(outcome)


class _Container(_Node):
    """What containers share: keys of their own on the blackboard, and the states in them.

    `userdata` are the initial values of its keys. `prefix` is that of its keys: none for the
    outermost container.
    """

    def set_up(self, path, inputs, outputs, userdata, catches):
        self.path = path
        self.prefix = f"{path.partition('/')[2]}/" if "/" in path else ""
        self.inputs, self.outputs = inputs, outputs
        self.userdata = dict(userdata)
        self.catches = catches
        self.children = {}

    def take(self, name, state, remapping):
        """Take a state into the container."""
        state.path, state.parent = f"{self.path}/{name}", self
        state.remapping = dict(remapping)
        self.children[name] = state

    def names(self, state):
        """The names of a state's keys on the blackboard; a container copies its own keys."""
        if not isinstance(state, Skill) or isinstance(self, Repeat):
            return {}
        own = state.state
        keys = [*own.get_registered_input_keys(), *own.get_registered_output_keys()]
        outer = {key: self.prefix + state.remapping.get(key, key) for key in keys}
        return {key: name for key, name in outer.items() if key != name}

    def starts(self, state):
        """A branch or item starts: `execute` has passed requests on before."""

    def enter(self, blackboard):
        if self.parent is None:
            self.tell("start")
            return
        self.parent.starts(self)
        self.tell("enter")
        self._copy(blackboard, self.inputs, into=True)

    def leave(self, blackboard, outcome):
        if self.parent is None:
            self.last = outcome
            self.tell("finish", outcome=outcome)
            return outcome
        self.ended(outcome)
        self._copy(blackboard, self.outputs, into=False)
        return outcome

    def _copy(self, blackboard, keys, *, into):
        remapping = {} if isinstance(self.parent, Repeat) else self.remapping
        values = {}
        for key in keys:
            own, outer = self.prefix + key, self.parent.prefix + remapping.get(key, key)
            source, target = (outer, own) if into else (own, outer)
            if source in blackboard:
                values[target] = blackboard[source]
        for name, value in values.items():
            blackboard[name] = value

    def failed(self):
        """The outcome after an exception. Raises it again if nothing catches it."""
        if not self.catches:
            raise
        _LOG.error(traceback.format_exc())
        return self.ended(self.catches)


class Machine(_Container, StateMachine):
    """A state machine."""

    def __init__(self, path, outcomes, inputs=(), outputs=(), userdata=(), catches=""):
        StateMachine.__init__(self, list(outcomes))
        self.set_up(path, inputs, outputs, userdata, catches)
        self.previous = None
        self.by_name = {}
        self.add_start_cb(self._start)
        self.add_transition_cb(self._move)
        self.add_end_cb(self._end)

    def add(self, name, state, transitions, remapping=()):
        """Add a state; `transitions` has every outcome of it. YASMIN refuses the name of an
        outcome: such a state has the name with ` (state)`, also in transitions."""
        self.take(name, state, remapping)
        name = f"{name} (state)" if name in self.get_outcomes() else name
        self.by_name[name] = state
        made = Caught(state) if isinstance(state, Machine) and state.catches else state
        self.add_state(name, made, transitions=transitions, remappings=self.names(state))

    def starts(self, state):
        """A state starts: it gets the request of the machine, unless the state before it has
        answered that."""
        with _LOCK:
            before = self.previous
            if self.requested and before is not None and not before.requested:
                self.requested = False
            elif self.requested:
                if before is not None:
                    before.serve()
                state.request()
            self.running, self.previous = [state], state

    def _start(self, blackboard, initial):
        self.previous = None
        self.enter(blackboard)

    def _move(self, blackboard, state, target, outcome):
        to = self.by_name[target].path
        self.by_name[state].tell("transition", outcome=outcome, to=to)

    def _end(self, blackboard, outcome):
        if not outcome:
            return
        with _LOCK:
            self.running = ()
            if not self.previous.requested:
                self.requested = False
        last = self.previous.last
        self.previous.tell("transition", outcome=last, to=f"{self.path}:{outcome}")
        self.leave(blackboard, outcome)


class Caught(State):
    """A state machine whose exceptions become an outcome."""

    def __init__(self, machine):
        State.__init__(self, [*machine.get_outcomes(), machine.catches])
        self.machine = machine

    def cancel_state(self):
        self.machine.cancel_state()
        State.cancel_state(self)

    def execute(self, blackboard):
        try:
            return self.machine(blackboard)
        except Exception:
            return self.machine.failed()


class Concurrence(_Container, State):
    """States that run at the same time, each in a thread.

    `rules` are pairs of an outcome and its conditions, outcomes by the name of a state; the first
    rule that holds decides, else `default`. `first_ends`: the end of one state is a request to stop
    for the others. `is_limit`: after a request to stop the outcome is `preempted`.
    """

    def __init__(self, path, outcomes, rules=(), default=None, first_ends=False, is_limit=False,
                 inputs=(), outputs=(), userdata=(), catches=""):  # fmt: skip
        State.__init__(self, list(outcomes))
        self.set_up(path, inputs, outputs, userdata, catches)
        self.rules, self.default = rules, default
        self.first_ends, self.is_limit = first_ends, is_limit

    def add(self, name, state, remapping=()):
        """Add a state."""
        self.take(name, state, remapping)

    def cancel_state(self):
        self.request()
        State.cancel_state(self)

    def execute(self, blackboard):
        self.enter(blackboard)
        try:
            outcome = self._outcome(self._run(blackboard))
        except Exception:
            return self.failed()
        return self.leave(blackboard, outcome)

    def _run(self, blackboard):
        """Run all states; their outcomes by name. Raises the first exception of a state."""
        ended, errors = {}, []
        stopping = False

        def run(name, state):
            nonlocal stopping
            error = None
            try:
                board = blackboard.copy()
                board.set_remappings({**board.get_remappings(), **self.names(state)})
                made = Caught(state) if isinstance(state, Machine) and state.catches else state
                outcome = made(board)
            except Exception as raised:
                error = raised
            with _LOCK:
                self.running.remove(state)
                if error is None:
                    ended[name] = outcome
                else:
                    errors.append(error)
                if (self.first_ends or error is not None) and not stopping:
                    stopping = True
                    if not self.requested:
                        for other in tuple(self.running):
                            other.request()

        with _LOCK:
            self.running = list(self.children.values())
            for state in self.running:
                if self.requested and not state.requested:
                    state.request()
        threads = [threading.Thread(target=run, args=item) for item in self.children.items()]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        with _LOCK:
            stopped = self.is_limit and self.requested
            unserved = [state for state in self.children.values() if state.requested]
            for state in unserved:
                state.recall()
            if not unserved or stopped:
                self.requested = False
        if errors:
            raise errors[0]
        return {None: PREEMPTED} if stopped else ended

    def _outcome(self, ended):
        if None in ended:
            return ended[None]
        for outcome, conditions in self.rules:
            if all(ended[name] == wanted for name, wanted in conditions.items()):
                return outcome
        return self.default


class Repeat(_Container, State):
    """A state that runs once for each item, which is in its key `item`.

    `items` is a list, or a function of the userdata of the container. Outcomes in `again` go on
    with the next item. `renamed` maps the last outcome, or `exhausted`, to that of the container.
    `is_loop`: after a request to stop the outcome is `preempted`.
    """

    def __init__(self, path, outcomes, items, item, again, exhausted, renamed=(), is_loop=False,
                 inputs=(), outputs=(), userdata=(), catches=""):  # fmt: skip
        State.__init__(self, list(outcomes))
        self.set_up(path, inputs, outputs, userdata, catches)
        self.items, self.item, self.again = items, item, again
        self.exhausted, self.renamed, self.is_loop = exhausted, dict(renamed), is_loop

    def add(self, name, state):
        """Add the state that is repeated."""
        self.take(name, state, {})

    def cancel_state(self):
        self.request()
        State.cancel_state(self)

    def execute(self, blackboard):
        self.enter(blackboard)
        try:
            outcome = self._run(blackboard)
        except Exception:
            return self.failed()
        return self.leave(blackboard, outcome)

    def _run(self, blackboard):
        (state,) = self.children.values()
        made = Caught(state) if isinstance(state, Machine) and state.catches else state
        items, result, outcome = self._items(blackboard), self.exhausted, None
        for place, item in enumerate(items):
            blackboard[self.prefix + self.item] = item
            with _LOCK:
                self.running = [state]
                if self.requested and not state.requested:
                    state.request()
            outcome = made(blackboard)
            if self.requested or outcome not in self.again:
                result = outcome
                break
            if place + 1 < len(items):
                state.tell("transition", outcome=outcome, to=state.path)
        with _LOCK:
            self.running = ()
            result = self.renamed.get(result, result)
            if self.requested and (self.is_loop or outcome is not None):
                self.recall()
                result = PREEMPTED if self.is_loop else result
        if outcome is not None:
            state.tell("transition", outcome=outcome, to=f"{self.path}:{result}")
        return result

    def _items(self, blackboard):
        if not callable(self.items):
            return self.items
        try:
            return list(self.items(_All(blackboard, self.prefix)))
        except Exception as error:
            self.tell("error", message=str(error))
            raise


class _All:
    """The userdata of a container, for the function that computes the items of a `Repeat`."""

    def __init__(self, blackboard, prefix):
        self._blackboard, self._prefix = blackboard, prefix

    def __getitem__(self, key):
        if self._prefix + key not in self._blackboard:
            raise KeyError(f"{key!r} holds nothing")
        return self._blackboard[self._prefix + key]

    def __getattr__(self, key):
        return self[key]


class Run:
    """A machine with its blackboard, with the functions of SMACH's machines that programs use."""

    def __init__(self, machine, userdata=()):
        self.machine = machine
        self.blackboard = Blackboard()
        containers = [machine]
        while containers:
            container = containers.pop()
            for key, value in container.userdata.items():
                self.blackboard[container.prefix + key] = value
            children = container.children.values()
            containers += [state for state in children if isinstance(state, _Container)]
        for key, value in dict(userdata).items():
            self.blackboard[key] = value

    def observe(self, observer):
        """Call a function with each event of the trace of later runs."""
        todo = [self.machine]
        while todo:
            state = todo.pop()
            state.observer = observer
            todo += getattr(state, "children", {}).values()

    def execute(self):
        """Run the machine; its outcome. After `cancel_state_machine`, which YASMIN ends with an
        exception, it is `preempted` if the machine has that outcome."""
        try:
            return self.machine(self.blackboard)
        except RuntimeError:
            if self.machine.is_canceled() and PREEMPTED in self.machine.get_outcomes():
                return PREEMPTED
            raise

    def request_preempt(self):
        """Request a stop of the machine."""
        self.machine.request()


class Program:
    """The module of a SMACH program. Its machine is replaced by that of YASMIN, which `build` makes
    of its parts."""

    def __init__(self, module, name, build):
        self.module, self.name, self.build = module, name, build
        self.smach_machine = module.build

    def run(self, *arguments, **values):
        """The machine with its blackboard; the arguments are those of `build` of the module."""
        return Run(self.build(Parts(self.smach_machine(*arguments, **values), self.name)))

    def start(self):
        """Run the program once; the exit code. A stop signal is a request to the machine."""

        def made(*arguments, **values):
            machine = self.run(*arguments, **values)
            if hasattr(self.module, "stop_at_signals"):
                self.module.stop_at_signals(machine.request_preempt)
            return machine

        made.__signature__ = inspect.signature(self.smach_machine)  # the parameters of a node
        self.module.build = made
        if hasattr(self.module, "run_node"):
            return self.module.run_node()
        outcome = self.module.main()
        print(f"outcome: {outcome}")
        signals = getattr(self.module, "stop_signals", ())
        return 128 + signals[0] if signals else int(outcome is None)


class Parts:
    """The parts of a machine of SMACH: `states` are those that are no containers, `userdata` the
    initial values of containers, both by path."""

    def __init__(self, machine, name):
        self.states, self.userdata = {}, {}
        todo = [(name, machine)]
        while todo:
            path, state = todo.pop()
            if hasattr(state, "get_children"):
                held = state.userdata
                self.userdata[path] = {key: held[key] for key in sorted(held.keys())}
                todo += [(f"{path}/{label}", one) for label, one in state.get_children().items()]
            else:
                self.states[path] = state
