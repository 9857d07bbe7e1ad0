"""Transitions for outcomes that their states do not have."""

import smach


class Weigh(smach.State):
    def __init__(self, extra=()):
        super().__init__(outcomes=["light", "heavy", *extra], input_keys=["parcel"])

    def execute(self, userdata):
        return "light" if userdata.parcel < 5 else "heavy"


@smach.cb_interface(outcomes=["open", "closed"])
def door(userdata):
    return "open"


def misspelt():
    sm = smach.StateMachine(outcomes=["done"])
    sm.userdata.parcel = 2
    with sm:
        sm.add("WEIGH", Weigh(), {"ligth": "done", "light": "done", "heavy": "done"})
    return sm


def outcome_of_another_type():
    sm = smach.StateMachine(outcomes=["done"])
    sm.userdata.parcel = 2
    with sm:
        sm.add("WEIGH", Weigh(["broken"]), {"light": "done", "heavy": "done", "broken": "AGAIN"})
        sm.add("AGAIN", Weigh(), {"light": "done", "heavy": "done", "timeout": "done"})
    return sm


def of_a_callback():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        sm.add("DOOR", smach.CBState(door), {"open": "done", "shut": "done", "closed": "done"})
    return sm


def of_a_container():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        inner = smach.StateMachine(outcomes=["passed"])
        with inner:
            inner.add("DOOR", smach.CBState(door), {"open": "passed", "closed": "DOOR"})
        sm.add("THROUGH", inner, {"passed": "done", "failed": "done"})
    return sm


def only_one_left():
    sm = smach.StateMachine(outcomes=["done"])
    sm.userdata.parcel = 2
    with sm:
        sm.add("WEIGH", Weigh(), {"small": "done", "heavy": "done"})
    return sm


def of_an_iterator():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        every = smach.Iterator(
            outcomes=["done", "stopped"], input_keys=[], output_keys=[],
            it=range(3), it_label="parcel", exhausted_outcome="done",
        )
        with every:
            smach.Iterator.set_contained_state(
                "WEIGH", Weigh(), loop_outcomes=["light", "hevy"], final_outcome_map={"heavy": "stopped"}
            )
        sm.add("EVERY", every, {"done": "done", "stopped": "done", "exhausted": "done"})
    return sm
