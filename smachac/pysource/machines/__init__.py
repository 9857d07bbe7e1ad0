"""Whole machines read from Python for SMACH by partial evaluation: the code is never run."""
