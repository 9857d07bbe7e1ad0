"""What the compiler found, for people and for machines: each module is one form of a report."""
