"""The targets json, ir, dot and Python; templates and interfaces."""
