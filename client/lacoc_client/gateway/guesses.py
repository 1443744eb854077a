"""Slows down whoever tries codes, so that nobody can try them all."""

from collections import OrderedDict

from lacoc_shared.network.allowance import Allowance

_GUESSES_HZ, _GUESSES_BURST = 0.5, 20
"""Wrong codes of a machine that are answered at once."""
_LATER_S = 1.0
"""How long a page waits for the answer to a further wrong code. Even with 400 pages at a time a
machine would try codes for a month. The right code never waits: a class may share one address."""
_MOST_MACHINES = 1000


class Guesses:
    """Slows down each machine that shows wrong codes, so that it can't try them all."""

    def __init__(self) -> None:
        self._machines: OrderedDict[str, Allowance] = OrderedDict()

    def wait_s(self, machine: str, now_s: float) -> float:
        """Count a wrong code; return how long its answer must wait [s].

        Args:
            machine: address of the machine that sent the code.
            now_s: time on a clock that never goes back [s].
        """
        allowance = self._machines.setdefault(machine, Allowance(_GUESSES_HZ, _GUESSES_BURST))
        self._machines.move_to_end(machine)
        if len(self._machines) > _MOST_MACHINES:
            self._machines.popitem(last=False)
        return 0.0 if allowance.take(1, now_s) else _LATER_S
