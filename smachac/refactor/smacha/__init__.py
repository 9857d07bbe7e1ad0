"""Migration: differences between SMACHA and smachac in scripts and templates."""
