"""A second machine for a contest's office: it copies the office's folder, and can take over."""
