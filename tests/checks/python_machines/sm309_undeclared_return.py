"""States that return what is none of their outcomes."""

import smach


class Other(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["seen", "hidden"])

    def execute(self, userdata):
        if userdata:
            return "seen"
        return "failed"


class Misspelt(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["seen", "hidden"])

    def execute(self, userdata):
        return "seeen"


class Nothing(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["done"])

    def execute(self, userdata):
        print("working")


class Alone(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["done"])

    def execute(self, userdata):
        "done"


class NoOutcomes(smach.State):
    def __init__(self):
        smach.State.__init__(self)

    def execute(self, userdata):
        return "done"


class Base(smach.State):
    def execute(self, userdata):
        return self.work(userdata) or "aborted"

    def work(self, userdata):
        return "done"


class Derived(Base):
    def __init__(self):
        super().__init__(outcomes=["done"])

    def work(self, userdata):
        return None


@smach.cb_interface(outcomes=["open"])
def door(userdata):
    return "closed"


@smach.cb_interface(outcomes=["open"])
def silent(userdata):
    print("door")


def lost(userdata):
    return "gone"


def machine():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        sm.add("OTHER", Other(), {"seen": "MISSPELT", "hidden": "MISSPELT"})
        sm.add("MISSPELT", Misspelt(), {"seen": "NOTHING", "hidden": "done"})
        sm.add("NOTHING", Nothing(), {"done": "ALONE"})
        sm.add("ALONE", Alone(), {"done": "DERIVED"})
        sm.add("DERIVED", Derived(), {"done": "NONE"})
        sm.add("NONE", NoOutcomes(), {})
        sm.add("DOOR", smach.CBState(door), {"open": "SILENT"})
        sm.add("SILENT", smach.CBState(silent), {"open": "LOST"})
        sm.add("LOST", smach.CBState(lost, outcomes=["here"]), {"here": "done"})
    return sm
