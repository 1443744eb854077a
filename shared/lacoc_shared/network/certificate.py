"""The certificate with which a program proves its name.

It can be renewed while the program runs.
"""

import hashlib
import ssl
from pathlib import Path
from typing import NamedTuple

from lacoc_shared.mistakes import UserError, text_of
from lacoc_shared.words import say


class Pair(NamedTuple):
    """The two files of a certificate and its private key (PEM)."""

    certificate: Path
    """The certificate file, with the certificates between it and an authority."""
    key: Path


class Certificate:
    """A certificate and its key, as a TLS context that can read renewed files.

    Args:
        pair: the files of certificate and key.

    Raises:
        UserError: if they can't be read, or do not fit together.
    """

    def __init__(self, pair: Pair) -> None:
        self._files = pair
        self._seen = self._versions()
        self.context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        self._load(self.context)

    def renew(self) -> bool:
        """Read certificate and key again if they have changed; return whether they were read.

        Open connections go on; new connections get the new certificate.

        Raises:
            UserError: if the new files can't be read, or do not fit together. Then the old
                certificate stays, and the error is raised only once, until the files change again.
        """
        versions = self._versions()
        if versions == self._seen:
            return False
        self._seen = versions
        self._load(ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER))  # half of a new pair replaces nothing
        self._load(self.context)
        return True

    def _load(self, context: ssl.SSLContext) -> None:
        try:
            context.load_cert_chain(*self._files, password="")  # without it, it would ask
            return
        except ssl.SSLError as error:
            why = say("public.no-pair", why=error.reason or str(error))
        except OSError as error:
            why = say("public.unreadable", why=error.strerror or str(error))
        names = [text_of(file) for file in self._files]
        raise UserError(say("public.wrong-certificate", files=names, why=why))

    def _versions(self) -> list[tuple[int, int]]:
        """Return the time of change and the size of both files; zeros for a missing file."""
        found = []
        for file in self._files:
            try:
                stat = file.stat()
                found.append((stat.st_mtime_ns, stat.st_size))
            except OSError:
                found.append((0, 0))
        return found


def fingerprint(certificate: str) -> str:
    """Return the fingerprint of a certificate (PEM): SHA-256, hexadecimal.

    Raises:
        ValueError: if it is not a certificate.
    """
    return hashlib.sha256(ssl.PEM_cert_to_DER_cert(certificate)).hexdigest()


def only_first(certificates: str) -> str:
    """Return the first certificate of a text (PEM) alone: it is all that `fingerprint` names.

    Raises:
        ValueError: if it is not a certificate.
    """
    return ssl.DER_cert_to_PEM_cert(ssl.PEM_cert_to_DER_cert(certificates))
