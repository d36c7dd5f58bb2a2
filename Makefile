# Everything runs in a local .venv that sets itself up; a second call starts at once.
PYTHON ?= python3
BIN := .venv/bin
# Python compiles what is imported; pip would compile all of numba and matplotlib for 13 s.
INSTALL := $(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile --editable

# Without byte code on disk each process would compile numba's sources again, for 2 s.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: demo test test-engines lint package validation bench clean

demo: .venv/demo.done  ## rain beads on thin plates; the page is rain/index.html
	$(BIN)/dem-demo rain --out rain

test: .venv/test.done  ## run the tests
	$(BIN)/python -m pytest --numprocesses auto --dist loadfile

ENGINES := liggghts libliggghts-dev libopenmpi-dev g++

test-engines: .venv/test.done  ## run the tests of engines that PyPI does not have
	@dpkg-query --show $(ENGINES) >/dev/null || \
	  { echo "for LIGGGHTS: apt-get install --no-install-recommends $(ENGINES)"; exit 1; }
	$(BIN)/python -m pytest tests/export/test_liggghts.py

lint: .venv/dev.done  ## check style and types
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

package: .venv/dev.done  ## build the wheel and use it in an environment of its own
	rm -rf dist
	$(BIN)/python -m build --outdir dist
	$(BIN)/twine check --strict dist/*
	$(PYTHON) -m venv dist/env
	dist/env/bin/python -m pip install --quiet --disable-pip-version-check dist/*.whl
	cd dist && env/bin/contactlaw cor --sphere gamma-alumina --plate glass \
	  --radius 0.9e-3 --thickness 1e-3 --speed 12
	cd dist && env/bin/contactlaw table check
	awk '/^```python/ {on = 1; next} /^```/ {if (on) exit} on' README.md | dist/env/bin/python -W error -

validation: .venv/validation.done  ## reproduce the paper; the report is validation/report/index.html
	$(BIN)/python -m validation

bench: .venv/bench.done  ## measure every target beside a peer
	$(BIN)/python -m validation.bench

clean:  ## forget the environment
	rm -rf .venv dist

# One stamp per extra: it is newer than pyproject.toml when what it stands for is installed.
.venv/%.done: pyproject.toml | .venv/bin/python
	@echo "Installing contactlaw[$*] into .venv ..."
	@$(INSTALL) '.[$*]'
	@touch $@

.venv/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "contactlaw needs Python 3.11 or later; try: make PYTHON=python3.11"; exit 1; }
	@$(PYTHON) -m venv .venv
