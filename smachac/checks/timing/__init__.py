"""Rules over time: time limits, loops, and preempt requests."""
