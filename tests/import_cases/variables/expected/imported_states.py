# Imported from machine.py by smachac; the lines below have the sha256 457040b93edfac5d.
"""Classes for the states of the scripts in this folder."""

try:
    import smach
except ImportError:  # without SMACH
    from smachac.runtime import smach

import machine


class Work(machine.Work):
    """../machine.py:8"""

    def __init__(self, outcomes_argument):
        super().__init__(outcomes=outcomes_argument)


class Work_2(machine.Work):
    """../machine.py:8"""

    def __init__(self, outcomes_argument):
        super().__init__(outcomes=outcomes_argument)
