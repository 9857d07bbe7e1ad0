"""All kinds of damage, by their names."""

from __future__ import annotations

import damage_concurrence
import damage_data
import damage_graph
import damage_names
from damage import KINDS

__all__ = ["KINDS", "damage_concurrence", "damage_data", "damage_graph", "damage_names"]
