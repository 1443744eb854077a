"""A gateway's numbers for Prometheus: how many people watch, and how many frames they get."""

from collections.abc import Iterator

from prometheus_client import Metric
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily
from prometheus_client.registry import Collector

from lacoc_client.web.gateway.courts import Courts


class GatewayMetrics(Collector):
    """The metrics of a gateway for Prometheus; a scrape only reads numbers and computes nothing.

    Args:
        courts: the courts of the gateway.
    """

    def __init__(self, courts: Courts) -> None:
        self._courts = courts

    def collect(self) -> Iterator[Metric]:
        """Return all metric families; called when Prometheus asks, on a thread of its own."""
        labels = ["court"]
        connected = GaugeMetricFamily(
            "lacoc_gateway_connected", "1 while the court sends frames.", labels=labels
        )
        viewers = GaugeMetricFamily(
            "lacoc_gateway_viewers", "Pages that watch the court.", labels=labels
        )
        sent = CounterMetricFamily(
            "lacoc_gateway_frames_sent", "Frames given to pages.", labels=labels
        )
        dropped = CounterMetricFamily(
            "lacoc_gateway_frames_dropped",
            "Frames that a page was too slow for; it got a newer one.",
            labels=labels,
        )
        for feed in self._courts.feeds:
            court = [feed.court]
            connected.add_metric(court, feed.connected)
            audiences = self._courts.audiences(feed)
            viewers.add_metric(court, sum(len(one) for one in audiences))
            frames = [one.frames() for one in audiences]
            sent.add_metric(court, sum(one.sent for one in frames))
            dropped.add_metric(court, sum(one.dropped for one in frames))
        yield from (connected, viewers, sent, dropped)
        courts = self._courts
        full = "Pages that found no place; those that only watch go on in pieces."
        yield CounterMetricFamily("lacoc_gateway_sent_away", full, courts.sent_away)
        asked = "Requests for matches in pieces that no cache answered."
        yield CounterMetricFamily("lacoc_gateway_pieces_asked", asked, courts.pieces_asked)
