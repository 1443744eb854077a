"""Tests of the processes that work for a studio."""

import os
import signal
import sys
import time
from collections.abc import Iterator
from concurrent.futures import CancelledError

import psutil
import pytest
from waiting import until

from lacoc_arenas import brains, time_limit
from lacoc_server.simulate import workers as workers_module
from lacoc_server.simulate.workers import WorkerDied, WorkerFailed, Workers

pytestmark = pytest.mark.slow


@pytest.fixture
def workers() -> Iterator[Workers]:
    """Give `Workers` with one process."""
    with Workers(1) as workers:
        yield workers


def test_an_error_is_that_of_its_job(workers: Workers) -> None:
    """A job that raises an error fails with the traceback; the same process runs the next job."""
    first = workers.submit(os.getpid).result()
    failed = workers.submit(int, "no number")
    with pytest.raises(WorkerFailed, match=r"ValueError: .*no number"):
        failed.result()
    assert workers.submit(os.getpid).result() == first != os.getpid()


def test_what_a_job_prints_is_no_result(workers: Workers) -> None:
    """What a job prints, such as a bot's own lines, goes to standard error."""
    assert workers.submit(prints_to_standard_error).result()


def prints_to_standard_error() -> bool:
    """Say whether `print` writes to standard error in the process that calls this."""
    return sys.stdout is sys.stderr


def test_a_process_that_ends_is_replaced(workers: Workers) -> None:
    """A job that ends its process fails; a new process runs the next job."""
    first = workers.submit(os.getpid)
    ends, following = workers.submit(os._exit, 3), workers.submit(os.getpid)
    with pytest.raises(WorkerDied):
        ends.result()
    assert following.result() != first.result()


def test_a_process_that_died_at_rest_costs_no_job(workers: Workers) -> None:
    """If a process is killed between two jobs, a new process runs the second job."""
    first = workers.submit(os.getpid).result()
    os.kill(first, signal.SIGKILL)
    until(lambda: _has_ended(first))
    assert workers.submit(os.getpid).result() != first


def _has_ended(pid: int) -> bool:
    try:
        return psutil.Process(pid).status() == psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return True


def test_a_job_that_can_not_be_sent_fails_alone(workers: Workers) -> None:
    """A job whose arguments no other process can get has an error; the next one is done."""
    assert isinstance(workers.submit(str, lambda: None).exception(), Exception)
    assert workers.submit(max, 1, 2).result() == 2


def test_jobs_fail_while_no_process_can_start_and_are_done_later(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A machine without room for a process loses no thread: the next job tries again."""

    def full(self: object, background: bool) -> None:
        raise BlockingIOError("Resource temporarily unavailable")

    monkeypatch.setattr(workers_module._WorkerProcess, "__init__", full)
    with Workers(1) as few:
        assert isinstance(few.submit(max, 1, 2).exception(), WorkerDied)
        monkeypatch.undo()
        assert few.submit(max, 1, 2).result() == 2


def test_a_job_has_a_time_limit() -> None:
    """A job that takes longer than the limit fails with `WorkerDied`."""
    with Workers(1, limit_s=1.0) as workers, pytest.raises(WorkerDied):
        workers.submit(time.sleep, 60).result()


def test_a_job_of_a_lost_process_is_given_to_another_one() -> None:
    """With `again` a job whose process stops or dies is done by a new process, so often only."""
    with Workers(1, limit_s=6.0, again=1) as workers:
        first = workers.submit(os.getpid).result()
        os.kill(first, signal.SIGSTOP)  # as while a computer sleeps
        assert workers.submit(os.getpid).result() != first
        with pytest.raises(WorkerDied):
            workers.submit(os._exit, 3).result()
        assert workers.submit(os.getpid).result() != first


def test_jobs_that_wait_can_be_cancelled(workers: Workers) -> None:
    """A cancelled job never runs; the job after it does."""
    first = workers.submit(os.getpid)
    slow, unwanted, last = (
        workers.submit(time.sleep, 0.3),
        workers.submit(os._exit, 3),
        workers.submit(os.getpid),
    )
    assert unwanted.cancel()
    assert last.result() == first.result()
    assert slow.done()


def test_close_ends_all_processes() -> None:
    """`close` cancels waiting jobs, lets running jobs fail, and leaves no process."""
    workers = Workers(2, background=True)
    pids = {workers.submit(os.getpid).result() for _ in range(4)}
    jobs = [workers.submit(time.sleep, 60) for _ in range(4)]
    children = [psutil.Process(pid) for pid in workers.processes]
    assert pids <= {one.pid for one in children}
    until(lambda: all(job.running() for job in jobs[:2]))
    workers.close()
    ends = (WorkerDied, WorkerDied, CancelledError, CancelledError)
    for job, end in zip(jobs, ends, strict=True):
        with pytest.raises(end):
            job.result(timeout=10)
    assert psutil.wait_procs(children, 10)[1] == []


def load(source: str) -> None:
    """Load a bot; what it does then is up to the source."""
    brains.of_program("my_bot.py", source.encode())


@pytest.mark.slow
@pytest.mark.parametrize(
    ("source", "says"),
    [
        ("sum(iter(int, 1))", r"my_bot\.py did not answer: nothing could interrupt it for 2 s"),
        (
            "import time\nwhile True:\n    try: time.sleep(9)\n    except BaseException: pass",
            r"my_bot\.py did not answer \(my_bot\.py:\d\): it waited for more than 0\.",
        ),
    ],
)
@pytest.mark.long
def test_a_bot_that_nothing_interrupts_is_named(
    monkeypatch: pytest.MonkeyPatch, source: str, says: str
) -> None:
    """A bot that lets nothing else run costs its process; the next job finds another one."""
    monkeypatch.setattr(workers_module, "_MOST_MISSED", 2)
    with Workers(1) as workers:
        assert workers.submit(impatient).result() is None
        with pytest.raises(WorkerDied, match=says) as died:
            workers.submit(load, source).result()
        assert died.value.last_words is not None
        assert workers.submit(abs, -1).result() == 1


def impatient() -> None:
    """Shorten the limit of bots in a worker process."""
    time_limit.MOST = time_limit.Most(wait_s=0.3)
