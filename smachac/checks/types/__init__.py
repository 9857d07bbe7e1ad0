"""Rules over values and their types."""
