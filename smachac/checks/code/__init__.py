"""Rules over the code in a script: expressions, and functions of the user."""
