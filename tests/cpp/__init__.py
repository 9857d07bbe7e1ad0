"""The C++ target: generated headers are compiled and run."""
