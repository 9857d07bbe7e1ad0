"""From text to the state graph: parse, resolve, lower; files, configuration and suppressions."""
