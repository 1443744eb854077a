"""Makes `stage`, the builders that the tests of the court share, importable."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).parent))
