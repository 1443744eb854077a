"""Folders with the files of students, from which bots play."""

from pathlib import Path

from lacoc_robots.library import sample_gait_files


def sample() -> bytes:
    """Return the hexapod's sample locomotion table."""
    locomotion = sample_gait_files("hexapod").locomotion
    assert locomotion is not None
    return locomotion.data


def handed_in(folder: Path, locomotion: bytes | None) -> Path:
    """Make a folder, put the locomotion table into it if one is given, and return the folder."""
    folder.mkdir()
    if locomotion is not None:
        (folder / "LocoTra-data.txt").write_bytes(locomotion)
    return folder


def players_of(folder: Path, *names: str, locomotion: bytes | None = None) -> list[str]:
    """Make a folder with a gait for each name; return a player "straight@FOLDER" for each."""
    gait = locomotion or sample()
    return [f"straight@{handed_in(folder / name, gait)}" for name in names]
