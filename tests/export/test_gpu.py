"""The header in CUDA and OpenCL: compiled by nvcc, and run by pocl beside the same code in C."""

import re
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import header
import metal
import numpy as np
import polymer
import pytest
from places import ROOT

import contactlaw as cl

ADVICE = "is missing: pip install contactlaw[engines]"
MODELS = {
    "metals": cl.ImpactModel(cl.Pair("bearing-steel-52100", "aluminium-6061-t6")),
    "rate": metal.MODEL,
    "losses": polymer.MODELS[0],
}


@pytest.fixture(scope="module")
def context():
    opencl = pytest.importorskip("pyopencl", reason=f"pyopencl {ADVICE}")
    processors = [one for at in opencl.get_platforms() for one in at.get_devices(opencl.device_type.CPU)]
    if not processors:
        pytest.skip(f"pocl {ADVICE}")
    return opencl.Context(processors[:1])


@pytest.mark.parametrize("name", MODELS)
def test_all_functions_are_those_of_c(name, context, tmp_path):
    import pyopencl as opencl

    cl.export.header(tmp_path / "contactlaw.h", MODELS[name])
    given = header.rows(1000, seed=1)
    expected = header.Library(tmp_path).answers(given)
    program = opencl.Program(context, header.SOURCE).build(["-I", str(tmp_path), "-Werror"])
    queue, flags, found = opencl.CommandQueue(context), opencl.mem_flags, np.empty_like(expected)
    # one work item a group: the arrays of a large group exceed the stack of a thread
    rows = opencl.Buffer(context, flags.COPY_HOST_PTR, hostbuf=given)
    out = opencl.Buffer(context, flags.WRITE_ONLY, found.nbytes)
    opencl.Kernel(program, "contactlaw_all")(queue, given.shape[:1], (1,), rows, out)
    opencl.enqueue_copy(queue, found, out)
    header.assert_close(given, found, expected)
    assert np.isfinite(found).mean(axis=0).min() > 0.5 and np.nanstd(found[:, 0]) > 0.05


@pytest.mark.parametrize("flag", ["-cl-fast-relaxed-math", "-cl-finite-math-only"])
def test_fast_maths_of_clang_are_refused(flag, context, tmp_path):
    """Pocl compiles with clang; gcc is tried beside the header of C."""
    import pyopencl as opencl

    cl.export.header(tmp_path / "contactlaw.h", MODELS["metals"], table="none")
    with pytest.raises(opencl.RuntimeError, match="no -ffast-math"):
        opencl.Program(context, '#include "contactlaw.h"').build([flag, "-I", str(tmp_path)])


@pytest.mark.long
def test_nvcc_compiles_all_functions_of_several_pairs_and_the_example_without_warnings(tmp_path):
    """For both sides; -G leaves out the optimization, of which nvcc takes minutes here."""
    wheel = find_spec("nvidia")
    folders = wheel.submodule_search_locations or () if wheel else ()
    inside = [str(one) for at in folders for one in Path(at).glob("cu*/bin/nvcc")]
    nvcc = next(iter(inside), None) or shutil.which("nvcc")
    if not nvcc:
        pytest.skip(f"nvcc {ADVICE}")
    warn = ["-Werror", "all-warnings", "-Xcompiler", "-Wall,-Wextra,-Wshadow,-Wconversion"]
    texts = []
    for name, model in MODELS.items():
        cl.export.header(tmp_path / f"{name}.h", model, prefix=name)
        texts.append(header.SOURCE.replace("contactlaw", name).replace("CONTACTLAW", name.upper()))
    (tmp_path / "pairs.cu").write_text("\n".join(texts))
    shutil.copy(ROOT / "docs/examples/event_driven.cu", tmp_path)
    text = (tmp_path / "event_driven.cu").read_text()
    export, compilation = re.findall(r"^ \*     (.*)$", text, re.MULTILINE)
    subprocess.run([sys.executable, "-m", *export.split()], cwd=tmp_path, check=True)
    for arguments in ["-G", "-c", "pairs.cu"], compilation.split(" && ")[0].split()[1:]:
        command = [nvcc, *warn, "-L", Path(nvcc).parents[1] / "lib", *arguments]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
        assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    # Without a GPU the example says so, after what one core gives.
    done = subprocess.run([tmp_path / "event_driven"], capture_output=True, text=True)
    assert re.search(r"after [\d.]+ s", done.stdout)
    assert done.returncode == ("no answer of a GPU" in done.stderr)
