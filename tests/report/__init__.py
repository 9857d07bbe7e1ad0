"""Findings and explanations as text, JSON and the formats of other tools."""
