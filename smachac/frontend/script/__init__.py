"""Scripts: from trees to resolved scripts, and to the state graph."""
