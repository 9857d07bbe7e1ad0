"""Containers that end with outcomes which they do not declare."""

import smach


class Look(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["seen", "hidden"])

    def execute(self, userdata):
        return "seen"


class Lost(Look):
    def execute(self, userdata):
        return "hidden"


def default_outcome():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        both = smach.Concurrence(
            outcomes=["all"], default_outcome="some",
            outcome_map={"all": {"LEFT": "seen", "RIGHT": "seen"}},
        )
        with both:
            smach.Concurrence.add("LEFT", Look())
            smach.Concurrence.add("RIGHT", Look())
        sm.add("BOTH", both, {"all": "done"})
    return sm


def rule():
    sm = smach.StateMachine(outcomes=["done", "failed"])
    with sm:
        both = smach.Concurrence(
            outcomes=["all", "none"], default_outcome="none",
            outcome_map={"alle": {"LEFT": "seen", "RIGHT": "seen"}},
        )
        with both:
            both.add("LEFT", Look())
            both.add("RIGHT", Look())
        sm.add("BOTH", both, {"all": "done", "none": "failed"})
    return sm


def inverted_rule():
    sm = smach.StateMachine(outcomes=["done", "failed"])
    with sm:
        both = smach.Concurrence(
            outcomes=["all", "none"], default_outcome="none",
            outcome_map={"LEFT": {"all": "seen"}},
        )
        with both:
            both.add("LEFT", Look())
            both.add("RIGHT", Look())
        sm.add("BOTH", both, {"all": "done", "none": "failed"})
    return sm


class Search(smach.Iterator):
    """The child ends it with `hidden`."""

    def __init__(self):
        super().__init__(
            outcomes=["found", "exhausted"], input_keys=[], output_keys=[], it=[1, 2, 3],
            it_label="place",
        )
        with self:
            smach.Iterator.set_contained_state("LOOK", Lost(), loop_outcomes=["seen"])


def search():
    sm = smach.StateMachine(outcomes=["done", "failed"])
    with sm:
        sm.add("SEARCH", Search(), {"found": "done", "exhausted": "failed"})
    return sm
