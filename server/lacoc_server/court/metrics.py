"""A court's numbers for Prometheus: its beats, its seats, its refusals."""

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from itertools import accumulate

from prometheus_client import Metric
from prometheus_client.core import (
    CounterMetricFamily,
    GaugeMetricFamily,
    HistogramMetricFamily,
)
from prometheus_client.registry import Collector

from lacoc_server.doors.inbox import Door
from lacoc_shared.messages import Health

BUCKETS_S = (0.0005, 0.001, 0.002, 0.003, 0.005, 0.0075, 0.01, 0.015, 0.02, 0.05, 0.1)
"""Upper bounds of the buckets for beat durations; a beat has 20 ms."""


class CourtMetrics(Collector):
    """The metrics of one court.

    The court's loop writes plain numbers and a scrape reads them on another thread, so no beat
    waits for a lock.

    Args:
        court: its name.
    """

    def __init__(self, court: str) -> None:
        self._court = court
        self._counts = [0] * (len(BUCKETS_S) + 1)
        self._sum_s = 0.0
        self._said: tuple[str, Health, Sequence[Door]] | None = None

    def beat(self, took_s: float) -> None:
        """Count a beat and its duration."""
        self._counts[bisect_left(BUCKETS_S, took_s)] += 1
        self._sum_s += took_s

    def health(self, match_id: str, health: Health, doors: Sequence[Door]) -> None:
        """Keep the newest health message and the counts of each seat's door for the next scrape."""
        self._said = match_id, health, doors

    def collect(self) -> Iterator[Metric]:
        """Yield all metric families; a scrape calls this."""
        yield self._durations()
        if self._said is None:
            return
        match_id, health, doors = self._said
        court = [self._court]
        info = GaugeMetricFamily(
            "lacoc_match_info", "1 for the match that is on.", labels=["court", "match_id"]
        )
        info.add_metric([self._court, match_id], 1)
        yield info
        for name, help, value in (
            ("match_number", "Number of the match at its court.", health.match),
            ("real_time_factor", "Of the last seconds; 1 is real time.", health.real_time_factor),
            (
                "beat_lateness_worst_seconds",
                "The latest start of a beat since the court was started.",
                health.worst_late_ms / 1000,
            ),
            (
                "input_delay_seconds",
                "Delay that makes the seats' links equal.",
                health.input_delay_ms / 1000,
            ),
            ("record_trouble", "1 while the record's disk fails.", bool(health.record_trouble)),
            (
                "replay_advised",
                "1 while the match is held worse than the contest wants.",
                bool(health.verdict and health.verdict.advice),
            ),
        ):
            gauge = GaugeMetricFamily(f"lacoc_{name}", help, labels=["court"])
            gauge.add_metric(court, float(value))
            yield gauge
        slow = CounterMetricFamily(
            "lacoc_slow_beats", "Beats that started more than 20 ms late.", labels=["court"]
        )
        slow.add_metric(court, health.slow_beats)
        yield slow
        yield from self._links(health, doors)

    def _durations(self) -> Metric:
        family = HistogramMetricFamily(
            "lacoc_beat_duration_seconds", "How long a beat's work took.", labels=["court"]
        )
        bounds = [*map(str, BUCKETS_S), "+Inf"]
        buckets = list(zip(bounds, accumulate(list(self._counts)), strict=True))
        family.add_metric([self._court], buckets, self._sum_s)
        return family

    def _links(self, health: Health, doors: Sequence[Door]) -> Iterator[Metric]:
        names = ["court", "seat"]
        commands = CounterMetricFamily(
            "lacoc_commands", "Valid commands of a seat, repeats too.", labels=names
        )
        refused = CounterMetricFamily(
            "lacoc_refused",
            "What was not believed, by reason; without a seat: the referee's desk.",
            labels=[*names, "why"],
        )
        heard = GaugeMetricFamily(
            "lacoc_seat_heard_seconds", "Since a held seat's last valid command.", labels=names
        )
        joined = GaugeMetricFamily("lacoc_seat_joined", "1 if the seat is held.", labels=names)
        trip = GaugeMetricFamily(
            "lacoc_seat_round_trip_seconds",
            "From a frame to the beat with the seat's answer to it, of the last 10 s.",
            labels=[*names, "quantile"],
        )
        late = CounterMetricFamily(
            "lacoc_late_commands", "Commands too late for the common delay.", labels=names
        )
        for seat, door in zip(health.seats, doors, strict=True):
            where = [self._court, seat.id]
            commands.add_metric(where, door.heard)
            joined.add_metric(where, seat.joined)
            if seat.heard_ms is not None:
                heard.add_metric(where, seat.heard_ms / 1000)
            late.add_metric(where, seat.late)
            for quantile, ms in (("0.5", seat.round_trip_p50_ms), ("0.95", seat.round_trip_p95_ms)):
                if ms is not None:
                    trip.add_metric([*where, quantile], ms / 1000)
            for why, count in door.refused.items():
                refused.add_metric([*where, why], count)
        for why, count in health.dropped.items():
            refused.add_metric([self._court, "", why], count)
        yield from (commands, refused, heard, joined, trip, late)
