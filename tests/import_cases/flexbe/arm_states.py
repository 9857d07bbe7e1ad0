from flexbe_core import EventState


class Look(EventState):
    """
    Searches a part.

    -- most   int  The tries.
    ># part   str  The part.
    #> place  int  Where it is.
    <= seen        It is there.
    <= nothing     It is not.
    """

    def __init__(self, most, names=("a", "b")):
        super().__init__(outcomes=["seen", "nothing"], input_keys=["part"], output_keys=["place"])
        self.most, self.names = most, names

    def on_enter(self, userdata):
        self.ticks = 0

    def execute(self, userdata):
        self.ticks += 1
        if self.ticks < self.most:
            return None
        userdata.place = len(userdata.part) + self.most
        return "seen" if self.most > 2 else "nothing"


class Note(EventState):
    def __init__(self, text, function=None):
        super().__init__(outcomes=["noted"], io_keys=["log"])
        self.text, self.function = text, function

    def execute(self, userdata):
        text = self.text if self.function is None else self.function(self.text)
        userdata.log = [*userdata.log, text]
        return "noted"


class Close(EventState):
    def __init__(self, force=1.0):
        super().__init__(outcomes=["closed", "lost"], input_keys=["place"])
        self.force = force

    def execute(self, userdata):
        return "closed" if userdata.place > self.force else "lost"


class Hold(EventState):
    """Watches the part until something ends it."""

    def __init__(self):
        super().__init__(outcomes=["slipped"], output_keys=["held"])

    def on_enter(self, userdata):
        userdata.held = True

    def execute(self, userdata):
        return None

    def on_exit(self, userdata):
        userdata.held = False
