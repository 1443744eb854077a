"""A court that is started alone, with the tokens and entries of a contest file.

    python -m tests.processes.alone CONTEST [OPTION OF lacoc serve]...

So tests and benchmarks know its tokens, and can change its numbers. It assigns itself open matches.
"""

import sys
from pathlib import Path

from lacoc_arenas import arena as arenas
from lacoc_server.commands import serve
from lacoc_shared.command import cli
from lacoc_shared.contest.file import load


def main() -> None:
    """Run the court."""
    file, *words = sys.argv[1:]
    plan = load(Path(file))
    name, entry = plan.court(words[words.index("--court") + 1] if "--court" in words else None)
    seats = [seat.id for seat in arenas.load(entry.arena, entry.settings).seats]
    secrets = plan.secrets
    tokens = iter([secrets.referee(name), *(secrets.seat(name, seat) for seat in seats)])
    serve._alone = lambda *_: plan
    serve.new_token = lambda: next(tokens)
    sys.exit(cli.main(["serve", *words]))


if __name__ == "__main__":
    main()
