"""The version of smachac."""

__version__ = "0.1.0"
