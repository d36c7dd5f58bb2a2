# Everything runs in a local .venv that sets itself up; a second call starts at once.
PYTHON ?= python3
BIN := .venv/bin
INSTALL := $(BIN)/python -m pip install --quiet --disable-pip-version-check --editable

.PHONY: demo test lint clean

demo: .venv/demo.done  ## rain beads on thin plates; figures and data in rain/
	$(BIN)/dem-demo rain --out rain

test: .venv/test.done  ## run the tests
	$(BIN)/python -m pytest

lint: .venv/dev.done  ## check style and types
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

clean:  ## forget the environment
	rm -rf .venv

# One stamp per extra: it is newer than pyproject.toml when what it stands for is installed.
.venv/%.done: pyproject.toml | .venv/bin/python
	@echo "Installing contactlaw[$*] into .venv ..."
	@$(INSTALL) '.[$*]'
	@touch $@

.venv/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "contactlaw needs Python 3.11 or later; try: make PYTHON=python3.11"; exit 1; }
	@$(PYTHON) -m venv .venv
