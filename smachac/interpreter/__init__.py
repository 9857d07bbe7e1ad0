"""The reference interpreter: it runs a machine step by step, in one thread, in virtual time."""
