"""States to which no path leads."""

import smach


class Move(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["there", "stuck"])

    def execute(self, userdata):
        return "there"


def led_past():
    sm = smach.StateMachine(outcomes=["done", "failed"])
    with sm:
        sm.add("START", Move(), {"there": "END", "stuck": "failed"})
        sm.add("MIDDLE", Move(), {"there": "END", "stuck": "failed"})
        sm.add("END", Move(), {"there": "done", "stuck": "failed"})
    return sm


def alone():
    sm = smach.StateMachine(outcomes=["done", "failed"])
    with sm:
        sm.add("START", Move(), {"there": "done", "stuck": "failed"})
        sm.add("PARK", Move(), {"there": "failed", "stuck": "failed"})
        sm.add("REST", Move(), {"there": "PARK", "stuck": "failed"})
    return sm


def same_target_twice():
    sm = smach.StateMachine(outcomes=["done", "failed"])
    with sm:
        sm.add("START", Move(), {"there": "END", "stuck": "END"})
        sm.add("PARK", Move(), {"there": "failed", "stuck": "failed"})
        sm.add("END", Move(), {"there": "done", "stuck": "failed"})
    return sm


class Nested(smach.StateMachine):
    def __init__(self):
        super().__init__(outcomes=["done", "failed"])
        with self:
            inner = smach.StateMachine(outcomes=["out"])
            with inner:
                inner.add("A", Move(), {"there": "out", "stuck": "out"})
                inner.add("B", Move(), {"there": "out", "stuck": "A"})
            self.add("INNER", inner, {"out": "done"})


def chosen(fast):
    """An unknown condition: the state is reached in one of two variants."""
    sm = smach.StateMachine(outcomes=["done", "failed"])
    with sm:
        sm.add("START", Move(), {"there": "SLOW" if not fast else "END", "stuck": "failed"})
        sm.add("SLOW", Move(), {"there": "END", "stuck": "failed"})
        sm.add("END", Move(), {"there": "done", "stuck": "failed"})
        sm.add("LOST", Move(), {"there": "END" if fast else "done", "stuck": "failed"})
    return sm
