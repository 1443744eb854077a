"""Robot-Othello (workshop 5-1, rules 5): walk over discs and they take your colour."""
