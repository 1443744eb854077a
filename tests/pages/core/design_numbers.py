"""Reads numbers as gait files have them: JSON, a list of cells, becomes a list of numbers or nulls.

A case of design_table.test.mjs runs it.
"""

import json
import sys

from lacoc_shared.gait.cells import narrow, number_of

cells = json.loads(sys.stdin.buffer.read())
json.dump([number_of(narrow(cell).strip()) for cell in cells], sys.stdout)
