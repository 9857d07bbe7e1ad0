"""The state graph: types, expressions, its text and its graph."""
