"""Targets that are neither a state nor an outcome of the container."""

import smach


class Grip(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["held", "slipped"])

    def execute(self, userdata):
        return "held"


def misspelt_state():
    sm = smach.StateMachine(outcomes=["done", "lost"])
    with sm:
        smach.StateMachine.add("GRIP", Grip(), transitions={"held": "LFIT", "slipped": "lost"})
        smach.StateMachine.add("LIFT", Grip(), transitions={"held": "done", "slipped": "lost"})
    return sm


def missing_state():
    sm = smach.StateMachine(outcomes=["done", "lost"])
    with sm:
        smach.StateMachine.add("GRIP", Grip(), {"held": "WEIGH", "slipped": "lost"})
        smach.StateMachine.add("LIFT", Grip(), {"held": "done", "slipped": "GRIP"})
    return sm


def state_of_another_container():
    sm = smach.StateMachine(outcomes=["done", "lost"])
    with sm:
        inner = smach.StateMachine(outcomes=["picked"])
        with inner:
            inner.add("GRIP", Grip(), {"held": "picked", "slipped": "PARK"})
        sm.add("PICK", inner, {"picked": "done"})
        sm.add("PARK", Grip(), {"held": "lost", "slipped": "lost"})
        sm.set_initial_state(["PICK"])
    return sm


def names_in_a_loop():
    sm = smach.StateMachine(outcomes=["done", "lost"])
    names = ["LEFT", "MIDDLE", "RIGHT"]
    with sm:
        for at, name in enumerate(names):
            following = f"{name}_{at + 1}"
            smach.StateMachine.add(name, Grip(), {"held": following, "slipped": "lost"})
    return sm


class Tidy(smach.StateMachine):
    def __init__(self):
        super().__init__(outcomes=["tidy"])
        with self:
            self.add("GRIP", Grip(), {"held": "tidy", "slipped": "failed"})
