"""Hypothesis strategies that several folders use, and their tests."""
