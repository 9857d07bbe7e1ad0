"""Keys that code reads and that are no input keys."""

import smach


class Drive(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["there"], input_keys=["goal"])

    def execute(self, userdata):
        print(userdata.goal, userdata.speed)
        return "there"


class Misspelt(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["there"], input_keys=["target_pose"])

    def execute(self, userdata):
        print(userdata.target_pos)
        return "there"


class OnlyOutput(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["there"], output_keys=["route"])

    def execute(self, userdata):
        userdata.route = []
        userdata.route.append(1)
        return "there"


class OuterName(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["there"], input_keys=["goal"])

    def execute(self, userdata):
        print(userdata.kitchen)
        return "there"


class Dictionary(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["there"], input_keys=["goal"])

    def execute(self, userdata):
        print(userdata.get("goal"))
        return "there"


@smach.cb_interface(outcomes=["there"])
def callback(ud):
    print(ud["speed"])
    return "there"


class Given(smach.State):
    """No finding: the lists are arguments."""

    def __init__(self, inputs):
        smach.State.__init__(self, outcomes=["there"], input_keys=inputs)

    def execute(self, userdata):
        print(userdata.goal)
        return "there"


def machine():
    sm = smach.StateMachine(outcomes=["done"])
    sm.userdata.goal = sm.userdata.target_pose = sm.userdata.kitchen = 1
    with sm:
        sm.add("DRIVE", Drive(), {"there": "MISSPELT"})
        sm.add("MISSPELT", Misspelt(), {"there": "ROUTE"})
        sm.add("ROUTE", OnlyOutput(), {"there": "OUTER"})
        sm.add("OUTER", OuterName(), {"there": "DICTIONARY"}, remapping={"goal": "kitchen"})
        sm.add("DICTIONARY", Dictionary(), {"there": "CALLBACK"})
        sm.add("CALLBACK", smach.CBState(callback), {"there": "GIVEN"})
        sm.add("GIVEN", Given(["goal"]), {"there": "done"})
    return sm
