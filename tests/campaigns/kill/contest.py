r"""Kills office, courts and gateway of a contest at random moments; checks that nothing is lost.

    python -m tests.campaigns.kill.contest --teams 30 --courts 4 --kills 100
    python -m tests.campaigns.kill.contest --teams 12 --courts 2 --machines 20 \
        --seconds 40 --speed 4

Bots play a Swiss stage of five rounds and a double knockout of the best eight at 20 times the
speed. Their robots stand still, so each game has the same result whenever it is played. The contest
is played twice, once undisturbed, and once with kills (SIGKILL). A killed office is started again
with the same command; it starts a killed court or gateway itself.

With `--machines` whole machines are lost instead: all processes of the office's machine are killed
at a random moment in which all courts play, and its folder is moved away. The contest goes on at a
second machine, which a third one copies, and so on.
"""

import random
import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import psutil
from arguments import arguments
from lacoc_process import contest_run
from ports import free_port
from tests.campaigns.kill.machines import Relay

from lacoc_server.contest.acts import organiser
from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league.facts import AnyFact, Called, Played, Recalled

_REST_S = 1.0
_CALM_SPEED = 20.0
_BOT = "def bot(sheet, seat):\n    return lambda frame: None\n"
_STAGES = """
[stage.swiss]
format = "swiss"
rounds = 5
settings = {{ match = {{ duration_s = {seconds}, countdown_s = 1.0, start = "ready" }} }}

[stage.finals]
format = "double-knockout"
after = "swiss"
teams = 8
extra_games = 0
settings = {{ match = {{ duration_s = {seconds}, countdown_s = 1.0, start = "ready" }} }}
"""


def main() -> None:
    """Play a contest without and with kills; print all differences, and exit with 1 if any."""
    options = arguments(
        __doc__,
        teams=30,
        courts=4,
        kills=100,
        machines=(0, "office's machines that are lost"),
        seconds=(4.0, "length of a game"),
        speed=_CALM_SPEED,
        seed=0,
    )
    with tempfile.TemporaryDirectory() as folder:
        calm = _contest(Path(folder, "calm"), options.teams, options.courts, options.seconds)
        chance = random.Random(options.seed)
        killed: Counter[str] = Counter()
        calm_s = _play(calm, _CALM_SPEED, 0, chance, killed)
        wild = _contest(Path(folder, "wild"), options.teams, options.courts, options.seconds)
        right = True
        if options.machines:
            begun_s = time.monotonic()
            relay = Relay(wild, options.speed, options.courts, chance)
            wild = relay.run(options.machines)
            wild_s = time.monotonic() - begun_s
            right = relay.report(wild)
        else:
            wild_s = _play(wild, options.speed, options.kills, chance, killed)
        right &= _report(calm, wild, killed, calm_s, wild_s)
    sys.exit(0 if right else 1)


def _contest(folder: Path, teams: int, courts: int, seconds: float) -> Path:
    folder.mkdir()
    text = f'[contest]\nname = "Kills"\nleast_rest_s = {_REST_S}\n'
    text += f'\n[standby]\noffice = "127.0.0.1:{free_port()}"\n'
    for number in range(1, courts + 1):
        listen = f'listen = ["127.0.0.1:{free_port()}"]'
        text += f'\n[court.court-{number}]\narena = "othello"\n{listen}\n'
    file = folder / "contest.toml"
    file.write_text(text + _STAGES.format(seconds=seconds))
    bot = folder / "bot.py"
    bot.write_text(_BOT)
    for number in range(1, teams + 1):
        organiser.enter(file, f"Team {number:02d}", None, str(bot), "")
    return file


def _play(
    file: Path, speed: float, kills: int, chance: random.Random, killed: Counter[str]
) -> float:
    """Play a contest to its end, with kills on the way; return how long it took [s]."""
    begun_s = time.monotonic()
    while True:
        with contest_run(file, "--until-over", "--speed", str(speed), fresh=True) as run:
            process = run.process
            while process.poll() is None:
                time.sleep(chance.uniform(0.2, 3.0))
                wanted = killed.total() < kills and process.poll() is None
                if wanted and _kill(process.pid, chance, killed):
                    process.wait()
            if process.returncode == 0:
                return time.monotonic() - begun_s


def _kill(office: int, chance: random.Random, killed: Counter[str]) -> bool:
    """Kill the office, a court or the gateway; return whether it was the office."""
    try:
        # One that has just ended has no words any more.
        children = {one.pid: _what(one.cmdline()) for one in psutil.Process(office).children()}
        able = [pid for pid, what in children.items() if what in ("serve", "web")]
        pid = chance.choice([*able, office])
        psutil.Process(pid).send_signal(signal.SIGKILL)
    except psutil.NoSuchProcess:
        return False
    killed["office" if pid == office else children[pid]] += 1
    return bool(pid == office)


def _what(words: Sequence[str]) -> str:
    return next((word for word in words if word in ("serve", "web", "bot")), "")


def _report(calm: Path, wild: Path, killed: Counter[str], calm_s: float, wild_s: float) -> bool:
    tables = [_tables(calm), _tables(wild)]
    facts = _facts(wild)
    found: dict[str, Any] = {
        "kills": dict(killed),
        "calm_s": round(calm_s),
        "killed_s": round(wild_s),
        "games": sum(isinstance(fact, Played) for fact in facts),
        "same_standings": tables[0] == tables[1],
        "counted_twice": _twice(facts),
        "on_two_courts": _on_two_courts(facts),
        "rest_broken": _rest_broken(facts),
    }
    print(found)
    wrong = found["counted_twice"] or found["on_two_courts"] or found["rest_broken"]
    return bool(found["same_standings"]) and not wrong


def _tables(file: Path) -> object:
    return [view.tables for view in organiser.sheet(file).stages]


def _facts(file: Path) -> tuple[AnyFact, ...]:
    with FactStore(ContestFolder(file).facts) as store:
        return store.facts()


def _twice(facts: Sequence[AnyFact]) -> int:
    """Count the games with several results that are not void."""
    results = Counter(
        (fact.pairing, fact.game)
        for fact in facts
        if isinstance(fact, Played) and fact.outcome != "void"
    )
    return sum(times > 1 for times in results.values())


def _on_two_courts(facts: Sequence[AnyFact]) -> int:
    """Count the calls that name a team already on a court, or a court that already has a game."""
    wrong = 0
    on: dict[tuple[str, int], Called] = {}
    for fact in facts:
        if isinstance(fact, Called):
            busy = {team for call in on.values() for team in call.teams}
            wrong += bool(busy & {*fact.teams}) or fact.court in {one.court for one in on.values()}
            on[fact.pairing, fact.game] = fact
        elif isinstance(fact, Played | Recalled):
            on.pop((fact.pairing, fact.game), None)
    return wrong


def _rest_broken(facts: Sequence[AnyFact]) -> int:
    """Count the calls of teams that had not rested long enough after another match."""
    wrong = 0
    ended: dict[str, tuple[str, int]] = {}
    for fact in facts:
        if isinstance(fact, Called):
            for team in fact.teams:
                pairing, at_ms = ended.get(team, (fact.pairing, 0))
                wrong += pairing != fact.pairing and fact.at_ms - at_ms < 1000 * _REST_S
        elif isinstance(fact, Played):
            ended |= dict.fromkeys(fact.teams, (fact.pairing, fact.at_ms))
    return wrong


if __name__ == "__main__":
    main()
