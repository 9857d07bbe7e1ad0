"""Classes whose keys and paths depend on the arguments: read with the values of each instance."""

import smach


class Rotate(smach.State):
    def __init__(self, angle=None):
        super().__init__(outcomes=["done"], input_keys=["angle"] if angle is None else [])
        self.angle = angle

    def execute(self, userdata):
        print(userdata.angle if self.angle is None else self.angle)
        return "done"


class Point(smach.State):
    def __init__(self, target=None):
        super().__init__(outcomes=["done"])
        self.target = target

    def execute(self, userdata):
        print(self.target or userdata.target)
        return "done"


class Detect(smach.State):
    """The condition is the wrong way round: a finding for Detect(), and none for Detect("x")."""

    def __init__(self, wanted=None):
        super().__init__(outcomes=["done"], output_keys=[] if wanted is None else ["found"])
        self.wanted = wanted

    def execute(self, userdata):
        if self.wanted is None:
            userdata.found = 1
        return "done"


class Ask(smach.State):
    """No finding: a method changes the attribute."""

    def __init__(self, retry=False):
        super().__init__(outcomes=["done"])
        self.retry = retry

    def again(self):
        self.retry = True

    def execute(self, userdata):
        if not self.retry:
            self.again()
            return "done"
        return "done"


class Mode(smach.State):
    def __init__(self, mode):
        super().__init__(outcomes=["done", "failed"] if mode == "careful" else ["done"])
        self.mode = mode

    def execute(self, userdata):
        if self.mode == "careful":
            return "failed"
        return "done"


class Own(smach.State):
    """No finding of SM301: `place` is set before it is read."""

    def __init__(self):
        super().__init__(outcomes=["done"], input_keys=["place"], output_keys=["place"])

    def execute(self, userdata):
        userdata.place = [1, 2]
        print(userdata.place[0])
        return "done"


def machine():
    sm = smach.StateMachine(outcomes=["end", "bad"])
    sm.userdata.angle = 90
    with sm:
        sm.add("ROTATE", Rotate(), {"done": "ROTATE_360"})
        sm.add("ROTATE_360", Rotate(360), {"done": "POINT_AT_DOOR"})
        sm.add("POINT_AT_DOOR", Point("door"), {"done": "DETECT_CUP"})
        sm.add("DETECT_CUP", Detect("cup"), {"done": "ASK"})
        sm.add("ASK", Ask(), {"done": "CAREFUL"})
        sm.add("CAREFUL", Mode("careful"), {"done": "FAST", "failed": "bad"})
        sm.add("FAST", Mode("fast"), {"done": "OWN"})
        sm.add("OWN", Own(), {"done": "end"})
    sm.execute()


def faults():
    sm = smach.StateMachine(outcomes=["end"])
    with sm:
        sm.add("POINT", Point(), {"done": "DETECT"})
        sm.add("DETECT", Detect(), {"done": "end"})
    return sm
