"""Keys that are read and never set, or set too late."""

import smach


class Weigh(smach.State):
    def __init__(self):
        smach.State.__init__(
            self, outcomes=["weighed"], input_keys=["parcel"], output_keys=["weight"]
        )

    def execute(self, userdata):
        userdata.weight = len(userdata.parcel)
        return "weighed"


class Sort(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["sorted"], input_keys=["weight", "address"])

    def execute(self, userdata):
        print(userdata.weight, userdata.address)
        return "sorted"


class Count(smach.State):
    def __init__(self):
        smach.State.__init__(
            self, outcomes=["again", "enough"], input_keys=["tries"], output_keys=["tries"]
        )

    def execute(self, userdata):
        userdata.tries = userdata.tries + 1
        return "again" if userdata.tries < 3 else "enough"


@smach.cb_interface(input_keys=["speed"], outcomes=["done"])
def drive(userdata):
    return "done" if userdata.speed else "done"


def never_set():
    sm = smach.StateMachine(outcomes=["done"])
    sm.userdata.parcel = "a"
    with sm:
        sm.add("WEIGH", Weigh(), {"weighed": "SORT"})
        sm.add("SORT", Sort(), {"sorted": "done"})
    sm.execute()


def set_too_late():
    sm = smach.StateMachine(outcomes=["done"])
    sm.userdata.parcel = "a"
    sm.userdata.address = "b"
    with sm:
        sm.add("SORT", Sort(), {"sorted": "WEIGH"})
        sm.add("WEIGH", Weigh(), {"weighed": "done"})
    sm.execute()


def counter():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        sm.add("COUNT", Count(), {"again": "COUNT", "enough": "done"})
    sm.execute()


def several():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        sm.add("SORT", Sort(), {"sorted": "done"})
    sm.execute()


def remapped():
    sm = smach.StateMachine(outcomes=["done"])
    sm.userdata.parcel = "a"
    sm.userdata.street = "b"
    with sm:
        sm.add("WEIGH", Weigh(), {"weighed": "SORT"}, remapping={"weight": "grams"})
        sm.add("SORT", Sort(), {"sorted": "done"}, remapping={"address": "street"})
    sm.execute()


def inside():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        inner = smach.StateMachine(outcomes=["done"], input_keys=["speed"])
        with inner:
            inner.add("DRIVE", smach.CBState(drive), {"done": "done"})
        sm.add("INNER", inner, {"done": "done"})
    sm.execute()


def not_an_input():
    sm = smach.StateMachine(outcomes=["done"])
    sm.userdata.speed = 1
    with sm:
        inner = smach.StateMachine(outcomes=["done"])
        with inner:
            inner.add("DRIVE", smach.CBState(drive), {"done": "done"})
        sm.add("INNER", inner, {"done": "done"})
    sm.execute()


def given_from_outside(values):
    """No finding: the userdata is not known."""
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        sm.add("SORT", Sort(), {"sorted": "done"})
    sm.execute(values)
