"""Rules over the classes of the user, against the interfaces of their state types."""
