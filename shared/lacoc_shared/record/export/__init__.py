"""Exports of a record for other programs: tables, JSON and a 3D view."""
