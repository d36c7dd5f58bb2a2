"""Make small faults in a copy of the sources, one at a time, and see that a named test fails.

``python tests/mutations/mutate.py [ROOM or beginning of a path ...] [--find [TESTS ...]]``

Each ``ROOM.toml`` beside this file lists edits. An edit has a file, a text that occurs in it once, its
replacement, a sentence that says why the change is a fault, and the test that fails with it. An edit
with ``plain`` runs its test with numba switched off, because everything is compiled anew after a
change of a kernel. An edit that no test notices has an empty ``test``. Each line of the output begins
with what became of an edit:

- caught: its test fails with it, and passes without it;
- missed: its test passes with it;
- found: its test passes with it, and the first of the tests after ``--find`` that fails is named (all
  tests but the long ones, if none are given);
- open: no test notices it;
- wrong: its text does not occur once, or its test does not pass without it.

All runs are in a temporary copy of the tree, one process after the other.
"""

import argparse
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
from pathlib import Path
from typing import NamedTuple

LISTS = Path(__file__).parent
ROOT = LISTS.parent.parent
LONGEST = 900.0  # [s] of one test; a change may make a loop endless


class Edit(NamedTuple):
    room: str
    file: str
    text: str
    replacement: str
    why: str
    test: str
    plain: bool = False


def edits() -> list[Edit]:
    """All edits, in the order of the files and their lines."""
    lists = {path.stem: tomllib.loads(path.read_text("utf-8")) for path in sorted(LISTS.glob("*.toml"))}
    return [Edit(room, **one) for room, found in lists.items() for one in found["edit"]]


def run(copy: Path, plain: bool, *tests: str) -> tuple[bool, str]:
    """Whether the tests pass, and what pytest says in its last lines."""
    environment = os.environ | {"PYTHONPATH": str(copy), "CONTACTLAW_CACHE_DIR": str(copy / ".cache")}
    environment.pop("NUMBA_DISABLE_JIT", None)
    if plain:
        environment["NUMBA_DISABLE_JIT"] = "1"
    command = [sys.executable, "-m", "pytest", "-q", "-x", "--no-header", "--tb=no", "-p", "no:cacheprovider", *tests]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
    with subprocess.Popen(command, cwd=copy, env=environment, start_new_session=True, **pipes) as process:
        try:
            said, _ = process.communicate(timeout=LONGEST * len(tests))
        except subprocess.TimeoutExpired:
            said = f"longer than {LONGEST:g} s"
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
    # a test that is skipped has shown nothing
    return process.returncode == 0 and " passed" in said and "SKIPPED" not in said, said


def outcome(copy: Path, edit: Edit, wider: list[str] | None) -> tuple[str, str]:
    """What became of an edit, in one word, and the test that noticed it or a remark."""
    path = copy / edit.file
    before = path.read_text("utf-8")
    if before.count(edit.text) != 1:
        return "wrong", f"its text occurs {before.count(edit.text)} times"
    codes = copy / ".pytest_cache/machine-code"
    known = set(codes.glob("*"))
    path.write_text(before.replace(edit.text, edit.replacement), "utf-8")
    try:
        for what, plain, tests in (
            ("caught", edit.plain, [edit.test] if edit.test else None),
            ("found", False, wider and ["-m", "not long", *wider]),
        ):
            passed, said = run(copy, plain, *tests) if tests else (True, "")
            if not passed:
                return what, " ".join(re.findall(r"^(?:FAILED|ERROR) (\S+)", said, re.M)) or said[-300:]
    finally:
        path.write_text(before, "utf-8")
        for folder in set(codes.glob("*")) - known:  # code of this edit alone
            shutil.rmtree(folder)
    return ("missed", edit.test) if edit.test else ("open", edit.why)


def main() -> int:
    """Print a row for each edit; 1 if one was not caught, or if the list is out of date."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("rooms", nargs="*", help="rooms, or beginnings of paths; by default all")
    parser.add_argument("--find", nargs="*", metavar="TESTS", help="run these where the test named passes")
    chosen = parser.parse_args()
    some = [
        one
        for one in edits()
        if not chosen.rooms or any(name == one.room or one.file.startswith(name) for name in chosen.rooms)
    ]
    wider = None if chosen.find is None else chosen.find or ["tests"]
    listed = subprocess.check_output(["git", "ls-files", "-z", "-co", "--exclude-standard"], cwd=ROOT, text=True)
    with tempfile.TemporaryDirectory(prefix="mutations-") as folder:
        copy = Path(folder)
        for name in filter(lambda name: (ROOT / name).is_file(), listed.split("\0")):
            (copy / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, copy / name)
        counts: dict[str, int] = {}
        failing: dict[tuple[bool, str], str] = {}
        for plain in (False, True):
            tests = sorted({one.test for one in some if one.test and one.plain == plain})
            if tests and not run(copy, plain, *tests)[0]:
                found = {(plain, test): run(copy, plain, test) for test in tests}
                failing |= {test: said[-300:] for test, (passed, said) in found.items() if not passed}
        for one in some:
            begun = time.perf_counter()
            if said := failing.get((one.plain, one.test)):
                what, remark = "wrong", f"without the edit, {one.test} does not pass: {said}"
            else:
                what, remark = outcome(copy, one, wider)
            counts[what] = counts.get(what, 0) + 1
            line = " ".join(one.replacement.split())[:60]
            print(f"{what:7}{time.perf_counter() - begun:6.0f} s  {one.file}: {line}\n{'':17}{remark}", flush=True)
    print(", ".join(f"{count} {what}" for what, count in sorted(counts.items())))
    return int(any(what in counts for what in ("missed", "found", "wrong")))


if __name__ == "__main__":
    sys.exit(main())
