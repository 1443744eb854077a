"""Limits the requests of each sender, and slows down machines that try one code after another."""

from collections import OrderedDict

from lacoc_shared.network.allowance import Allowance

_GUESSES_HZ, _GUESSES_BURST = 0.5, 20
"""How many wrong codes of a machine are answered without a wait: in a second on average, and in a
burst."""
_LATER_S = 1.0
"""Delay of the answer to each wrong code above these limits [s]. So a page tries at most as many
codes a second as it may have open requests (a page of a class: one). The right code never waits: a
class may share one address."""
_MOST_SENDERS = 1000


class Allowances:
    """Limits requests with one `Allowance` for each sender.

    It keeps the allowances of the newest senders only: a sender that was forgotten begins anew.

    Args:
        rate_hz: how many requests of a sender pass in a second, in the long run.
        burst: how many pass at once.
    """

    def __init__(self, rate_hz: float, burst: int) -> None:
        self._rate_hz, self._burst = rate_hz, burst
        self._senders: OrderedDict[str, Allowance] = OrderedDict()

    def take(self, sender: str, now_s: float) -> bool:
        """Count a request of a sender; return whether the request may pass.

        Args:
            sender: who sent it, such as the address of a machine.
            now_s: time on a clock that never goes back [s].
        """
        allowance = self._senders.setdefault(sender, Allowance(self._rate_hz, self._burst))
        self._senders.move_to_end(sender)
        if len(self._senders) > _MOST_SENDERS:
            self._senders.popitem(last=False)
        return bool(allowance.take(1, now_s))


class Guesses:
    """Slows down each machine that shows wrong codes, so that it can't try them all."""

    def __init__(self) -> None:
        self._machines = Allowances(_GUESSES_HZ, _GUESSES_BURST)

    def wait_s(self, machine: str, now_s: float) -> float:
        """Count a wrong code that a machine sent; return how long its answer must wait [s].

        Args:
            machine: address of the machine that sent the code.
            now_s: time on a clock that never goes back [s].
        """
        return 0.0 if self._machines.take(machine, now_s) else _LATER_S
