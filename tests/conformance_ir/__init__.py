"""The interpreter and the generated Python against recorded runs of SMACH itself."""
