"""An arena: a folder with its TOML, rules, field and bots, ready to be played.

The TOML has `title`, a table [match] with the settings that every game has, one [[seat]] for each
seat, and a table [game] with the settings of this game alone. The contest file may override any
entry (docs/write-an-arena.md).
"""

import importlib
import importlib.util
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Annotated, Any, Literal

import msgspec

from lacoc_arenas.bot import BotFactory
from lacoc_arenas.checked_game import ArenaCode, checked
from lacoc_arenas.game import AnyGame
from lacoc_shared.command import plugins
from lacoc_shared.contest.toml_text import BadToml, read_toml
from lacoc_shared.contest.wrong_value import place_and_words
from lacoc_shared.gait.tables import Level
from lacoc_shared.mistakes import UserError, printable
from lacoc_shared.seat import Colour, Pattern
from lacoc_shared.words import Phrase, say

_GROUP = "lacoc.arenas"
_FILE = "arena.toml"
_PARTS = ("rules", "field", "bots")
"""Modules of an arena; each is imported when it is needed."""

Seconds = Annotated[float, msgspec.Meta(ge=0, le=86_400)]


class MatchSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Settings that every game shares (rules 4); each can be set in the arena file."""

    duration_s: Seconds = 180.0
    """Length of a match (workshop 5-1 rule 2, 5-2 rule 1); 0: no time limit."""
    countdown_s: Seconds = 3.0
    """How long the countdown before every start and every resume is."""
    restart_freeze_s: Seconds = 5.0
    """For this long after a restart ([x]) a robot's keys are refused: another [x], and digits."""
    levels: Annotated[tuple[Literal["A", "B"], ...], msgspec.Meta(min_length=1)] = ("B",)
    """Levels of control that are open; a seat begins with the first one."""
    repeat: bool = True
    """True: a sequence repeats until the command changes (workshop 4-2)."""
    start: Literal["referee", "ready"] = "referee"
    """Who starts the match: the referee, or every seat by saying ready."""
    unattended_s: Seconds = 900.0
    """A match that starts by "ready" ends when no seat has been heard for this long; 0: it never
    ends for this reason."""

    lead_volatility: Annotated[float, msgspec.Meta(ge=0.0)] = 0.0
    """Standard deviation of the change of the lead in one second of play [points]. Pages compute
    the chances to win from it; the match does not use it. 0: pages show no chances."""

    @property
    def open_levels(self) -> tuple[Level, ...]:
        """Return the names in `levels` as `Level` values."""
        return tuple(Level("AB".index(level)) for level in self.levels)


class SeatSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A seat and how its robot looks; the contest file may give its team another look."""

    id: Annotated[str, msgspec.Meta(pattern="^[a-z0-9]{1,16}$")]
    colour: Colour
    pattern: Pattern = "plain"


class _ArenaFile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    title: str
    match: MatchSettings = MatchSettings()
    seat: tuple[SeatSettings, ...]
    game: dict[str, Any] = {}


class _WrongEntry(UserError):
    """Raised when an entry of the arena file, or one that the contest puts in its place, is wrong.

    Args:
        name: name of the arena.
        where: place of the entry, such as "match.duration_s"; "" if it is not one entry.
        error: what is wrong with it.
        known: the entries that could be there; None if they are not known.
    """

    def __init__(
        self, name: str, where: str, error: Phrase | str, known: Sequence[str] | None = None
    ) -> None:
        table, _, rest = where.partition(".")
        if table == "game":
            said = say("arena.wrong-game", name=name, where=rest or None, error=error)
        else:
            said = say("arena.wrong", name=name, where=where or None, error=error, known=known)
        super().__init__(said)
        self.replaced = say(
            "arena.wrong-settings", name=name, where=where or None, error=error, known=known
        )
        """The sentence for the case that the wrong entry is an override, and not from the file."""


class Arena:
    """An arena as it is played: its file with the contest's overrides, and its rules."""

    def __init__(
        self, name: str, settings: dict[str, Any], module: ModuleType, folder: Path | None
    ) -> None:
        """Make an arena; call `load` or `from_settings` instead.

        Raises:
            UserError: if a setting is wrong; the message names it.
        """
        self.name = name
        self.settings = settings
        """The whole file with the contest's overrides, as plain values; `name` and these values
        make the same arena again.
        """
        self.folder = folder
        """The folder of an arena that is not installed; its code runs because a user named it."""
        self._module = module.__name__
        self._source = ArenaCode(name, str(plugins.folder_of(module)))
        try:
            file = msgspec.convert(settings, _ArenaFile)
        except msgspec.ValidationError as error:
            where, wrong = place_and_words(error, _ArenaFile)
            raise _WrongEntry(name, where, wrong, _entries(where, wrong)) from None
        try:
            self.game: AnyGame = self._make(file.game)
        except msgspec.ValidationError as error:
            where, wrong = place_and_words(error)
            raise _WrongEntry(name, f"game.{where}".rstrip("."), wrong) from None
        except ValueError as error:
            raise _WrongEntry(name, "game", str(error)) from None
        ids = [seat.id for seat in file.seat]
        if len(ids) != len(self.game.starts) or len(set(ids)) != len(ids):
            needed = len(self.game.starts)
            raise _WrongEntry(name, "", say("arena.seats-needed", needed=needed, found=ids))
        self.title = file.title
        self.match = file.match
        self.seats = file.seat

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the arena as a call that makes it again.

        So another process imports the code of the arena's folder before it unpickles any object
        of this code.
        """
        return from_settings, (self.name, self.settings, self.folder)

    def _make(self, settings: dict[str, Any]) -> AnyGame:
        """Make the game from its settings.

        If the arena is no part of LACOC, all that the game returns is checked (`checked`).
        """
        game = self._source.call("make", self._part("rules", "make"), settings, refuses=True)
        ours = self._module.startswith(f"{__package__}.")
        return game if ours else checked(self._source, game)

    def _part(self, part: str, name: str) -> Any:
        """Import a module of the arena and return the object `name` from it.

        Args:
            part: the module: rules, field or bots.
            name: the object's name.

        Raises:
            UserError: if the module can't be imported, or lacks the object.
        """
        module = self._source.call(f"{part}.py", importlib.import_module, f"{self._module}.{part}")
        if not hasattr(module, name):
            raise self._source.wrong(say("game.module-lacks", module=f"{part}.py", name=name))
        return getattr(module, name)

    def plays(self, recorded: str) -> bool:
        """Say whether a record was played in this arena, judged by the arena's name in the record.

        The folder may have moved since the record was made. So a folder that the user named matches
        any name that is not installed.
        """
        moved = self.folder is not None and not is_installed(recorded)
        return moved or recorded == self.name

    def build_field(self, spec: Any) -> None:
        """Add the game's floor, walls and markers to an `MjSpec`."""
        self._source.call("build", self._part("field", "build"), spec, self.game)

    @property
    def bots(self) -> dict[str, BotFactory]:
        """The game's own bots by name, the weakest first."""
        bots: dict[str, BotFactory] = self._part("bots", "BOTS")
        if not (isinstance(bots, dict) and all(map(callable, bots.values()))):
            raise self._source.wrong(say("game.bots", found=printable(repr(bots), 80)))
        return bots


def load(
    name: str,
    overrides: Mapping[str, Any] | None = None,
    looks: Mapping[str, Mapping[str, str]] | None = None,
) -> Arena:
    """Load an installed arena, or an arena in a folder.

    Args:
        name: an installed name such as "othello", or a folder's path.
        overrides: nested entries that replace those of the arena's file.
        looks: by seat, the `colour` and `pattern` of its team (rules 4).

    Raises:
        UserError: if there is no such arena, or its file or an override is wrong.
    """
    module = plugins.package(_GROUP, "arena", name)
    _require_whole(module)
    path = plugins.folder_of(module) / _FILE
    try:
        settings = read_toml(path.read_bytes())
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("arena.unreadable", path=str(path), why=why)) from None
    except BadToml as error:
        raise UserError(say("arena.unreadable", path=str(path), why=error.phrase)) from None
    folder = None if name in plugins.installed(_GROUP) else Path(name).expanduser().resolve()
    shown = str(folder or name)
    merged = merge(settings, overrides or {})
    if looks:
        merged["seat"] = [seat | looks.get(seat["id"], {}) for seat in merged["seat"]]
    try:
        return Arena(shown, merged, module, folder)
    except _WrongEntry as wrong:
        if not overrides:
            raise
        Arena(shown, settings, module, folder)  # raises if the file itself is wrong
        raise UserError(wrong.replaced) from None


def load_installed(
    name: str,
    overrides: Mapping[str, Any],
    looks: Mapping[str, Mapping[str, str]] | None = None,
) -> Arena:
    """Load an arena whose name comes from the network or from a stranger: no folder's code runs.

    Raises:
        UserError: as `load`, and if no arena of this name is installed.
    """
    plugins.installed_package(_GROUP, "arena", name)
    return load(name, overrides, looks)


def is_installed(name: str) -> bool:
    """Say whether an arena of this name is installed; a folder's path is no such name."""
    return name in plugins.installed(_GROUP)


def from_settings(name: str, settings: dict[str, Any], folder: Path | None = None) -> Arena:
    """Make the arena in which a recorded match was played, with the settings in its record.

    Args:
        name: as the record has it. It stands only for an installed arena: anybody may have
            written the record, and a folder's code must not run because a record names it.
        settings: `Arena.settings`.
        folder: the folder of an arena that is not installed, as the user named it.

    Raises:
        UserError: if the arena is not installed here and no folder was named, or if a part or a
            setting of the arena is wrong.
    """
    if folder is not None and name not in plugins.installed(_GROUP):
        module = plugins.package_of_folder(folder)
        _require_whole(module)
        return Arena(name, settings, module, folder)
    try:
        module = plugins.installed_package(_GROUP, "arena", name)
    except UserError as error:
        raise UserError(say("arena.untrusted", why=error.phrase)) from None
    return Arena(name, settings, module, None)


def _require_whole(module: ModuleType) -> None:
    """Check that the package of an arena has every part that an arena needs.

    Raises:
        UserError: if a part is missing; the message names it.
    """
    folder = plugins.folder_of(module)
    missing = [] if (folder / _FILE).exists() else [_FILE]
    missing += [
        f"{part}.py"
        for part in _PARTS
        if importlib.util.find_spec(f"{module.__name__}.{part}") is None
    ]
    if missing:
        raise UserError(
            say(
                "arena.not-whole",
                folder=str(folder),
                missing=missing,
                parts=[_FILE, *(f"{part}.py" for part in _PARTS)],
                example=str(Path(__file__).parent / "othello"),
            )
        )


def _entries(where: str, wrong: Phrase | str) -> Sequence[str] | None:
    """Return the names that entries of a table of the arena file may have.

    None if the mistake is not an unknown name.

    Args:
        where: place of the table.
        wrong: the mistake in it.
    """
    if isinstance(wrong, str) or wrong.code != "value.no-entry":
        return None
    kind = {"": _ArenaFile, "match": MatchSettings}.get(where, SeatSettings)
    return kind.__struct_fields__


def merge(settings: Mapping[str, Any], overrides: Mapping[str, Any]) -> dict[str, Any]:
    """Return settings in which overrides replace entries, in nested tables too.

    A list or a single value is replaced as a whole.
    """
    merged = dict(settings)
    for key, value in overrides.items():
        old = merged.get(key)
        both = isinstance(old, Mapping) and isinstance(value, Mapping)
        merged[key] = merge(old, value) if both else value  # type: ignore[arg-type]
    return merged
