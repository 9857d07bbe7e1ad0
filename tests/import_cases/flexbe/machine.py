"""A behavior of FlexBE: containers, conditions, other behaviors in it, parameters, autonomy."""

from flexbe_core import Autonomy, Behavior, ConcurrencyContainer, OperatableStateMachine

from arm_states import Close, Hold, Look, Note
from place_sm import PlaceSM

NAMES = ("x", "y")


class DeliverySM(Behavior):
    """Finds a part, holds it and puts it down."""

    def __init__(self, node):
        super().__init__()
        self.name = "Delivery"
        self.add_parameter("most", 3)
        self.add_parameter("greeting", "hello")
        self.add_behavior(PlaceSM, "Place", node)
        self.add_behavior(PlaceSM, "Put", node)

    def create(self):
        # x:833 y:40, x:833 y:140
        _state_machine = OperatableStateMachine(outcomes=["finished", "failed"])
        _state_machine.userdata.log = []
        _state_machine.userdata.what = "bolt"
        _state_machine.userdata.spot = 0

        # x:333 y:40, x:333 y:140
        _sm_search_0 = OperatableStateMachine(
            outcomes=["found", "lost"], input_keys=["part", "log"], output_keys=["place", "log"]
        )
        with _sm_search_0:
            # x:30 y:40
            OperatableStateMachine.add(
                "Look",
                Look(most=self.most, names=NAMES),
                transitions={"seen": "Say", "nothing": "lost"},
                autonomy={"seen": Autonomy.High, "nothing": 1},
                remapping={"part": "part", "place": "place"},
            )
            # x:130 y:40
            OperatableStateMachine.add(
                "Say",
                Note(text=self.greeting, function=lambda text: text.upper()),
                transitions={"noted": "found"},
                autonomy={"noted": Autonomy.Off},
                remapping={"log": "log"},
            )

        # x:533 y:40, x:533 y:140
        _sm_grasp_1 = ConcurrencyContainer(
            outcomes=["held", "failed"],
            input_keys=["spot"],
            output_keys=["held"],
            conditions=[
                ("held", [("Close", "closed")]),
                ("failed", [("Close", "lost")]),
                ("failed", [("Hold", "slipped")]),
            ],
        )
        with _sm_grasp_1:
            # x:30 y:40
            OperatableStateMachine.add(
                "Close",
                Close(),
                transitions={"closed": "held", "lost": "failed"},
                autonomy={"closed": Autonomy.Off, "lost": Autonomy.Off},
                remapping={"place": "spot"},
            )
            # x:130 y:40
            OperatableStateMachine.add(
                "Hold",
                Hold(),
                transitions={"slipped": "failed"},
                autonomy={"slipped": Autonomy.Off},
                remapping={"held": "held"},
            )

        with _state_machine:
            # x:30 y:40
            OperatableStateMachine.add(
                "Search",
                _sm_search_0,
                transitions={"found": "Grasp", "lost": "failed"},
                autonomy={"found": Autonomy.Inherit, "lost": Autonomy.Inherit},
                remapping={"part": "what", "place": "spot", "log": "log"},
            )
            # x:230 y:40
            OperatableStateMachine.add(
                "Grasp",
                _sm_grasp_1,
                transitions={"held": "Place", "failed": "failed"},
                autonomy={"held": Autonomy.Inherit, "failed": Autonomy.Inherit},
                remapping={"spot": "spot", "held": "held"},
            )
            # x:430 y:40
            OperatableStateMachine.add(
                "Place",
                self.use_behavior(PlaceSM, "Place", default_keys=["place"]),
                transitions={"placed": "Put", "failed": "Put"},
                autonomy={"placed": Autonomy.Inherit, "failed": Autonomy.Inherit},
                remapping={"log": "log"},
            )
            # x:630 y:40
            OperatableStateMachine.add(
                "Put",
                self.use_behavior(PlaceSM, "Put", parameters={"force": 6.5}),
                transitions={"placed": "finished", "failed": "Search"},
                autonomy={"placed": Autonomy.Inherit, "failed": Autonomy.Inherit},
                remapping={"log": "log", "place": "spot"},
            )
        return _state_machine
