"""Keys that code sets and that are no output keys."""

import smach


class Look(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["seen"], output_keys=["place"])

    def execute(self, userdata):
        userdata.place = 1
        userdata.colour = "red"
        return "seen"


class Misspelt(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["seen"], output_keys=["place"])

    def execute(self, userdata):
        userdata.plase = 1
        return "seen"


class Counter(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["seen"], input_keys=["n"])

    def execute(self, ud):
        ud.n = 1
        return "seen"


@smach.cb_interface(input_keys=["n"], outcomes=["seen"])
def callback(userdata):
    userdata.result = userdata.n
    return "seen"


class Own(smach.StateMachine):
    def __init__(self):
        super().__init__(outcomes=["done"], input_keys=["n"])
        with self:
            self.add("CALL", smach.CBState(self.call, outcomes=["seen"]), {"seen": "done"})

    def call(self, userdata):
        userdata.answer = 42
        return "seen"


def machine():
    sm = smach.StateMachine(outcomes=["done"])
    sm.userdata.n = 0
    with sm:
        sm.add("LOOK", Look(), {"seen": "MISSPELT"})
        sm.add("MISSPELT", Misspelt(), {"seen": "COUNTER"})
        sm.add("COUNTER", Counter(), {"seen": "CALLBACK"})
        sm.add("CALLBACK", smach.CBState(callback), {"seen": "OWN"})
        sm.add("OWN", Own())
    return sm
