"""Rules over names: of states, of outcomes, and of the targets of transitions."""
