"""The messages to the teacher's pages of a class."""

from collections.abc import Sequence
from typing import NamedTuple

import msgspec

from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_client.web.office.links import qr_code
from lacoc_client.workshop.classroom.cards import Card
from lacoc_client.workshop.classroom.state import ClassState
from lacoc_client.workshop.classroom.tournament import TournamentState
from lacoc_shared.words import Phrase


class Trouble(NamedTuple):
    """The technical faults of a class that the teacher's page shows."""

    file: Phrase | None
    """What is wrong with the class file; None: nothing is wrong."""
    studios: int
    why: Phrase | None
    """Why there is no studio; None: there is one, or it is not known yet."""


def class_message(
    state: ClassState,
    addresses: Sequence[str],
    trouble: Trouble,
    cards: Sequence[Card] | None,
) -> bytes:
    """Return the message that tells a teacher's page how the class stands.

    Args:
        state: settings and groups of the class, and what was handed out.
        addresses: addresses that students can open.
        trouble: what is wrong with the class file or the studio.
        cards: the cards of all students, for a page that has just been opened; None: the page has
            them already.
    """
    handed = state.handed
    body = {
        "code": state.code,
        "addresses": addresses,
        "qr": qr_code(addresses[0]) if addresses else "",
        "rules": state.rules,
        "trouble": trouble.file,
        "studios": trouble.studios,
        "why": trouble.why,
        "handed": handed and {"number": handed.number, "title": handed.title},
        "groups": [
            {
                "name": one.name,
                "members": one.members,
                "roles": one.roles,
                "word": one.word,
                "handed": one.handed and one.handed.title,
            }
            for one in state.groups
        ],
        "cards": cards,
    }
    return wire.map_message(MessageKind.CLASS, body)


def card_message(card: Card) -> bytes:
    """Return the message with a student's changed card."""
    return wire.map_message(MessageKind.CARD, msgspec.structs.asdict(card))


def gone_message(name: str) -> bytes:
    """Return the message that a student was deleted."""
    return wire.map_message(MessageKind.GONE, {"name": name})


def tournament_message(state: TournamentState) -> bytes:
    """Return the message about the tournament of a class."""
    return wire.map_message(MessageKind.TOURNAMENT, msgspec.structs.asdict(state))
