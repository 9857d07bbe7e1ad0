"""Reports of findings and explanations: one module for each form of output."""
