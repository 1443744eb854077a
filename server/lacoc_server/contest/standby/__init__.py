"""A second machine for a contest's office: it copies all that is kept, and can go on."""
