"""Tables with what the help says about commands, so that the help need not import them.

Importing all commands takes a second. So their first sentences are here, and a test compares them
with the commands. The tables also say which commands need packages that may not be installed.
"""

from collections.abc import Mapping
from typing import NamedTuple

from rich.markup import escape

from lacoc_shared.command import help as help_text
from lacoc_shared.command import installing

NEEDS = '(needs the extra "{}")'
LACKS = 'The extra "{}" is not installed here. To install it, run: {}'
"""Texts for commands that lack a package. They are in the table of help, because the table of
phrases takes four times as long to read."""


class ListedCommand(NamedTuple):
    """A command of LACOC, as the help of its group lists it."""

    summary: str
    """First paragraph of the command's help, in English."""
    extra: str = ""
    """Extra of LACOC that the command needs for its usual work; "": none."""
    panel: str = ""
    """Heading under which the command stands, in English; "": the usual heading."""

    @property
    def lacking(self) -> bool:
        """Whether a package that the command needs is not installed."""
        return bool(self.extra) and installing.missing(self.extra)

    def in_words(self) -> str:
        """Return what a list of commands says of this one, in the language of the process."""
        summary = help_text.summary_in_words(self.summary)
        if self.lacking:
            summary += " " + escape(help_text.sentence(NEEDS, self.extra))
        return summary


Listing = Mapping[str, ListedCommand]
"""Mapping from the name of a command to its entry, in the order of the help."""


def advice(listing: Listing) -> str:
    """Return the line below a list that says how to install what its commands lack; "": nothing."""
    extras = dict.fromkeys(one.extra for one in listing.values() if one.lacking)
    return "\n\n".join(
        escape(help_text.sentence(LACKS, extra, installing.command(extra))) for extra in extras
    )


_SERVER = "server"
_PANELS: Mapping[str, Mapping[str, ListedCommand]] = {
    "Play": {
        "demo": ListedCommand(
            "Show a whole match: a court, two bots and a referee meet over the network.", _SERVER
        ),
        "practice": ListedCommand(
            "Walk your robot on a field of its own, with all keys, as long as you like.", _SERVER
        ),
        "play": ListedCommand("Hold a seat and steer your robot with the keyboard."),
        "watch": ListedCommand("Watch a match: clock, score and events as they come."),
    },
    "Prepare your robot": {
        "design": ListedCommand(
            "Design a gait: change the table, let the robot walk, and see why it walks as it does.",
            _SERVER,
        ),
        "class": ListedCommand(
            "Let a class design gaits in the browser: 'lacoc class FOLDER' opens it.", _SERVER
        ),
        "gait": ListedCommand(
            "Take the sample gait, check gait files, and convert one kind to another."
        ),
        "trial": ListedCommand(
            "Let a robot walk alone, and print how well it walks: figures, foot bars and "
            "explanations.",
            _SERVER,
        ),
        "coach": ListedCommand(
            "Say which numbers of a gait matter, and search for a better gait with few changes.",
            _SERVER,
        ),
        "robot": ListedCommand(
            "Check a robot file, import the workshop's header, export MJCF, or list the robots."
        ),
    },
    "Run a contest": {
        "contest": ListedCommand(
            "Run a contest: its file, courts and tokens; entries, matches, standings and their "
            "proof."
        ),
        "serve": ListedCommand(
            "Run a court: it moves the robots, keeps clock and score, and records the match.",
            _SERVER,
        ),
        "web": ListedCommand(
            "Serve the pages of courts: spectators, broadcast, contestants, referee, replays."
        ),
        "referee": ListedCommand(
            "Referee a match: decide, read the log, see how well the court runs."
        ),
        "doctor": ListedCommand(
            "Check whether this machine is ready: packages, ports, graphics, clock, disk."
        ),
    },
    "Study and develop": {
        "docs": ListedCommand(
            "Read the pages about LACOC: rules, files, a contest day, bots, security."
        ),
        "replay": ListedCommand(
            "Look at the record of a match, check it, or export tables from it."
        ),
        "film": ListedCommand(
            "Make a film of a recorded match, or of the best moments of a contest, as an MP4.",
            "film",
        ),
        "stream": ListedCommand(
            "Send an event live to a video platform, or into a file, until Ctrl-C.", "film"
        ),
        "simulate": ListedCommand(
            "Play matches of bots or ghosts without a picture, and print the results.", _SERVER
        ),
        "bot": ListedCommand(
            "Let a bot hold a seat: it joins, says ready and plays, match after match."
        ),
        "studio": ListedCommand(
            "Run a studio: it lets robots walk and measures them, for pages on which gaits are "
            "designed.",
            _SERVER,
        ),
    },
}
OTHERS = "Commands of other packages"
"""Heading for commands that are not in the listing, in a group that has headings."""
COMMANDS: Listing = {
    name: one._replace(panel=panel)
    for panel, listed in _PANELS.items()
    for name, one in listed.items()
}
"""The commands of `lacoc`."""
REPLAY: Listing = {
    "fork": ListedCommand(
        "Go on with a recorded match from one of its beats, as a court would have.", _SERVER
    ),
    "highlights": ListedCommand(
        "List the moments in which the odds of a match changed most, the largest change first.",
        _SERVER,
    ),
    "odds": ListedCommand(
        "Print how the chance to win changes during a match, computed from forks that bots play.",
        _SERVER,
    ),
    "verify": ListedCommand(
        "Judge a record again, simulate it again section by section, and print one of three "
        "verdicts.",
        _SERVER,
    ),
}
"""The commands that the court's packages add to `lacoc replay`."""
