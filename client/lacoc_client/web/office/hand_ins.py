"""Limits how often files may be handed in, because the office then weighs in robot and gait."""

import msgspec

from lacoc_client.web.gateway.guesses import Allowances
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

_APPLY_MINUTES = 1
_APPLICATIONS = 80
"""How many applications one machine may send at once; after these, one a minute. A school behind
one address has 35 teams, and some of them try twice."""
_CHANGE_S = 10
_CHANGES = 10
"""How many times at once a team may change its files; after these, once in `_CHANGE_S`."""


class _Kind(msgspec.Struct):
    do: str = ""
    secret: str = ""


class HandIns:
    """Limits the requests to the desk that hand in files."""

    def __init__(self) -> None:
        self._applications = Allowances(1 / (60 * _APPLY_MINUTES), _APPLICATIONS)
        self._changes = Allowances(1 / _CHANGE_S, _CHANGES)

    def count(self, machine: str, request: bytes, now_s: float) -> None:
        """Count a request to the desk if it hands in files.

        Args:
            machine: address of the machine that sent it.
            request: an encoded request; one that can't be decoded is not counted: it is left to the
                desk.
            now_s: time on a clock that never goes back [s].

        Raises:
            UserError: if this machine or team has handed in files too often.
        """
        try:
            kind = msgspec.msgpack.decode(request, type=_Kind)
        except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError):
            return
        if kind.do == "apply" and not self._applications.take(machine, now_s):
            raise UserError(say("desk.many-from-here", minutes=_APPLY_MINUTES))
        if kind.do == "change" and not self._changes.take(kind.secret, now_s):
            raise UserError(say("desk.many-files", seconds=_CHANGE_S))
