# Imported from machine.py by smachac; the lines below have the sha256 57d2649b9c56d655.
"""Classes for the states of the scripts in this folder."""

try:
    import smach
except ImportError:  # without SMACH
    from smachac.runtime import smach

import voice_of_vendor


class Speak(voice_of_vendor.Speak):
    """../machine.py:11"""

    def __init__(self, arguments):
        super().__init__(*arguments)
