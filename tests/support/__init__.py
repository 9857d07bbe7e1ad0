"""Builders and checks that several folders use."""
