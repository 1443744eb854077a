"""Loco-data.xlsx: a gait file of postures that is a workbook.

People edit the sheet "EX (input)". The sheet "Loco-data" shows the same cells by formulas; a
spreadsheet program can save it as text. LACOC reads the edited sheet itself.
"""

INPUT_SHEET = "EX (input)"
MIRROR_SHEET = "Loco-data"
