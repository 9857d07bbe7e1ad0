"""All mutations: importing the modules that define them enters them in `MUTATIONS`."""

from __future__ import annotations

from tests.trust import (
    mutate_classes,
    mutate_concurrences,
    mutate_data,
    mutate_failures,
    mutate_graph,
    mutate_names,
    mutate_properties,
    mutate_stops,
    mutate_values,
    mutate_written_code,
)
from tests.trust.mutants import MUTATIONS

__all__ = [
    "MUTATIONS",
    "mutate_classes",
    "mutate_concurrences",
    "mutate_data",
    "mutate_failures",
    "mutate_graph",
    "mutate_names",
    "mutate_properties",
    "mutate_stops",
    "mutate_values",
    "mutate_written_code",
]
