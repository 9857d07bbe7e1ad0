"""Values in the class of a state type: what it reads of userdata and messages, and writes."""
