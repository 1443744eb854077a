"""Gives a short recorded match to film."""

from pathlib import Path

import pytest
from bot_matches import bot_match
from chromium import NoBrowser, build_pages, find_chromium

SETTINGS = {
    "match": {"duration_s": 7.0, "countdown_s": 0.1},
    "game": {"clearance_m": 0.05, "starts": [[-0.42, -0.22], [-0.42, 0.22]]},
}
"""Robots that start near flags, so that a flag falls within seconds."""


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the record of a match of Flag-Strike, 7 s long."""
    folder = tmp_path_factory.mktemp("film")
    return bot_match(folder, "flag-strike", ("planner", "straight"), SETTINGS)


@pytest.fixture(scope="module")
def with_browser() -> str:
    """Give Chromium's path, after the pages are built; without a Chromium the test fails."""
    build_pages()
    try:
        return find_chromium()
    except NoBrowser as why:
        pytest.fail(str(why), pytrace=False)
