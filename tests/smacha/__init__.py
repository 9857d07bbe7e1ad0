"""Scripts and templates written for SMACHA."""
