"""Source text of the user in Python and C++: read, never run."""
