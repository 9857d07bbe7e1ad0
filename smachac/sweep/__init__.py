"""Sweeps: many runs of one script with seeds and varied values, in worker processes."""
