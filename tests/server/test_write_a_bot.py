"""Tests of docs/write-a-bot.md: its code works as printed, by the page alone."""

import re
from itertools import pairwise
from pathlib import Path

import pytest
from stage import setup

from lacoc_arenas import arena as arenas
from lacoc_server.simulate import player, simulate
from lacoc_shared.inputs import KeySeat
from lacoc_shared.record.reader import Record

PAGE = Path(__file__).parents[2] / "docs" / "write-a-bot.md"
BLOCKS = re.findall(r"^```python\n(.*?)^```", PAGE.read_text("utf-8"), re.M | re.S)
SHORT = {"match": {"duration_s": 20.0}}


def name_of(block: str) -> str:
    """Return the name of the file, which the first line of a block gives."""
    name = re.match(r"# (\w+\.py): ", block)
    assert name is not None, block
    return name[1]


@pytest.mark.slow
@pytest.mark.parametrize("arena", ["othello", pytest.param("flag-strike", marks=pytest.mark.long)])
@pytest.mark.parametrize("block", BLOCKS, ids=name_of)
def test_the_page_s_bots_play(tmp_path: Path, block: str, arena: str) -> None:
    """Each bot of the page plays both games: it walks, and presses no key that is pressed."""
    bot = tmp_path / name_of(block)
    bot.write_text(block, encoding="utf-8")
    ground = arenas.load(arena, SHORT)
    players = [player(ground, 0, str(bot)), player(ground, 1, "straight")]
    simulate(setup(arena, SHORT), players, tmp_path / "records")
    (file,) = (tmp_path / "records").iterdir()
    keys = [
        (one.level, one.key)
        for _, inputs in sorted(Record.read(file).inputs.items())
        for one in inputs
        if isinstance(one, KeySeat) and one.seat == 0
    ]
    assert keys
    assert all(now != before for before, now in pairwise(keys))
