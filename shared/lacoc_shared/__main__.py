"""Runs `lacoc` as `python -m lacoc_shared`, where the command is not on the search path."""

import sys

from lacoc_shared.command import parent
from lacoc_shared.command.cli import main

parent.follow()
sys.exit(main())
