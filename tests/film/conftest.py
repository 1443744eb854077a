"""Gives a short recorded match to film."""

import sys
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).parents[1] / "pages"))

from chromium import NoBrowser, build_pages, find_chromium

from lacoc_arenas import arena as arenas
from lacoc_server.simulate import player, simulate
from lacoc_shared.record.schema import Setup

SETTINGS = {
    "match": {"duration_s": 7.0, "countdown_s": 0.1},
    "game": {"clearance_m": 0.05, "starts": [[-0.42, -0.22], [-0.42, 0.22]]},
}
"""Robots that start near flags, so that a flag falls within seconds."""


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the record of a match of Flag-Strike, 7 s long."""
    folder = tmp_path_factory.mktemp("film")
    arena = arenas.load("flag-strike", SETTINGS)
    setup = Setup(
        match_id="short",
        court="hall",
        match=1,
        arena="flag-strike",
        settings=arena.settings,
        limits={},
    )
    players = [player(arena, seat, bot) for seat, bot in enumerate(("planner", "straight"))]
    simulate(setup, players, folder)
    return folder / "short.mcap"


@pytest.fixture(scope="module")
def with_browser() -> str:
    """Give Chromium's path, after the pages are built; without a Chromium the test fails."""
    build_pages()
    try:
        return find_chromium()
    except NoBrowser as why:
        pytest.fail(str(why), pytrace=False)
