"""Players: each runs test cases on the program that a target generates."""
