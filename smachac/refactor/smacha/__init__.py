"""Migration: where SMACHA's scripts and templates mean something else in smachac."""
