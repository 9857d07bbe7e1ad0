"""Rules over userdata: keys that are unset, unused, undeclared or overwritten, and remappings."""
