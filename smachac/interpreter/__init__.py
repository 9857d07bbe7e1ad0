"""The reference interpreter: what a machine does, step by step, in one thread."""
