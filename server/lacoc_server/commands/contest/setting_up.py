"""Write and check the contest file (`lacoc_shared.contest.file`), and make its certificate."""

from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

import typer

from lacoc_arenas import arena as arenas
from lacoc_robots.library import find_robot
from lacoc_robots.limits import Limits
from lacoc_server.contest.kept.plans import doubts, not_for_courts, open_stage, plans
from lacoc_server.contest.league.facts import Planned
from lacoc_shared.command import screen
from lacoc_shared.command.keep import save
from lacoc_shared.contest import file as contests
from lacoc_shared.contest.courts import ContestCourt, beside, wrong_in
from lacoc_shared.keyspace import KeySpace
from lacoc_shared.mistakes import Gathered, UserError
from lacoc_shared.network.address import DEFAULT_PORT
from lacoc_shared.network.public import PublicAddress
from lacoc_shared.words import Phrase, say

FILE = Path("contest.toml")
FileToRead = Annotated[
    Path, typer.Argument(envvar="LACOC_CONTEST", metavar="FILE", help="The contest file.")
]

_TEMPLATE = """\
# A contest of LACOC. Check it with 'lacoc contest check', {enter}start
# everything with 'lacoc contest run'. It has no secret: all tokens are in
# {secrets}, which only you can read.

[contest]
name = "Contest"
recordings = "recordings"  # folder of the records, beside this file
robot = "hexapod"          # for a team that brings none: an installed robot or a file
least_rest_s = 60          # shortest time between two matches of a team
# entries_close = 2030-05-01T18:00:00   # else with the first draw
{public}
[limits]                   # for robots that teams bring; these are some of the defaults
# legs_max = 8
# width_m = 0.45           # and length_m, height_m: the robot with every angle 0
# mass_max_kg = 3.0
# ang_min_deg_s = 240.0    # fastest joint
# torque_n_m = 2.0         # strongest servo

[health]                   # a match held worse than this: "rematch advised"; these are the defaults
# real_time_factor = 0.98  # at least, over the time that was played
# slow_beats_percent = 1.0
# worst_late_ms = 200.0
# silent_s = 5.0           # of a seat; heard_percent = 70.0: of its repeats that arrived
# faults = 0               # stops of physics; resumptions = 2: restarts of a killed court

# A second machine can copy everything, and go on if this one is lost ('lacoc docs contest-day').
# [standby]
# office = "192.168.1.20:7446"   # this machine, where the second one copies

# A stage after another one; 'lacoc docs contest' has all formats and settings. Without
# start = "ready" a referee starts each game.
{stages}
# Each court has a port of its own.
{courts}"""


_GROUPS = """\
[stage.groups]
format = "round-robin"     # or "swiss", "sequential", "single-knockout", "double-knockout"
groups = 2
# title.en = "Preliminaries"   # what people read; without it "Group stage"
# title.ja = "予選"
arena = "{arena}"
settings.match.start = "ready"
# settings.match.duration_s = 120.0    # length of a game; else as in the arena's file
# settings.match.levels = ["B"]        # ["A", "B"]: posture keys too

[stage.finals]
format = "single-knockout"
after = "groups"
# draw = "organiser"       # wait until you draw it on /office; else it is drawn at once
teams = 4                  # the best four of the groups
apart = true               # teams of one group or club do not meet in the first round
games = 3                  # best of three, sides swapped after each game
third_place = true
# final_court = "{court}"   # where the final is played; else at any court that is free
arena = "{arena}"
settings.match.start = "ready"
# settings.match.duration_s = 120.0    # length of a game; else as in the arena's file
"""
_OPEN = """\
[stage.friendly]
format = "open"            # whoever has the link of a seat plays, match after match
arena = "{arena}"
settings.match.start = "ready"
# settings.match.duration_s = 120.0    # length of a match; else as in the arena's file
# settings.match.levels = ["B"]        # ["A", "B"]: posture keys too
"""
_HALL = """
# pages = "https://lacoc.example.org/"  # where everybody opens the pages; else at this machine
"""
_ONLINE = """
pages = "{pages}"  # as everybody opens the pages: all links begin with it
proxies = ["{proxy}"]  # whose word about who asks is believed ('lacoc docs online')
# certificate = "fullchain.pem"        # without a proxy: pages and courts encrypt by themselves
# private_key = "privkey.pem"
"""
_COURT = """\
[court.{court}]
arena = "{arena}"
{where}
"""
_HALL_COURT = """\
listen = ["0.0.0.0:{port}"]          # 127.0.0.1:{port}: this machine alone
# connect = "192.168.1.20:{port}"    # where others reach it
# input_delay = "equal"              # hold keys until both links have the same delay,
# input_delay_max_ms = 400           # at most this"""
_ONLINE_COURT = """\
listen = ["127.0.0.1:{port}"]        # for this machine only: contestants play on pages
input_delay = "equal"                # the near and the far contestant have the same delay"""
_PROXY = "127.0.0.1"


def init(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="The contest file to write.")] = FILE,
    arena: Annotated[
        str, typer.Option(metavar="NAME", help="The game: an arena's name or folder.")
    ] = "othello",
    court: Annotated[str, typer.Option(metavar="NAME", help="The court's name.")] = contests.MAIN,
    courts: Annotated[int, typer.Option(metavar="N", help="Number of courts.", min=1, max=64)] = 1,
    friendly: Annotated[
        bool,
        typer.Option(
            "--open",
            help="Plan open matches in place of groups and a knockout: whoever has the link of a "
            "seat plays, match after match.",
        ),
    ] = False,
    pages: Annotated[
        str | None,
        typer.Option(
            metavar="URL",
            help="Plan it for the internet, behind a proxy at this address, such as "
            "https://lacoc.example.org (see 'lacoc docs online').",
        ),
    ] = None,
    proxy: Annotated[
        str, typer.Option(metavar="ADDRESS", help="Address or network of that proxy.")
    ] = _PROXY,
    if_missing: Annotated[
        bool, typer.Option("--if-missing", help="Do nothing if the file is there already.")
    ] = False,
) -> None:
    """Write a contest file with comments: groups and a knockout, or with --open friendly matches.

    All tokens are beside it, in a file of their own that only you can read (contest.secrets.json).
    If there is a contest file of that name already, it is kept under another name.
    """
    if if_missing and file.exists():
        screen.note(say("contest.stays-as-it-is", file=str(file)))
        return
    KeySpace(court)
    arena = beside(Path.cwd(), arena)
    arenas.load(arena)
    names = [court] if courts == 1 else [f"{court}-{n + 1}" for n in range(courts)]
    public = None if pages is None else PublicAddress.of(pages, proxies=[proxy])
    text = _text(arena, names, public, contests.secrets_path(file).name, friendly=friendly)
    kept = save(file, text.encode())
    contest = contests.load(file)
    for name in names:
        contest.secrets.referee(name)
    if kept is not None:
        screen.note(say("command.kept", path=str(file), kept=str(kept)))
    if public is not None:
        screen.note(say("contest.written-online", file=str(file)))
    elif friendly:
        screen.note(say("contest.written-open", file=str(file)))
    else:
        screen.note(say("contest.written", file=str(file)))
    if doubt := not_for_courts([*plans(contest, file), open_stage(contest, file)]):
        screen.warn(doubt)


def _text(
    arena: str, courts: list[str], public: PublicAddress | None, secrets: str, *, friendly: bool
) -> str:
    """Return the text of a contest file.

    Args:
        arena: the game.
        courts: names of the courts.
        public: where everybody opens the pages of a contest on the internet; None: in a hall.
        secrets: name of the file of all tokens.
        friendly: whether to plan open matches.
    """
    where = _HALL_COURT if public is None else _ONLINE_COURT
    tables = [
        _COURT.format(court=court, arena=arena, where=where.format(port=port))
        for port, court in enumerate(courts, DEFAULT_PORT)
    ]
    head = _HALL
    if public is not None:
        head = _ONLINE.format(pages=f"{public.pages}/", proxy=public.proxies[0])
    stages = (_OPEN if friendly else _GROUPS).format(arena=arena, court=courts[0])
    enter = "" if friendly else "enter each team with 'lacoc contest enter NAME FOLDER', "
    return _TEMPLATE.format(
        enter=enter, secrets=secrets, public=head, stages=stages, courts="\n".join(tables)
    )


def check(file: FileToRead = FILE) -> None:
    """Check a contest file, its stages, its arenas' settings, its robot and limits for robots."""
    contest = contests.load(file)
    found = Gathered()
    with found:
        Limits.of(contest.limits)
    with found:
        find_robot(contest.robot)
    for name, court in contest.courts.items():
        with found:
            _check_court(name, court)
    stages: list[Planned] = []
    with found:
        stages = plans(contest, file)
    friendly = None
    with found:
        friendly = open_stage(contest, file)
    found.check()
    of_facts: list[Phrase] = []
    if contests.facts_path(file).exists():  # else no team has entered, and reading makes no file
        from lacoc_server.contest.acts import (
            organiser,
        )  # needs packages that the base install lacks

        of_facts = organiser.doubts_of(file)
    courts = [f"{name} ({court.arena})" for name, court in contest.courts.items()]
    screen.show(say("contest.right", file=str(file), courts=courts))
    for doubt in filter(None, (*doubts(stages), not_for_courts([*stages, friendly]))):
        screen.warn(doubt)
    close = contest.entries_close
    if close is not None and close.astimezone(UTC) <= datetime.now(UTC):
        screen.warn(say("contest.close-is-over", time=close.isoformat()))
    if contest.public.certificate is not None:
        # It needs packages, as `organiser` does.
        from lacoc_server.contest.acts.certificate import doubts as certificate_doubts

        for doubt in certificate_doubts(contest.public, close, datetime.now(UTC)):
            screen.warn(doubt)
    for doubt in of_facts:
        screen.warn(doubt)


def certificate(
    file: FileToRead = FILE,
    host: Annotated[
        list[str] | None,
        typer.Option(
            metavar="HOST",
            help="Another name or IP address by which this machine is reached; can be given more "
            "than once.",
        ),
    ] = None,
) -> None:
    """Encrypt a contest in a hall without a domain: make a certificate for pages and courts.

    A private authority issues it, which this command makes too. The files are in the folder 'tls'
    beside the contest file, and entries in the contest file name them. If you run this command
    again, the same authority issues a new certificate, and running courts and pages take it by
    themselves.

    With a domain, put the files of a public certificate into the contest file instead.
    """
    from lacoc_server.contest.acts.certificate import make_certificate  # needs packages

    hosts, end = make_certificate(file, host or ())
    screen.show(say("contest.certificate", hosts=hosts, day=str(end)))


def _check_court(name: str, court: ContestCourt) -> None:
    try:
        arenas.load(court.arena, court.settings)
    except UserError as error:
        raise wrong_in(f"court.{name}", error) from None
