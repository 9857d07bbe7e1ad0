"""Requests to stop in generated programs: functions that pass them on where SMACH does not, and the
containers that need them (docs/semantics.md, Preemption)."""

from __future__ import annotations

from collections.abc import Mapping

from smachac.ir.nodes import Concurrence, Leaf, Machine
from smachac.ir.nodes import Iterator as IteratorNode
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import containers, ends_preempted

PASSING_ON = '''def withdraw(state):
    """Take back the unanswered stop requests of a state and of the states inside."""
    if state.preempt_requested():
        state.recall_preempt()
        for child in getattr(state, "get_children", dict)().values():
            withdraw(child)


def stoppable(container):
    """Let a container pass on every stop request, also an early one and a second one."""
    if not getattr(smach, "compat", True):  # the bundled runtime does so itself
        return container
    run, request = container.execute, container.request_preempt
    children = container.get_children
    concurrent = isinstance(container, smach.Concurrence)
    container.busy = container.asked = False

    def pass_on():
        for label in container.get_active_states() or list(children()):
            child = children().get(label)
            again = hasattr(child, "get_children")
            if child and (again or not child.preempt_requested()):
                child.request_preempt()

    def request_preempt():
        if not container.busy:
            return request()
        container.asked = True
        if not concurrent:
            smach.State.request_preempt(container)
        pass_on()

    def execute(*userdata):
        container.busy, container.asked = True, container.preempt_requested()
        if container.asked:
            pass_on()
        if concurrent:  # with its own request, SMACH for ROS 1 ends as preempted
            container.service_preempt()
        unanswered = True
        try:
            outcome = run(*userdata)
            unanswered = any(child.preempt_requested() for child in children().values())
            return outcome
        finally:
            container.busy = False
            for child in children().values():
                withdraw(child)
            if concurrent and container.asked and unanswered:
                request()

    if concurrent and container._child_termination_cb:
        ends = container._child_termination_cb

        def ends_others(outcomes):
            return not container.asked and ends(outcomes)

        container._child_termination_cb = ends_others
    container.execute, container.request_preempt = execute, request_preempt
    return container'''
"""The functions that a module contains if it has Iterators or Concurrences: SMACH itself does not
pass on a request to stop that comes before they run (rules P9, P10)."""

SECOND_REQUEST = '''def stoppable_again(machine):
    """Let a machine pass on a second stop request while the same container in it runs."""
    request, children = machine.request_preempt, machine.get_children

    def request_preempt():
        again = machine.preempt_requested() and getattr(smach, "compat", True)
        request()
        for label in machine.get_active_states() if again else ():
            if hasattr(children().get(label), "get_children"):
                children()[label].request_preempt()

    machine.request_preempt = request_preempt
    return machine'''
"""The function that a module contains if a machine has a container in it: SMACH itself does not
pass on a second request (rule P2)."""

STOPPING = '''def ends_preempted(container):
    """Let a time limit or loop end as preempted after a request to stop."""
    run, request = container.execute, container.request_preempt
    recall = container.recall_preempt

    def request_preempt():
        container.stopped = True
        request()

    def recall_preempt():
        container.stopped = False
        recall()

    def execute(*userdata):
        container.stopped = container.stopped or container.preempt_requested()
        try:
            outcome = run(*userdata)
            if container.stopped:
                container.service_preempt()
                outcome = "preempted"
            return outcome
        finally:
            container.stopped = False

    container.execute, container.stopped = execute, False
    container.request_preempt = request_preempt
    container.recall_preempt = recall_preempt
    return container'''
"""The function that a module contains if a state has a time limit, retries or a loop."""


def wrappers(machine: Machine) -> dict[str, str]:
    """The function around each container that does not pass on all requests to stop, by path.

    In a container in which no state answers a request, it makes no difference who receives it.
    """
    found: dict[str, str] = {}
    answering: set[str] = set()
    for path, node in reversed(list(containers(machine.root))):
        inner = any(f"{path}/{child.name}" in answering for child in node.children)
        if isinstance(node, Concurrence | IteratorNode):
            found[path] = "stoppable"
        elif inner:
            found[path] = "stoppable_again"
        if path in found or any(_answers(child, machine) for child in node.children):
            answering.add(path)
    return found


def _answers(node: object, machine: Machine) -> bool:
    """Whether a leaf may answer a request to stop: the code of the user may, a built-in state does
    if its type has the outcome for it."""
    if not isinstance(node, Leaf):
        return False
    type_ = machine.state_types.get(node.type)
    declared = type_.outcomes if type_ is not None else ()
    names = [outcome.name for outcome in (*node.outcomes, *declared)]
    return not node.built_in or PREEMPTED in names


def stop_functions(machine: Machine, used: Mapping[str, str]) -> list[str]:
    """The functions that a module contains for requests to stop; `used` are those by path."""
    texts = {"stoppable": PASSING_ON, "stoppable_again": SECOND_REQUEST}
    found = [text for name, text in texts.items() if name in used.values()]
    # The containers of time limits, retries and loops are found without visiting leaves.
    if any(ends_preempted(node) for _, node in containers(machine.root)):
        found.append(STOPPING)
    return found
