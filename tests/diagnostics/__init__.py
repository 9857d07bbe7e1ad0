"""Findings, spans and the spelling of names."""
