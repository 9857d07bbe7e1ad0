"""The typed state graph: nodes, types, expressions, traversal, graph, printer and parser."""
