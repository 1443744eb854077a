"""Makes the modules of this folder and the helper modules of tests/server importable."""

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path += [str(HERE), str(HERE.parent / "server")]
