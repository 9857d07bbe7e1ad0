"""What is computed from a machine: the data flow, control flow, types and outcomes that rules use."""
