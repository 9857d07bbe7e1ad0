"""A behavior as the app of FlexBE generates it, with another one in it, that of `picking_sm.py`. The
states are in a module of their own.

Expected: one machine, all states exact; the embedded behavior has the
key `part` from outside and `speed` from itself. SM310 in `on_exit` of the module; SM403 for the
condition that names an outcome which `Watch` does not have; SM302 for `shelf`, which nothing sets.
"""

from flexbe_core import Autonomy
from flexbe_core import Behavior
from flexbe_core import ConcurrencyContainer
from flexbe_core import Logger
from flexbe_core import OperatableStateMachine
from flexbe_core import PriorityContainer
from flexbe_states.log_state import LogState
from picking_sm import PickingSM
from robot_states import Place as robot_states__Place
from robot_states import Watch


class DeliverySM(Behavior):
    """Picks a part and places it."""

    def __init__(self, node):
        super().__init__()
        self.name = 'Delivery'

        # parameters of this behavior
        self.add_parameter('waiting_time', 4.0)

        # references to used behaviors
        OperatableStateMachine.initialize_ros(node)
        ConcurrencyContainer.initialize_ros(node)
        PriorityContainer.initialize_ros(node)
        Logger.initialize(node)
        LogState.initialize_ros(node)
        Watch.initialize_ros(node)
        robot_states__Place.initialize_ros(node)
        self.add_behavior(PickingSM, 'Picking', node)

        # Additional initialization code can be added inside the following tags
        # [MANUAL_INIT]

        # [/MANUAL_INIT]

    def create(self):
        # x:920 y:78, x:909 y:171
        _state_machine = OperatableStateMachine(outcomes=['finished', 'failed'])
        _state_machine.userdata.part = 'bolt'

        # x:500 y:78, x:482 y:226
        _sm_place_and_watch_0 = ConcurrencyContainer(outcomes=['placed', 'stopped'],
                                                     input_keys=['shelf'],
                                                     conditions=[('placed', [('Place', 'placed')]),
                                                                 ('stopped', [('Watch', 'near')]),
                                                                 ('stopped', [('Watch', 'close')])
                                                                 ])

        with _sm_place_and_watch_0:
            # x:108 y:72
            OperatableStateMachine.add('Place',
                                       robot_states__Place(self.waiting_time),
                                       transitions={'placed': 'placed'},
                                       autonomy={'placed': Autonomy.Off},
                                       remapping={'shelf': 'shelf'})

            # x:110 y:173
            OperatableStateMachine.add('Watch',
                                       Watch(),
                                       transitions={'near': 'stopped'},
                                       autonomy={'near': Autonomy.Off})

        with _state_machine:
            # x:52 y:78
            OperatableStateMachine.add('Start',
                                       LogState(text='go', severity=Logger.REPORT_HINT),
                                       transitions={'done': 'Picking'},
                                       autonomy={'done': Autonomy.Low})

            # x:565 y:166
            OperatableStateMachine.add('Picking',
                                       self.use_behavior(PickingSM, 'Picking',
                                                         default_keys=['speed']),
                                       transitions={'picked': 'Deliver', 'failed': 'failed'},
                                       autonomy={'picked': Autonomy.Inherit, 'failed': Autonomy.Inherit},
                                       remapping={'part': 'part'})

            # x:273 y:106
            OperatableStateMachine.add('Deliver',
                                       _sm_place_and_watch_0,
                                       transitions={'placed': 'finished', 'stopped': 'Start'},
                                       autonomy={'placed': Autonomy.Inherit, 'stopped': Autonomy.Inherit},
                                       remapping={'shelf': 'shelf'})

        return _state_machine

    # Private functions can be added inside the following tags
    # [MANUAL_FUNC]

    # [/MANUAL_FUNC]
