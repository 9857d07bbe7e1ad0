# Imported from ../machine.py by smachac; the lines below have the sha256 ca11574730dcf692.
"""Classes for the states of the scripts in this folder."""

import voice_of_vendor


class Speak(voice_of_vendor.Speak):
    """../machine.py:11"""

    def __init__(self, argument_1):
        super().__init__(argument_1)
