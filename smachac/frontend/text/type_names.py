"""Names of types: those of the project file, and those of a script."""

from __future__ import annotations

import re
from collections.abc import Mapping

Aliases = Mapping[str, str]
"""The type of each name, itself without names."""

WORD = re.compile(r"\b[A-Za-z_]\w*\b(?!\s*:)")
"""A word of a type that is not the name of a field."""


def filled(text: str, aliases: Aliases) -> str:
    """A type with the types of the names in it."""
    return WORD.sub(lambda found: aliases.get(found.group(), found.group()), text)


def record_text(value: object) -> str | None:
    """The text of a type, given as a text or as a mapping of fields; None for anything else."""
    if isinstance(value, str):
        return value
    if not isinstance(value, dict) or not value:
        return None
    texts = {str(name): record_text(part) for name, part in value.items()}
    parts = [f"{field_name(name)}: {text}" for name, text in texts.items() if text is not None]
    return f"{{{', '.join(parts)}}}" if len(parts) == len(texts) else None


def field_name(name: str) -> str:
    """The name of a field of a record as a type has it."""
    import json

    return name if name.isidentifier() else json.dumps(name)
