"""Robot-Othello (workshop 5-1, rules 5): discs take the colour of a robot that walks over them."""
