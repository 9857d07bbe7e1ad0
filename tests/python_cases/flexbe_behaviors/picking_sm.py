from flexbe_core import Autonomy, Behavior, OperatableStateMachine
from robot_states import Grasp


class PickingSM(Behavior):
    def __init__(self, node):
        super(PickingSM, self).__init__()
        self.name = 'Picking'

    def create(self):
        _state_machine = OperatableStateMachine(outcomes=['picked', 'failed'], input_keys=['part', 'speed'])
        _state_machine.userdata.part = None
        _state_machine.userdata.speed = 0.5

        with _state_machine:
            OperatableStateMachine.add('Grasp',
                                       Grasp(),
                                       transitions={'held': 'picked', 'lost': 'failed'},
                                       autonomy={'held': Autonomy.Off, 'lost': Autonomy.High},
                                       remapping={'part': 'part', 'speed': 'speed'})

        return _state_machine
