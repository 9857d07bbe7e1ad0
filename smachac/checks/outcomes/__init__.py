"""Rules over outcomes: which are possible, where they lead, and which hide failures."""
