"""Texts of YAML: trees with spans, syntax errors, suppressions, and readers of fields."""
