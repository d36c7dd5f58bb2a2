"""What a forked child does under other circumstances than the tests: it compiles nothing again."""

import multiprocessing
import os
import pwd
import resource

# A child that gave up its rights may not read the packages any more: what is imported late is here.
import filelock  # noqa: F401
import platformdirs  # noqa: F401
import tqdm  # noqa: F401

FORK = multiprocessing.get_context("fork")


def in_child(function, *arguments):
    """Run a function in a forked process and return what it returned, or raise what it raised."""
    receive, send = FORK.Pipe(duplex=False)

    def run():
        try:
            send.send(function(*arguments))
        except BaseException as error:
            send.send(error)

    process = FORK.Process(target=run)
    process.start()
    send.close()  # so that the end of a killed child is the end of the pipe
    try:
        result = receive.recv()
    except EOFError:
        result = None
    process.join()
    if isinstance(result, BaseException):
        raise result
    return result


def fill_disk(*_):
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))


def lose_home(*_, **chosen):
    """Be a user without a home folder, as in a container that was started with --user 54321."""
    for name in ("HOME", "XDG_CACHE_HOME", "CONTACTLAW_CACHE_DIR"):
        os.environ.pop(name, None)
    os.environ.update(chosen)
    if os.geteuid() == 0:
        os.setuid(54321)
    else:  # no rights to become a user without an entry
        pwd.getpwuid = pwd.getpwnam = {}.__getitem__
