"""Loco-data.xlsx: postures in a workbook (workshop 4-1 and Fig. 4-1, rules 2).

People edit the sheet "EX (input)". The sheet "Loco-data" shows the same cells by formulas; a
spreadsheet program can save it as text. LACOC reads the edited sheet itself.
"""

INPUT_SHEET = "EX (input)"
MIRROR_SHEET = "Loco-data"
