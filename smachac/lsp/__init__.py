"""The language server: answers to editors, computed from the texts that they hold."""
