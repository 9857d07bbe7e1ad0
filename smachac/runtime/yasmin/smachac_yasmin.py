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
from functools import partial
from types import MappingProxyType

from yasmin import Blackboard, State, StateMachine

PREEMPTED = "preempted"
_LOCK = threading.RLock()
_LOG = logging.getLogger("yasmin")


class Keys:
    """The userdata of a `Skill`, as SMACH has it: its declared keys, by their names on the
    blackboard."""

    def __init__(self, skill, blackboard, inputs, outputs):
        self.__dict__.update(
            _skill=skill, _blackboard=blackboard, _inputs=inputs, _outputs=outputs, _path=skill.path
        )

    def __getitem__(self, key):
        try:
            return self._blackboard[self._inputs[key]]
        except (KeyError, RuntimeError):
            known = key in self._inputs
            fault = "holds nothing" if known else "is not one of the input keys"
            raise KeyError(f"{key!r} {fault}") from None

    def __setitem__(self, key, value):
        if key not in self._outputs:
            _LOG.error("%r is not one of the output keys: the value is dropped", key)
            return
        self._blackboard[self._outputs[key]] = value
        if self._skill.observer is not None:
            self._skill.tell("write", key=key, value=value)

    def __contains__(self, key):
        return key in self._inputs and self._inputs[key] in self._blackboard

    __getattr__ = __getitem__
    __setattr__ = __setitem__

    def keys(self):
        """The keys that can be read."""
        return [key for key in self._inputs if key in self]


class AllKeys(Keys):
    """The userdata of the state in a `Repeat`, which may use every key there."""

    def keys(self):
        names, prefix = self._blackboard.keys(), self._inputs.prefix
        return [name[len(prefix) :] for name in names if name.startswith(prefix)]


class _AllNames:
    """The names on the blackboard of all keys of a container."""

    def __init__(self, prefix):
        self.prefix = prefix

    def __getitem__(self, key):
        return self.prefix + key

    def __contains__(self, key):
        return True


def _keys_of(inputs):
    """A class of `Keys` with a property for each input: several times as fast as `__getattr__`."""

    def reader(key, name):
        def read(self):
            try:
                return self._blackboard[name]
            except RuntimeError:
                raise KeyError(f"{key!r} holds nothing") from None

        return property(read)

    readers = {key: reader(key, name) for key, name in inputs.items() if not hasattr(Keys, key)}
    return type("Keys", (Keys,), readers)


class _Node:
    """A state or container: its path, the container around it, its requests to stop.

    `catches` is the outcome that an exception in it becomes.
    """

    path = ""
    parent = None
    catches = ""
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
        """Pass the end of this visit to the observer. YASMIN raises an error for an outcome that is
        not declared."""
        self.last = outcome
        if self.observer is None:
            return outcome
        self.parent.latest = self
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
        self.keys = None
        self.work = getattr(state, "attempted", state.execute)
        if catches:
            self.work = self._caught

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

    def bind(self, blackboard):
        """Take the blackboard of a run: `execute` is a function without further look-ups."""
        parent, work = self.parent, self.work
        if self.keys is None:
            self.keys = parent.keys(self)
        keys = self.keys(self, blackboard)

        def execute(_blackboard):
            if parent.requested:
                parent.pass_on(self)
            return work(keys)

        self.execute = execute

    def observed(self, keys, work):
        """Run the work of the state, with the events of the trace."""
        self.tell("enter")
        try:
            outcome = work(keys)
        except Exception as error:
            self.tell("error", message=f"{type(error).__name__}: {error}")
            raise
        return self.ended(outcome)

    def _caught(self, keys):
        """Run the state; an exception becomes an outcome."""
        try:
            return getattr(self.state, "attempted", self.state.execute)(keys)
        except Exception as error:
            self.tell("error", message=f"{type(error).__name__}: {error}")
            _LOG.error(traceback.format_exc())
            return self.catches


class Native(_Node, State):
    """A state of YASMIN with a class of its own. Its declared keys are those of its container, as
    for a `Skill`; all other keys are those of the blackboard, with the remapping of the state and
    of the containers around it.
    """

    def __init__(self, state, inputs=(), outputs=(), catches=""):
        self.state = state.native
        State.__init__(self, sorted({*self.state.get_outcomes(), *([catches] if catches else [])}))
        self.declared = (*inputs, *outputs)
        self.catches = catches

    def configure(self):
        self.state.configure()

    def request(self):
        self.requested = True
        self.tell("preempt")
        self.state.cancel_state()

    def cancel_state(self):
        self.request()
        State.cancel_state(self)

    def bind(self, blackboard):
        """Take the remapping of the containers around the state."""
        above, node = [], self
        while node.parent is not None:
            above.append({} if isinstance(node.parent, Repeat) else node.remapping)
            node = node.parent
        self.names = {}
        for remapping in reversed(above):
            outer = dict(self.names)
            self.names |= {key: outer.get(name, name) for key, name in remapping.items()}
        for key in self.declared:
            self.names[key] = self.parent.prefix + self.remapping.get(key, key)

    def execute(self, blackboard):
        if self.parent.requested:
            self.parent.pass_on(self)
        self.tell("enter")
        before = blackboard.get_remappings()
        blackboard.set_remappings(self.names)
        try:
            outcome = self.state(blackboard)
        except Exception as error:
            self.tell("error", message=f"{type(error).__name__}: {error}")
            if not self.catches:
                raise
            _LOG.error(traceback.format_exc())
            outcome = self.catches
        finally:
            blackboard.set_remappings(before)
        if self.state.is_canceled():
            self.serve()  # it was running when the request came
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
        self.requested = False

    def take(self, name, state, remapping):
        """Take a state into the container."""
        state.path, state.parent = f"{self.path}/{name}", self
        state.remapping = dict(remapping)
        self.children[name] = state

    def configure_all(self):
        """Configure the states, as a state machine of YASMIN does with its own."""
        for state in self.children.values():
            state.configure()

    def keys(self, state):
        """A function that makes the userdata of a state."""
        own, remapping = state.state, state.remapping
        inputs, outputs = (
            {key: self.prefix + remapping.get(key, key) for key in keys}
            for keys in (own.get_registered_input_keys(), own.get_registered_output_keys())
        )
        return partial(_keys_of(inputs), inputs=inputs, outputs=outputs)

    def bind(self, blackboard):
        """Take the blackboard of a run."""
        for state in self.children.values():
            state.bind(blackboard)

    def pass_on(self, state):
        """A branch or item starts: `execute` has passed requests on before."""

    def enter(self, blackboard):
        if self.parent is None:
            self.bind(blackboard)
            self.tell("start")
            return
        if self.parent.requested:
            self.parent.pass_on(self)
        self.tell("enter")
        self._copy(blackboard, self.inputs, into=True)

    def leave(self, blackboard, outcome):
        if self.parent is None:
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
        self.receiver = None
        self.by_name = {}
        self.add_start_cb(self._start)
        self.add_end_cb(self._end)

    def add(self, name, state, transitions, remapping=()):
        """Add a state; `transitions` has every outcome of it. YASMIN refuses the name of an
        outcome: such a state has the name with ` (state)`, also in transitions."""
        self.take(name, state, remapping)
        name = f"{name} (state)" if name in self.get_outcomes() else name
        self.by_name[name] = state
        made = Caught(state) if isinstance(state, Machine) and state.catches else state
        self.add_state(name, made, transitions=transitions)

    def request(self):
        """Send a request to stop to this machine and to its state. `receiver` is the state that has
        it; None if the machine has no state yet, or no more."""
        with _LOCK:
            self.requested = True
            self.tell("preempt")
            self.receiver = self.by_name.get(self.get_current_state())
            if self.receiver is not None:
                self.receiver.request()

    def pass_on(self, state):
        """A state starts: it gets the request of the machine, unless the state before it has
        answered that."""
        with _LOCK:
            before = self.receiver
            if before is state and state.requested:
                return
            if before is not None and not before.requested:
                self.requested = False
                return
            if before is not None:
                before.serve()
            self.receiver = state
            state.request()

    def _start(self, blackboard, initial):
        self.receiver = None
        self.enter(blackboard)

    def _move(self, blackboard, state, target, outcome):
        to = self.by_name[target].path
        self.by_name[state].tell("transition", outcome=outcome, to=to)

    def _end(self, blackboard, outcome):
        if not outcome:
            return
        with _LOCK:
            if self.receiver is not None and not self.receiver.requested:
                self.requested = False
        if self.observer is not None:
            last = self.latest
            last.tell("transition", outcome=last.last, to=f"{self.path}:{outcome}")
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
    for the others. `rule_ends`: so is the end after which a rule holds. `is_limit`: after a request
    to stop the outcome is `preempted`.
    """

    def __init__(self, path, outcomes, rules=(), default=None, first_ends=False, is_limit=False,
                 rule_ends=False, inputs=(), outputs=(), userdata=(), catches=""):  # fmt: skip
        State.__init__(self, list(outcomes))
        self.set_up(path, inputs, outputs, userdata, catches)
        self.rules, self.default = rules, default
        self.first_ends, self.is_limit, self.rule_ends = first_ends, is_limit, rule_ends

    def add(self, name, state, remapping=()):
        """Add a state."""
        self.take(name, state, remapping)

    configure = _Container.configure_all

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
                made = Caught(state) if isinstance(state, Machine) and state.catches else state
                outcome = made(blackboard.copy())
            except Exception as raised:
                error = raised
            with _LOCK:
                self.running.remove(state)
                if error is None:
                    ended[name] = outcome
                else:
                    errors.append(error)
                decides = self.first_ends or (self.rule_ends and self._rule(ended) is not None)
                if (decides or error is not None) and not stopping:
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
        outcome = self._rule(ended)
        return self.default if outcome is None else outcome

    def _rule(self, ended):
        """The outcome of the first rule that holds, or None."""
        for outcome, conditions in self.rules:
            if all(ended.get(name) == wanted for name, wanted in conditions.items()):
                return outcome
        return None


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

    def keys(self, state):
        names = _AllNames(self.prefix)
        return partial(AllKeys, inputs=names, outputs=names)

    configure = _Container.configure_all

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
            if state.observer is None and isinstance(state, Skill):
                state.work = partial(state.observed, work=state.work)
            elif state.observer is None and isinstance(state, Machine):
                state.add_transition_cb(state._move)
            state.observer = observer
            todo += getattr(state, "children", {}).values()

    def execute(self):
        """Run the machine; its outcome. After `cancel_state_machine`, which YASMIN ends with an
        exception, it is `preempted` if the machine has that outcome."""
        try:
            return self._executed()
        except RuntimeError:
            if self.machine.is_canceled() and PREEMPTED in self.machine.get_outcomes():
                return PREEMPTED
            raise

    def _executed(self):
        # Not in `execute`: pybind11 compares a caller of that name with each state that runs.
        return self.machine(self.blackboard)

    def request_preempt(self):
        """Request a stop of the machine."""
        self.machine.request()

    def is_running(self):
        """Whether the machine is being executed."""
        return self.machine.is_running()


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
    """The parts of a machine of SMACH: its states, and in `userdata` the initial values of
    containers, both by path. A class of the user can be a container: it is used as a state."""

    def __init__(self, machine, name):
        self.states, self.userdata = {}, {}
        todo = [(name, machine)]
        while todo:
            path, state = todo.pop()
            self.states[path] = state
            children = getattr(state, "get_children", None)
            if children is not None:
                held = state.userdata
                self.userdata[path] = {key: held[key] for key in sorted(held.keys())}
                todo += [(f"{path}/{label}", one) for label, one in children().items()]
