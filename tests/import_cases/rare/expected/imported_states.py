# Imported from machine.py by smachac; the lines below have the sha256 ccd9e940b0333756.
"""Classes for the states of the scripts in this folder."""

try:
    import smach
except ImportError:  # without SMACH
    from smachac.runtime import smach

import machine


class Do_2(machine.Do):
    """../machine.py:5"""

    def __init__(self, arguments):
        super().__init__(*arguments)
