"""The records that everybody may see in a contest that hides some: those that its sheet names."""

from pathlib import Path

from lacoc_client.web.gateway.contest_sheet import NewestSheet, PublishedSheet


class ShownRecords:
    """Returns the names of the records that a contest's newest sheet names; for any thread.

    Args:
        sheet: the newest sheet of the contest, which its office writes.
    """

    def __init__(self, sheet: Path) -> None:
        self._sheet = NewestSheet(sheet)
        self._known: tuple[PublishedSheet | None, frozenset[str]] = (None, frozenset())

    def __call__(self) -> frozenset[str]:
        """Return the names of the records; an empty set while there is no sheet."""
        sheet = self._sheet.take()
        if sheet is None:
            return frozenset()
        known, names = self._known
        if known is not sheet:
            names = frozenset(Path(game.record).name for game in sheet.games if game.record)
            self._known = sheet, names
        return names
