"""From when everybody may see the records of a contest: what its sheet names, a gateway serves."""

from pathlib import Path

from msgspec.structs import replace

from lacoc_client.web.gateway.recordings import Recordings
from lacoc_client.web.gateway.shown import ShownRecords
from lacoc_server.contest.acts import organiser
from lacoc_server.contest.kept.replays import shown
from lacoc_server.contest.league.sheet import ContestSheet, encode
from lacoc_shared.contest import file as contests
from lacoc_shared.messages.desk import Replays


def records(sheet: ContestSheet) -> dict[str, set[str]]:
    """Return the names of the records that a sheet names, by stage."""
    return {
        view.name: {
            Path(game.record).name for match in view.matches for game in match.games if game.record
        }
        for view in sheet.stages
    }


def test_records_are_kept_back_until_their_time(played: Path, tmp_path: Path) -> None:
    """The sheet names records at once, after their stage, or after the contest; so does /replay."""
    whole = organiser.sheet(played / "contest.toml")
    swiss, final = whole.stages
    plan = contests.load(played / "contest.toml")
    # One match of the final is still to be played.
    going = replace(
        whole,
        stages=(
            swiss,
            replace(final, matches=(*final.matches[:-1], replace(final.matches[-1], state="open"))),
        ),
    )
    every = records(whole)
    assert all(every.values())
    none: set[str] = set()
    for sheet, when, expected in (
        (going, "at-once", every),
        (going, "after-stage", {"swiss": every["swiss"], "final": none}),
        (going, "after-contest", {"swiss": none, "final": none}),
        (whole, "after-stage", every),
        (whole, "after-contest", every),
    ):
        choice: Replays = when  # type: ignore[assignment]
        public = shown(sheet, choice)
        assert records(public) == expected
        file = tmp_path / f"{when}.json"
        file.write_bytes(encode(public))
        shelf = Recordings(plan.recordings, list, ShownRecords(file))
        assert {one.name for one in shelf.listed()} == set().union(*expected.values())
        for name in set().union(*every.values()):
            assert (shelf.find(name) is not None) == (name in set().union(*expected.values()))
        shelf.close()


def test_no_record_is_shown_before_there_is_a_sheet(played: Path, tmp_path: Path) -> None:
    """A missing or broken sheet shows nothing."""
    plan = contests.load(played / "contest.toml")
    for text in (None, "{", "[]"):
        if text is not None:
            (tmp_path / "contest.json").write_text(text)
        shelf = Recordings(plan.recordings, list, ShownRecords(tmp_path / "contest.json"))
        assert shelf.listed() == []
        shelf.close()
