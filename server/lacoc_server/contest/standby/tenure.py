"""The time in which a machine is its contest's office: until it hears of a later one."""

import threading

from lacoc_server.contest.kept import machine
from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.machine import Machine, Retired
from lacoc_shared.words import say


class Tenure:
    """The time in which this machine is the office; any thread may use it.

    Args:
        where: the contest.
        generation: how often the office has gone to another machine.
    """

    def __init__(self, where: ContestFolder, generation: int) -> None:
        self.generation = generation
        self._where = where
        self._one = threading.Lock()
        self._is_over = False

    def hear(self, generation: int) -> None:
        """End this tenure if another office has a later generation.

        After that no fact can be appended in this folder, and no office can be started in it.

        Raises:
            UserError: if the file with this machine's role can't be written.
        """
        if generation > self.generation:
            self.end()

    def end(self) -> None:
        """End this tenure, because there is a later office.

        Raises:
            UserError: if the file with this machine's role can't be written.
        """
        with self._one:
            if not self._is_over:
                self._is_over = True
                machine.save(self._where.machine, Machine(role="retired"))

    def check(self) -> None:
        """Check that this machine is still the office.

        Raises:
            Retired: if its tenure is over.
        """
        if self._is_over:
            raise Retired(say("standby.is-retired"))

    def know(self, address: str) -> None:
        """Remember the address of a machine that copies this office and may take over.

        Raises:
            UserError: if the file with this machine's role can't be written.
        """
        with self._one:
            found = machine.read(self._where.machine)
            if not self._is_over and address not in found.known:
                machine.save(self._where.machine, Machine(known=(*found.known, address)))

    @property
    def known(self) -> tuple[str, ...]:
        """Addresses of the machines that were the office, or have copied it.

        Raises:
            UserError: if they can't be read.
        """
        return machine.read(self._where.machine).known
