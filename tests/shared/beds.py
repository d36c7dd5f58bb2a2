"""What holds for every bed of ``dem-demo``."""

import os
import signal
import subprocess
import sys
import time

from dem_demo.kit.runs import read

COMMAND = [sys.executable, "-m", "dem_demo"]


def check_what_an_interrupt_keeps(arguments, folder, kind, files, size, frames, command=COMMAND):
    """Interrupt a long run when its dump has this size [bytes]; it has fewer frames than these."""
    process = subprocess.Popen(
        [*command, *arguments, "--out", "out"], cwd=folder, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip
    end, dump = time.monotonic() + 120, f"**/.unfinished-*/{kind.NAME}.lammpstrj"
    while time.monotonic() < end and not any(
        file.stat().st_size > size for file in folder.glob(dump)
    ):
        time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=120)
    assert process.returncode == 130, errors
    assert "Traceback" not in errors
    assert errors.splitlines()[-1].endswith("under the law myc: interrupted by SIGINT")
    assert {path.name for path in (folder / "out").iterdir()} == files - {"constant.h5"}
    assert os.listdir(folder) == ["out"]
    runs = read(folder / "out", kind)
    assert runs.constant is None and runs.reason == "interrupted by SIGINT"
    assert 2 < runs.law.time.size < frames
    assert "Partial" in (folder / "out" / "summary.txt").read_text()
