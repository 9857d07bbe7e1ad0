"""Scripts made of machines in Python for SMACH (docs/existing.md)."""
