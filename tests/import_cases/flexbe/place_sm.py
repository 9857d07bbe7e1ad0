from flexbe_core import Autonomy, Behavior, OperatableStateMachine

from arm_states import Close, Note


class PlaceSM(Behavior):
    """Puts a part down."""

    def __init__(self, node):
        super().__init__()
        self.name = "Place"
        self.add_parameter("force", 2.5)

    def create(self):
        _state_machine = OperatableStateMachine(
            outcomes=["placed", "failed"], input_keys=["log", "place"], output_keys=["log"]
        )
        _state_machine.userdata.log = []
        _state_machine.userdata.place = 1
        with _state_machine:
            # x:30 y:40
            OperatableStateMachine.add(
                "Close",
                Close(force=self.force),
                transitions={"closed": "Note", "lost": "failed"},
                autonomy={"closed": Autonomy.Low, "lost": Autonomy.Full},
                remapping={"place": "place"},
            )
            # x:230 y:40
            OperatableStateMachine.add(
                "Note",
                Note(text="placed"),
                transitions={"noted": "placed"},
                autonomy={"noted": Autonomy.Off},
                remapping={"log": "log"},
            )
        return _state_machine
