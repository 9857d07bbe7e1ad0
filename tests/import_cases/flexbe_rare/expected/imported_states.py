# Imported from ../machine.py by smachac; the lines below have the sha256 1c56e59fc85af811.
"""Classes for the states of the scripts in this folder."""

import flexbe_core

import flexbe_states.decision_state
import machine


class Count(machine.Count):
    """../machine.py:11"""

    def __init__(self, outcomes_argument, limit):
        super().__init__(outcomes=outcomes_argument, limit=limit)
        self.set_rate(2)


class DecisionState(flexbe_states.decision_state.DecisionState):
    """../machine.py:60"""

    def __init__(self, outcomes_argument):
        super().__init__(
            outcomes=outcomes_argument,
            conditions=lambda x: 'up' if x else 'down',
        )


class Dock(flexbe_core.EventState):
    """../machine.py:74: its class is not known."""

    def __init__(self):
        super().__init__(
            outcomes=['finished'],
        )

    def execute(self, userdata):
        raise NotImplementedError('../machine.py:74')
