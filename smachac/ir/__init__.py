"""The typed state graph (IR): nodes, types, expressions, traversal, graph, printer and parser."""
