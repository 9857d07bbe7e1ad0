"""Scripts through the whole compiler."""
