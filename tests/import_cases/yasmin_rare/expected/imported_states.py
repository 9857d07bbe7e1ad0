# Imported from ../machine.py by smachac; the lines below have the sha256 0e2df720b221d762.
"""Classes for the states of the scripts in this folder."""

import yasmin
import yasmin_ros

import arm_states
import machine


class ServiceState_2(yasmin_ros.ServiceState):
    """../machine.py:25"""

    def __init__(self, srv_name, response_timeout):
        super().__init__(
            srv_name=srv_name,
            response_timeout=response_timeout,
            srv_type=machine.Trigger,
            create_request_handler=machine.request,
        )


class Ask(yasmin.State):
    """../machine.py:27: the function `self.ask` is not at the top of a module."""

    def __init__(self):
        super().__init__(
            outcomes=['yes', 'no'],
        )

    def execute(self, blackboard):
        raise NotImplementedError('../machine.py:27')


class Sleep(machine.Sleep):
    """../machine.py:12"""

    def __init__(self, seconds, outcomes_argument):
        super().__init__(seconds=seconds, outcomes=outcomes_argument)


class Drive(arm_states.Drive):
    """../machine.py:36"""

    def __init__(self, argument_1, speed):
        super().__init__(argument_1, speed=speed)
