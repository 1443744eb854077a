"""Check what a bot returns, and report its mistakes with the line of its own code.

Most bots are files that somebody is still writing. This module has all checks, so that a mistake
reads the same in a headless match and at a court.
"""

import traceback
from collections.abc import Callable
from copy import deepcopy
from types import FunctionType, MethodType
from typing import Any

from lacoc_arenas import time_limit
from lacoc_arenas.bot import BotFactory, Brain, Key
from lacoc_arenas.time_limit import Timer, TimeUp
from lacoc_shared.gait.tables import Level
from lacoc_shared.messages import Frame, Sheet
from lacoc_shared.mistakes import UserError, printable
from lacoc_shared.seat import RESTART_KEY
from lacoc_shared.words import Phrase, say

_OURS = (__file__, time_limit.__file__)
_LONGEST_ERROR = 200
_A_BRAIN = say("expected.brain")
_A_KEY = say("expected.key", restart=RESTART_KEY)


def checked(name: str, bot: BotFactory) -> BotFactory:
    """Return a bot that plays as the given bot does, and checks every result.

    The bot gets a sheet of its own, so that it can change nothing that other bots see. The
    returned bot and its brains raise UserError if the given bot or its brain fails, takes too
    long (`time_limit`), or returns something that is not allowed.

    Args:
        name: the bot's name, as the user typed it.
        bot: the function that makes a brain.
    """

    def make(sheet: Sheet, seat: int) -> Brain:
        timer = Timer(name)
        try:
            brain = timer.begin(bot, deepcopy(sheet), seat)
        except KeyboardInterrupt:
            raise
        except BaseException as error:
            raise _failed(name, bot, error) from error
        if not callable(brain):
            raise _gave_back(name, bot, brain, _A_BRAIN)

        def see(frame: Frame) -> Key | None:
            try:
                found = timer.frame(brain, frame)
                key = _plain_key(found)
            except KeyboardInterrupt:
                raise
            except BaseException as error:
                raise _failed(name, brain, error) from error
            if key is None and found is not None:
                raise _gave_back(name, brain, found, _A_KEY)
            return key

        return see

    return make


def loaded(name: str, load: Callable[[], Any]) -> Any:
    """Run the code of a bot's file, within the time limit for loading it.

    Args:
        name: the bot's name, as the user typed it; tracebacks call its file by this name.
        load: runs the code.

    Raises:
        UserError: if it fails or takes too long.
    """
    try:
        return Timer(name).begin(load)
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        raise broken(name, error, name) from error


def broken(name: str, error: BaseException, file: str | None) -> UserError:
    """Make the error for an exception that a bot raised; its sentence names the bot's failing line.

    Args:
        name: the bot's name, as the user typed it.
        error: the exception; `TimeUp` if the bot took too long.
        file: the file of the bot's code, as tracebacks name it; None if the bot has no file. Then
            the error names no line.
    """
    calls = traceback.extract_tb(error.__traceback__)
    lines = [call.lineno for call in calls if call.filename == file]
    line = lines[-1] if lines else getattr(error, "lineno", None)  # a SyntaxError has its own
    place = None if file is None or line is None else f"{file}:{line}"
    if isinstance(error, TimeUp):
        return UserError(say("bot.no-answer", bot=name, place=place, why=error.why))
    if isinstance(error, ModuleNotFoundError) and error.name:
        return UserError(say("bot.no-module", bot=name, place=place, module=error.name))
    reason = error.msg if isinstance(error, SyntaxError) else error
    what = f"{type(error).__name__}: {_written(str, reason)}"
    what = printable(what, _LONGEST_ERROR)
    return UserError(say("bot.ended", bot=name, place=place, error=what))


def _failed(name: str, function: Callable[..., Any], error: BaseException) -> UserError:
    """Make the error for an exception of a bot's function, with the line of the bot's own code."""
    called = error.__traceback__
    while called is not None and called.tb_frame.f_code.co_filename in _OURS:
        called = called.tb_next
    if called is None and isinstance(error, TypeError):  # it does not take these arguments
        place = _place(function)
        return UserError(say("bot.can-not-call", bot=name, place=place, error=str(error)))
    return broken(name, error, called and called.tb_frame.f_code.co_filename)


def _plain_key(found: Any) -> Key | None:
    """Return a key made of plain numbers, which every record and message can hold.

    None: it is no key. True and False are no digits.
    """
    if not isinstance(found, Key) or found.level not in (0, 1):
        return None
    if not isinstance(found.key, int) or isinstance(found.key, bool):
        return None
    key = Key(Level(int(found.level)), int(found.key))
    return key if 0 <= key.key <= RESTART_KEY else None


def _gave_back(name: str, function: object, found: object, expected: Phrase) -> UserError:
    shown = printable(_written(repr, found), 80)
    place = _place(function)
    return UserError(say("bot.returned", bot=name, place=place, found=shown, expected=expected))


def _written(write: Callable[[object], str], value: object) -> str:
    """Return a bot's value as `write` (`repr` or `str`) writes it; its type's name if it can't."""
    try:
        return write(value)
    except KeyboardInterrupt:
        raise
    except BaseException:  # the bot's own code writes it
        return type(value).__name__


def _place(function: object) -> str | None:
    """Return the file and line where a function begins; None if it is no Python function."""
    if not isinstance(function, FunctionType | MethodType):
        return None
    code = getattr(function, "__code__", None)  # a method may be that of any callable
    return None if code is None else f"{code.co_filename}:{code.co_firstlineno}"
