# Imported from machine.py by smachac; the lines below have the sha256 05e25da359dd5203.
"""Classes for the states of the scripts in this folder."""

import voice_of_vendor


class Speak(voice_of_vendor.Speak):
    """../machine.py:11"""

    def __init__(self, arguments):
        super().__init__(*arguments)
