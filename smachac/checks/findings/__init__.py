"""Parts of findings that several folders of rules share: words, places, edits, helps."""
