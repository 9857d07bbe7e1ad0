# Imported from ../machine.py by smachac; the lines below have the sha256 ed6e213ea99e86dc.
"""Classes for the states of the scripts in this folder."""

import machine


class Work(machine.Work):
    """../machine.py:8"""

    def __init__(self, outcomes_argument):
        super().__init__(outcomes=outcomes_argument)


class Work_2(machine.Work):
    """../machine.py:8"""

    def __init__(self, outcomes_argument):
        super().__init__(outcomes=outcomes_argument)
