from yasmin import State, StateMachine


class Close(State):
    def __init__(self, force=1.0):
        super().__init__(outcomes=["closed", "lost"])
        self.force = force

    def execute(self, blackboard):
        blackboard["force"] = self.force
        return "closed"


class Look(State):
    def __init__(self, times):
        super().__init__(outcomes=["seen", "NEXT"])
        self.times = times

    def execute(self, blackboard):
        blackboard["log"] = [*blackboard["log"], f"look {self.times} {blackboard['weight']}"]
        return "NEXT" if self.times > 1 else "seen"


class Tour(StateMachine):
    """Looks twice."""

    def __init__(self, times):
        super().__init__(outcomes=["over"])
        self.add_state("NEXT", Look(1), {"seen": "over", "NEXT": "over"})
        self.add_state("LOOK", Look(times), {"seen": "NEXT"})
        self.set_start_state("LOOK")
