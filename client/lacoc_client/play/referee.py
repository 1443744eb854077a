"""A referee's connection to a court: it sends decisions and returns the court's replies."""

from lacoc_client.play.asking import ask
from lacoc_shared.codec import encode
from lacoc_shared.decisions import Decision
from lacoc_shared.keyspace import DECISION_MAX_BYTES, KeySpace
from lacoc_shared.messages import (
    DecisionReply,
    DecisionRequest,
    Done,
    Enter,
    Outlook,
    OutlookRequest,
)
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.session import Session
from lacoc_shared.words import Phrase, say

_OUTLOOK_S = 30.0
"""Longest wait for an outlook [s]: a court computes it while its beats go on."""


class RefereeClient:
    """Sends a referee's decisions to a court.

    Args:
        session: an open client session.
        court: the court's name.
        token: a referee's token.
    """

    def __init__(self, session: Session, court: str, token: str) -> None:
        self._session = session
        self._keys = KeySpace(court)
        self._token = token

    def enter(self) -> None:
        """Show the court the referee's token, without a decision.

        Raises:
            UserError: if it is not a referee's token of the court, or no court answers.
        """
        key, request = self._keys.enter, Enter(token=self._token)
        ask(self._session, self._keys, key, request, Done, repeatable=True)

    def decide(self, decision: Decision, reason: Phrase | str, by: str) -> DecisionReply:
        """Send a decision, and return the court's reply, which comes when the decision is on disk.

        Args:
            decision: the decision.
            reason: why, for the record: a text, or a phrase of `reason.*`.
            by: who decides, for the record.

        Raises:
            NoAnswer: if no reply came. The decision may have been made; the log of events shows it.
            UserError: if the court refuses; the message is its reason. Also if the reason is too
                long.
        """
        name = str(type(decision).__struct_config__.tag)
        request = DecisionRequest(token=self._token, by=by, reason=reason, decision=decision)
        # A court's door drops what is larger, without an answer.
        if len(encode(request)) > DECISION_MAX_BYTES:
            raise UserError(say("refused.reason-too-long"))
        key = self._keys.decision(name)
        return ask(self._session, self._keys, key, request, DecisionReply)

    def look_ahead(self, decision: Decision | None, seconds: float) -> Outlook:
        """Ask the court what would happen if play went on; the match stays as it is.

        Args:
            decision: a decision that would be made before play goes on; None: no decision.
            seconds: how long play would go on at most [s], up to `OUTLOOK_MOST_S`.

        Raises:
            UserError: if the court refuses, such as when the match is not in a halt.
        """
        request = OutlookRequest(token=self._token, decision=decision, seconds=seconds)
        key = self._keys.outlook
        return ask(self._session, self._keys, key, request, Outlook, _OUTLOOK_S, repeatable=True)
