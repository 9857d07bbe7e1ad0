"""Classes that do not work as states."""

import smach


class NoExecute(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["done"])

    def run(self, userdata):
        return "done"


class Generator(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["done"])

    def execute(self, userdata):
        yield "done"


class Coroutine(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["done"])

    async def execute(self, userdata):
        return "done"


class NoUserdata(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["done"])

    def execute(self):
        return "done"


class NoConstructorCall(smach.State):
    def __init__(self):
        self.count = 0

    def execute(self, userdata):
        return "done"


class WrongArgument(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["done"], inputs=["n"])

    def execute(self, userdata):
        return "done"


class UndefinedName(smach.State):
    """Only with --all."""

    def __init__(self):
        smach.State.__init__(self, outcomes=["done"])

    def execute(self, userdata):
        print(speed)
        return "done"


def machine():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        sm.add("NO_EXECUTE", NoExecute(), {"done": "GENERATOR"})
        sm.add("GENERATOR", Generator(), {"done": "COROUTINE"})
        sm.add("COROUTINE", Coroutine(), {"done": "NO_USERDATA"})
        sm.add("NO_USERDATA", NoUserdata(), {"done": "UNDEFINED"})
        sm.add("UNDEFINED", UndefinedName(), {"done": "done"})
    return sm


def no_constructor_call():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        sm.add("FIRST", NoConstructorCall(), {"done": "done"})
    return sm


def wrong_argument():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        sm.add("FIRST", WrongArgument(), {"done": "done"})
    return sm


def again():
    """The same class: no second finding."""
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        sm.add("FIRST", NoExecute(), {"done": "SECOND"})
        sm.add("SECOND", NoExecute(), {"done": "done"})
    return sm
