"""The parsers of the grammars, written by scripts/parsers.py: lark's own lexer and parser in the
module `lalr` (MPL-2.0, LICENSES.txt), and a module of tables for each grammar."""
