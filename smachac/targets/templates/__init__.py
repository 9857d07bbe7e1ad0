"""The template engine: blocks of Jinja templates, rendered in a sandbox with a budget."""
