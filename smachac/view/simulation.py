"""Simulation in a view: a machine that stands before states, whose outcomes the user chooses."""

from __future__ import annotations

import gc
import re
import shlex
import threading
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import Any

from smachac.analysis.data_types import type_of_data
from smachac.analysis.type_lattice import fits
from smachac.diagnostics.source import Source
from smachac.frontend.text.data_files import plain
from smachac.frontend.text.yaml_tree import parse
from smachac.interpreter.behaviours import builtin_behaviour, own_code
from smachac.interpreter.interpreter import run
from smachac.interpreter.result import Event
from smachac.interpreter.scenario import (
    ScenarioStep,
    flow_text,
    read_scenario,
    scenario_behaviour,
    scenario_text,
)
from smachac.interpreter.simulation import (
    Choice,
    Position,
    chosen_scenario,
    is_possible,
    simulate,
)
from smachac.interpreter.userdata import LONGEST_WAIT
from smachac.ir.durations import in_one_unit, seconds
from smachac.ir.leaf import variable
from smachac.ir.nodes import Concurrence, Data, Leaf, Machine, Struct, is_number
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.script_paths import script_paths
from smachac.ir.secret_keys import secret_keys
from smachac.ir.traversal import outcome_names, walk
from smachac.ir.types import Type
from smachac.ir.written import Written, duration, written
from smachac.runtime.tracing.writer import SECRET, with_shown_paths
from smachac.verify.sample_values import SampleValues
from smachac.view.feed import Feed
from smachac.view.server import ActionError

MOST_CHOICES = 2_000
"""The most choices of a simulation."""

Save = Callable[[str, Callable[[str], str]], str]
"""Writes a text to the file of a scenario, by the name of the file and the function that makes the
text from its path, unless it exists with another text; the path. Raises ActionError."""

_NAME = re.compile(r"\w[\w.-]{0,99}")

ERROR = "an error of the simulation"
"""The message of an exception that the user chooses without one."""


class _Simulated:
    """What is known of a machine: its written states, its leaves, the types of its keys.

    `automatic` are the timers and pauses, which need no choice; `limits` the timers, with their
    states; `raced` the leaves in a concurrence that stops them when another branch ends.
    """

    def __init__(self, machine: Machine, view: Written) -> None:
        self.machine, self.view = machine, view
        self.leaves = {path: node for path, node in walk(machine.root) if isinstance(node, Leaf)}
        parts = written(machine).parts.values()
        self.automatic = {part.full for part in parts if part.role in ("timer", "pause")}
        self.limits = {part.full: part.state for part in parts if part.role == "timer"}
        self.raced = set(_raced(machine))
        self.shown = script_paths(machine.root)
        self.secret = secret_keys(machine)
        self.samples = SampleValues(machine)

    def words(self, choice: Choice) -> str:
        """The step of a choice in words, without the values of secret keys."""
        return _step_text(choice.step, self.secret.get(choice.path, ()))

    def position(self, choices: Sequence[Choice]) -> Position:
        return simulate(self.machine, choices, self.automatic)


def _raced(machine: Machine) -> Iterator[str]:
    """The full paths of all states in a concurrence with `join: any`."""
    inside: set[str] = set()
    for path, node in walk(machine.root):
        if path.rpartition("/")[0] in inside:
            inside.add(path)
            yield path
        elif isinstance(node, Concurrence) and node.join == "any":
            inside.add(path)


class Simulation:
    """The simulation of the script of a view, which all its pages show.

    `script` is the script as commands name it. The choices are kept as steps of leaves: a machine
    that takes the place of another one is simulated as far as they fit.
    """

    def __init__(
        self,
        feed: Feed,
        script: str,
        save: Save,
        view: Callable[[Machine], Written] = written,
    ) -> None:
        self._feed, self._script, self._save, self._view = feed, script, save, view
        self._lock = threading.Lock()
        self._machine: Machine | None = None
        self._simulated: _Simulated | None = None
        self._choices: list[Choice] = []
        self._position: Position | None = None
        self._note = ""

    def use(self, machine: Machine | None) -> None:
        """Use a machine from now on; None if the script has errors, so that the last one stays."""
        with self._lock:
            self._machine = machine
            before = self._simulated
            if machine is None or before is None:
                return
            self._simulated = _Simulated(machine, self._view(machine))
            self._replay(self._simulated, before)

    def act(self, body: Mapping[str, Any]) -> object:
        """Do one action of a page: `start`, `choose`, `back`, `save` or `end`. All but the first
        have the number of choices that the page shows, `at`. Raises ActionError."""
        with self._lock:
            gc.collect(0)  # automatic collection is off
            action = body.get("action")
            if action == "start":
                return self._start()
            if self._position is None or self._simulated is None:
                raise ActionError("no simulation runs")
            if body.get("at") != len(self._choices):
                raise ActionError("the simulation has gone on in another page: look at it again")
            match action:
                case "choose":
                    return self._choose(self._simulated, self._position, body)
                case "back":
                    return self._back(self._simulated, body)
                case "save":
                    return self._save_scenario(self._simulated, self._position, body)
                case "end":
                    return self._end()
            raise ActionError("there is no such action")

    # Actions

    def _start(self) -> object:
        if self._machine is None:
            raise ActionError("the script has errors, which must be fixed first")
        self._simulated = _Simulated(self._machine, self._view(self._machine))
        self._choices, self._note = [], ""
        return self._show(self._simulated, self._simulated.position([]))

    def _end(self) -> object:
        self._choices, self._position, self._simulated, self._note = [], None, None, ""
        self._feed.publish({"kind": "simulation", "state": "off"})
        return {}

    def _back(self, simulated: _Simulated, body: Mapping[str, Any]) -> object:
        """Take back the choices from number `to` on; without it, the last one."""
        to = body.get("to", len(self._choices) - 1)
        if not isinstance(to, int) or isinstance(to, bool) or not 0 <= to < len(self._choices):
            raise ActionError("there is no such step")
        self._choices, self._note = self._choices[:to], ""
        return self._show(simulated, simulated.position(self._choices))

    def _choose(self, simulated: _Simulated, position: Position, body: Mapping[str, Any]) -> object:
        path = body.get("path")
        full = next((full for full in position.waiting if simulated.view.state(full) == path), None)
        if full is None:
            raise ActionError(f"`{str(path)[:200]}` does not wait for an outcome")
        if len(self._choices) >= MOST_CHOICES:
            raise ActionError(f"a simulation has at most {MOST_CHOICES} steps")
        step = _step(simulated, full, body)
        self._choices, self._note = [*self._choices, Choice(full, step)], ""
        return self._show(simulated, simulated.position(self._choices))

    def _save_scenario(
        self, simulated: _Simulated, position: Position, body: Mapping[str, Any]
    ) -> object:
        name = body.get("name")
        if not isinstance(name, str) or _NAME.fullmatch(name) is None:
            raise ActionError("the name of a scenario has letters, digits, `_`, `-` and `.` alone")
        if position.result is None:
            raise ActionError("the machine has not ended: choose on, or go back")
        text, turns = self._scenario(simulated, position)
        file = f"{name}.yml"
        expected = ["--expect", position.result.outcome] if position.result.outcome else []
        order = ["--schedule", ",".join(turns)] if turns else []

        def command(path: str) -> str:
            words = ["smachac", "run", self._script, "--mock", path, *expected, *order]
            return shlex.join(words)

        why = ""
        if (failure := position.result.error) is not None:
            place = simulated.shown.get(failure.path, failure.path)
            why = f"# the run fails in {place}: {' '.join(failure.message.split())}\n"
        saved = self._save(file, lambda path: f"# {command(path)}\n{why}{text}")
        return {"file": saved, "command": command(saved)}

    def _scenario(self, simulated: _Simulated, position: Position) -> tuple[str, tuple[str, ...]]:
        """The text of the scenario of the choices, and the turns of branches without which it is
        another run. Raises ActionError if it does not play as the simulation does."""
        machine, shown = simulated.machine, simulated.shown
        steps = chosen_scenario(self._choices).steps
        text = scenario_text({shown.get(full, full): row for full, row in steps.items()})
        tree = parse(Source("scenario", text), [])
        scenario, problems = read_scenario(None if tree is None else plain(tree), machine)
        for schedule in (None, position.schedule):
            events: list[Event] = []
            behaviour = scenario_behaviour(scenario, machine, builtin_behaviour())
            run(machine, behaviour, events.append, schedule=schedule)
            if not problems and events == list(position.events):
                return text, schedule or ()
        reason = f": {problems[0].message}" if problems else ""
        raise ActionError(f"a scenario cannot describe this run{reason}")

    # What the pages show

    def _replay(self, simulated: _Simulated, before: _Simulated) -> None:
        """Simulate another machine: the choices up to the first one that does not fit."""
        moved = [_moved(choice, before.view, simulated.view) for choice in self._choices]
        known = next((at for at, choice in enumerate(moved) if choice is None), len(moved))
        choices = [choice for choice in moved[:known] if choice is not None]
        position = simulated.position(choices)
        if position.performed < len(self._choices):
            count = len(self._choices)
            lost = self._choices[position.performed]
            self._note = (
                f"The script has changed: step {position.performed + 1} of {count},"
                f" `{before.view.state(lost.path)}: {before.words(lost)}`, does not fit any more."
            )
        self._choices = choices[: position.performed]
        self._show(simulated, position)

    def _show(self, simulated: _Simulated, position: Position) -> object:
        self._position = position
        result = position.result
        self._feed.publish(
            {
                "kind": "simulation",
                "state": "waits" if result is None else "ended" if result.outcome else "failed",
                "note": self._note,
                "t": position.time,
                "events": [with_shown_paths(event, simulated.shown) for event in position.events],
                "steps": [
                    {"path": simulated.view.state(choice.path), "text": simulated.words(choice)}
                    for choice in self._choices
                ],
                "at": [self._waiting(simulated, position, full) for full in position.waiting],
                "outcome": None if result is None else result.outcome,
            }
        )
        return {}

    def _waiting(self, simulated: _Simulated, position: Position, full: str) -> dict[str, Any]:
        """A leaf that waits for a choice: its outcomes with their keys, and what else it can do."""
        leaf = simulated.leaves[full]
        stopped = full in position.stopped and PREEMPTED in outcome_names(leaf)
        names = (PREEMPTED,) if stopped else outcome_names(leaf)
        visit = 1 + sum(choice.path == full for choice in self._choices)
        return {
            "path": simulated.view.state(full),
            "stopped": full in position.stopped,
            "stops": PREEMPTED in outcome_names(leaf),
            "outcomes": [
                {"name": name, "keys": [] if stopped else _keys(simulated, full, name, visit)}
                for name in names
            ],
            "run": "" if stopped else _own_code(leaf),
            "wait": "" if stopped else self._wait(simulated, position, full),
        }

    def _wait(self, simulated: _Simulated, position: Position, full: str) -> str:
        """What happens if a leaf waits: which time limit passes, or that it waits for the other
        branches; empty if nothing ends the wait."""
        after = simulated.position([*self._choices, Choice(full, ScenarioStep(wait=True))])
        passed = after.time - position.time
        if passed >= LONGEST_WAIT / 2:
            return ""
        new = after.events[len(position.events) :]
        ended = (event for event in new if event["event"] == "exit" and event["t"] > position.time)
        timer = next((event for event in ended if event["path"] in simulated.limits), None)
        if timer is not None:
            name = simulated.limits[timer["path"]].rpartition("/")[2]
            left = duration(timer["t"] - position.time)
            return f"time limit of {name} in {left}: let it pass"
        if passed > 0:
            return f"wait {duration(passed)} for a stop request"
        return "wait for a stop request" if full in simulated.raced else ""


def _own_code(leaf: Leaf) -> str:
    """What a leaf does without a step, in words; empty if it only ends."""
    match own_code(leaf):
        case "time":
            time = variable(leaf, "time")
            return f"wait {duration(float(time))}" if is_number(time) else "wait its time"
        case "":
            return ""
        case code:
            return f"run its {code}"


def _keys(simulated: _Simulated, full: str, outcome: str, visit: int) -> list[dict[str, Any]]:
    """The keys that a leaf writes with an outcome, with values by their types."""
    leaf = simulated.leaves[full]
    samples = simulated.samples.outputs(full, leaf, outcome, visit)
    return [
        {
            "name": key,
            "type": str(type_),
            "text": _is_text(type_),
            "choices": _choices(type_),
            "value": value if _is_text(type_) else flow_text(value),
        }
        for key, value in samples
        for type_ in [simulated.samples.type_of(full, leaf, key)]
    ]


def _is_text(type_: Type) -> bool:
    return type_.name == "str"


def _choices(type_: Type) -> list[str]:
    """All values of a type, as scenarios have them; empty if there are too many."""
    if type_.name == "bool":
        return ["true", "false"]
    return [flow_text(value) for value in type_.args] if type_.name in ("one_of", "literal") else []


def _step(simulated: _Simulated, full: str, body: Mapping[str, Any]) -> ScenarioStep:
    """The step that a page describes for a leaf. Raises ActionError."""
    leaf, stop = simulated.leaves[full], body.get("stop") is True
    if body.get("run") is True:
        return ScenarioStep(run=True, stop=stop)
    if body.get("wait") is True:
        return ScenarioStep(wait=True, stop=stop)
    error = body.get("error")
    if isinstance(error, str):
        return ScenarioStep(error=error.strip() or ERROR, stop=stop)
    outcome, after = body.get("outcome"), seconds(body.get("after", 0))
    if not isinstance(outcome, str) or not is_possible(ScenarioStep(outcome=outcome), leaf):
        raise ActionError(f"`{str(outcome)[:80]}` is not an outcome of `{leaf.name}`")
    if after is None:
        raise ActionError("the time is a number and a unit, such as `30 s`, `5 min` or `2 h`")
    given = body.get("set", {})
    if not isinstance(given, dict):
        raise ActionError("the values of keys are missing")
    return ScenarioStep(
        outcome=outcome,
        writes=tuple((key, _value(simulated, full, key, text)) for key, text in given.items()),
        after=after,
        stop=stop,
    )


def _value(simulated: _Simulated, full: str, key: str, text: object) -> object:
    """The value of an output key that a page has as text. Raises ActionError."""
    leaf = simulated.leaves[full]
    if all(key != output.name for output in leaf.outputs) or not isinstance(text, str):
        raise ActionError(f"`{key[:80]}` is not an output key of `{leaf.name}`")
    type_ = simulated.samples.type_of(full, leaf, key)
    if _is_text(type_):
        return text
    report: list[Any] = []
    tree = parse(Source(key, text), report)
    if tree is None or report or "\n" in text:
        raise ActionError(f"the value of `{key}` cannot be read: write it as in a scenario")
    value = plain(tree)
    is_message = any(sign in str(type_) for sign in "/.")  # whose values scenarios have no form for
    if not is_message and not fits(type_of_data(_data(value)), type_):
        raise ActionError(f"`{key}` is {type_}: `{text[:80]}` does not fit")
    return value


def _data(value: object) -> Data:
    """Plain data as a value of a script."""
    match value:
        case dict():
            return Struct(entries=tuple((str(key), _data(item)) for key, item in value.items()))
        case list():
            return tuple(map(_data, value))
        case bool() | int() | float() | str() | None:
            return value
    return str(value)


def _moved(choice: Choice, before: Written, now: Written) -> Choice | None:
    """A choice in one machine for another one: that of the same state of the script."""
    state = now.states.get(before.state(choice.path))
    return None if state is None else Choice(state.full, choice.step)


def _step_text(step: ScenarioStep, secret: Collection[str]) -> str:
    """A step in words."""
    words = ["stop request"] if step.stop else []
    if step.run:
        words.append("its own code")
    elif step.wait:
        words.append("waits")
    elif step.error:
        words.append(f"error: {step.error}")
    else:
        words.append(step.outcome or "")
    words += [f"after {in_one_unit(step.after)}"] if step.after else []
    for key, value in step.writes:
        words.append(f"{key} = {SECRET if key in secret else flow_text(value)}")
    return ", ".join(words)
