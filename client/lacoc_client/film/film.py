"""Makes a film of one record or of several, and stills of it."""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from lacoc_client.film import moments, plan
from lacoc_client.film.camera_page import camera_page
from lacoc_client.film.crew import SOUND_HZ, drawn_by
from lacoc_client.film.look import Look
from lacoc_client.film.moments import Moment
from lacoc_client.film.movie import Movie, movie
from lacoc_client.film.plan import Picture, Shot
from lacoc_client.film.site import served
from lacoc_shared.command import keep
from lacoc_shared.mistakes import UserError
from lacoc_shared.record import files
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import BEATS_PER_S
from lacoc_shared.words import say

HIGHLIGHTS = 5
"""How many moments a film of a match's highlights shows."""
REEL = 2
"""How many moments of each match a reel shows; a reel is a film of several matches."""
_AFTER_BEATS = BEATS_PER_S // 2
"""How long after the match's largest moment its still is taken [beats]."""

Progress = Callable[[int, int], None]
"""Called with two numbers: how many pictures the film has now, and how many it will have after the
part that is being drawn."""


@dataclass(frozen=True)
class FilmPart:
    """A record of which a film shows something: all of it, or some moments."""

    record: Record
    paths: tuple[Path, ...]
    count: int | None = None
    """How many moments are shown; None: the whole match."""
    chosen: tuple[Moment, ...] = ()
    """The moments to choose from; empty: all moments in which the score changed."""
    opening: bool = False
    """Whether the card with the teams is shown first."""
    counted: tuple[int, ...] = ()
    """The points that count in the contest, by seat; empty: there is no contest."""

    @property
    def moments(self) -> list[Moment]:
        """The moments of the match from which those that the film shows are chosen."""
        return list(self.chosen) or moments.by_score(self.record)

    @property
    def decided(self) -> tuple[int, ...]:
        """The points that count, if the organiser gave others than the court's; else empty."""
        return () if self.counted == moments.final_scores(self.record) else self.counted

    def shots(self, first: int, last: int) -> list[Shot]:
        """Return the shots of the match, in order.

        Args:
            first: the first beat that may be shown.
            last: the last beat that may be shown.

        Raises:
            UserError: if all chosen moments are outside of them.
        """
        if self.count is None:
            return plan.whole(first, last)
        inside = [one for one in self.moments if first <= one.beat <= last]
        if self.chosen and not inside:
            raise UserError(say("film.moments-outside", first=first, last=last))
        best = moments.largest(inside, self.count)
        opening = moments.opening(self.record, plan.OPENING_BEATS) if self.opening else None
        return plan.highlights(best, first, last, opening=opening)

    def still(self, first: int, last: int) -> int:
        """Return the beat of the match's still: just after its largest moment.

        If the match has no moment, it is the middle of play.
        """
        best = moments.largest(self.moments, 1)
        if best:
            return min(last, max(first, best[0].beat + _AFTER_BEATS))
        played = moments.played(self.record) or [first, last]
        return (played[0] + played[-1]) // 2


def part(path: Path, count: int | None = None, *, opening: bool = False) -> FilmPart:
    """Read the record of a match that a film shows.

    Args:
        path: a packed file, or a segment.
        count: how many moments are shown; None: the whole match.
        opening: whether the card with the teams is shown first.

    Raises:
        UserError: if it is no record, or is damaged so far that nothing can be shown.
    """
    paths = tuple(files.record_paths(path))
    return FilmPart(Record.read(paths), paths, count, opening=opening)


def make(
    parts: Sequence[FilmPart], out: Path, look: Look, fps: int, browsers: int, progress: Progress
) -> int:
    """Make a film of one or several matches.

    Args:
        parts: its records, in order.
        out: the film's path.
        look: how it looks.
        fps: pictures a second.
        browsers: how many draw at a time.
        progress: called after each picture.

    Returns:
        The number of its pictures.

    Raises:
        UserError: if a record can't be shown, there is no browser, or the film can't be written.
    """
    with movie(out, look.width, look.height, fps, SOUND_HZ) as film:
        for one in parts:
            _add(film, one, look, fps, browsers, progress)
    return film.count


def still(one: FilmPart, out: Path, look: Look) -> None:
    """Write the still of a record as PNG; an older file of this name is kept under a numbered name.

    Args:
        one: the record.
        out: the picture's path.
        look: how it looks.

    Raises:
        UserError: as for `make`.
    """

    def drawn() -> bytes:
        with served(one.paths, one.decided) as site, camera_page(site.address(look), look) as page:
            return page.picture(_way(one.still(page.first, page.last), page.first))

    # In a thread of its own, as those of a film: a notebook has an event loop in this one, and
    # beside it no browser can be steered.
    with ThreadPoolExecutor(1) as thread:
        keep.save(out, thread.submit(drawn).result())


def _add(
    film: Movie, one: FilmPart, look: Look, fps: int, browsers: int, progress: Progress
) -> None:
    with (
        served(one.paths, one.decided) as site,
        drawn_by(browsers, site.address(look), look) as crew,
    ):
        pictures = plan.pictures(one.shots(*crew.ends()), fps)
        before = film.count
        film.hear(crew.begin(pictures, fps))
        for png in crew.pictures(len(pictures)):
            film.add(png)
            progress(film.count, before + len(pictures))


def _way(beat: int, first: int) -> list[Picture]:
    """Return the pictures that the page must show for a still: some before its beat, and its own.

    The earlier pictures let the automatic camera move to where it must be at the beat.

    Args:
        beat: the beat of the still.
        first: beat at which the replay begins; no picture is from before it.
    """
    return plan.pictures([Shot(max(first, beat - plan.RUN_UP_BEATS), beat)], BEATS_PER_S)
