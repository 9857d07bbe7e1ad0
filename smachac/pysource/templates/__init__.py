"""Templates of the user: those of a program, and the code in them."""
