"""What is known of a group: who is in it, who does what, and which word it has chosen."""

from collections.abc import Iterable, Mapping
from typing import Literal

import msgspec

from lacoc_client.workshop.classroom.groups.handed import Handed
from lacoc_shared.contest.names import told_apart
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

Role = Literal["", "forward", "turn"]
"""What a member designs (workshop 4-2): "forward" the rows 1 to 4, "turn" the rows 5 to 8."""

MEMBERS_MOST = 4
GROUPS_MOST = 50
"""Most groups of a class."""
_WORDS_MOST = 12
_TITLE_MOST = 40


class GroupWord(msgspec.Struct, frozen=True, kw_only=True):
    """A word for how the robot should walk."""

    word: str
    by: str
    """Who proposed it."""


class GroupState(msgspec.Struct, frozen=True, kw_only=True):
    """A group; every change makes a new state."""

    id: str
    """Names its table."""
    name: str
    members: tuple[str, ...] = ()
    """Nicknames, whoever came first first."""
    roles: Mapping[str, Role] = {}
    """By nickname."""
    words: tuple[GroupWord, ...] = ()
    votes: Mapping[str, str] = {}
    """The word of each member who has voted."""
    handed: Handed | None = None
    """The last table that the teacher handed out to this group."""

    def joined(self, member: str) -> "GroupState":
        """Return the group with one more member.

        Raises:
            UserError: if the group is full.
        """
        if member in self.members:
            return self
        if len(self.members) >= MEMBERS_MOST:
            raise UserError(say("groups.full", name=self.name, most=MEMBERS_MOST))
        return msgspec.structs.replace(self, members=(*self.members, member))

    def left(self, member: str) -> "GroupState":
        """Return the group without a member; the member's words stay until nobody wants them."""
        return msgspec.structs.replace(
            self,
            members=tuple(one for one in self.members if one != member),
            roles={name: role for name, role in self.roles.items() if name != member},
            votes={name: word for name, word in self.votes.items() if name != member},
            words=tuple(
                msgspec.structs.replace(one, by="") if one.by == member else one
                for one in self.words
            ),
        )

    def with_role(self, member: str, role: Role) -> "GroupState":
        """Return the group in which a member has a role; "": none."""
        return msgspec.structs.replace(self, roles={**self.roles, member: role})

    def voted(self, member: str, word: str) -> "GroupState":
        """Return the group after a member's vote for a word, which may be a new proposal.

        Raises:
            UserError: if there are too many words already.
        """
        words = self.words
        if all(one.word != word for one in words):
            voted_for = {vote for name, vote in self.votes.items() if name != member}
            words = tuple(one for one in words if one.word in voted_for or one.by != member)
            if len(words) >= _WORDS_MOST:
                raise UserError(say("groups.words", most=_WORDS_MOST))
            words = (*words, GroupWord(word=word, by=member))
        return msgspec.structs.replace(self, words=words, votes={**self.votes, member: word})

    @property
    def word(self) -> str:
        """The word with most votes, and of equal ones the first; "": none."""
        counts = [(self.count(one.word), -at, one.word) for at, one in enumerate(self.words)]
        return max(counts)[2] if counts and max(counts)[0] else ""

    def count(self, word: str) -> int:
        """Return how many votes a word has."""
        return sum(vote == word for vote in self.votes.values())


def group_title(name: str, students: Iterable[str]) -> str:
    """Return the name of a group where it stands beside students: one may be called like it."""
    return told_apart(name, students, "group", _TITLE_MOST)
