"""smachac: a compiler for robot task state machines."""

__version__ = "0.1.0"
