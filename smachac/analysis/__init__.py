"""What is computed from a machine: data flow, control flow, types and outcomes."""
