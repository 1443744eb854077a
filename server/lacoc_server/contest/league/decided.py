"""What people decided in a contest, in words: "Semi-final 1: Bees did not come"; pure."""

import msgspec

from lacoc_server.contest.league.contest import Contest
from lacoc_server.contest.league.facts import (
    Disqualified,
    Drawn,
    Entered,
    FilesChanged,
    NoShow,
    OfDecision,
    Replaced,
    Replay,
    Substituted,
    Undrawn,
    Voided,
    Withdrawn,
)
from lacoc_server.contest.league.fixture import named
from lacoc_server.contest.league.titles import title
from lacoc_shared.words import Phrase, say


class Decided(msgspec.Struct, frozen=True, kw_only=True):
    """A decision that people made in a contest, in words."""

    fact: str
    at_ms: int
    """When it was made, in milliseconds since 1970, UTC."""
    what: Phrase
    pairing: str = ""
    """Pairing of the match that was decided about; "": the decision is about a team or a stage."""
    stage: str = ""
    """The stage, if the decision is a draw by lot or by hand; else ""."""
    reason: str
    by: str = ""
    """Who of the staff made it; "": the organiser."""


def decided(contest: Contest) -> tuple[Decided, ...]:
    """Put the decisions of people into words, in their order."""
    return tuple(
        Decided(
            fact=fact.id,
            at_ms=fact.at_ms,
            what=in_words(contest, fact),
            pairing=getattr(fact, "pairing", ""),
            stage=fact.stage if isinstance(fact, Drawn) else "",
            reason=fact.reason,
            by=fact.by,
        )
        for fact in contest.decisions
    )


def in_words(contest: Contest, fact: OfDecision) -> Phrase:
    """Put a decision into words, without its reason."""
    match fact:
        case Entered():
            return say("decided.entered-late", team=fact.team)
        case Substituted():
            return say("decided.substituted", team=fact.team, substitute=fact.substitute)
        case Drawn():
            stage = title(contest, fact.stage)
            if fact.how == "lot":
                return say("decided.drawn-by-lot", stage=stage, lot=fact.lot)
            return say("decided.drawn-by-hand", stage=stage)
        case Undrawn():
            return say("decided.undrawn", stage=title(contest, fact.stage))
        case Withdrawn():
            return say("decided.withdrawn", team=fact.team)
        case Disqualified():
            return say("decided.disqualified", team=fact.team)
        case FilesChanged(club=None):
            return say("decided.files-changed", team=fact.team)
        case FilesChanged():
            return say("decided.club-changed", team=fact.team, club=fact.club or None)
        case NoShow():
            said = named(contest, fact.pairing)
            return say("decided.no-show", match=said, team=fact.team)
        case Voided():
            said = named(contest, fact.pairing)
            return say("decided.voided", match=said, teams=fact.teams)
        case Replay():
            said = named(contest, fact.pairing, fact.game)
            return say("decided.replay", match=said, teams=fact.teams)
        case Replaced():
            left, right = fact.teams
            points, conceded = fact.scores
            return say(
                "decided.replaced",
                match=named(contest, fact.pairing, fact.game),
                left=left,
                right=right,
                points=points,
                conceded=conceded,
            )
