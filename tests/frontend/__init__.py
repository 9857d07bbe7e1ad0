"""From YAML text to the state graph."""
