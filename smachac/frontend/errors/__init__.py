"""The diagnostics of the front end: SM001 to SM022."""
