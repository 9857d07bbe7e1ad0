"""Rules about states that a concurrence does not have."""

import smach


class Look(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["seen", "hidden"])

    def execute(self, userdata):
        return "seen"


def misspelt_state():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        both = smach.Concurrence(
            outcomes=["all", "none"], default_outcome="none",
            outcome_map={"all": {"LEFT": "seen", "RIHGT": "seen"}},
        )
        with both:
            both.add("LEFT", Look())
            both.add("RIGHT", Look())
        sm.add("BOTH", both, {"all": "done", "none": "done"})
    return sm


def missing_outcome():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        both = smach.Concurrence(
            outcomes=["all", "none"], default_outcome="none",
            outcome_map={"all": {"LEFT": "seen", "RIGHT": "found"}},
        )
        with both:
            both.add("LEFT", Look())
            both.add("RIGHT", Look())
        sm.add("BOTH", both, {"all": "done", "none": "done"})
    return sm


class Both(smach.Concurrence):
    def __init__(self):
        super().__init__(
            outcomes=["all", "none"], default_outcome="none",
            outcome_map={"all": {"UP": "seen"}, "none": {}},
        )
        with self:
            self.add("LEFT", Look())
            self.add("RIGHT", Look())
