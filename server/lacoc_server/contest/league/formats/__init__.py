"""Formats of a contest's stages.

Each is a `format.Format`, and is named by an entry point of the group `lacoc.formats`.
"""
