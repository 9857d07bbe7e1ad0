"""Outcomes without transitions."""

import smach


class Grip(smach.State):
    def __init__(self, outcomes=("held", "slipped")):
        smach.State.__init__(self, outcomes=list(outcomes))

    def execute(self, userdata):
        return "held"


def one():
    sm = smach.StateMachine(outcomes=["done", "failed"])
    with sm:
        sm.add("GRIP", Grip(), {"held": "done"})
    return sm


def several():
    sm = smach.StateMachine(outcomes=["done", "failed"])
    with sm:
        sm.add("GRIP", Grip(["held", "slipped", "jammed"]), {"held": "LIFT"})
        sm.add("LIFT", Grip(), {"held": "done", "slipped": "failed"})
    return sm


def without_transitions():
    sm = smach.StateMachine(outcomes=["done", "failed"])
    with sm:
        sm.add("GRIP", Grip())
    return sm


def sequence():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        steps = smach.Sequence(outcomes=["held"], connector_outcome="held")
        with steps:
            smach.Sequence.add("FIRST", Grip())
            smach.Sequence.add("SECOND", Grip())
        sm.add("STEPS", steps, {"held": "done"})
    return sm


class Pick(smach.StateMachine):
    def __init__(self, retry):
        super().__init__(outcomes=["picked"])
        with self:
            self.add("GRIP", Grip(), {"held": "picked", "slipped": "GRIP" if retry else "picked"})
            self.add("AGAIN", Grip(), {"held": "picked", "slipped": None})


def pick():
    sm = smach.StateMachine(outcomes=["done", "failed"])
    with sm:
        sm.add("PICK", Pick(True))
    return sm
