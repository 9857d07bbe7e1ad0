"""Faults in the class of a state type: unknown names and members, wrong calls."""
