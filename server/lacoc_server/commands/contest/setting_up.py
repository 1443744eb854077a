"""Write, check and show the contest file (`lacoc_shared.contest.file`); make its certificate."""

import os
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

import typer
from rich.text import Text

from lacoc_arenas import arena as arenas
from lacoc_robots.limits import Limits
from lacoc_server.contest.kept.plans import plans
from lacoc_shared.command import options, screen
from lacoc_shared.command.keep import save
from lacoc_shared.contest import entrances
from lacoc_shared.contest import file as contests
from lacoc_shared.contest.file import Contest, Court
from lacoc_shared.contest.tokens import new_token
from lacoc_shared.keyspace import Keys
from lacoc_shared.mistakes import Gathered, UserError
from lacoc_shared.network.public import PublicAddress
from lacoc_shared.words import render, say

FILE = Path("contest.toml")
FileToRead = Annotated[
    Path, typer.Argument(envvar="LACOC_CONTEST", metavar="FILE", help="The contest file.")
]

_TEMPLATE = """\
# A contest of LACOC. Check it with 'lacoc contest check', start its court with
# 'lacoc serve --contest {file}', and hand each person their line of 'lacoc contest show'.
# 'lacoc contest certificate' makes a certificate, with which everything is encrypted.
# Whoever has a token is let in with it: keep this file to yourself.

[contest]
name = "Contest"
recordings = "recordings"  # folder of the records, beside this file
robot = "hexapod"          # for a team that brings none: an installed robot or a file

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

# One table like this for each court; each listens at a port of its own (7448, 7449, ...).
[court.{court}]
arena = "{arena}"
listen = ["0.0.0.0:7447"]          # 127.0.0.1:7447: this machine alone
# connect = "192.168.1.20:7447"    # where others reach it, for 'show'
# input_delay = "equal"                # hold keys until both links have the same delay,
# input_delay_max_ms = 400             # at most this

# A seat may have its team's own look: colour = "#009e73", pattern = "plain", "stripes" or "dots".
{seats}
[court.{court}.referee]
token = "{referee}"

# What differs from the arena's own file.
[court.{court}.settings.match]
# duration_s = 120.0
# countdown_s = 3.0
# restart_freeze_s = 5.0   # keys are refused for so long after [x]
# levels = ["B"]           # ["A", "B"]: posture keys too
# start = "ready"          # begin when all seats are ready, without a referee's word
# unattended_s = 900.0     # such a match ends when nobody has been heard for so long; 0: never
"""


_EVENT = """\
# A contest of LACOC with many matches. Check it with 'lacoc contest check', enter each team with
# 'lacoc contest enter NAME FOLDER', then start everything with 'lacoc contest run'.
# Whoever has a token is let in with it: keep this file to yourself.

[contest]
name = "Contest"
recordings = "recordings"  # folder of the records, beside this file
robot = "hexapod"          # for a team that brings none: an installed robot or a file
least_rest_s = 60          # shortest time between two matches of a team
# entries_close = 2030-05-01T18:00:00   # else with the first draw
{public}
[limits]                   # for robots that teams bring; see 'lacoc contest init' without --event

[office]                   # gives the courts their matches
token = "{office}"

# A second machine can copy everything, and go on if this one is lost ('lacoc docs contest-day').
# [standby]
# office = "192.168.1.20:7446"   # this machine, where the second one copies
# token = "{standby}"            # encrypts what is copied

# A stage after another one; 'lacoc docs contest' has all formats and settings. Without
# start = "ready" a referee starts each game.
[stage.groups]
format = "round-robin"     # or "swiss", "sequential", "single-knockout", "double-knockout"
groups = 2
# title.en = "Preliminaries"   # what people read; without it "Group stage"
# title.ja = "予選"
arena = "{arena}"
settings.match.start = "ready"
# settings.match.duration_s = 120.0    # length of a game; else as in the arena's file

[stage.finals]
format = "single-knockout"
after = "groups"
# draw = "organiser"       # wait until you draw it on /office; else it is drawn at once
teams = 4                  # the best four of the groups
games = 3                  # best of three, sides swapped after each game
third_place = true
arena = "{arena}"
settings.match.start = "ready"
# settings.match.duration_s = 120.0    # length of a game; else as in the arena's file
{courts}"""
_HALL = """
# pages = "https://lacoc.example.org/"  # where everybody opens the pages; else at this machine
"""
_ONLINE = """
pages = "{pages}"  # as everybody opens the pages: all links begin with it
proxies = ["{proxy}"]  # whose word about who asks is believed ('lacoc docs online')
# certificate = "fullchain.pem"        # without a proxy: pages and courts encrypt by themselves
# private_key = "privkey.pem"
"""
_EVENT_COURT = """
[court.{court}]
arena = "{arena}"
{where}
[court.{court}.referee]
token = "{referee}"
"""
_HALL_COURT = """\
listen = ["0.0.0.0:{port}"]
# connect = "192.168.1.20:{port}"    # where others reach it"""
_ONLINE_COURT = """\
listen = ["127.0.0.1:{port}"]        # for this machine only: contestants play on pages
input_delay = "equal"                # the near and the far contestant have the same delay"""
_FIRST_PORT = 7447
_PROXY = "127.0.0.1"


def init(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="The contest file to write.")] = FILE,
    arena: Annotated[
        str, typer.Option(metavar="NAME", help="The court's game: an arena's name or folder.")
    ] = "othello",
    court: Annotated[str, typer.Option(metavar="NAME", help="The court's name.")] = contests.MAIN,
    event: Annotated[
        bool,
        typer.Option(
            "--event",
            help="Plan a whole event: groups and a knockout, whose matches an office gives to the "
            "courts.",
        ),
    ] = False,
    courts: Annotated[
        int, typer.Option(metavar="N", help="Number of courts, with --event.", min=1, max=64)
    ] = 1,
    pages: Annotated[
        str | None,
        typer.Option(
            metavar="URL",
            help="With --event: plan it for the internet, behind a proxy at this address, such as "
            "https://lacoc.example.org (see 'lacoc docs online').",
        ),
    ] = None,
    proxy: Annotated[
        str, typer.Option(metavar="ADDRESS", help="Address or network of that proxy.")
    ] = _PROXY,
) -> None:
    """Write a contest file with comments and fresh tokens.

    If there is a file of that name already, it is kept under another name.
    """
    Keys(court)
    if event:
        arenas.load(arena)
        names = [court] if courts == 1 else [f"{court}-{n + 1}" for n in range(courts)]
        public = None if pages is None else PublicAddress.of(pages, proxies=[proxy])
        text = _event(arena, names, public)
    else:
        seats = "\n".join(
            f'[court.{court}.seat.{seat.id}]\ntoken = "{new_token()}"\n'
            for seat in arenas.load(arena).seats
        )
        text = _TEMPLATE.format(
            file=file, court=court, arena=arena, seats=seats, referee=new_token()
        )
    before = os.umask(0o077)  # nobody but its owner may ever read it
    try:
        kept = save(file, text.encode())
    finally:
        os.umask(before)
    if kept is not None:
        screen.note(say("command.kept", path=str(file), kept=str(kept)))
    if event and pages is not None:
        screen.note(say("contest.written-online", file=str(file)))
    elif event:
        screen.note(say("contest.written-event", file=str(file)))
    else:
        screen.note(say("contest.written", file=str(file)))


def _event(arena: str, courts: list[str], public: PublicAddress | None) -> str:
    """Return the text of the contest file of an event.

    Args:
        arena: the courts' game.
        courts: names of the courts.
        public: where everybody opens the pages of an event on the internet; None: in a hall.
    """
    where = _HALL_COURT if public is None else _ONLINE_COURT
    tables = [
        _EVENT_COURT.format(
            court=court, arena=arena, where=where.format(port=port), referee=new_token()
        )
        for port, court in enumerate(courts, _FIRST_PORT)
    ]
    head = _HALL
    if public is not None:
        head = _ONLINE.format(pages=f"{public.pages}/", proxy=public.proxies[0])
    return _EVENT.format(
        arena=arena,
        office=new_token(),
        standby=new_token(),
        courts="".join(tables),
        public=head,
    )


def check(file: FileToRead = FILE) -> None:
    """Check a contest file, its stages, its arenas' settings and its limits for robots."""
    contest = contests.load(file)
    found = Gathered()
    with found:
        Limits.of(contest.limits)
    for name, court in contest.courts.items():
        with found:
            _check_court(name, court, contest)
    with found:
        plans(contest, file)
    found.check()
    courts = [f"{name} ({court.arena})" for name, court in contest.courts.items()]
    screen.show(say("contest.right", file=str(file), courts=courts))
    close = contest.entries_close
    if close is not None and close.astimezone(UTC) <= datetime.now(UTC):
        screen.warn(say("contest.close-is-over", time=close.isoformat()))
    if contest.public.certificate is not None:
        from lacoc_server.contest.certificate import doubts  # needs packages, as `organiser`

        for doubt in doubts(contest.public, close, datetime.now(UTC)):
            screen.warn(doubt)
    if contests.facts_path(file).exists():  # else no team has entered, and reading makes no file
        from lacoc_server.contest import organiser  # needs packages that the base install lacks

        for doubt in organiser.doubts_of(file):
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
    from lacoc_server.contest.certificate import make_certificate  # needs packages

    hosts, end = make_certificate(file, host or ())
    screen.show(say("contest.certificate", hosts=hosts, day=str(end)))


def show(
    file: FileToRead = FILE,
    court: options.CourtName = None,
    host: options.CourtHost = None,
    json: options.Json = False,
) -> None:
    """Print the command line for each contestant, the referee and spectators."""
    contest = contests.load(file)
    names = [contest.court(court)[0]] if court else list(contest.courts)
    any_host = host or contest.own_host
    lines = {name: entrances.join_lines(name, contest.courts[name], any_host) for name in names}
    if json:
        screen.print_json(lines)
        return
    for name, by_person in lines.items():
        for person, line in by_person.items():
            screen.show(
                Text(render(say("contest.for-whom", court=name, person=person)), style="dim")
            )
            screen.stdout.print(line, markup=False, soft_wrap=True)  # to be copied whole
    if host is None and not all(contest.courts[name].host for name in names):
        screen.note(say("contest.host", host=any_host))


def _check_court(name: str, court: Court, contest: Contest) -> None:
    try:
        arena = arenas.load(court.arena, court.settings, court.looks)
    except UserError as error:
        raise contests.wrong_in(f"court.{name}", error) from None
    if contest.office is not None:  # it opens the seats
        return
    there = {seat.id for seat in arena.seats}
    if there != set(court.seat):
        raise UserError(
            say(
                "contest.arena-seats",
                court=name,
                arena=court.arena,
                there=sorted(there),
                seats=sorted(court.seat),
            )
        )
