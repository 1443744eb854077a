"""A student of a class, who has a token and a card on the teacher's page."""

import time
from collections.abc import Callable, Iterable, Sequence

from lacoc_client.workshop.classroom.cards import (
    Card,
    SeenStudent,
    best_speed,
    card,
    hand_times,
)
from lacoc_client.workshop.design.learning.diary import Diary
from lacoc_client.workshop.design.learning.rules import StudentRules
from lacoc_client.workshop.design.learning.student import Student
from lacoc_client.workshop.phases.class_file import Document, Kept
from lacoc_client.workshop.phases.evidence import JoinedClass, Tried
from lacoc_shared.studio import TrialReply

TOKEN = "token"
"""Name of the document in the class file that has the hashes of a student's tokens."""
_MOST_BROWSERS = 4


class ClassStudent(Student):
    """A student of a class; used from the event loop only.

    Args:
        name: the nickname.
        diary: keeps what the student does.
        rules: returns what the teacher allows.
    """

    def __init__(self, name: str, diary: Diary, rules: Callable[[], StudentRules]) -> None:
        super().__init__(name, diary, rules)
        self.token_hashes: tuple[str, ...] = ()
        """Hashes of the tokens of the browsers that may enter as this student, the newest last."""
        self.is_admitting = True
        """Whether another browser may enter under this name with the class code, and then gets a
        token."""
        self.seen_s = 0.0
        """When the student last did something or opened a page, in seconds since 1970 (UTC)."""
        self.hand_up_s: float | None = None
        """Time at which the hand went up, in seconds since 1970 (UTC); None: it is not up."""
        self._trial: TrialReply | None = None
        self._last: Card | None = None
        self._best: tuple[int, float | None] = (0, None)
        """Number of trials, and the best speed of them."""

    def begin(self, evidence: Sequence[Kept], documents: Iterable[Document]) -> None:
        """Load what this student did, the own table and the hashes of tokens from the class file.

        Args:
            evidence: the student's evidence, in the file's order.
            documents: the student's own table, and the hashes of the student's tokens.
        """
        documents = list(documents)
        self.diary.begin((one.evidence for one in evidence), documents)
        self.open_kept()
        tokens = (one.content.decode() for one in documents if one.name == TOKEN)
        self.token_hashes = tuple(next(tokens, "").split())
        self.is_admitting = not self.token_hashes
        self.seen_s = evidence[-1].at_s if evidence else 0.0
        self.hand_up_s = hand_times((one.at_s, one.evidence) for one in evidence)

    @property
    def is_idle(self) -> bool:
        """Whether the student has no page open and has done nothing except enter the class."""
        did = any(not isinstance(one, JoinedClass) for one in self.diary.evidence)
        has_table = self.own.is_touched or self.table.is_touched
        return not (self.viewers or self.lessons or did or has_table)

    def learned(self, trial: TrialReply | None) -> None:
        """Note that the student did something. After a trial, `trial` is the studio's reply."""
        self.seen_s = time.time()
        if trial is not None:
            self._trial = trial
        self.hand_moved()

    def hand_moved(self) -> None:
        """Note since when the student has had a hand up to ask for help, or that no hand is up."""
        if not self.diary.progress.hand_up:
            self.hand_up_s = None
        elif self.hand_up_s is None:
            self.hand_up_s = time.time()

    def add_token(self, token_hash: str) -> None:
        """Let one more browser enter as this student, with a token of its own.

        If the student then has too many browsers, the token of the oldest one becomes invalid.
        """
        self.token_hashes = (*self.token_hashes, token_hash)[-_MOST_BROWSERS:]
        self.is_admitting = False

    def card(self) -> Card:
        """Return the student's card."""
        seen = SeenStudent(
            name=self.name,
            online=bool(self.viewers or self.lessons),
            in_lesson=bool(self.lessons),
            seen_s=self.seen_s,
            hand_up_s=self.hand_up_s,
            trial=self._trial,
            best_mm_s=self._best_mm_s(),
        )
        return card(seen, self.diary.evidence, self.diary.progress, time.time())

    def _best_mm_s(self) -> float | None:
        """Return the best speed; all edits are looked at only after a new trial."""
        trials = sum(isinstance(one, Tried) for one in self.diary.evidence)
        if trials != self._best[0]:
            self._best = trials, best_speed(self.diary.evidence)
        return self._best[1]

    def changed_card(self) -> Card | None:
        """Return the student's card if it has changed since the last call; else None."""
        now = self.card()
        if now == self._last:
            return None
        self._last = now
        return now

    async def keep_token(self) -> None:
        """Write the hashes of the student's tokens to the disk."""
        await self.diary.write(TOKEN, " ".join(self.token_hashes).encode())
