"""The state of a group: its members, their roles, and the words for how its robot should walk."""

from collections.abc import Iterable, Mapping
from typing import Literal

import msgspec

from lacoc_client.workshop.classroom.groups.handed import Handed
from lacoc_shared.contest.names import told_apart
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

Role = Literal["", "forward", "turn"]
"""What a member designs: "forward" the rows 1 to 4, "turn" the rows 5 to 8 of the table."""

MEMBERS_MOST = 4
GROUPS_MOST = 50
"""Most groups of a class."""
_WORDS_MOST = 12
_TITLE_MOST = 40


class GroupWord(msgspec.Struct, frozen=True, kw_only=True):
    """A word for how the group's robot should walk."""

    word: str
    by: str
    """Nickname of the member who proposed it; "": this member has left."""


class GroupState(msgspec.Struct, frozen=True, kw_only=True):
    """The state of a group; each change makes a new object."""

    id: str
    """Id of the group and of its table."""
    name: str
    members: tuple[str, ...] = ()
    """Nicknames of the members, in the order in which they came."""
    roles: Mapping[str, Role] = {}
    """The role of each member who has one, by nickname."""
    words: tuple[GroupWord, ...] = ()
    votes: Mapping[str, str] = {}
    """The word for which each member has voted, by nickname."""
    handed: Handed | None = None
    """The last table that the teacher handed out to this group."""
    taken: int = 0
    """Number of the newest handed-out table that a member has taken for all."""
    last: str = ""
    """Nickname of the member who left last; "": the group has members."""

    def joined(self, member: str) -> "GroupState":
        """Return the group after a student has joined it.

        Raises:
            UserError: if the group is full.
        """
        if member in self.members:
            return self
        if len(self.members) >= MEMBERS_MOST:
            raise UserError(say("groups.full", name=self.name, most=MEMBERS_MOST))
        return msgspec.structs.replace(self, members=(*self.members, member), last="")

    def left(self, member: str) -> "GroupState":
        """Return the group after a member has left it; the words that the member proposed stay."""
        members = tuple(one for one in self.members if one != member)
        return msgspec.structs.replace(
            self,
            members=members,
            last="" if members else member,
            roles={name: role for name, role in self.roles.items() if name != member},
            votes={name: word for name, word in self.votes.items() if name != member},
            words=tuple(
                msgspec.structs.replace(one, by="") if one.by == member else one
                for one in self.words
            ),
        )

    def with_role(self, member: str, role: Role) -> "GroupState":
        """Return the group after a member has taken a role; "": no role."""
        return msgspec.structs.replace(self, roles={**self.roles, member: role})

    def voted(self, member: str, word: str) -> "GroupState":
        """Return the group after a member's vote for a word.

        A vote for a new word also proposes the word.

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
        """The word with the most votes; of equal ones the oldest. "": no word has a vote."""
        counts = [(self.count(one.word), -at, one.word) for at, one in enumerate(self.words)]
        return max(counts)[2] if counts and max(counts)[0] else ""

    def count(self, word: str) -> int:
        """Return how many members have voted for a word."""
        return sum(vote == word for vote in self.votes.values())


def group_title(name: str, students: Iterable[str]) -> str:
    """Return the name of a group for lists that also contain students.

    It differs from the students' names.
    """
    return told_apart(name, students, "group", _TITLE_MOST)
