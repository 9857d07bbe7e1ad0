"""Recorded machines, built from JSON with the bundled runtime and run.

A case holds a tree of nodes (`leaf`, `state_machine`, `sequence`, `concurrence`, `iterator`)
whose leaves follow a script. The result has the form of the recorded expectations: for each run
the outcome or the error, the events, and the userdata of every container afterwards.
"""

from __future__ import annotations

import copy
import threading
from collections.abc import Callable, Mapping
from typing import Any

from smachac.runtime import smach
from tests.conformance.vector_leaf import PATIENCE, Json, Leaf, Recording, Script, join, scripted


class BuildError(Exception):
    """Building failed at a path; the error is the cause."""

    def __init__(self, path: str) -> None:
        super().__init__(path)
        self.path = path


Make = Callable[[Json, str, Recording], Any]


def build(node: Json, path: str, recording: Recording) -> Any:
    """The state or container that a node describes. Raises BuildError."""
    recording.types[path] = node["type"]
    if node["type"] == "leaf":
        state = _leaf(Script(node, path, recording))
    else:
        state = _container(node, path, recording)
    recording.nodes[path] = state
    return state


def _leaf(script: Script) -> Any:
    node = script.node
    if not node.get("cb"):
        return Leaf(script)
    both = node.get("io", [])
    inputs, outputs = [*node.get("in", []), *both], [*node.get("out", []), *both]
    script.state = smach.CBState(smach.cb_interface(node["outcomes"], inputs, outputs)(script.run))
    return script.state


def _container(node: Json, path: str, recording: Recording) -> Any:
    specs = node.get("states") or node.get("children") or [node["child"]] if _has(node) else []
    children = [(s, build(s["node"], join(path, s["label"]), recording)) for s in specs]
    at = path
    try:
        container = _NEW[node["type"]](node, recording)
        with container:
            for spec, state in children:
                at = join(path, spec["label"])
                _ADD[node["type"]](node, spec, state)
            at = path
    except Exception as error:
        raise BuildError(at) from error
    for key, preset in node.get("preset", {}).items():
        container.userdata[key] = copy.deepcopy(preset)
    if "initial" in node:
        held = store(recording.library, node.get("initial_ud", {}))
        container.set_initial_state(list(node["initial"]), held)
    watch(container, path, recording)
    return container


def watch(container: Any, path: str, recording: Recording) -> None:
    """Have the callbacks of a container recorded."""
    container.register_start_cb(lambda ud, labels: recording.add("<", path, list(labels)))
    if recording.types[path] != "concurrence":
        container.register_transition_cb(lambda ud, labels: recording.add("~", path, list(labels)))
    container.register_termination_cb(
        lambda ud, labels, outcome: recording.add(">", path, labels, outcome)
    )


def _has(node: Json) -> bool:
    return any(node.get(field) for field in ("states", "children", "child"))


def store(library: Any, content: Mapping[str, Json]) -> Any:
    """A UserData with copies of some values."""
    ud = library.UserData()
    for key, held in content.items():
        ud[key] = copy.deepcopy(held)
    return ud


def _keys(node: Json) -> dict[str, Any]:
    return {"input_keys": list(node.get("in", [])), "output_keys": list(node.get("out", []))}


def _new_machine(node: Json, recording: Recording) -> Any:
    return smach.StateMachine(list(node["outcomes"]), **_keys(node))


def _new_sequence(node: Json, recording: Recording) -> Any:
    return smach.Sequence(list(node["outcomes"]), node["connector"], **_keys(node))


def _new_concurrence(node: Json, recording: Recording) -> Any:
    policy: dict[str, Any] = {}
    if "map" in node:
        policy["outcome_map"] = {outcome: dict(rule) for outcome, rule in node["map"]}
    if "outcome_cb" in node:
        policy["outcome_cb"] = _rules(node["outcome_cb"], None, recording)
    if "term_cb" in node:
        policy["child_termination_cb"] = _rules(node["term_cb"], False, recording)
    return smach.Concurrence(list(node["outcomes"]), node["default"], **_keys(node), **policy)


def _rules(rules: Json, otherwise: Json, recording: Recording) -> Callable[[Json], Json]:
    """A callback on outcomes: the first rule that agrees decides."""

    def callback(outcomes: Mapping[str, str | None]) -> Json:
        for rule in rules:
            when = rule.get("when", {})
            if any(label not in outcomes or outcomes[label] != when[label] for label in when):
                continue
            if isinstance(rule["ret"], dict):
                raise scripted(rule["ret"]["raise"], recording)
            return rule["ret"]
        return otherwise

    return callback


def _new_iterator(node: Json, recording: Recording) -> Any:
    iterator = smach.Iterator(
        list(node["outcomes"]),
        **_keys(node),
        it=[],
        it_label=node.get("it_label", "it_data"),
        exhausted_outcome=node.get("exhausted", "exhausted"),
    )
    items = node["it"]
    with iterator:
        smach.Iterator.set_iteritems(
            (lambda: iterator.userdata[items["key"]]) if isinstance(items, dict) else list(items),
            node.get("it_label", "it_data"),
        )
    return iterator


def _add_to_machine(node: Json, spec: Json, state: Any) -> None:
    kind = smach.StateMachine if node["type"] == "state_machine" else smach.Sequence
    given = {k: copy.deepcopy(spec[k]) for k in ("transitions", "remapping") if k in spec}
    if "constants" in spec:
        given["constants"] = copy.deepcopy(spec["constants"])
    if "auto" in spec:
        kind.add_auto(spec["label"], state, list(spec["auto"]), **given)
    else:
        kind.add(spec["label"], state, **given)


def _add_to_concurrence(node: Json, spec: Json, state: Any) -> None:
    smach.Concurrence.add(spec["label"], state, remapping=dict(spec.get("remapping", {})))


def _add_to_iterator(node: Json, spec: Json, state: Any) -> None:
    smach.Iterator.set_contained_state(
        spec["label"],
        state,
        loop_outcomes=list(node.get("loop", [])),
        break_outcomes=list(node.get("break", [])),
        final_outcome_map=dict(node.get("final", {})),
    )


_NEW = {
    "state_machine": _new_machine,
    "sequence": _new_sequence,
    "concurrence": _new_concurrence,
    "iterator": _new_iterator,
}
_ADD = {
    "state_machine": _add_to_machine,
    "sequence": _add_to_machine,
    "concurrence": _add_to_concurrence,
    "iterator": _add_to_iterator,
}


def replay(case: Json, make: Make = build, library: Any = smach) -> Json:
    """Build and run a case; the result in the form of the recorded expectations.

    `make` builds the machine with the classes of `library`.
    """
    recording = Recording(case, library)
    try:
        root = make(case["machine"], "/", recording)
    except BuildError as error:
        return {"build": {"error": type(error.__cause__).__name__, "at": error.path}}
    result: dict[str, Json] = {}
    faulty = [path for path in _containers(recording) if not _consistent(recording, path)]
    if faulty:
        result["inconsistent"] = faulty
    root.userdata.update(store(library, case.get("userdata", {})))
    if case.get("preempt_before"):
        root.request_preempt()
    parent = store(library, case["parent"]) if "parent" in case else None
    result["runs"] = [_run(root, parent, recording, faulty) for _ in range(case.get("runs", 1))]
    return result


def _containers(recording: Recording) -> list[str]:
    return sorted(path for path, kind in recording.types.items() if kind != "leaf")


def _consistent(recording: Recording, path: str) -> bool:
    library = recording.library
    try:
        recording.nodes[path].check_consistency()
    except (library.InvalidStateError, library.InvalidTransitionError):
        return False
    return True


def _run(root: Any, parent: Any, recording: Recording, faulty: list[str]) -> Json:
    recording.restart()
    ended: list[tuple[str | None, BaseException | None]] = []

    def execute() -> None:
        try:
            ended.append((root.execute(parent), None))
        except BaseException as error:
            ended.append((None, error))

    thread = threading.Thread(target=execute, daemon=True)
    thread.start()
    thread.join(2 * PATIENCE)
    run: dict[str, Json] = {}
    if not ended:
        run["category"] = "hang"
    elif ended[0][1] is not None:
        run["error"] = type(ended[0][1]).__name__
        run["category"] = _category(ended[0][1], recording)
    else:
        run["outcome"] = ended[0][0]
        if ended[0][0] is None:
            run["category"] = "inconsistent" if "/" in faulty else "no_outcome"
    for event in _walk(recording.events):
        if event[0] == "|":
            event[2] = {label: events for label, events in event[2].items() if events}
    run["events"] = recording.events
    run["userdata"] = _content(root.userdata)
    inner = [path for path in _containers(recording) if path != "/"]
    if inner:
        run["scopes"] = {path: _content(recording.nodes[path].userdata) for path in inner}
    if parent is not None:
        run["parent"] = _content(parent)
    return run


def _walk(events: list[Json]) -> list[Json]:
    """The events with those inside branches."""
    inside = [e for e in events if e[0] == "|"]
    return events + [w for e in inside for branch in e[2].values() for w in _walk(branch)]


def _content(ud: Any) -> dict[str, Json]:
    return {key: copy.deepcopy(ud[key]) for key in ud.keys()}  # noqa: SIM118 (no mapping)


def _category(error: BaseException | None, recording: Recording) -> str:
    """The first cause of an error."""
    if recording.causes:
        return recording.causes[0]
    causes = []
    while error is not None:
        causes.append(error)
        error = error.__cause__ or error.__context__
    if any(cause is known for cause in causes for known in recording.scripted):
        return "user_callback"
    if any(isinstance(cause, recording.library.InvalidTransitionError) for cause in causes):
        return "invalid_transition"
    return "other"
