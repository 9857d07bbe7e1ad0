# Imported from ../machine.py by smachac; the lines below have the sha256 6c17f4cc35471a63.
"""Classes for the states of the scripts in this folder."""

try:
    import smach
except ImportError:  # without SMACH
    from smachac.runtime import smach

import machine


class Ask(smach.CBState):
    """../machine.py:21"""

    def __init__(self):
        super().__init__(cb=machine.ask, outcomes=['asked'], output_keys=['answer'])


class Choose(smach.State):
    """../machine.py:22: the function `self.choose` is not at the top of a module."""

    def __init__(self):
        super().__init__(
            outcomes=['chosen', 'unknown'],
            input_keys=['answer'],
            output_keys=['choice'],
        )

    def execute(self, userdata):
        raise NotImplementedError('../machine.py:22')


class Store(smach.State):
    """../machine.py:25: the function `store` is not at the top of a module."""

    def __init__(self):
        super().__init__(
            outcomes=['stored'],
            input_keys=['choice'],
        )

    def execute(self, userdata):
        raise NotImplementedError('../machine.py:25')
