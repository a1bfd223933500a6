"""Where the runs of a sweep are made: this process, others, a Dask cluster, Slurm, any executor of Python."""

from __future__ import annotations

import collections
import itertools
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from ._errors import UsageError

__all__ = ["Task", "submitter", "workers_of"]

Task = Sequence[Any]
"""Runs that are sent together."""
Outcome = tuple[Task, Any]
"""A task with its result, or with the exception in its place."""

_SPAWN_WINDOW = 2  # tasks that wait in each process
_ARRAY = 1000  # jobs of a Slurm array


def kind_of(executor: Any) -> str:
    """Return "here", "processes", "address", "dask", "submitit" or "futures". Raises UsageError."""
    if executor is None:
        return "here"
    if isinstance(executor, str):
        if executor == "processes":
            return "processes"
        if "://" in executor:
            return "address"
        raise UsageError(
            "an executor is None, 'processes', the address of a Dask scheduler ('tcp://…') or an object with submit(), "
            f"not {executor!r}"
        )
    module = type(executor).__module__.split(".")[0]
    if module == "distributed" and hasattr(executor, "scheduler_info"):
        return "dask"
    if module == "submitit" or hasattr(executor, "map_array"):
        return "submitit"
    if hasattr(executor, "submit"):
        return "futures"
    raise UsageError(f"an executor has submit(), as those of concurrent.futures; {type(executor).__name__} has none")


def workers_of(executor: Any, workers: int) -> int:
    """Return the number of concurrent tasks; 0: unknown."""
    import os

    kind = kind_of(executor)
    if kind == "here":
        return 1
    if kind == "processes":
        return workers or len(os.sched_getaffinity(0))
    if kind == "dask":
        return sum(executor.nthreads().values())
    return int(getattr(executor, "_max_workers", 0))


def submitter(
    executor: Any, workers: int, retries: int, options: Mapping[str, Any]
) -> Callable[[Callable[..., Any], Any, Sequence[Task]], Iterator[Outcome]]:
    """Run tasks, f(common, task), and yield each with its result as it arrives. Closing drops the rest."""
    kind = kind_of(executor)
    if options and kind not in ("dask", "address"):
        raise UsageError("submit is for Dask: keywords of Client.submit()")
    if workers and kind != "processes":
        raise UsageError("workers is the number of processes of the executor 'processes'")
    if kind == "here":
        return _here
    if kind == "processes":
        return lambda f, common, tasks: _processes(f, common, tasks, workers_of(executor, workers), retries)
    if kind == "address":
        return lambda f, common, tasks: _at_address(executor, f, common, tasks, retries, options)
    if kind == "dask":
        return lambda f, common, tasks: _dask(executor, f, common, tasks, retries, options)
    if kind == "submitit":
        return lambda f, common, tasks: _submitit(executor, f, common, tasks)
    return lambda f, common, tasks: _futures(executor, f, common, tasks)


def _here(f: Callable[..., Any], common: Any, tasks: Sequence[Task]) -> Iterator[Outcome]:
    for task in tasks:
        yield task, f(common, task)


def _futures(executor: Any, f: Callable[..., Any], common: Any, tasks: Sequence[Task]) -> Iterator[Outcome]:
    """Submit to executors like those of concurrent.futures."""
    import queue

    done: queue.SimpleQueue[tuple[Task, Any]] = queue.SimpleQueue()
    waiting = collections.deque(tasks)
    window = 4 * int(getattr(executor, "_max_workers", 0)) or 256
    under_way: set[Any] = set()
    try:
        while waiting or under_way:
            while waiting and len(under_way) < window:
                task = waiting.popleft()
                try:
                    future = executor.submit(f, common, task)
                except Exception as error:  # a pool that broke takes no more
                    yield task, error
                    continue
                under_way.add(future)
                future.add_done_callback(lambda ended, task=task: done.put((task, ended)))
            if not under_way:
                continue
            task, future = done.get()
            under_way.discard(future)
            yield task, _result_of(future)
    finally:
        for future in under_way:
            future.cancel()


def _result_of(future: Any) -> Any:
    try:
        return future.result()
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # concurrent.futures.CancelledError of other executors may be any
        return error


def _processes(
    f: Callable[..., Any], common: Any, tasks: Sequence[Task], workers: int, retries: int
) -> Iterator[Outcome]:
    """Submit to processes of this machine, started by spawn: forks of processes with threads or a display may hang.

    A process that dies breaks the pool: then another one does what was under way, run by run, one at a time, so that
    the one that ends processes is known.
    """
    import concurrent.futures
    import multiprocessing

    context = multiprocessing.get_context("spawn")
    sent = _pickled(f, common)
    waiting = collections.deque(tasks)
    suspects: collections.deque[tuple[Task, int]] = collections.deque()
    while waiting or suspects:
        pool = concurrent.futures.ProcessPoolExecutor(workers, mp_context=context)
        under_way: dict[Any, tuple[Task, int]] = {}
        broken = complete = False
        try:
            while not broken and (waiting or suspects or under_way):
                if suspects and not under_way:
                    task, deaths = suspects.popleft()
                    under_way[pool.submit(_unpickled, sent, task)] = (task, deaths)
                while not suspects and waiting and len(under_way) < _SPAWN_WINDOW * workers:
                    task = waiting.popleft()
                    under_way[pool.submit(_unpickled, sent, task)] = (task, 0)
                ended, _ = concurrent.futures.wait(under_way, return_when=concurrent.futures.FIRST_COMPLETED)
                for future in ended:
                    task, deaths = under_way.pop(future)
                    result = _result_of(future)
                    if not isinstance(result, concurrent.futures.BrokenExecutor):
                        yield task, result
                        continue
                    broken = True
                    if len(task) > 1:
                        suspects.extend(([run], 0) for run in task)
                    elif deaths < retries:
                        suspects.append((task, deaths + 1))
                    else:
                        yield task, result
            suspects.extend(([run], 0) for task, _ in under_way.values() for run in task)
            complete = True
        finally:
            if not complete:
                # What they compute is dropped: nobody waits for its end.
                for process in list((getattr(pool, "_processes", None) or {}).values()):
                    process.terminate()
            pool.shutdown(wait=True, cancel_futures=True)


def _pickled(f: Callable[..., Any], common: Any) -> bytes:
    """Return both as bytes, also lambdas if the package cloudpickle is installed. Raises UsageError."""
    import pickle

    try:
        return pickle.dumps((f, common))
    except Exception as error:
        try:
            import cloudpickle  # type: ignore[import-not-found, import-untyped, unused-ignore]
        except ImportError:
            raise UsageError(
                f"the metrics cannot be sent to other processes ({error}): define them with def in a module or script, "
                "or install cloudpickle"
            ) from None
        return bytes(cloudpickle.dumps((f, common)))


def _unpickled(sent: bytes, task: Task) -> Any:
    import pickle

    f, common = pickle.loads(sent)
    return f(common, task)


def _at_address(
    address: str, f: Callable[..., Any], common: Any, tasks: Sequence[Task], retries: int, options: Mapping[str, Any]
) -> Iterator[Outcome]:
    from distributed import Client  # type: ignore[import-not-found, import-untyped, unused-ignore]

    with Client(address, set_as_default=False) as client:
        yield from _dask(client, f, common, tasks, retries, options)


def _dask(
    client: Any, f: Callable[..., Any], common: Any, tasks: Sequence[Task], retries: int, options: Mapping[str, Any]
) -> Iterator[Outcome]:
    """Submit to a Dask cluster. It releases each future with its result, so a worker that dies later loses nothing."""
    from distributed import as_completed

    waiting = collections.deque(tasks)
    under_way: dict[str, Task] = {}
    ended = as_completed(loop=client.loop)

    def send() -> None:
        # Enough for every thread to have the next task; the scheduler's memory is for few.
        window = max(64, 4 * sum(client.nthreads().values()))
        while waiting and len(under_way) < window:
            task = waiting.popleft()
            # pure=False: the name of a task is not made of its contents, so one that was released is made again.
            future = client.submit(f, common, list(task), pure=False, retries=retries, **options)
            under_way[future.key] = task
            ended.add(future)

    try:
        send()
        while under_way:
            future = next(ended)
            task = under_way.pop(future.key)
            result = _result_of(future)
            future.release()
            del future
            yield task, result
            send()
    finally:
        if under_way:
            client.cancel([future for future in list(ended.futures)])


class _Restartable:
    """A task of submitit that Slurm may end and queue again: what is made is in the folder, and is not made again."""

    def __init__(self, f: Callable[..., Any]):
        self.f = f

    def __call__(self, common: Any, task: Task) -> Any:
        return self.f(common, task)

    def checkpoint(self, common: Any, task: Task) -> Any:
        from submitit.helpers import DelayedSubmission  # type: ignore[import-not-found, import-untyped, unused-ignore]

        return DelayedSubmission(self, common, task)


def _submitit(executor: Any, f: Callable[..., Any], common: Any, tasks: Sequence[Task]) -> Iterator[Outcome]:
    """Submit an array of jobs. Their results stay in submitit's folder until they are read."""
    # A cluster takes arrays of some number of jobs: 1,001 if nobody has changed it.
    share = -(-len(tasks) // _ARRAY)
    tasks = [list(itertools.chain(*tasks[i : i + share])) for i in range(0, len(tasks), max(share, 1))]
    if not tasks:
        return
    jobs = dict(enumerate(executor.map_array(_Restartable(f), [common] * len(tasks), tasks)))
    try:
        while jobs:
            ended = [number for number, job in jobs.items() if job.done()]
            for number in ended:
                yield tasks[number], _result_of(jobs.pop(number))
            if not ended:
                time.sleep(0.2)
    finally:
        for job in jobs.values():
            job.cancel()
