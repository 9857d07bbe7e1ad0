"""smachac: a compiler for robot task state machines."""
