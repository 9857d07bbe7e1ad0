"""Soundness: random correct projects, mutants of them, and their runs."""
