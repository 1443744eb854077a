"""`python -m tests.campaigns.forge.contest`: how many forgeries does `lacoc contest verify` find?

A small contest is played and published. In each of many copies of the folder one thing is forged,
so that it means something else: a fact, an entry, a record or a table of standings. After a forged
fact the sheet and the standings are sometimes computed again, and the facts numbered again.

Two kinds of forgery leave a history that nobody can tell from a true one: the last facts are
missing, or a decision was added. The first is found with an earlier publication (`--earlier`); for
the second, each decision is listed. Both kinds are counted apart.
"""

import json
import random
import shutil
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import small_contest
from arguments import arguments
from msgspec.structs import replace
from tests.campaigns.forge import game as game_forger
from tests.campaigns.forge.record import Forger, Harmless

from lacoc_server.contest.acts import organiser
from lacoc_server.contest.headless.play import outcome
from lacoc_server.contest.kept.entries import EntryFolder
from lacoc_server.contest.kept.folder import ContestFolder, file_hash
from lacoc_server.contest.kept.publish import (
    ENTRIES,
    FACTS,
    GAMES,
    RECORDS,
    SHEET,
    STANDINGS,
    tables,
)
from lacoc_server.contest.kept.store import FactStore
from lacoc_server.contest.league import facts as league_facts
from lacoc_server.contest.league import sheet as sheets
from lacoc_server.contest.league.contest import Contest, compute
from lacoc_server.contest.league.facts import (
    AnyFact,
    Closed,
    Disqualified,
    Drawn,
    Entered,
    FilesChanged,
    Planned,
    Played,
    Replaced,
    RoundDrawn,
    new,
)
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.verify.games import check_game, games_of
from lacoc_server.contest.verify.history import check_earlier, decisions
from lacoc_server.contest.verify.published import check_published, read
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.reader import Record
from lacoc_shared.words import render

_NAME = "Cup"
AGAIN = "a game played again"
"""The kind of forgery after which everything is computed again."""


class Forged(NamedTuple):
    """The results of checking forgeries."""

    kinds: Counter[str]
    """How many were made, by kind."""
    missed: list[str]
    """Forgeries that `verify` did not find, although something in the folder contradicts them."""
    fitting: int
    """Histories that fit together."""
    fitting_missed: list[str]
    """Those that were not found with an earlier publication either."""
    changes: Counter[str]
    """What was changed in games that were played again."""
    other_results: int
    """How many of these claim another result than the honest contest."""
    harmless: Counter[str]
    """Those that `verify` accepts, because they claim the results of the honest contest."""


class _Copy:
    """A copy of the published folder that is being forged."""

    def __init__(self, honest: Path, other: Path, folder: Path, chance: random.Random) -> None:
        shutil.copytree(honest, folder)
        self.honest = honest
        self.folder = folder
        self.other = other
        self.chance = chance
        self.facts = [*read(folder)]
        self.name = ""

    def index(self, *kinds: type) -> int:
        """Choose a fact of these kinds by chance; return its index."""
        places = [at for at, fact in enumerate(self.facts) if isinstance(fact, kinds)]
        if not places:
            raise Harmless
        return self.chance.choice(places)

    def change(self, at: int, **changes: Any) -> None:
        """Change fields of a fact."""
        if all(getattr(self.facts[at], name) == value for name, value in changes.items()):
            raise Harmless
        self.facts[at] = replace(self.facts[at], **changes)

    def record(self) -> tuple[int, Path]:
        """Choose a game; return the index of its fact, and its record."""
        at = self.index(Played)
        fact = self.facts[at]
        assert isinstance(fact, Played)
        return at, self.folder / RECORDS / fact.record

    def write(self, *, whole: bool, again: bool) -> None:
        """Write the facts.

        Args:
            whole: whether they are numbered again, from 1 on.
            again: whether sheet and standings are computed from them.
        """
        if whole:
            self.facts = [
                replace(fact, id=f"f{number}", number=number)
                for number, fact in enumerate(self.facts, 1)
            ]
        (self.folder / FACTS).write_bytes(league_facts.encode(self.facts))
        if again:
            self.tables()

    def tables(self) -> None:
        """Compute sheet and standings from the facts."""
        sheet = sheets.sheet(_NAME, compute(self.facts, FORMATS))
        for name, content in {SHEET: sheets.encode(sheet), **tables(sheet)}.items():
            (self.folder / name).write_bytes(content)


def forge(honest: Path, other: Path, count: int, seed: int, only: Collection[str] = ()) -> Forged:
    """Forge copies of a published contest, and check each.

    Args:
        honest: the published folder.
        other: the published folder of another contest with the same teams.
        count: number of forgeries.
        seed: seed of the random choice.
        only: the kinds to make; empty: all.
    """
    chance = random.Random(seed)
    checker = _Checker()
    if wrong := [*checker.findings(honest)]:
        raise AssertionError(f"the honest contest does not follow: {wrong}")
    facts = read(honest)
    kinds: Counter[str] = Counter()
    missed: list[str] = []
    fitting_missed: list[str] = []
    names = [name for name in only or _KINDS for _ in range(_KINDS[name][1])]
    changes: Counter[str] = Counter()
    harmless: Counter[str] = Counter()
    claims, other_results = _claims([*facts]), 0
    made = 0
    while made < count:
        name = chance.choice(names)
        with tempfile.TemporaryDirectory() as place:
            copy = _Copy(honest, other, Path(place, "copy"), chance)
            try:
                _KINDS[name][0](copy)
            except (Harmless, UserError):
                continue
            made += 1
            kinds[name] += 1
            title = f"{name}: {copy.name}"
            same = name == AGAIN and _claims(copy.facts) == claims
            if name == AGAIN:
                changes.update(one.partition(" (")[0] for one in copy.name.split(" + "))
                other_results += not same
            if next(checker.findings(copy.folder), None) is not None:
                continue
            if same:
                harmless[copy.name] += 1
                continue
            if name not in _FITTING:
                missed.append(title)
                continue
            now = read(copy.folder)
            told = {render(one) for one in decisions(now)} - {
                render(one) for one in decisions(facts)
            }
            if not told and not [*check_earlier(facts, now)]:
                fitting_missed.append(title)
    fitting = sum(kinds[name] for name in _FITTING)
    return Forged(kinds, missed, fitting, fitting_missed, changes, other_results, harmless)


class _Checker:
    """Checks published folders; equal games of the copies are checked only once."""

    def __init__(self) -> None:
        self._known: dict[tuple[bytes, str, bytes], list[str]] = {}

    def findings(self, folder: Path) -> Iterator[str]:
        """Yield what is wrong with a published folder, as sentences."""
        try:
            facts = read(folder)
            yield from map(render, check_published(folder, facts))
        except UserError as error:
            yield str(error)
            return
        entries = b"".join(path.read_bytes() for path in sorted((folder / ENTRIES).glob("*/*")))
        for game in games_of(facts):
            path = folder / RECORDS / game.played.record
            found = file_hash(path) if path.is_file() else ""
            name = (msgspec.json.encode(replace(game, played=_bare(game.played))), found, entries)
            if name not in self._known:
                found = check_game(folder, game, proven=True, programs=True)
                self._known[name] = [render(one) for one in (*found.wrong, *found.unchecked)]
            yield from self._known[name]


def _bare(fact: Played) -> Played:
    return replace(fact, id="f", number=0, at_ms=0)


def _meaning(facts: list[AnyFact]) -> tuple[object, ...]:
    """Return what facts mean: who entered what, and what was planned, drawn and won."""
    contest: Contest = compute(facts, FORMATS)
    stages = [
        (
            replace(view.plan, id="", number=0, at_ms=0),
            view.stage,
            [
                (match.teams, match.winner, match.state, [replace(g, fact="") for g in match.games])
                for match in view.matches
            ],
            view.tables,
        )
        for view in contest.stages
    ]
    return contest.teams, contest.closed, stages


def _claims(facts: list[AnyFact]) -> object:
    """Return the results that facts claim: of each game and match, and each rank."""
    return [
        (
            [
                (match.teams, match.winner, [(g.teams, g.scores, g.outcome) for g in match.games])
                for match in view.matches
            ],
            view.tables,
        )
        for view in compute(facts, FORMATS).stages
    ]


def _finish(copy: _Copy, before: tuple[object, ...] | None = None) -> None:
    """Write forged facts, unless they mean what the honest ones mean."""
    if before is not None:
        try:
            if _meaning(copy.facts) == before:
                raise Harmless
        except UserError:
            pass
    whole, again = copy.chance.random() < 0.7, copy.chance.random() < 0.7
    copy.name += f"{', numbers made whole' * whole}{', tables computed again' * again}"
    copy.write(whole=whole, again=again)


def _result(copy: _Copy) -> None:
    at = copy.index(Played)
    fact = copy.facts[at]
    assert isinstance(fact, Played)
    left, right = fact.scores
    changes: dict[str, dict[str, Any]] = {
        "one point more": {"scores": (left + 1, right)},
        "points swapped": {"scores": (right, left)},
        "another winner": {
            "outcome": copy.chance.choice(
                [o for o in ("left", "right", "draw") if o != fact.outcome]
            )
        },
        "void": {"outcome": "void"},
        "seats swapped": {"teams": fact.teams[::-1]},
        "another game": {"game": fact.game + 1},
        "no record": {"record": "", "record_hash": ""},
    }
    copy.name = copy.chance.choice(sorted(changes))
    copy.change(at, **changes[copy.name])
    _finish(copy)


def _fact_added(copy: _Copy) -> None:
    before = _meaning(copy.facts)
    at = copy.index(Played, Entered, Drawn, RoundDrawn, Closed)
    fact = copy.facts[at]
    if isinstance(fact, Played):
        added: AnyFact = replace(fact, scores=(9, 0), outcome="left", id="x")
    elif isinstance(fact, Entered):
        added = replace(fact, team="Zoe", id="x")
    elif isinstance(fact, Drawn):
        added = replace(fact, entries=fact.entries[::-1], id="x")
    elif isinstance(fact, RoundDrawn):
        added = replace(fact, pairs=fact.pairs[::-1], id="x")
    else:
        added = replace(fact, id="x")
    place = copy.chance.randrange(at + 1)
    copy.name = f"{type(added).__name__} before fact {place + 1}"
    copy.facts.insert(place, added)
    copy.facts = [replace(one, number=number) for number, one in enumerate(copy.facts, 1)]
    _finish(copy, before)


def _fact_removed(copy: _Copy) -> None:
    before = _meaning(copy.facts)
    at = copy.chance.randrange(len(copy.facts) - 1)  # without the last one, the rest fits
    copy.name = f"{type(copy.facts[at]).__name__}, fact {at + 1}"
    del copy.facts[at]
    _finish(copy, before)


def _fact_changed(copy: _Copy) -> None:
    before = _meaning(copy.facts)
    at = copy.index(Planned, Drawn, RoundDrawn, Entered)
    fact = copy.facts[at]
    copy.name = type(fact).__name__
    if isinstance(fact, Planned):
        other = "round-robin" if fact.format != "round-robin" else "swiss"
        longer = {**fact.arena_settings, "match": {"duration_s": 5.0, "countdown_s": 0.1}}
        changes = copy.chance.choice(
            [
                {"format": other},
                {"arena": "othello" if fact.arena == "flag-strike" else "flag-strike"},
                {"arena_settings": longer},
                {"limits": {"legs_max": 4.0}},
                {"teams": 3},
                {"settings": replace(fact.settings, rounds=1, games=1)},
            ]
        )
        copy.change(at, **changes)
    elif isinstance(fact, Drawn):
        entries = [*fact.entries]
        copy.chance.shuffle(entries)
        copy.change(at, entries=tuple(entries))
    elif isinstance(fact, RoundDrawn):
        teams = [team for pair in fact.pairs for team in pair]
        one, two = copy.chance.sample(teams, 2)
        swap = {one: two, two: one}
        pairs = tuple(tuple(swap.get(team, team) for team in pair) for pair in fact.pairs)
        copy.change(at, pairs=pairs)
    elif isinstance(fact, Entered):
        others = {one.files for one in copy.facts if isinstance(one, Entered)} - {fact.files}
        changes = copy.chance.choice(
            [{"files": copy.chance.choice(sorted(others))}, {"team": "Zoe"}]
        )
        copy.change(at, **changes)
    _finish(copy, before)


def _fact_moved(copy: _Copy) -> None:
    """Move a fact across another fact; one of the two depends on the other."""
    at = copy.index(Played, Drawn, RoundDrawn, Closed, Entered)
    fact = copy.facts.pop(at)
    to = copy.chance.randrange(len(copy.facts) + 1)
    across = copy.facts[min(at, to) : max(at, to)]
    draws = (Drawn, RoundDrawn)
    if isinstance(fact, Closed):
        matters = any(isinstance(one, Entered | Drawn) for one in across)
    elif isinstance(fact, Entered):
        matters = any(isinstance(one, Entered | Closed) for one in across)
    elif isinstance(fact, Played):
        matters = any(isinstance(one, draws) for one in across)
    else:
        matters = any(isinstance(one, (*draws, Played, Closed)) for one in across)
    if not matters:
        raise Harmless
    copy.name = f"{type(fact).__name__} from {at + 1} to {to + 1}"
    copy.facts.insert(to, fact)
    whole = copy.chance.random() < 0.7
    if not whole:
        copy.facts = [replace(one, number=number) for number, one in enumerate(copy.facts, 1)]
    copy.write(whole=whole, again=copy.chance.random() < 0.7)


def _late_entry(copy: _Copy) -> None:
    """After entries are closed, add a team, or replace a team's files without a reason."""
    closed = next(at for at, fact in enumerate(copy.facts) if isinstance(fact, Closed))
    files = copy.facts[copy.index(Entered)]
    assert isinstance(files, Entered)
    place = copy.chance.randint(closed + 1, len(copy.facts))
    copy.name = copy.chance.choice(["a team", "files"])
    fact: AnyFact = replace(files, team="Zoe", id="x")
    if copy.name == "files":
        fact = new(FilesChanged, team="Ann", files=files.files, bot=files.bot)
    copy.facts.insert(place, fact)
    copy.write(whole=True, again=True)


def _bot(copy: _Copy) -> None:
    if copy.chance.random() < 0.5:
        at = copy.index(Entered)
        copy.change(at, **copy.chance.choice([{"bot": "planner2"}, {"picture": True}]))
        copy.name = "in a fact"
        copy.write(whole=True, again=True)
        return
    path = copy.chance.choice(sorted((copy.folder / ENTRIES).glob("*/entry.json")))
    path.write_text('{"bot":"planner2"}')
    copy.name = "in an entry"


def _entry(copy: _Copy) -> None:
    path = copy.chance.choice(sorted((copy.folder / ENTRIES).glob("*/*")))
    copy.name = path.name
    data = bytearray(path.read_bytes())
    match copy.chance.randrange(3):
        case 0:
            path.unlink()
        case 1:
            data[copy.chance.randrange(len(data))] ^= 1
            path.write_bytes(data)
        case _:
            path.write_bytes(data + b"\n")


def _record(copy: _Copy) -> None:
    at, path = copy.record()
    other = copy.chance.choice([one for one in sorted(path.parent.iterdir()) if one != path])
    copy.name, record = Forger(Record.read(path), Record.read(other)).forge(copy.chance)
    path.unlink()
    game_forger.written(record, path)
    if copy.chance.random() < 0.7:
        copy.name += ", with its hash"
        changes: dict[str, Any] = {"record_hash": file_hash(path)}
        if record.result is not None and copy.chance.random() < 0.5:
            left, right = record.result.scores
            changes |= {"scores": (left, right), "teams": record.result.teams}
            if record.result.official in ("left", "right", "draw"):
                changes["outcome"] = record.result.official
        copy.facts[at] = replace(copy.facts[at], **changes)
        copy.write(whole=True, again=True)


def _played_again(copy: _Copy) -> None:
    """Play a game again with one or two changes, and then the rest of the contest, as it follows.

    Everything after the change is computed again by the software itself: record, hash, fact, the
    games that follow, draws, sheet and tables.
    """
    facts = [*read(copy.honest)]
    games = games_of(facts)
    game = copy.chance.choice([*games, *games[-1:] * len(games)])  # a later one takes less time
    kept = EntryFolder(copy.honest / ENTRIES)
    entries = [kept.load(one[-1]) for one in game.files]
    work = copy.folder.parent / "work"
    shutil.copytree(copy.honest.parent, work, ignore=shutil.ignore_patterns("published", "*.db"))
    where = ContestFolder(work / "contest.toml")
    (where.records / game.played.record).unlink()
    change = game_forger.forge(game, entries, where.records, copy.chance)
    copy.name = " + ".join(change.names)
    fact = {"record": game.played.record, **change.fact}
    path = where.records / fact["record"]
    result = Record.read([path]).result
    if result is None:
        raise Harmless
    shown = {"scores": result.scores, "outcome": outcome(("left", "right"), result.official)}
    played = replace(game.played, **{**shown, "record_hash": file_hash(path), **fact})
    with FactStore(where.facts) as store:
        at = facts.index(game.played)
        store.append(*facts[:at], *change.before, played)
    small_contest.play(where.file)
    shutil.rmtree(copy.folder)
    organiser.publish_to(where.file, copy.folder)
    copy.facts = [*read(copy.folder)]


def _records_swapped(copy: _Copy) -> None:
    one, first = copy.record()
    two, second = copy.record()
    if one == two:
        raise Harmless
    facts = copy.facts[one], copy.facts[two]
    copy.name = copy.chance.choice(["files", "names in the facts", "files and hashes"])
    names, hashes = ([getattr(fact, of) for fact in facts] for of in ("record", "record_hash"))
    if "files" in copy.name:
        data = first.read_bytes()
        first.write_bytes(second.read_bytes())
        second.write_bytes(data)
    if "names" in copy.name:
        copy.change(one, record=names[1], record_hash=hashes[1])
        copy.change(two, record=names[0], record_hash=hashes[0])
    if "hashes" in copy.name:
        copy.change(one, record_hash=hashes[1])
        copy.change(two, record_hash=hashes[0])
    copy.write(whole=True, again=True)


def _other_contest(copy: _Copy) -> None:
    """Take a record of another contest with the same teams; most of the time, its result too."""
    at, path = copy.record()
    there = copy.chance.choice(sorted((copy.other / RECORDS).iterdir()))
    result = Record.read(there).result
    assert result is not None
    to = copy.chance.choice([path, path.with_name(there.name)])
    if to == path and file_hash(there) == file_hash(path):
        raise Harmless
    if to != path and to.exists():  # the very same game
        raise Harmless
    shutil.copyfile(there, to)
    copy.name = f"as {'itself' if to != path else 'another'}"
    left, right = result.scores
    copy.change(at, record=to.name, record_hash=file_hash(to))
    if copy.chance.random() < 0.7:
        copy.facts[at] = replace(
            copy.facts[at], scores=(left, right), outcome=result.official, teams=result.teams
        )
    copy.write(whole=True, again=True)


def _record_twice(copy: _Copy) -> None:
    """Name the record of one game for a second game too, perhaps as a copy of another name."""
    one, first = copy.record()
    two, second = copy.record()
    if one == two:
        raise Harmless
    fact = copy.facts[one]
    assert isinstance(fact, Played)
    name = copy.chance.choice([fact.record, f"./{fact.record}", f"{first.stem}.bak", second.name])
    if not (copy.folder / RECORDS / name).exists() or name == second.name:
        shutil.copyfile(first, copy.folder / RECORDS / name)
    copy.name = "under another name" if name != fact.record else "as it is"
    copy.change(
        two, record=name, record_hash=fact.record_hash, scores=fact.scores, outcome=fact.outcome
    )
    copy.write(whole=True, again=True)


def _table(copy: _Copy) -> None:
    copy.name = copy.chance.choice([STANDINGS, GAMES, SHEET])
    path = copy.folder / copy.name
    data = bytearray(path.read_bytes())
    places = [at for at, byte in enumerate(data) if chr(byte).isdigit()]
    at = copy.chance.choice(places)
    data[at] = ord(copy.chance.choice([d for d in "0123456789" if ord(d) != data[at]]))
    path.write_bytes(data)


def _cut(copy: _Copy) -> None:
    """Leave out the last facts."""
    copy.facts = copy.facts[: copy.chance.randrange(1, len(copy.facts))]
    copy.name = f"after fact {len(copy.facts)}"
    copy.write(whole=True, again=True)


def _decision(copy: _Copy) -> None:
    """Add a decision that nobody made."""
    fact = copy.facts[copy.index(Played)]
    assert isinstance(fact, Played)
    decision: AnyFact = copy.chance.choice(
        [
            new(Disqualified, team=fact.teams[0], reason="because"),
            new(
                Replaced,
                pairing=fact.pairing,
                game=fact.game,
                teams=fact.teams,
                scores=(9, 0),
                outcome="left",
                reason="because",
            ),
        ]
    )
    copy.name = type(decision).__name__
    copy.facts.append(decision)
    copy.write(whole=True, again=True)


def _tie_breaks(copy: _Copy) -> None:
    """Break ties in another way than was planned."""
    before = _meaning(copy.facts)
    at = copy.index(Planned)
    fact = copy.facts[at]
    assert isinstance(fact, Planned)
    order = [*copy.chance.sample(["wins", "difference", "scored", "buchholz", "seed"], 3)]
    copy.name = " ".join(order)
    copy.change(at, settings=replace(fact.settings, tie_breaks=tuple(order)))
    if _meaning(copy.facts) == before:
        raise Harmless
    copy.write(whole=True, again=True)


_KINDS: dict[str, tuple[Callable[[_Copy], None], int]] = {
    "a result in a fact": (_result, 3),
    "a fact added": (_fact_added, 2),
    "a fact removed": (_fact_removed, 2),
    "a fact changed": (_fact_changed, 2),
    "a fact moved": (_fact_moved, 2),
    "an entry after the deadline": (_late_entry, 1),
    "a bot's name": (_bot, 1),
    "a file of an entry": (_entry, 1),
    "a record": (_record, 5),
    "two records swapped": (_records_swapped, 2),
    "a record of another contest": (_other_contest, 2),
    "a record used twice": (_record_twice, 1),
    AGAIN: (_played_again, 5),
    "a table": (_table, 1),
    "the last facts missing": (_cut, 1),
    "a decision added": (_decision, 1),
    "other tie-breaks": (_tie_breaks, 1),
}
"""Every kind of forgery by name, and how often it is made."""
_FITTING = ("the last facts missing", "a decision added", "other tie-breaks")
"""Kinds that make a history which fits together; an earlier publication contradicts it."""


def contests(folder: Path) -> tuple[Path, Path]:
    """Play and publish a contest, and another one with the same teams; return both folders."""
    honest = small_contest.enter(folder / "honest")
    teams, bots = [*small_contest.BOTS], [*small_contest.BOTS.values()]
    others = dict(zip(teams, bots[1:] + bots[:1], strict=True))  # the same files, other bots
    other = small_contest.enter(folder / "other", bots=others)
    for file in (honest, other):
        small_contest.play(file)
    return small_contest.publish(honest), small_contest.publish(other)


def main() -> None:
    """Forge, check and print the result; exit with 1 if a forgery was missed."""
    options = arguments(
        __doc__, forgeries=1000, seed=1, again=(False, "only games that are played again")
    )
    with tempfile.TemporaryDirectory() as folder:
        honest, other = contests(Path(folder))
        found = forge(honest, other, options.forgeries, options.seed, [AGAIN] * options.again)
    contradicted = sum(found.kinds.values()) - found.fitting - sum(found.harmless.values())
    told = {
        "forgeries": dict(found.kinds),
        "found": f"{contradicted - len(found.missed)} of {contradicted}",
        "missed": found.missed,
        "histories that fit, told as a decision or found with --earlier": (
            f"{found.fitting - len(found.fitting_missed)} of {found.fitting}"
        ),
        "of these missed": found.fitting_missed,
        "changed in games played again": dict(found.changes),
        "games played again with another result": found.other_results,
        "accepted, with the honest result": dict(found.harmless),
    }
    print(json.dumps(told, indent=1, ensure_ascii=False))
    sys.exit(bool(found.missed or found.fitting_missed))


if __name__ == "__main__":
    main()
