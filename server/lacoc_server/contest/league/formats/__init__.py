"""Formats of a contest's stages.

Each is an object with the methods of `format.Format`, which an entry point of the group
`lacoc.formats` names.
"""
