"""Enter teams, play the matches of a contest, and print its standings."""

from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from lacoc_server.commands.contest.setting_up import FILE, FileToRead
from lacoc_shared.command import child, options, screen
from lacoc_shared.words import render, say

if TYPE_CHECKING:
    from lacoc_server.contest.kept.entries import HandedIn
    from lacoc_server.contest.kept.sheet_writer import Progress
    from lacoc_server.contest.league.sheet import ContestSheet
    from lacoc_server.contest.league.standings import Table
    from lacoc_server.contest.live.run import Opened
    from lacoc_shared.words import Phrase

# The base install can set up a contest but can't play one: what plays is imported when it is used.

ContestArgument = Annotated[
    Path,
    typer.Option("--contest", envvar="LACOC_CONTEST", metavar="FILE", help="The contest file."),
]
Team = Annotated[str, typer.Argument(metavar="TEAM", help="Name of the team.")]
Reason = Annotated[
    str, typer.Option("--reason", metavar="TEXT", help="The reason; everybody can read it.")
]

By = Annotated[
    str,
    typer.Option("--by", metavar="NAME", help="Who decides; by default the organiser."),
]


def enter(
    team: Team,
    folder: Annotated[
        Path | None,
        typer.Argument(
            metavar="FOLDER",
            help="Folder with the team's gait files, robot.toml if the robot is its own, and "
            "picture.png if it has a picture; by default the contest's robot with its sample gait.",
        ),
    ] = None,
    bot: Annotated[
        str,
        typer.Option(metavar="BOT", help="The bot that plays: an installed one, or your_bot.py."),
    ] = "",
    contest: ContestArgument = FILE,
    reason: Reason = "",
    club: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="Its school or club, '' for none; a stage with apart = true draws teams of one "
            "club apart.",
        ),
    ] = None,
    by: By = "",
) -> None:
    """Enter a team with its files; they are weighed in at once, and frozen.

    Of several gait files for a level the newest one is taken: Loco-data.txt or Loco-data.xlsx for
    level A, LocoTra-data.txt for level B. If there is none for level B, it is made from the
    postures, with the sequences of the sample's keys.

    A team can enter again with other files until entries are closed: at the time in the contest
    file, or when the first stage is drawn. After that a change, or a late team, needs a reason.
    """
    from lacoc_server.contest.acts import organiser

    done = organiser.enter(contest, team, folder, bot, reason, _tell_found, club=club, by=by)
    screen.show(done)


def _tell_found(handed: "HandedIn") -> None:
    """Print which files of a folder are taken, and remarks on them."""
    if handed.taken:
        screen.note(say("contest.taken", files=handed.taken))
    for note in handed.notes:
        screen.warn(note)
    if handed.made and handed.gaits.postures is not None:
        screen.note(say("contest.made-level-b", file=handed.gaits.postures.name))


def run(
    file: FileToRead = FILE,
    headless: Annotated[
        bool, typer.Option("--headless", help="Let bots play, as fast as the machine can.")
    ] = False,
    steer: Annotated[
        str, typer.Option(metavar="BOT", help="The bot that steers teams without a bot.")
    ] = "planner",
    jobs: options.Jobs = None,
    cluster: Annotated[
        str | None,
        typer.Option(
            metavar="ADDRESS",
            help="With --headless: play at the workers of this Dask cluster, such as "
            "tcp://192.168.1.20:8786.",
        ),
    ] = None,
    listen: Annotated[
        str | None,
        typer.Option(
            metavar="HOST:PORT",
            help="Address for the pages; 0.0.0.0:8080 lets everybody on the same network see them. "
            "Not with --headless.",
        ),
    ] = None,
    speed: Annotated[
        float,
        typer.Option(help="2 plays twice as fast as real time. Not with --headless.", min=0.1),
    ] = 1.0,
    browser: Annotated[
        bool, typer.Option("--open/--no-open", help="Open the pages in the browser.")
    ] = False,
    entries: Annotated[
        bool,
        typer.Option(
            "--entries",
            help="First let teams enter on the page /enter, until you close entries on the page "
            "/office; this holds after a restart too. If the file has entries_close, they may "
            "enter until then also without this option. Not with --headless.",
        ),
    ] = False,
    until_over: Annotated[
        bool,
        typer.Option(
            "--until-over",
            help="End by itself soon after the last result; by default courts and pages stay until "
            "Ctrl-C. Not with --headless.",
        ),
    ] = False,
    take_over: Annotated[
        bool,
        typer.Option(
            "--take-over",
            help="Go on here, from this machine's copy of an office whose machine is gone "
            "('lacoc contest standby'). Not with --headless.",
        ),
    ] = False,
    json: options.Json = False,
) -> None:
    """Play the contest: draw each stage when its teams are known, and play its games.

    The office of the contest runs here, with all courts of the contest file, the pages, and the
    bots of teams that are bots. A free court gets the next game; its result comes from the court.
    Ctrl-C, or even kill -9, loses nothing: start it again, and the contest goes on. Courts with
    'elsewhere' in the contest file run on other machines ('lacoc contest courts').

    With --headless there is no network: bots play as fast as the machine can. A game is known by
    all that decides it, such as the files of both teams, the rules and the software. If its record
    is there, it is not played again. After a change of one entry, start a new contest with the same
    folder of records: it plays only the games that the change decides.
    """
    from lacoc_server.contest.acts import organiser
    from lacoc_server.contest.headless.pool import Pool, interrupted_by_signals

    for doubt in organiser.doubts_of(file):
        screen.warn(doubt)
    with _retiring(), interrupted_by_signals(), screen.progress() as progress:
        task = progress.add_task(render(say("simulate.matches")), total=None)

        def changed(done: int, there: int) -> None:
            progress.update(task, completed=done, total=there)

        if headless:
            from lacoc_server.contest.headless.cluster import Cluster

            engine = Pool(jobs) if cluster is None else Cluster(cluster, screen.warn)
            sheet, played = organiser.play_headless(file, steer, engine, changed, screen.warn)
        else:
            if take_over:
                _take_over(file)
            played = None
            sheet = _live(file, changed, speed, listen, browser, entries, until_over, json)
    games = sum(len(match.games) for view in sheet.stages for match in view.matches)
    if json:
        screen.print_json({"kind": "end", "played": played, "games": games})
        return
    _show(sheet)
    if played is not None:
        screen.note(say("contest.played-now", played=played, games=games))


@contextmanager
def _retiring() -> Iterator[None]:
    """In the block, end this process if another machine has become the contest's office.

    Its exit code, `NOT_AGAIN`, says that the process must not be started again.
    """
    from lacoc_server.contest.kept.machine import Retired

    try:
        yield
    except Retired as retired:
        screen.error(retired.phrase)
        raise typer.Exit(child.NOT_AGAIN) from None


def _take_over(file: Path) -> None:
    """Make this machine the contest's office; do nothing if it is the office already."""
    from lacoc_server.contest.standby.taking_over import take_over

    said = take_over(file)
    if said is not None:
        screen.note(said)


def _live(
    file: Path,
    changed: "Progress",
    speed: float,
    listen: str | None,
    browser: bool,
    entries: bool,
    until_over: bool,
    json: bool,
) -> "ContestSheet":
    """Run the contest at its courts until Ctrl-C, or until it is over."""
    from lacoc_server.contest.live.run import play_live

    def opened(where: "Opened") -> None:
        if json:
            screen.print_json({"kind": "open", **where._asdict()})
            return
        screen.show(say("contest.open", url=f"{where.url}/contest", courts=[*where.courts]))
        screen.show(say("contest.office-page", url=where.office))
        screen.show(say("contest.enter-page", url=f"{where.url}/enter", code=where.code))
        for court, links in where.seats.items():
            for seat, link in links.items():
                screen.show(say("contest.open-seat", court=court, seat=seat, url=link))

    return play_live(
        file,
        opened,
        changed,
        screen.note,
        news=(lambda _: None) if json else _tell_news,
        speed=speed,
        listen=listen,
        show=browser,
        entering=entries,
        until_over=until_over,
    )


def _tell_news(what: "Phrase") -> None:
    """Print a piece of news from the contest, with the time of day."""
    screen.show(f"{datetime.now():%H:%M} {render(what)}", screen.stderr)


def standings(file: FileToRead = FILE, json: options.Json = False) -> None:
    """Print the standings of each stage as they are now; before the draw, who has entered."""
    from lacoc_server.contest.acts import organiser
    from lacoc_server.contest.league.sheet import encode

    sheet = organiser.sheet(file)
    if json:
        screen.stdout.print(encode(sheet).decode(), markup=False, soft_wrap=True)
    elif sheet.stages:
        _show(sheet)
    else:
        _show_entered(sheet, organiser.waiting(file))


def _show_entered(sheet: "ContestSheet", waiting: list[str]) -> None:
    here = [team for team in sheet.teams if not team.gone]
    screen.show(say("contest.not-drawn", teams=len(here)))
    for team in here:
        screen.show(say("contest.entered-team", team=team.name, bot=team.bot or None))
    for name in waiting:
        screen.show(say("contest.waiting-team", team=name))


def _show(sheet: "ContestSheet") -> None:
    titles = [say("fact.rank"), say("fact.team"), say("fact.won"), say("fact.drawn")]
    titles += [say("fact.lost"), say("fact.points"), say("fact.score")]
    for view in sheet.stages:
        for table in view.tables:
            codes = _deciding(table)
            shown = screen.table(*titles, *(say("plain.text", text=code) for code in codes))
            title = say(
                "contest.stage-title",
                stage=sheet.titles[view.name],
                group=table.section.upper() or None,
            )
            shown.title = render(title)
            for row in table.rows:
                numbers = (row.won, row.drawn, row.lost, row.points)
                score = f"{row.scored} : {row.conceded}"
                ties = [str(row.tie_breaks[table.tie_breaks.index(code)]) for code in codes]
                rank = f"{row.rank} =" if row.shares else str(row.rank)
                shown.add_row(rank, row.team, *map(str, numbers), score, *ties)
            screen.show(shown)
            if any(row.shares for row in table.rows):
                screen.show(say("contest.by-the-draw"))
            for above, row in pairwise(table.rows):
                if row.decided_by and "points" not in table.tie_breaks:  # a bracket
                    first, second, tie = above.team, row.team, row.decided_by
                    screen.show(say("standing.level", above=first, below=second, tie=tie))


def _deciding(table: "Table") -> list[str]:
    """Return the tie-breaks (except points and seed) that decided a rank, in the table's order."""
    decided = {row.decided_by for row in table.rows} - {"", "seed", "points"}
    return [code for code in table.tie_breaks if code in decided]
