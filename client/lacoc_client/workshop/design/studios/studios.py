"""Several studios that share the work of all pages."""

from collections.abc import Sequence

from lacoc_client.workshop.design.studios.asker import Asker
from lacoc_shared.words import Phrase


class Studios:
    """Connections to one or more studios; each request goes to the studio with the least to do.

    Args:
        askers: the connections; they are started and closed here.
    """

    def __init__(self, askers: Sequence[Asker]) -> None:
        self._askers = tuple(askers)

    def start(self) -> None:
        """Begin to look for the studios."""
        for asker in self._askers:
            asker.start()

    def close(self) -> None:
        """Close the connections to all studios."""
        for asker in self._askers:
            asker.close()

    @property
    def present(self) -> int:
        """Number of studios that can be reached now."""
        return sum(asker.studio is not None for asker in self._askers)

    @property
    def why(self) -> Phrase | None:
        """Why there is no studio; None: there is one, or nobody has looked yet."""
        return None if self.present else self._askers[0].why

    def free(self) -> Asker:
        """Return the connection to the least busy studio; without a studio, any connection."""
        return min(self._askers, key=lambda asker: (asker.studio is None, asker.open))
