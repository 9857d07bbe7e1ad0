"""Diagnostics: sources and spans, findings, severities, spelling suggestions, baselines."""
