"""Takes a studio's requests from the network, and gives them to processes that answer them."""

from collections.abc import Sequence
from concurrent.futures import CancelledError, Future
from functools import partial
from typing import Self

from lacoc_server.simulate.workers import WorkerDied, Workers
from lacoc_server.studio.answers import Answer, Busy, read, refusal
from lacoc_server.studio.floors import answered
from lacoc_server.studio.searches import Searches
from lacoc_server.studio.wishes import REQUESTS
from lacoc_shared.codec import BadMessage, encode
from lacoc_shared.command import log
from lacoc_shared.messages import PROTOCOL, Done, Refusal
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.session import Request, open_studio
from lacoc_shared.studio import CancelRequest, Progress, RobotRequest, StudioKeys
from lacoc_shared.words import render, say

_MOST_WAITING = 128
"""Most requests that may wait for a process; more are refused, and may be sent again."""


class Studio:
    """Answers requests over the network until it is closed; used as a context manager.

    Zenoh's threads bring the requests, and refuse some at once. Other threads send the answers that
    processes compute.

    Args:
        name: name of the studio.
        listen: addresses to listen on; port 0 takes a free one.
        jobs: number of processes for trials, and also for searches; None: one for each core.

    Raises:
        UserError: if the name is wrong, or the studio can't listen on an address.
    """

    def __init__(self, name: str, listen: Sequence[str], jobs: int | None = None) -> None:
        self._keys = keys = StudioKeys(name)
        self._log = log.get(studio=name)
        self._session = session = open_studio(listen)
        # A computer that slept may have lost the processes, and a trial is the same each time.
        self._workers = Workers(jobs, again=1)
        for _ in range(self._workers.count):  # so that the first student does not wait for MuJoCo
            self._workers.submit(answered, "robot", encode(RobotRequest(protocol=PROTOCOL)))
        self._searches = Searches(jobs, self._told, self._failed)
        session.answer(keys.request("*"), self._arrived)
        session.announce(keys.alive)
        self.locators = session.locators()
        """Addresses to connect to, with the real ports."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._searches.close()
        self._workers.close()
        self._session.close()

    def _arrived(self, request: Request) -> None:
        """Pass a request on or refuse it, without slow work, because Zenoh's thread runs this."""
        what, payload = request.key.rpartition("/")[2], request.payload
        try:
            match what:
                case _ if what in REQUESTS:
                    asked = read(payload, REQUESTS[what])
                    self._searches.add(asked, partial(_answer, request))
                case "cancel":
                    self._searches.cancel(read(payload, CancelRequest).job)
                    request.reply(encode(Done()))
                case _:
                    if self._workers.waiting >= _MOST_WAITING:
                        raise Busy(say("studio.busy"))
                    result = self._workers.submit(answered, what, payload)
                    result.add_done_callback(partial(self._done, request))
        except (BadMessage, UserError) as error:
            request.refuse(encode(refusal(error)))

    def _done(self, request: Request, result: "Future[Answer]") -> None:
        try:
            answer = result.result()
        except (Exception, CancelledError) as error:
            answer = self._failed(error)
        _answer(request, answer)

    def _failed(self, error: BaseException) -> Answer:
        """Log an unexpected error of a request, and return the refusal to answer with."""
        ended = isinstance(error, WorkerDied | CancelledError)
        why = say("studio.died") if ended else say("studio.failed")
        self._log.warning(render(why), code=why.code, error=repr(error))
        return Answer(False, encode(Refusal(why, again=ended)))

    def _told(self, job: str, how_far: Progress) -> None:
        self._session.send(self._keys.progress(job), encode(how_far))


def _answer(request: Request, answer: Answer) -> None:
    (request.reply if answer.right else request.refuse)(answer.payload)
