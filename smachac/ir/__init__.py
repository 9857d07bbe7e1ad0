"""The typed state graph and what is known of it: nodes, paths, types, text, graph, interpreter."""
