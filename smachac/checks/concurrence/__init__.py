"""Rules over concurrences: outcome maps, and branches that use the same key or resource."""
