"""The simulated world, the arm and its clock."""
