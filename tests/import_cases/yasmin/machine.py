"""A machine for YASMIN: classes, functions, containers, remappings, values on the blackboard."""

from yasmin import Blackboard, CbState, Concurrence, State, StateMachine

from grippers import Close, Tour

LIMITS = (3, 5)


class Weigh(State):
    """Weighs a part."""

    def __init__(self, limits, unit="kg", label=None):
        super().__init__(outcomes=["light", "heavy"])
        self.limits, self.unit, self.label = limits, unit, label

    def execute(self, blackboard):
        blackboard["log"] = [*blackboard["log"], f"{self.label} {self.unit}"]
        weight = blackboard["weight"]
        blackboard["weight"] = weight + 1
        return "heavy" if weight >= self.limits[0] else "light"


class Beep(State):
    def __init__(self):
        super().__init__(["DONE"])
        self.times = 0
        self.declare_parameter("times", "how often", 1)

    def configure(self):
        self.times = self.get_parameter("times")

    def execute(self, blackboard):
        blackboard[f"beep {self.times}"] = self.times
        return "DONE"


def note(blackboard):
    blackboard["log"] = [*blackboard["log"], f"note {blackboard['text']}"]
    return "noted"


def build():
    sm = StateMachine(outcomes=["finished", "failed"], handle_sigint=True)
    sm.add_input_key("text", "what is noted", "hello")
    sm.add_state("WEIGH", Weigh(LIMITS, label="first"), {"light": "WEIGH", "heavy": "NOTE"})
    sm.add_state("NOTE", CbState(["noted"], note), {"noted": "TOUR"})
    sm.add_state("TOUR", Tour(2), {"over": "AGAIN"}, remappings={"weight": "other"})
    loud = Beep()
    loud.set_parameter("times", 3)
    both = Concurrence(
        states={"LOUD": loud, "CLOSE": Close(force=2.5)},
        default_outcome="failed",
        outcome_map={"ready": {"LOUD": "DONE", "CLOSE": "closed"}},
    )
    sm.add_state("AGAIN", both, {"ready": "DONE"})
    sm.add_state("DONE", CbState({"noted"}, note), {"noted": "finished"}, {"text": "last"})
    return sm


def main():
    blackboard = Blackboard()
    blackboard["weight"] = 1
    blackboard["other"] = 4
    blackboard["log"] = []
    blackboard.set("last", "bye")
    sm = build()
    try:
        print(sm(blackboard))
    except RuntimeError as error:
        print(error)


if __name__ == "__main__":
    main()
