"""The formats that are installed here: LACOC's own and those of other packages."""

from collections.abc import Iterator, Mapping

from lacoc_server.contest.league.formats.format import Format
from lacoc_shared.command import plugins

_GROUP = "lacoc.formats"


class Installed(Mapping[str, Format]):
    """All installed formats by name; each is imported when it is asked for."""

    def __getitem__(self, name: str) -> Format:
        """Return a format, or raise a `KeyError` if none of this name is installed."""
        loaded: Format = plugins.installed(_GROUP)[name].load()
        return loaded

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names, in alphabetical order."""
        return iter(plugins.installed(_GROUP))

    def __len__(self) -> int:
        """Count the formats."""
        return len(plugins.installed(_GROUP))

    def __contains__(self, name: object) -> bool:
        """Say whether a format is installed, without importing it."""
        return name in plugins.installed(_GROUP)


FORMATS = Installed()
