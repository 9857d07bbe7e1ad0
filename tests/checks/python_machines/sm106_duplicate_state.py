"""States that are added twice."""

import smach


class Step(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["ok"])

    def execute(self, userdata):
        return "ok"


def twice():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        sm.add("STEP", Step(), {"ok": "STEP"})
        sm.add("STEP", Step(), {"ok": "done"})
    return sm


def copied():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        sm.add("OPEN", Step(), {"ok": "CLOSE"})
        sm.add("OPEN", Step(), {"ok": "done"})
    return sm


def branches():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        both = smach.Concurrence(["ok"], "ok", outcome_map={"ok": {"LEFT": "ok"}})
        with both:
            both.add("LEFT", Step())
            both.add("LEFT", Step())
        sm.add("BOTH", both, {"ok": "done"})
    return sm


def loop():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        for _ in range(2):
            smach.StateMachine.add("STEP", Step(), {"ok": "done"})
    return sm
