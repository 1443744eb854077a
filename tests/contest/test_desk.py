"""Tests of the desk of an office: entries by page, decisions, moves, and who may do what."""

from pathlib import Path
from random import Random

import pytest
from chance_event import Event
from office_room import CODE, KEY, NOW_MS, Room, said, sample

from lacoc_robots.library import robot_folder
from lacoc_server.contest.acts import deciding, organiser
from lacoc_server.contest.kept.applications import Applications
from lacoc_server.contest.kept.entries import ContestEntry
from lacoc_server.contest.kept.event_code import EventCode
from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.plans import note_plans
from lacoc_server.contest.league.contest import compute
from lacoc_server.contest.league.facts import (
    Called,
    Closed,
    Drawn,
    Entered,
    Moved,
    Played,
    Replaced,
    Withdrawn,
    new,
)
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.timetable.calling import SeenCourt
from lacoc_server.contest.league.timetable.schedule import playable
from lacoc_server.contest.live.office import Office
from lacoc_server.contest.verify.history import check_history
from lacoc_shared.codec import encode
from lacoc_shared.gait.text import read_gait
from lacoc_shared.messages import Refusal, SentFile
from lacoc_shared.messages.desk import (
    Apply,
    Approve,
    ChangeFiles,
    CloseEntries,
    CourtDay,
    CourtPlan,
    Decline,
    Draw,
    Effect,
    EventInfo,
    LookAtEvent,
    Move,
    NewCode,
    Overview,
    Overviewed,
    Own,
    OwnEntry,
    Rule,
    Said,
    TakeOut,
    TeamFiles,
    ToDraw,
    TokenList,
    Tokens,
)
from lacoc_shared.words import render, say


@pytest.fixture
def room(tmp_path: Path) -> Room:
    return Room(tmp_path)


def test_a_team_enters_by_page(room: Room) -> None:
    """A team applies; when the organiser approves, a fact with its files is appended."""
    applied = room.ask(Apply(secret="k7q m3x", team=" Bees ", files=sample()))
    assert isinstance(applied, OwnEntry)
    assert (applied.team, applied.state) == ("Bees", "waits")
    assert [type(fact).__name__ for fact in room.facts] == ["Planned"], (
        "no fact before the organiser approves"
    )
    assert room.states() == {"Bees": "waits"}

    room.ask(Approve(secret=KEY, teams=("Bees",)))

    (entered,) = (fact for fact in room.facts if type(fact).__name__ == "Entered")
    assert entered.files == applied.files  # type: ignore[union-attr]
    assert room.where.entries.load(applied.files).locomotion == sample().locomotion.data  # type: ignore[union-attr]
    own = room.ask(Own(secret=applied.token))
    assert isinstance(own, OwnEntry)
    assert (own.state, own.token) == ("in", applied.token), "one token for the whole event"


def test_a_workbook_is_read_as_at_a_court(room: Room) -> None:
    """A workbook enters under its own name; a broken one is a mistake of the team's own file."""
    locomotion = sample().locomotion
    data = (robot_folder("hexapod") / "Loco-data.xlsx").read_bytes()
    files = TeamFiles(postures=SentFile("Loco-data.xlsx", data), locomotion=locomotion)
    applied = room.ask(Apply(secret=CODE, team="Bees", files=files))
    assert isinstance(applied, OwnEntry), applied
    text = room.applications.waiting["Bees"].entry.postures
    assert text is not None
    assert read_gait(text, "") == read_gait(sample().postures.data, "")  # type: ignore[union-attr]

    alone = TeamFiles(postures=files.postures)
    assert isinstance(room.ask(Apply(secret=CODE, team="Crabs", files=alone)), OwnEntry)

    half = SentFile("mine.xlsx", data[: len(data) // 2])
    refused = room.ask(Apply(secret=CODE, team="Ants", files=TeamFiles(postures=half)))
    assert isinstance(refused, Refusal)
    (mistake,) = refused.mistakes
    assert (mistake.file, mistake.found) == ("mine.xlsx", say("gait.damaged"))
    assert room.states()["Ants"] == "refused"


def test_a_mistake_in_a_text_has_the_team_s_own_name(room: Room) -> None:
    """A mistake names the file as the team called it."""
    files = TeamFiles(locomotion=SentFile("walk.txt", b"z"))
    refused = room.ask(Apply(secret=CODE, team="Ants", files=files))
    assert isinstance(refused, Refusal)
    assert {mistake.file for mistake in refused.mistakes} == {"walk.txt"}


def test_files_are_replaced_until_entries_close_then_with_a_reason(room: Room) -> None:
    """Until entries close, a team replaces its files; later the organiser must approve them."""
    room.enter("Ants")
    applied = room.ask(Apply(secret=CODE, team="Bees", files=sample()))
    assert isinstance(applied, OwnEntry)
    again = room.ask(ChangeFiles(secret=applied.token, files=sample(b"\n")))
    assert isinstance(again, OwnEntry)
    assert again.state == "waits"
    room.ask(Approve(secret=KEY, teams=("Bees",)))
    early = room.ask(ChangeFiles(secret=applied.token, files=sample(b"\n\n")))
    assert isinstance(early, OwnEntry)
    assert early.state == "in"

    room.ask(CloseEntries(secret=KEY))
    late = room.ask(ChangeFiles(secret=applied.token, files=sample(b"\n\n\n")))
    assert isinstance(late, OwnEntry)
    assert late.state == "late"
    assert room.states()["Bees"] == "late"
    assert compute(room.facts, FORMATS).teams[1].files == early.files, "nothing has changed yet"
    assert said(room.ask(Approve(secret=KEY, teams=("Bees",)))) == "contest.needs-reason"
    room.ask(Approve(secret=KEY, teams=("Bees",), reason="motor limit was misread"))
    assert compute(room.facts, FORMATS).teams[1].files == late.files
    assert room.facts[-1].reason == "motor limit was misread"  # type: ignore[union-attr]


def test_all_mistakes_are_told_and_the_organiser_sees_them(room: Room) -> None:
    """A refused team gets every mistake of its files, and the organiser's page shows them."""
    broken = SentFile("LocoTra-data.txt", b"1\t2\nx\ty\n")
    answer = room.ask(Apply(secret=CODE, team="Bees", files=TeamFiles(locomotion=broken)))
    assert isinstance(answer, Refusal)
    assert answer.mistakes
    (row,) = room.view.teams
    assert (row.state, row.mistakes) == ("refused", answer.mistakes)
    assert not room.applications.waiting
    assert isinstance(room.ask(Apply(secret=CODE, team="Bees", files=sample())), OwnEntry)
    assert room.states() == {"Bees": "waits"}
    assert said(room.ask(Apply(secret=CODE, team="Ants", files=TeamFiles()))) == "desk.no-files"


@pytest.mark.parametrize("name", ["Ants", "ANTS", "Ａnts", " ants ", "Bees"])
def test_a_name_has_one_owner(room: Room, name: str) -> None:
    """The name of a team that has entered or applied is taken.

    Another team can't have it with other capitals, wide letters or spaces either.
    """
    room.enter("Ants")
    room.ask(Apply(secret=CODE, team="Bees", files=sample()))
    assert said(room.ask(Apply(secret=CODE, team=name, files=sample()))) == "desk.name-taken"


def test_a_club_that_a_command_gave_is_shown(room: Room) -> None:
    """The organiser's page has the club of a team also if the team did not type it."""
    organiser.enter(room.file, "Ants", None, "", "", club="Kyoto")
    assert [(row.team, row.club) for row in room.view.teams] == [("Ants", "Kyoto")]


def test_a_club_that_the_organiser_changed_stays(room: Room) -> None:
    """What a team typed when it applied is not its club any more once the organiser changed it."""
    room.ask(Apply(secret=CODE, team="Bees", files=sample(), club="Tokio"))
    room.ask(Approve(secret=KEY, teams=("Bees",)))
    organiser.enter(room.file, "Bees", None, "", "", club="Tokyo")
    assert [row.club for row in room.view.teams] == ["Tokyo"]
    organiser.take_out(room.file, "Bees", "", disqualified=False)
    room.ask(Approve(secret=KEY, teams=("Bees",)))
    assert [team.club for team in compute(room.facts, FORMATS).teams] == ["Tokyo"]


@pytest.mark.parametrize("teams", [0, 1, 2])
def test_entries_do_not_close_by_themselves_without_teams(tmp_path: Path, teams: int) -> None:
    """An application after the time for it closes entries only if there are teams to play."""
    over = "[contest]\nentries_close = 2020-01-01T00:00:00\n"
    room = Room(tmp_path, stages=f'{over}[stage.cup]\nformat = "round-robin"\n')
    for team in ("Ants", "Bees")[:teams]:
        room.store.append(new(Entered, team=team, files="f"))
    room.ask(Apply(secret=CODE, team="Crabs", files=sample()))
    assert compute(room.facts, FORMATS).closed == (teams == 2)


def test_a_declined_name_is_free_and_its_link_opens_nothing(room: Room) -> None:
    """The link of a declined team opens nothing; whoever takes its name gets another token.

    How to reach the declined team is forgotten.
    """
    first = room.ask(Apply(secret=CODE, team="Bees", files=sample(), contact="bee@example.org"))
    assert isinstance(first, OwnEntry)
    room.ask(Decline(secret=KEY, teams=("Bees",)))
    assert "bee@example.org" not in room.where.contacts.read_text()
    assert said(room.ask(Own(secret=first.token))) == "desk.no-such-team"
    second = room.ask(Apply(secret=CODE, team="Bees", files=sample()))
    assert isinstance(second, OwnEntry)
    assert second.token != first.token
    assert said(room.ask(Decline(secret=KEY, teams=("Crabs",)))) == "desk.no-application"


def test_files_of_a_team_that_is_declined_meanwhile_do_not_come_back(
    room: Room, monkeypatch: pytest.MonkeyPatch
) -> None:
    """While files are weighed in, the organiser may decline the team: then they are forgotten."""
    first = room.ask(Apply(secret=CODE, team="Bees", files=sample()))
    assert isinstance(first, OwnEntry)
    weighed = room.desk._weighed

    def slowly(team: str, files: TeamFiles) -> ContestEntry:
        entry = weighed(team, files)
        room.ask(Decline(secret=KEY, teams=(team,)))
        return entry

    monkeypatch.setattr(room.desk, "_weighed", slowly)
    changed = ChangeFiles(secret=first.token, files=sample())
    assert said(room.ask(changed)) == "desk.no-such-team"
    assert room.states() == {}


def test_a_page_of_a_team_that_is_declined_meanwhile_gets_no_new_token(
    room: Room, monkeypatch: pytest.MonkeyPatch
) -> None:
    """While a team's page asks for its entry, the organiser may decline the team."""
    first = room.ask(Apply(secret=CODE, team="Bees", files=sample()))
    assert isinstance(first, OwnEntry)
    found = room.desk.admission.team

    def declined_then(secret: str, now_s: float) -> str:
        team = found(secret, now_s)
        monkeypatch.undo()
        room.ask(Decline(secret=KEY, teams=(team,)))
        return team

    monkeypatch.setattr(room.desk.admission, "team", declined_then)
    assert said(room.ask(Own(secret=first.token))) == "desk.no-such-team"
    assert room.where.contest.secrets.team_of(first.token) is None


def test_a_flood_of_applications_is_cleared_at_once(room: Room) -> None:
    """The organiser declines all that wait with one act, and makes another event code.

    With the old code nobody applies any more; the link of a team that has applied still opens its
    entry. The new code is the code after a restart too.
    """
    flood = tuple(f"Flood {number}" for number in range(5))
    for team in flood:
        room.ask(Apply(secret=CODE, team=team, files=sample()))
    declined = room.ask(Decline(secret=KEY, teams=flood))
    assert isinstance(declined, Said)
    assert room.states() == {}
    bees = room.ask(Apply(secret=CODE, team="Bees", files=sample()))
    assert isinstance(bees, OwnEntry)
    assert said(room.ask(Decline(secret=KEY, teams=("Bees", "Nobody")))) == "desk.no-application"
    assert room.states() == {"Bees": "waits"}

    room.ask(NewCode(secret=KEY))
    code = room.view.code
    assert code != CODE
    assert EventCode(room.where.event_code, CODE).value == code
    assert said(room.ask(Apply(secret=CODE, team="Ants", files=sample()))) == "desk.wrong-code"
    assert isinstance(room.ask(Apply(secret=code, team="Ants", files=sample())), OwnEntry)
    assert isinstance(room.ask(Own(secret=bees.token)), OwnEntry)


def test_the_organiser_brings_a_withdrawn_team_back(room: Room) -> None:
    """While entries are open, one press brings a team back with the files that it had."""
    room.enter("Ants", "Bees")
    room.ask(TakeOut(secret=KEY, team="Bees", reason="by mistake", really=True))
    assert room.states()["Bees"] == "withdrawn"
    room.ask(Approve(secret=KEY, teams=("Bees",)))
    assert room.states()["Bees"] == "in"
    room.ask(TakeOut(secret=KEY, team="Bees", reason="ill", really=True))
    room.enter("Crabs")
    room.ask(CloseEntries(secret=KEY))
    answer = room.ask(Approve(secret=KEY, teams=("Bees",), reason="well again"))
    assert said(answer) == "contest.gone-for-good"


def test_applications_are_there_after_a_restart(room: Room) -> None:
    """Applications and their files are on the disk, so a restarted office has them."""
    room.ask(Apply(secret=CODE, team="Bees", files=sample()))
    with Applications(room.where.applications) as again:
        assert again.waiting.keys() == {"Bees"}
        assert again.waiting["Bees"].entry == room.applications.waiting["Bees"].entry


def test_entries_close_once_and_need_two_teams(room: Room) -> None:
    """Closing entries appends a fact; a team that is still waiting does not take part."""
    room.enter("Ants")
    assert said(room.ask(CloseEntries(secret=KEY))) == "contest.few-teams"
    room.enter("Bees")
    room.ask(Apply(secret=CODE, team="Crabs", files=sample()))
    room.ask(CloseEntries(secret=KEY))
    assert isinstance(room.facts[-1], Closed)
    assert said(room.ask(CloseEntries(secret=KEY))) == "desk.closed-already"
    assert isinstance(room.ask(Apply(secret=CODE, team="Dogs", files=sample())), OwnEntry)
    for team in ("Crabs", "Dogs"):
        assert said(room.ask(Approve(secret=KEY, teams=(team,)))) == "contest.late-reason"
    room.ask(Approve(secret=KEY, teams=("Dogs",), reason="a late train"))
    assert room.states()["Dogs"] == "in"


def test_more_swiss_rounds_than_opponents_are_told(tmp_path: Path) -> None:
    """Whoever closes entries is told if a Swiss stage has more rounds than a team has opponents."""
    swiss = '[stage.swiss]\nformat = "swiss"\nrounds = {}\n'
    for rounds, doubted in ((3, False), (4, True)):
        folder = tmp_path / str(rounds)
        folder.mkdir()
        room = Room(folder, swiss.format(rounds))
        room.enter("Ants", "Bees", "Crabs")
        answer = room.ask(CloseEntries(secret=KEY))
        assert isinstance(answer, Said)
        assert ("contest.many-rounds" in [line.code for line in answer.said]) is doubted
        assert [one.code for one in organiser.doubts_of(room.file)] == (
            ["contest.many-rounds"] if doubted else []
        )


def test_a_decision_is_shown_before_it_is_made(room: Room) -> None:
    """A preview appends no fact; the decision has the shown effect on matches and ranks."""
    room.enter("Ants", "Bees")
    room.ask(CloseEntries(secret=KEY))
    room.draw()
    (match,) = playable(room.book.contest)
    first, second = match.next_seats or ("", "")
    facts = {"pairing": match.pairing.id, "game": 1, "teams": (first, second)}
    room.store.append(new(Played, scores=(10, 2), outcome="left", **facts))

    rule = {"kind": "result", "pairing": match.pairing.id, "scores": (2, 10), "reason": "swapped"}
    before = room.facts
    seen = room.ask(Rule(secret=KEY, **rule))
    assert isinstance(seen, Effect)
    assert not seen.done
    assert {line.code for line in seen.lines} == {
        "decide.match",
        "decide.plays-no-more",
        "decide.rank",
    }
    assert room.facts == before
    done = room.ask(Rule(secret=KEY, really=True, **rule))
    assert isinstance(done, Effect)
    assert done.lines == seen.lines
    assert room.book.contest.stages[0].ranking[0] == second

    out = TakeOut(secret=KEY, team=first, reason="left early")
    count = len(room.facts)
    seen = room.ask(out)
    assert isinstance(seen, Effect)
    assert seen.lines[0] == say("decide.leaves", team=first, left=1)
    assert len(room.facts) == count
    room.ask(TakeOut(secret=KEY, team=first, reason="left early", really=True))
    assert room.states()[first] == "withdrawn"


def test_a_preview_names_the_match_that_a_team_plays_now(room: Room) -> None:
    """A team whose last match is at a court has not played its last one."""
    room.enter("Ants", "Bees", "Crabs")
    room.ask(CloseEntries(secret=KEY))
    room.draw()
    matches = room.book.contest.stages[0].matches
    for number, match in enumerate(match for match in matches if match.next_seats):
        assert match.next_seats is not None
        facts = {"pairing": match.pairing.id, "game": 1, "teams": match.next_seats}
        if number < 2:
            room.store.append(new(Played, scores=(10, 2), outcome="left", **facts))
        else:
            room.store.append(new(Called, court="north", **facts))
    first = matches[0].pairing.id
    rule = Rule(secret=KEY, kind="result", pairing=first, scores=(2, 10), reason="swapped")
    seen = room.ask(rule)
    assert isinstance(seen, Effect)
    codes = [line.code for line in seen.lines]
    assert codes.count("decide.then") + codes.count("decide.plays-no-more") == 2
    assert "decide.then" in codes


@pytest.fixture
def over(tmp_path: Path) -> Room:
    """Give a contest whose final waits for the organiser: Ann has won, before Ben and Cyd."""
    final = '[stage.final]\nformat = "single-knockout"\nafter = "cup"\nteams = 2\n'
    room = Room(tmp_path, f'{final}draw = "organiser"\n')
    room.enter("Ann", "Ben", "Cyd")
    room.draw()
    room.draw()
    while matches := playable(room.book.contest):
        seats = matches[0].next_seats
        assert seats is not None
        assert room.view.to_draw is None, "the stage before it is not over"
        outcome = "left" if seats[0] < seats[1] else "right"
        facts = {"pairing": matches[0].pairing.id, "game": 1, "teams": seats}
        room.store.append(new(Played, scores=(5, 5), outcome=outcome, **facts))
    return room


def test_a_stage_waits_for_the_organiser_s_draw(over: Room) -> None:
    """The office does not draw such a stage; the organiser sees its teams, and draws it.

    If a correction has changed the teams meanwhile, nothing is drawn.
    """
    office = Office(over.store, over.where.entries, over.secrets.team, {}, {})
    office.step()
    assert [view.name for view in office.contest.stages] == ["cup"]
    assert not office.over
    shown = over.view.to_draw
    assert shown is not None
    assert (shown.stage, shown.entries) == ("final", ("Ann", "Ben"))

    over.store.append(new(Withdrawn, team="Ann", reason="ill"))
    draw = Draw(secret=KEY, stage=shown.stage, entries=shown.entries)
    assert said(over.ask(draw)) == "contest.other-draw"
    now = over.view.to_draw
    assert now is not None
    assert now.entries == ("Ben", "Cyd")
    draw = Draw(secret=KEY, stage="final", entries=now.entries)
    assert isinstance(over.ask(draw), Said)
    office.step()
    assert office.contest.stages[-1].stage.entries == ("Ben", "Cyd")
    assert over.view.to_draw is None
    assert said(over.ask(draw)) == "contest.nothing-to-draw"
    assert [*check_history(over.facts, over.book.contest)] == []


def test_the_draw_says_first_who_would_meet_again(over: Room) -> None:
    """The organiser sees before the draw who has met already, and who meets at once."""
    shown = over.view.to_draw
    assert shown is not None
    assert (shown.meet, shown.met) == (((0, 1),), (("Ann", "Ben"),))
    assert shown.apart == (), "two teams can't be kept apart"


def test_a_first_stage_can_wait_too(tmp_path: Path) -> None:
    """Closing entries does not draw a first stage that waits for the organiser."""
    room = Room(tmp_path, "")
    text = room.file.read_text().replace("[stage.cup]\n", '[stage.cup]\ndraw = "organiser"\n')
    room.file.write_text(text)
    room.where = ContestFolder(room.file)
    note_plans(room.store, room.where.plans)
    room.enter("Ann", "Ben")
    office = Office(room.store, room.where.entries, room.secrets.team, {}, {}, draw_from_ms=None)
    office.step()
    assert room.view.to_draw is None, "entries are open"
    room.ask(CloseEntries(secret=KEY))
    office.step()
    assert office.contest.stages == ()
    assert room.view.to_draw == ToDraw(
        stage="cup",
        title=say("stage.round-robin", number=None),
        entries=("Ann", "Ben"),
    )


def test_a_team_that_is_in_with_the_same_files_waits_for_nothing(room: Room) -> None:
    """A team that applied by page and was entered by command is in; only other files wait."""
    room.enter("Ants")
    applied = room.ask(Apply(secret=CODE, team="Bees", files=sample()))
    assert isinstance(applied, OwnEntry)
    entry = room.applications.waiting["Bees"].entry
    organiser.enter_weighed(room.where, room.store, "Bees", entry, "")
    assert room.states() == {"Ants": "in", "Bees": "in"}
    room.ask(CloseEntries(secret=KEY))
    room.ask(ChangeFiles(secret=applied.token, files=sample(b"\n\n")))
    assert room.states()["Bees"] == "late"


def test_a_stage_that_is_drawn_keeps_its_teams(tmp_path: Path) -> None:
    """A preview says that a later stage is drawn already if ranks before it would change."""
    final = '[stage.final]\nformat = "single-knockout"\nafter = "cup"\nteams = 2\n'
    room = Room(tmp_path, final)
    room.enter("Ann", "Ben", "Cyd")
    room.draw()
    room.draw()
    while matches := playable(room.book.contest):
        pairing, seats = matches[0].pairing.id, matches[0].next_seats
        assert seats is not None
        facts = {"pairing": pairing, "game": 1, "teams": seats}
        room.store.append(new(Played, scores=(10, 2), outcome="left", **facts))
    changed = {"kind": "void", "pairing": pairing, "reason": "the net fell"}
    seen = room.ask(Rule(secret=KEY, **changed))
    assert isinstance(seen, Effect)
    assert "decide.drawn" not in [line.code for line in seen.lines]
    room.draw()
    assert [view.name for view in room.book.contest.stages] == ["cup", "final"]
    seen = room.ask(Rule(secret=KEY, **changed))
    assert isinstance(seen, Effect)
    assert seen.lines[-1] == say("decide.drawn", stage=say("stage.single-knockout", number=None))


def test_a_referee_sees_what_comes_and_what_a_result_changes(room: Room) -> None:
    """The token of a court's referee shows the court's next games and the effect of a result."""
    room.enter("Ann", "Ben", "Cyd", "Dan")
    room.draw()
    token = room.secrets.referee("north")
    assert room.ask(CourtDay(secret="x", court="north")) == Refusal(say("refused.no-referee-token"))
    assert room.ask(CourtDay(secret=token, court="south")) == Refusal(
        say("refused.no-referee-token")
    )
    room.draw()  # closes entries first
    match = playable(compute(room.facts, FORMATS))[0]
    assert match.next_seats is not None
    left, right = match.next_seats
    call = {"pairing": match.pairing.id, "game": 1, "teams": (left, right)}
    room.store.append(new(Called, court="north", **call))
    facts = room.facts
    plan = room.ask(CourtDay(secret=token, court="north"))
    assert isinstance(plan, CourtPlan)
    assert plan.changes == ()
    assert {slot.court for slot in plan.coming} == {"north"}
    assert match.pairing.id not in {slot.pairing for slot in plan.coming}
    plan = room.ask(CourtDay(secret=token, court="north", scores=(1, 5), outcome="right"))
    assert isinstance(plan, CourtPlan)
    assert plan.changes[0].code == "decide.match"
    assert dict(plan.changes[0].values)["winner"] == right
    codes = {one.code for one in plan.changes}
    assert "decide.rank" not in codes, "the stage is not over"
    assert "decide.taken-back" not in codes, "the court's game ends; nobody takes it back"
    ranks = {
        one.values["team"]: one.values["after"]
        for one in plan.changes
        if one.code == "decide.rank-so-far"
    }
    assert ranks.get(right, 1) == 1  # it may have been first before
    assert left in ranks
    drawn = room.ask(CourtDay(secret=token, court="north", scores=(5, 5), outcome="draw"))
    assert isinstance(drawn, CourtPlan)
    told = [render(line) for line in drawn.changes]
    about = "Round robin, round 1"
    assert f"{about} is a draw: {left} and {right} get 1 point each." in told
    assert [line.split(" then plays: ")[0] for line in told if "then plays" in line] == [
        left,
        right,
    ]
    assert room.facts == facts


def test_a_drawn_game_of_a_match_of_several_says_how_it_goes_on(room: Room) -> None:
    """Before a drawn game counts, both teams read the score of the match and which game follows."""
    room.file.write_text(room.file.read_text().replace("[stage.cup]", "[stage.cup]\ngames = 3"))
    room.where = ContestFolder(room.file)
    note_plans(room.store, room.where.plans)
    room.enter("Ann", "Ben")
    room.draw()
    room.draw()
    (match,) = playable(compute(room.facts, FORMATS))
    assert match.next_seats is not None
    left, right = match.next_seats
    result = new(
        Replaced,
        pairing=match.pairing.id,
        game=1,
        teams=(left, right),
        scores=(5, 5),
        outcome="draw",
        reason="?",
    )
    (told,) = deciding.effect(room.facts, [result])
    assert render(told) == (
        f"Round robin, round 1 goes on at {match.teams[0]} ½ : ½ {match.teams[1]}: "
        "both teams play game 2."
    )


def test_a_level_match_says_to_whom_it_goes_and_why() -> None:
    """Before the last drawn game of a knockout counts, the winner is named with the reason."""
    event = Event(2, 1, Random(1))
    event.add(Closed)
    event.begin("cup", "single-knockout", event.names)
    (match,) = event.contest.stages[0].matches
    seats, level = match.next_seats, {"scores": (5, 5), "outcome": "draw"}
    event.add(Played, pairing=match.pairing.id, game=1, teams=seats, **level)
    again = new(Replaced, pairing=match.pairing.id, game=2, teams=seats, reason="?", **level)
    told = [render(line) for line in deciding.effect(event.facts, [again])]
    assert (
        "Final is level. It goes to t001 by the order of the draw, because they are equal in all "
        "else."
    ) in told


def test_a_result_that_counts_already_changes_nothing() -> None:
    """Who decides the score again that counts is told so; not what the teams play next."""
    event = Event(4, 1, Random(1))
    event.add(Closed)
    event.begin("cup", "single-knockout", event.names)
    match = event.contest.stages[0].matches[0]
    about = {"pairing": match.pairing.id, "game": 1, "teams": match.next_seats}
    counts = {"scores": (7, 5), "outcome": "left"}
    event.add(Played, **about, **counts)
    again = new(Replaced, **about, **counts, reason="?")
    assert [line.code for line in deciding.effect(event.facts, [again])] == ["decide.nothing"]
    other = new(Replaced, **about, scores=(7, 6), outcome="left", reason="?")
    assert "decide.then" in [line.code for line in deciding.effect(event.facts, [other])]


def test_a_court_that_does_not_answer_is_marked_at_once(room: Room) -> None:
    """The organiser sees it as soon as the office does, not only when its game is taken back."""
    assert [court.here for court in room.view.courts] == [True, True]
    seen = {**room.known.seen, "north": SeenCourt(NOW_MS)}
    room.known = room.known._replace(seen=seen)
    assert {court.court: court.here for court in room.view.courts} == {
        "north": False,
        "south": True,
    }


def test_a_match_is_moved(room: Room) -> None:
    """After a move, the view has the match at its new court and time; a wrong court is refused."""
    room.enter("Ants", "Bees", "Crabs", "Dogs")
    room.ask(CloseEntries(secret=KEY))
    room.draw()
    slots = {slot.pairing: slot.court for slot in room.view.slots}
    last = [*slots][-1]
    other = "south" if slots[last] == "north" else "north"
    later_ms = NOW_MS + 3_600_000
    answer = room.ask(Move(secret=KEY, pairing=last, court=other, not_before_ms=later_ms))
    (told,) = answer.said  # type: ignore[attr-defined]
    match = next(match for match in playable(room.book.contest) if match.pairing.id == last)
    assert f"({match.seated[0]} – {match.seated[1]}) is moved to court {other}." in render(told)
    (slot,) = (slot for slot in room.view.slots if slot.pairing == last)
    assert (slot.court, slot.at_ms) == (other, later_ms)
    assert slot.moved is not None
    assert slot.moved.court == other
    assert said(room.ask(Move(secret=KEY, pairing=last, court="east"))) == "desk.no-court"
    assert said(room.ask(Move(secret=KEY, pairing=last, not_before_ms=1))) == "day.in-the-past"
    room.store.append(new(Moved, pairing=last, not_before_ms=1))  # by now it is in the past
    assert isinstance(room.ask(Move(secret=KEY, pairing=last, not_before_ms=1)), Said)
    assert said(room.ask(Move(secret=KEY, pairing="x:a1.1"))) == "decide.no-match"
    assert said(room.ask(Move(secret=KEY, pairing=last, before=last))) == "desk.before-itself"


def test_an_unchanged_view_is_not_sent_again(room: Room) -> None:
    """If a page already has the newest view, the desk answers it without a view."""
    answer = room.ask(Overview(secret=KEY, known=room.view.version))
    assert isinstance(answer, Overviewed)
    assert answer.view is None


def test_the_organiser_gets_the_tokens_of_open_seats(tmp_path: Path) -> None:
    """In a contest with a stage of open matches each seat of each court has a token."""
    room = Room(tmp_path, '[stage.friendly]\nformat = "open"\n')
    answer = room.ask(Tokens(secret=KEY))
    assert isinstance(answer, TokenList)
    assert [(one.court, one.seat, one.token) for one in answer.seats] == [
        (court, seat, room.secrets.seat(court, seat))
        for court in ("north", "south")
        for seat in ("left", "right")
    ]


def test_tokens_are_for_the_organiser_alone(room: Room) -> None:
    """The organiser gets the tokens of all teams of people and of referees; others get none."""
    room.enter("Ants")
    organiser.enter(room.file, "Bots", None, "planner", "")
    answer = room.ask(Tokens(secret=KEY))
    assert isinstance(answer, TokenList)
    assert answer.teams == {"Ants": room.secrets.team("Ants")}
    assert answer.referees == {name: room.secrets.referee(name) for name in ("north", "south")}
    assert answer.seats == ()
    for secret in ("", CODE, room.secrets.team("Ants")):
        assert said(room.ask(Tokens(secret=secret))) == "desk.not-organiser"


def test_a_token_of_the_command_is_known_at_once(room: Room) -> None:
    """A token that another program makes while the office runs opens the team's entry."""
    room.enter("Ants")
    token = organiser.tokens(room.file, "Ants")["Ants"]
    own = room.ask(Own(secret=token))
    assert isinstance(own, OwnEntry)
    assert (own.team, own.state) == ("Ants", "in")
    assert room.secrets.team("Ants") == token


def test_roles_hold(room: Room) -> None:
    """No role can do what only another role may do; after many wrong tokens one must wait."""
    room.enter("Ants", "Bees")
    token = room.secrets.team("Ants")
    before = (room.facts, room.applications.waiting)
    organisers = [
        Overview,
        CloseEntries,
        Tokens,
    ]
    for secret in ("", CODE, token, "x", KEY.upper()):
        for kind in organisers:
            assert said(room.ask(kind(secret=secret))) == "desk.not-organiser"
        for request in (
            Approve(secret=secret, teams=("Ants",)),
            Decline(secret=secret, teams=("Ants",)),
            NewCode(secret=secret),
            Draw(secret=secret, stage="cup", entries=("Ants", "Bees")),
            TakeOut(secret=secret, team="Bees", really=True),
            Rule(secret=secret, kind="void", pairing="cup:a1.1", reason="x", really=True),
            Move(secret=secret, pairing="cup:a1.1", court="north"),
        ):
            assert said(room.ask(request)) == "desk.not-organiser"
    for secret in ("", token, KEY, "K7QM3Y"):
        request = Apply(secret=secret, team="Crabs", files=sample())
        assert said(room.ask(request)) == "desk.wrong-code"
    for secret in ("", CODE, KEY, f"{token}x"):
        assert said(room.ask(ChangeFiles(secret=secret, files=sample()))) == "desk.no-such-team"
    assert (room.facts, room.applications.waiting) == before
    for _ in range(300):
        last = room.ask(Own(secret="guess"))
    assert isinstance(last, Refusal)
    assert last.again
    assert last.why.code == "desk.slower"
    assert isinstance(room.ask(Own(secret=token)), OwnEntry), "a right one is always let in"
    assert isinstance(room.ask(LookAtEvent()), EventInfo)


def test_what_is_no_request_is_refused(room: Room) -> None:
    """Bytes that are no request are refused, and no stage is drawn."""
    for payload in (b"", b"\xc1", b"\x80", encode({"do": "draw"}), b"x" * 200_000):
        assert said(room.desk.judge(payload)) == "desk.bad-request"
    assert not any(isinstance(fact, Drawn) for fact in room.facts)
