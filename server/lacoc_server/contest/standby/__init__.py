"""A second machine for a contest's office: it copies what the office keeps, and can take over."""
