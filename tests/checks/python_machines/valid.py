"""Machines that work: no finding."""

import smach


class Base(smach.State):
    extra = ["stopped"]

    def __init__(self, outcomes, **keys):
        super().__init__(outcomes=outcomes + self.extra, **keys)

    def execute(self, userdata):
        return self.work(userdata)

    def work(self, userdata):
        raise NotImplementedError


class Read(Base):
    def __init__(self, key):
        super().__init__(["ok"], input_keys=[key])
        self.key = key

    def work(self, userdata):
        return {1: "ok", 2: "stopped"}[userdata[self.key]]


class Register(smach.State):
    def __init__(self):
        smach.State.__init__(self)
        self.register_outcomes(["ok"])
        self.register_input_keys(["n"])
        self.register_output_keys(["n", "m"])

    def execute(self, userdata):
        userdata.n += 1
        setattr(userdata, "m", userdata["n"])
        return "ok"


class Both(smach.State):
    def __init__(self):
        smach.State.__init__(self, ["ok"], io_keys=["n"])
        self.outcome = "ok"

    def execute(self, userdata):
        userdata.n = getattr(userdata, "n") + 1
        return self.outcome


class Mixin:
    def execute(self, userdata):
        return "ok"


class Mixed(Mixin, smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["ok"])


class Loop(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["ok"])

    def execute(self, userdata):
        while True:
            for _ in range(3):
                return "ok"


@smach.cb_interface(input_keys=["n"], output_keys=["half"], outcomes=["ok"])
def halve(userdata, divisor, unit=""):
    userdata.half = userdata.n / divisor
    return "ok"


class Inner(smach.StateMachine):
    def __init__(self):
        super().__init__(outcomes=["ok"], input_keys=["number"], output_keys=["half"])
        self.userdata.limit = 3
        with self:
            self.add("HALVE", smach.CBState(halve, cb_args=[2], cb_kwargs={"unit": "m"}),
                     remapping={"n": "number"})


def states():
    sm = smach.StateMachine(outcomes=["end", "stopped"], output_keys=["half"])
    sm.userdata.n = 0
    with sm:
        sm.add("REGISTER", Register(), {"ok": "READ"})
        sm.add("READ", Read("m"), {"ok": "BOTH"})
        sm.add("BOTH", Both(), {"ok": "MIXED"})
        sm.add("MIXED", Mixed(), {"ok": "LOOP"})
        sm.add("LOOP", Loop(), {"ok": "INNER"})
        sm.add("INNER", Inner(), {"ok": "end"}, remapping={"number": "n"})
    sm.execute()


def containers():
    sm = smach.StateMachine(outcomes=["end"])
    sm.userdata.n = 1
    with sm:
        both = smach.Concurrence(
            outcomes=["all", "some"], default_outcome="some", input_keys=["n"],
            output_keys=["half"], outcome_map={"all": {"LEFT": "ok", "RIGHT": "ok"}},
        )
        with both:
            smach.Concurrence.add("LEFT", smach.CBState(halve, cb_args=[2]))
            smach.Concurrence.add("RIGHT", Mixed())
        smach.StateMachine.add("BOTH", both, {"all": "STEPS", "some": "STEPS"})
        steps = smach.Sequence(outcomes=["ok"], connector_outcome="ok", input_keys=["half"])
        with steps:
            smach.Sequence.add("ONE", Loop())
            smach.Sequence.add("TWO", Mixed())
        smach.StateMachine.add("STEPS", steps, {"ok": "EACH"})
        every = smach.Iterator(
            outcomes=["done"], input_keys=["half"], output_keys=[], it=[1, 2],
            it_label="item", exhausted_outcome="done",
        )
        with every:
            inner = smach.StateMachine(outcomes=["next"], input_keys=["item", "half"])
            with inner:
                inner.add("SHOW", Read("item"), {"ok": "next", "stopped": "next"})
            smach.Iterator.set_contained_state("SHOW_ALL", inner, loop_outcomes=["next"])
        smach.StateMachine.add("EACH", every, {"done": "end"})
    sm.execute()


def tables():
    table = {"ok": None}
    sm = smach.StateMachine(outcomes=["ok", "end"])
    with sm:
        for name, following in zip("AB", ["B", "C"]):
            sm.add(name, Mixed(), transitions={**table, "ok": following})
        sm.add("C", Loop(), dict(table))
        sm.add_auto if False else None
    sm.set_initial_state(["A"])
    sm.execute()


def chosen(fast=False):
    sm = smach.StateMachine(["end"])
    sm.userdata["n"] = 1
    with sm:
        if fast:
            sm.add("GO", Mixed(), {"ok": "end"})
        else:
            sm.add("GO", Both(), {"ok": "WAIT"})
            sm.add("WAIT", Loop(), {"ok": "end"})
    sm.execute()
