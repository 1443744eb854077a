"""Formats of a contest's stages; an entry point of the group `lacoc.formats` names one.

The entry point is an object that is a `format.Format`.
"""
