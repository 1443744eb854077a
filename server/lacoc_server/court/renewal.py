"""Notices that the certificate of a court was renewed.

Zenoh can't give an open listener another certificate. So the court ends when no match is in play,
and the command that started it starts it again.
"""

import threading
from typing import Self

from lacoc_shared.command import log, parent
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.certificate import Certificate, Pair

_LOOK_S = 1.0


class Renewal:
    """Watches the files of a certificate, on a thread of its own; used as a context manager.

    Args:
        pair: the files of certificate and key.
        court: the court's name, for its log.

    Raises:
        UserError: if these files can't be used.
    """

    def __init__(self, pair: Pair, court: str) -> None:
        self.is_due = False
        """Whether the court must be started again to use its newest certificate.

        It stays False at a court that a person started, because nobody would start it again.
        """
        self._certificate = Certificate(pair)
        self._log = log.get(court=court)
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._look, name="certificate", daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ending.set()
        self._thread.join()

    def _look(self) -> None:
        while not self._ending.wait(_LOOK_S):
            try:
                if self._certificate.renew():
                    self.is_due = parent.is_followed()
                    when = "when no match is in play" if self.is_due else "when it is started again"
                    said = f"The certificate was renewed: the court uses it {when}."
                    self._log.info(said, kind="certificate")
            except UserError as error:
                self.is_due = False
                self._log.warning(f"The old certificate stays: {error}", kind="certificate")
