"""Calls that fail while a machine is built."""

import smach


class Grip(smach.State):
    def __init__(self, force, *, slow=False):
        smach.State.__init__(self, outcomes=["ok"])
        self.force = force

    def execute(self, userdata):
        return "ok"


class Stop(smach.State):
    def __init__(self, *names, **others):
        smach.State.__init__(self, outcomes=["ok"])

    def execute(self, userdata):
        return "ok"


def missing():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        smach.StateMachine.add("A", Grip(), {"ok": "done"})
    return sm


def unknown_by_name():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        smach.StateMachine.add("A", Grip(3.0, slwo=True), {"ok": "done"})
    return sm


def too_many():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        smach.StateMachine.add("A", Grip(3.0, True), {"ok": "done"})
    return sm


def unknown_to_smach():
    sm = smach.StateMachine(outcome=["done"])
    with sm:
        smach.StateMachine.add("A", Stop(), {"ok": "done"})
    return sm


def of_add():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        smach.StateMachine.add("A", Stop(), transition={"ok": "done"})
    return sm


def class_as_state():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        smach.StateMachine.add("A", Stop, {"ok": "done"})
    return sm


def list_of_pairs():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        smach.StateMachine.add("A", Stop(), transitions=[("ok", "done")])
    return sm


def of_a_concurrence():
    both = smach.Concurrence(["done"], "done", outcome_map={"done": {"A": "ok"}})
    with both:
        smach.Concurrence.add("A", Stop(), transitions={"ok": "done"})
    return both


def in_another_container():
    both = smach.Concurrence(["done"], "done", outcome_map={"done": {"A": "ok"}})
    with both:
        smach.StateMachine.add("A", Stop(), transitions={"ok": "done"})
    return both


def fits(*given, **others):
    """No finding: any arguments, unknown ones, and a call that may fail."""
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        smach.StateMachine.add("A", Stop(1, 2, speed=3), transitions={"ok": "B"})
        smach.StateMachine.add("B", Grip(*given, **others), {"ok": "C"})
        try:
            smach.StateMachine.add("C", Grip(), {"ok": "done"})
        except TypeError:
            smach.StateMachine.add("C", Grip(1.0), {"ok": "done"})
    return sm
