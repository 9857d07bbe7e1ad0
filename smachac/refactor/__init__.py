"""Scripts rewritten: laid out anew, or with their states elsewhere. Text in, text out."""
