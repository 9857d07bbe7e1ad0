"""Branches that use one key: only with --all."""

import smach


class Look(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["seen"], output_keys=["place"])

    def execute(self, userdata):
        userdata.place = 1
        return "seen"


def machine():
    sm = smach.StateMachine(outcomes=["done"], output_keys=["place"])
    with sm:
        both = smach.Concurrence(
            outcomes=["all", "none"], default_outcome="none", output_keys=["place"],
            outcome_map={"all": {"LEFT": "seen", "RIGHT": "seen"}},
        )
        with both:
            both.add("LEFT", Look())
            both.add("RIGHT", Look())
        sm.add("BOTH", both, {"all": "done", "none": "done"})
    return sm
