"""The key folder: what `lacoc contest keys` makes beside the contest file."""

from dataclasses import dataclass
from pathlib import Path

from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say


@dataclass(frozen=True)
class KeyFolder:
    """Names and reads the files in a key folder."""

    path: Path

    @property
    def ca(self) -> Path:
        """Certificate of the contest's own authority; public."""
        return self.path / "ca.pem"

    @property
    def ca_key(self) -> Path:
        """The authority's private key: needed only to make certificates, never by a court."""
        return self.path / "ca.key"

    @property
    def certificate(self) -> Path:
        """The courts' certificate."""
        return self.path / "court.pem"

    @property
    def private_key(self) -> Path:
        """The courts' private key."""
        return self.path / "court.key"

    @property
    def gateway_token(self) -> Path:
        """The secret that the contest's gateways share with its courts."""
        return self.path / "gateway.token"

    @property
    def invitations(self) -> Path:
        """Folder of the invitations."""
        return self.path / "invitations"

    def invitation(self, user: str) -> Path:
        """Return the path of the invitation of a user, such as "main.left"."""
        return self.invitations / f"{user}.toml"

    def read(self, path: Path) -> str:
        """Read a file of the folder.

        Raises:
            UserError: if it can't be read.
        """
        try:
            return path.read_text(encoding="ascii")
        except (OSError, UnicodeDecodeError) as error:
            reason = error.strerror or str(error) if isinstance(error, OSError) else "not text"
            raise UserError(say("contest.key-unreadable", path=str(path), why=reason)) from None
