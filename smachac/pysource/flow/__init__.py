"""Control flow of the functions of a class: paths, returns, local variables."""
