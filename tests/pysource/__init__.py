"""Reading the code of the user in Python and C++."""
