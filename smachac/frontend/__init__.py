"""The frontend: parse, resolve and lower scripts; read state types, files and settings."""
