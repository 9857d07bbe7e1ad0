"""The differences of two machines: states, transitions, keys, values, outcomes, findings."""
