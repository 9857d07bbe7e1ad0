"""Sources, spans, diagnostics, severities, spelling and baselines: what all other rooms import."""
