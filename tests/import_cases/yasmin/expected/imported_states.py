# Imported from ../machine.py by smachac; the lines below have the sha256 da9e2f943ba6a15e.
"""Classes for the states of the scripts in this folder."""

import yasmin

import machine


class Note(yasmin.CbState):
    """../machine.py:47"""

    def __init__(self):
        super().__init__(outcomes=['noted'], callback=machine.note)


class Beep(machine.Beep):
    """../machine.py:24"""

    def __init__(self):
        super().__init__()
        self.set_parameter('times', 3)


class Note_2(yasmin.CbState):
    """../machine.py:57"""

    def __init__(self):
        super().__init__(outcomes={'noted'}, callback=machine.note)
