"""Scenarios: scripted outcomes, writes and errors of chosen leaves, in place of their state type's
code."""

from __future__ import annotations

import copy
import json
import math
import random
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import NamedTuple

from smachac.diagnostics.diagnostic import did_you_mean
from smachac.diagnostics.spelling import MOST_EXPLAINED, is_plain
from smachac.diagnostics.wording import listed
from smachac.interpreter.behaviours import own_code, preemptible
from smachac.interpreter.result import Behaviour
from smachac.interpreter.userdata import BehaviourError, Userdata
from smachac.ir.durations import in_one_unit, seconds
from smachac.ir.leaf import default_outcome
from smachac.ir.nodes import Iterator, Leaf, Machine
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.script_paths import walk_script
from smachac.ir.traversal import enclosing, outcome_names, walk
from smachac.records import dataclass, replace


@dataclass(frozen=True, slots=True, kw_only=True)
class ScenarioStep:
    """One visit of a leaf: the keys it writes, in order, and its outcome.

    Without an outcome the leaf ends with its default outcome. `stop`: the visit begins with a
    request to stop for the whole machine. `wait`: the leaf first waits for a request to stop.
    `after`: the time that the visit takes, in seconds. `error`: the leaf raises an error with this
    message instead. `chances`: outcomes with their probabilities, one of which is drawn at each
    visit and takes the place of `outcome`. `run`: the leaf behaves as without a step.
    """

    outcome: str | None = None
    chances: tuple[tuple[str, float], ...] = ()
    writes: tuple[tuple[str, object], ...] = ()
    wait: bool = False
    error: str = ""
    stop: bool = False
    after: float = 0.0
    run: bool = False


STEP_FIELDS: Mapping[str, str] = {
    "outcome": "The outcome it ends with, or the probability of each of several outcomes; without"
    " one, its default outcome.",
    "set": "The userdata keys that it writes: {width: 0.05}.",
    "after": "The time that it takes: 30 s.",
    "wait": "It first waits for a request to stop.",
    "error": "It raises an error with this message.",
    "stop": "The visit begins with a request to stop for the whole machine.",
    "run": "It runs its own functions, or waits its own time, as a state without steps.",
}
"""The fields of a step in a scenario file, with their descriptions."""

OWN_CODE = ("run", "stop")
"""The fields of a step that runs the code of its state."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Scenario:
    """The steps of leaves by path. Visit n performs step n; the last step repeats.

    A path is that of the script (docs/language.md, Paths) or the full one, and may be shortened to
    its end (`GRASP`, `PICK/GRASP`) if only one leaf has that end. `fill`: output keys that a step
    does not write get values by their types.
    """

    steps: Mapping[str, tuple[ScenarioStep, ...]]
    fill: bool = False


Fill = Callable[[str, Leaf, str, int], Sequence[tuple[str, object]]]
"""The values that a leaf writes by their types: from its path, itself, its outcome and the number
of its visit, from 1."""

SCENARIO_FIELDS: Mapping[str, str] = {
    "states": "The steps of states, by path; the last step repeats.",
    "fill": "Output keys that a step does not set get values by their types.",
}
"""The fields of a scenario file, with their descriptions."""


def scenario_behaviour(
    scenario: Scenario,
    machine: Machine,
    otherwise: Behaviour,
    seed: int = 0,
    fill: Fill | None = None,
) -> Behaviour:
    """A behaviour that follows a scenario; leaves without steps follow `otherwise`.

    `seed` is that of outcomes with probabilities; each leaf has random numbers of its own. With
    `fill`, leaves that do not run their own code write all their outputs. Raises ValueError for a
    path that names no leaf, or several.
    """
    by_path = _by_path(scenario, machine)
    others = preemptible(otherwise)
    sources: dict[str, random.Random] = {}

    def behave(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
        steps = by_path.get(path)
        if not steps and (fill is None or own_code(leaf)):
            return others(path, leaf, visit, userdata)
        steps = steps or (ScenarioStep(),)
        step = steps[min(visit, len(steps)) - 1]
        if step.chances:
            if path not in sources:
                sources[path] = random.Random(f"{seed}/{path}")
            outcomes, weights = zip(*step.chances, strict=True)
            step = replace(step, outcome=sources[path].choices(outcomes, weights)[0])
        if fill is not None:
            outcome = step.outcome if step.outcome is not None else default_outcome(leaf)
            writes = {**dict(fill(path, leaf, outcome, visit)), **dict(step.writes)}
            step = replace(step, writes=tuple(writes.items()))
        return play_step(step, others, path, leaf, visit, userdata)

    return behave


def play_step(
    step: ScenarioStep,
    otherwise: Behaviour,
    path: str,
    leaf: Leaf,
    visit: int,
    userdata: Userdata,
) -> str:
    """Perform one step of a leaf, or what it does `otherwise`; the outcome."""
    if step.stop:
        userdata.stop_machine()
    if step.run:
        return otherwise(path, leaf, visit, userdata)
    return perform_step(step, leaf, userdata)


def perform_step(step: ScenarioStep, leaf: Leaf, userdata: Userdata) -> str:
    """Perform one step of a leaf, without its `stop` and `run`; the outcome."""
    able = PREEMPTED in outcome_names(leaf)
    if userdata.preempted and able:
        userdata.service_preempt()
        return PREEMPTED
    if step.wait and not userdata.preempted:
        userdata.wait_for_stop()
        if able:
            return PREEMPTED
    userdata.sleep(step.after)
    if step.error:
        raise BehaviourError(step.error)
    for key, value in step.writes:
        userdata[key] = copy.deepcopy(value)
    return step.outcome if step.outcome is not None else default_outcome(leaf)


class PlainStep(NamedTuple):
    """A step as plain data, for generated programs, which have no `after` and `run`."""

    outcome: str
    writes: dict[str, object]
    wait: bool
    error: str
    stop: bool


def plain_steps_by_path(scenario: Scenario, machine: Machine) -> dict[str, list[PlainStep]]:
    """The steps of a scenario as plain data, by full path.

    Raises ValueError for a path that names no leaf, or several.
    """
    nodes = dict(walk(machine.root))
    rows: dict[str, list[PlainStep]] = {}
    for path, steps in _by_path(scenario, machine).items():
        leaf = nodes[path]
        assert isinstance(leaf, Leaf)
        usual = default_outcome(leaf)
        rows[path] = [
            PlainStep(step.outcome or usual, dict(step.writes), step.wait, step.error, step.stop)
            for step in steps
        ]
    return rows


def scenario_text(rows: Mapping[str, Sequence[ScenarioStep]]) -> str:
    """A scenario as a file for `smachac run --mock`. Steps with `chances` are not possible."""
    lines = ["states:" if rows else "states: {}"]
    for path, row in rows.items():
        steps = [_short(_step(step)) for step in row]
        if len(steps) == 1:
            lines.append(f"  {flow_text(path)}: {steps[0]}")
        else:
            lines += [f"  {flow_text(path)}:", *(f"    - {step}" for step in steps)]
    return "\n".join(lines) + "\n"


def scenario_line(rows: Mapping[str, Sequence[ScenarioStep]]) -> str:
    """A scenario on one line, with steps that are only an outcome as short as possible."""
    states = {path: [_short(_step(step)) for step in row] for path, row in rows.items()}
    parts = (f"{flow_text(path)}: [{', '.join(steps)}]" for path, steps in states.items())
    return f"{{states: {{{', '.join(parts)}}}}}"


def flow_text(value: object) -> str:
    """A value as YAML on one line, with quotes only where they are needed."""
    match value:
        case dict():
            return f"{{{', '.join(f'{flow_text(key)}: {flow_text(value[key])}' for key in value)}}}"
        case list() | tuple():
            return f"[{', '.join(map(flow_text, value))}]"
        case str() if is_plain(value):
            return value
        case float() if not math.isfinite(value):
            return ".nan" if math.isnan(value) else ".inf" if value > 0 else "-.inf"
    return quoted(value)


def _short(step: dict[str, object]) -> str:
    return flow_text(step["outcome"] if [*step] == ["outcome"] else step)


def _step(step: ScenarioStep) -> dict[str, object]:
    data: dict[str, object] = {"stop": True} if step.stop else {}
    if step.run:
        return data | {"run": True}
    data |= {"after": in_one_unit(step.after)} if step.after else {}
    if step.error:
        return data | {"error": step.error}
    data |= {"wait": True} if step.wait else {}
    data |= {"outcome": step.outcome} if step.outcome is not None else {}
    return data | ({"set": dict(step.writes)} if step.writes else {})


def quoted(value: object) -> str:
    """A value as YAML on one line."""
    return json.dumps(value, ensure_ascii=False)


def _by_path(scenario: Scenario, machine: Machine) -> dict[str, tuple[ScenarioStep, ...]]:
    leaves = _leaves(machine)
    by_path: dict[str, tuple[ScenarioStep, ...]] = {}
    for name, steps in scenario.steps.items():
        path = _found(name, leaves)
        if path is None:
            raise ValueError(": ".join(filter(None, _not_found(name, machine, leaves))))
        by_path[path] = steps
    return by_path


class ScenarioProblem(NamedTuple):
    """A fault of a scenario. `state` is the key below `states:` that it is about, if any; `step`
    the number of the step, counted from 1."""

    message: str
    help: str | None = None
    state: str | None = None
    step: int | None = None


def read_scenario(data: object, machine: Machine) -> tuple[Scenario, list[ScenarioProblem]]:
    """The scenario that plain data of a file describes, with full paths; and its faults.

    ```yaml
    states:
      sm/PICK/GRASP:
        - {outcome: aborted}
        - {outcome: succeeded, set: {width: 0.05}}
        - {error: the gripper does not answer}
      CHECK: succeeded
      TIMER: {wait: true}
      WALK: [succeeded, {outcome: preempted, stop: true}]
      CHARGE: {outcome: full, after: 2 h}
      LIFT: {outcome: {succeeded: 0.7, aborted: 0.3}}
    ```
    """
    problems: list[ScenarioProblem] = []
    steps: dict[str, tuple[ScenarioStep, ...]] = {}
    leaves, unknown = _leaves(machine), 0
    if not isinstance(data, dict) or not isinstance(data.get("states"), dict):
        message = "a scenario is a mapping with `states`: a mapping of paths"
        near = (
            (did_you_mean(str(key), ["states"]) for key in data if key != "states")
            if isinstance(data, dict)
            else ()
        )
        help_ = next(filter(None, near), None) or f"write `states: {{{_example(leaves)}}}`"
        return Scenario(steps={}), [ScenarioProblem(message, help_)]
    problems.extend(
        ScenarioProblem(
            f"unknown key `{key}`; a scenario has `states` and `fill`", f"remove `{key}`"
        )
        for key in data
        if key not in SCENARIO_FIELDS
    )
    if not isinstance(data.get("fill", False), bool):
        problems.append(ScenarioProblem("`fill` is true or false", "write `fill: true`"))
    names: dict[str, str] = {}
    for key, given in data["states"].items():
        name = str(key)
        path = _found(name, leaves)
        if path is None:
            unknown += 1
            if unknown <= MOST_EXPLAINED:
                problems.append(ScenarioProblem(*_not_found(name, machine, leaves), name))
            else:
                problems.append(ScenarioProblem(f"there is no state `{name}`", None, name))
            continue
        if path in names:
            message = f"`{names[path]}` and `{name}` are the same state"
            problems.append(ScenarioProblem(message, "write all its steps in one list", name))
        names.setdefault(path, name)
        entries = given if isinstance(given, list) else [given]
        if not entries:
            help_ = f"write `{_example(leaves, path)}`, or remove it"
            problems.append(ScenarioProblem(f"`{name}` has no steps", help_, name))
        reader = _StepReader(leaves[path], name, problems)
        steps[path] = tuple(reader.step(entry, at) for at, entry in enumerate(entries, 1))
    return Scenario(steps=steps, fill=data.get("fill") is True), problems


@dataclass(frozen=True, slots=True)
class _LeafEntry:
    """A leaf, whether it may write any key, and its paths: in the script, without the roles of
    sugar, in the graph."""

    leaf: Leaf
    unrestricted: bool
    paths: tuple[str, str, str]


@dataclass(frozen=True, slots=True)
class _StepReader:
    """Converts the steps of one leaf, `name` in the scenario, and collects the problems."""

    place: _LeafEntry
    name: str
    problems: list[ScenarioProblem]

    def step(self, entry: object, number: int) -> ScenarioStep:
        if isinstance(entry, str | bool):
            return ScenarioStep(outcome=self.outcome(entry, number))
        if not isinstance(entry, dict):
            self.problem(number, "a step is an outcome, or a mapping with `outcome` and `set`")
            return ScenarioStep()
        for key in entry:
            if key not in STEP_FIELDS:
                help_ = _name_help(str(key), STEP_FIELDS)
                self.problem(number, f"unknown key `{key}`", help_)
        writes = entry.get("set") or {}
        if not isinstance(writes, dict):
            self.problem(number, "`set` is a mapping of userdata keys to values")
            writes = {}
        declared = [key.name for key in self.place.leaf.outputs]
        for key in writes:
            if not self.place.unrestricted and key not in declared:
                help_ = _name_help(str(key), declared)
                self.problem(number, f"`{key}` is not one of its output keys", help_)
        for key in ("wait", "stop", "run"):
            if not isinstance(entry.get(key, False), bool):
                self.problem(number, f"`{key}` is true or false")
        after = seconds(entry.get("after", 0))
        if after is None:
            self.problem(number, "`after` is a time, such as `30 s`, `5 min` or `2 h`")
        if entry.get("run") is True and (others := [key for key in entry if key not in OWN_CODE]):
            self.problem(number, f"a step with `run` has no `{others[0]}`")
        given = entry.get("outcome")
        chances = self.chances(given, number) if isinstance(given, dict) else ()
        single = "outcome" in entry and not isinstance(given, dict)
        return ScenarioStep(
            outcome=self.outcome(given, number) if single else None,
            chances=chances,
            writes=tuple((str(key), writes[key]) for key in writes),
            wait=entry.get("wait") is True,
            error=str(entry.get("error", "")),
            stop=entry.get("stop") is True,
            after=after or 0.0,
            run=entry.get("run") is True,
        )

    def outcome(self, given: object, number: int) -> str:
        """The outcome of a step. YAML reads the outcomes `true` and `false` as booleans."""
        name = str(given).lower() if isinstance(given, bool) else str(given)
        declared = outcome_names(self.place.leaf)
        if not self.place.leaf.open and name not in declared:
            help_ = _name_help(name, declared)
            self.problem(number, f"`{name}` is not one of its outcomes", help_)
        return name

    def chances(self, given: dict[object, object], number: int) -> tuple[tuple[str, float], ...]:
        """The probabilities of the outcomes of a step."""
        found = []
        for name, value in given.items():
            outcome = self.outcome(name, number)
            if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value <= 1:
                self.problem(number, f"the probability of `{outcome}` is a number from 0 to 1")
                return ()
            found.append((outcome, float(value)))
        total = math.fsum(value for _, value in found)
        if abs(total - 1) > 1e-6:
            self.problem(number, f"the probabilities of its outcomes add up to {total:g}, not to 1")
            return ()
        return tuple(found)

    def problem(self, number: int, message: str, help_: str | None = None) -> None:
        text = f"{self.place.paths[0]}, step {number}: {message}"
        self.problems.append(ScenarioProblem(text, help_, self.name, number))


@dataclass(frozen=True, slots=True)
class _Leaves:
    """The leaves of a machine by full path, and the full paths of those whose path ends with a
    name, for each form of paths."""

    by_path: Mapping[str, _LeafEntry]
    by_end: tuple[Mapping[str, list[str]], ...]

    def __getitem__(self, path: str) -> _LeafEntry:
        return self.by_path[path]


def leaves_named(name: str, machine: Machine) -> tuple[list[str], ScenarioProblem | None]:
    """The full paths of the leaves that a name means, which can be several; without one, the
    fault."""
    leaves = _leaves(machine)
    found = _matches(name, leaves)
    problem = None if found else ScenarioProblem(*_not_found(name, machine, leaves))
    return found, problem


def _leaves(machine: Machine) -> _Leaves:
    by_path = _leaves_by_path(machine)
    by_end: tuple[dict[str, list[str]], ...] = ({}, {}, {})
    for path, leaf in by_path.items():
        for form, shown in zip(by_end, leaf.paths, strict=True):
            form.setdefault(shown.rpartition("/")[2], []).append(path)
    return _Leaves(by_path, by_end)


def _leaves_by_path(machine: Machine) -> dict[str, _LeafEntry]:
    around = enclosing(machine.root)
    return {
        path.full: _LeafEntry(
            path.node,
            path.node.open or isinstance(around[path.full][1], Iterator),
            (path.shown, path.plain, path.full),
        )
        for path in walk_script(machine.root)
        if isinstance(path.node, Leaf)
    }


def _matches(name: str, leaves: _Leaves) -> list[str]:
    """The full paths of the leaves that a name means: those whose path in the script it is or ends;
    if there are none, those of which it is the end of the path without roles, or the full path."""
    for form, by_end in enumerate(leaves.by_end):
        alike = by_end.get(name.rpartition("/")[2], ())
        paths = {path: leaves[path].paths[form] for path in alike}
        found = [path for path, shown in paths.items() if shown == name]
        found = found or [path for path, shown in paths.items() if shown.endswith(f"/{name}")]
        if found:
            return found
    return []


def _found(name: str, leaves: _Leaves) -> str | None:
    """The full path of the leaf with a name; None if there is none, or several."""
    if name in leaves.by_path:
        return name
    matches = _matches(name, leaves)
    return matches[0] if len(matches) == 1 else None


def _not_found(name: str, machine: Machine, leaves: _Leaves) -> tuple[str, str | None]:
    """The message and the help for a name that is no leaf, or several."""
    matches = [leaves[path].paths[0] for path in _matches(name, leaves)]
    if matches:
        named = ", ".join(f"`{path}`" for path in matches)
        return f"`{name}` may be any of {named}", "write one of them, or an entry for each"
    paths = (path for other in walk_script(machine.root) for path in (other.shown, other.full))
    if any(f"/{path}".endswith(f"/{name}") for path in paths):
        message = f"`{name}` is a container: it ends as its states make it end"
        return message, "name one of its states"
    shown = [entry.paths[0] for entry in leaves.by_path.values()]
    names = [*shown, *(path.rpartition("/")[2] for path in shown)]
    return f"there is no state `{name}`", did_you_mean(name, names)


def _name_help(name: str, known: Collection[str]) -> str | None:
    """The known name that is meant, or all of them."""
    return did_you_mean(name, known) or (f"use one of {listed(known)}" if known else None)


def _example(leaves: _Leaves, path: str = "") -> str:
    """An entry of a scenario, for a leaf with a path or for the first one: `PICK: [succeeded]`."""
    place = leaves.by_path.get(path) or next(iter(leaves.by_path.values()), None)
    if place is None:
        return "STATE: [OUTCOME]"
    outcomes = outcome_names(place.leaf) or ("OUTCOME",)
    return f"{place.paths[0].rpartition('/')[2]}: [{outcomes[0]}]"
