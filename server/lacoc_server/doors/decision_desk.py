"""The door for referees' requests: it checks the token, the form and the size of numbers.

The match itself decides whether a decision is legal now.
"""

import math
from collections import Counter
from collections.abc import Collection

import msgspec

from lacoc_server.doors.sessions import AnyToken, Why
from lacoc_shared import codec, seal
from lacoc_shared.contest.names import read_name
from lacoc_shared.decisions import DECISIONS, NUMBER_MAX, REFEREE_NAME_MAX, Decision
from lacoc_shared.inputs import Decide
from lacoc_shared.keyspace import DECISION_MAX_BYTES
from lacoc_shared.messages import DecisionRequest, Done, Enter, OutlookRequest, Refusal
from lacoc_shared.words import Phrase, say


class _Name(msgspec.Struct):
    type: str


class _DecisionName(msgspec.Struct):
    decision: _Name


class DecisionDesk:
    """Checks the requests of referees at the court's door, and counts those that it refuses.

    Args:
        referee_hashes: hashes of the tokens that are accepted.
    """

    def __init__(self, referee_hashes: Collection[str]) -> None:
        self._referee_hashes = tuple(referee_hashes)
        self.refused: Counter[str] = Counter()
        """Number of refusals by `Why`."""

    def enter(self, payload: bytes) -> Done | Refusal:
        """Check the token of a referee who only enters, without a decision.

        Args:
            payload: should be an `Enter`.
        """
        return self._check_token(payload, Enter) or Done()

    def decision(self, name: str, payload: bytes) -> Decide | Refusal:
        """Check a request for a decision: its token, form, referee's name and numbers.

        Args:
            name: the decision's name, from the key expression of the request.
            payload: should be a `DecisionRequest`.
        """
        refusal = self._check_token(payload, AnyToken)
        if refusal is not None:
            return refusal
        try:
            found = codec.decode(payload, _DecisionName).decision.type
            if found not in DECISIONS or found != name:
                raise codec.BadMessage(f"there is no decision {found!r:.40} under {name!r:.40}")
            request = codec.decode(payload, DecisionRequest)
            if not _is_reason(request.reason):
                raise codec.BadMessage("the reason is neither a text nor a phrase of reason.*")
        except codec.BadMessage as error:
            said = say("refused.bad-decision", error=str(error), decisions=_all_decisions())
            return self._refuse(Why.BAD_DECISION, said)
        by = read_name(request.by, REFEREE_NAME_MAX)
        if by is None:
            return self._refuse(Why.BAD_NAME, say("refused.who-decides", most=REFEREE_NAME_MAX))
        if not _numbers_are_sane(request.decision):
            why = say("why.number-too-large")
            said = say("refused.decision", decision=name, why=why)
            return self._refuse(Why.OUT_OF_RANGE, said)
        return Decide(by, request.reason, request.decision)

    def outlook(self, payload: bytes) -> OutlookRequest | Refusal:
        """Check a request for an outlook: its token, form and numbers.

        Args:
            payload: should be an `OutlookRequest`.
        """
        refusal = self._check_token(payload, AnyToken)
        if refusal is not None:
            return refusal
        try:
            request = codec.decode(payload, OutlookRequest)
        except codec.BadMessage as error:
            return self._refuse(Why.BAD_BYTES, say("refused.bad-request", error=str(error)))
        if request.decision is not None and not _numbers_are_sane(request.decision):
            return self._refuse(Why.OUT_OF_RANGE, say("why.number-too-large"))
        return request

    def _check_token(self, payload: bytes, kind: type[AnyToken] | type[Enter]) -> Refusal | None:
        try:
            token = codec.decode(payload, kind, DECISION_MAX_BYTES).token
        except codec.BadMessage as error:
            return self._refuse(Why.BAD_BYTES, say("refused.bad-request", error=str(error)))
        if not any(seal.verify_token(token, known) for known in self._referee_hashes):
            return self._refuse(Why.WRONG_TOKEN, say("refused.no-referee-token"))
        return None

    def _refuse(self, why: Why, said: Phrase) -> Refusal:
        self.refused[why.value] += 1
        return Refusal(said)


def _is_reason(reason: Phrase | str) -> bool:
    """Return whether a reason may be recorded: a text, or a `reason.*` phrase with text values."""
    if isinstance(reason, str):
        return True
    plain = all(value is None or isinstance(value, str) for value in reason.values.values())
    return plain and reason.code.startswith("reason.")


def _numbers_are_sane(decision: Decision) -> bool:
    numbers = [n for n in msgspec.structs.astuple(decision) if isinstance(n, int | float)]
    return all(math.isfinite(number) and abs(number) <= NUMBER_MAX for number in numbers)


def _all_decisions() -> str:
    """List every decision with its arguments: "start, adjust (seat: str, points: int), ..."."""
    texts = []
    for name, kind in DECISIONS.items():
        fields = ", ".join(f"{f.name}: {f.type.__name__}" for f in msgspec.structs.fields(kind))
        texts.append(f"{name} ({fields})" if fields else name)
    return ", ".join(texts)
