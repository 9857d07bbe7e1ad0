"""What is computed from a machine: data flow, types, outcomes, failures."""
