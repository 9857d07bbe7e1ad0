"""State types: interfaces, templates with meta blocks, and the types of values."""
