# Each target installs what it needs into a local .venv at its first call.
PYTHON ?= python3
BIN := .venv/bin
# Python compiles modules as they are imported; pip would take 13 s for all of numba and matplotlib.
INSTALL := $(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile --editable

# Without byte code on disk each process would compile numba's sources again, for 2 s.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: demo test test-long test-engines lint docs package validation bench pictures clean

demo: .venv/demo.done  ## rain beads on thin plates; the page is rain/index.html
	$(BIN)/dem-demo rain --out rain

PYTEST := $(BIN)/python -m pytest --numprocesses auto --dist worksteal

test: .venv/test.done  ## run the tests, but for those of `test-long`; of a part: PART=tests/laws
	$(PYTEST) -m "not long" $(PART)

test-long: .venv/test.done  ## run long validations: whole fits, statistics, elements, the catalogue
	$(PYTEST) -m long

ENGINES := liggghts libliggghts-dev libopenmpi-dev g++

test-engines: .venv/engines.done  ## run the tests of LIGGGHTS, CUDA and OpenCL; none may be skipped
	@dpkg-query --show $(ENGINES) >/dev/null || \
	  { echo "for LIGGGHTS: apt-get install --no-install-recommends $(ENGINES)"; exit 1; }
	$(BIN)/python -m pytest tests/export/test_liggghts.py tests/export/test_gpu.py \
	  --junitxml=.venv/engines.xml
	@! grep -o '<skipped [^>]*' .venv/engines.xml

lint: .venv/dev.done  ## check style and types
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

docs: .venv/docs.done  ## build the site of the documentation: build/docs/index.html
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --strict --quiet

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

validation: .venv/validation.done  ## write the report on accuracy and on the paper: validation/report/index.html
	$(BIN)/python -m validation

bench: .venv/bench.done  ## measure each performance target beside a comparable program
	$(BIN)/python -m validation.bench

PICTURES := .venv/pictures

pictures: .venv/test.done  ## draw the pictures of docs again, in about 10 minutes
	$(BIN)/dem-demo rain --out $(PICTURES)/rain
	$(BIN)/mpirun -np 2 $(BIN)/dem-demo sieve --out $(PICTURES)/sieve
	$(BIN)/python -m validation --out $(PICTURES)/report
	cp $(PICTURES)/rain/rain.gif $(PICTURES)/rain/restitution.png docs
	cp $(PICTURES)/sieve/dissipation.png docs/sieve.png
	cp $(PICTURES)/report/fig15_restitution.png docs/fem_restitution.png
	cp $(PICTURES)/report/fig26_oblique.png docs/oblique.png
	cp $(PICTURES)/report/fig28_edges.png docs/edges.png
	mkdir -p $(PICTURES)/docs/examples && cp docs/examples/rebounds.csv $(PICTURES)/docs/examples
	cd $(PICTURES) && awk '/^```sh/ {on = 1; next} /^```/ {on = 0} on' $(CURDIR)/docs/gallery.md | \
	  PATH="$(CURDIR)/$(BIN):$$PATH" sh -e
	$(BIN)/dem-demo sieve --beads 300 --out $(PICTURES)/small
	$(BIN)/contactlaw report $(PICTURES)/small/sieve.h5 --mesh $(PICTURES)/small/deck.stl --scale 1mm \
	  --out $(PICTURES)/small/report
	cp $(PICTURES)/small/report/places.png docs/gallery/report.png
	cp $(PICTURES)/rain/constant_cor.png docs/gallery/constant.png
	cd $(PICTURES) && cp thickness.png speed.png map.png oblique.png fit.png $(CURDIR)/docs/gallery
	$(BIN)/contactlaw explore --sphere bearing-steel-52100 --plate aluminium-6061-t6 --out docs/explore.html

clean:  ## remove the environment and the wheels
	rm -rf .venv dist

# One stamp file per extra; the extra is installed again when pyproject.toml is newer.
.venv/%.done: pyproject.toml | .venv/bin/python
	@echo "Installing contactlaw[$*] into .venv ..."
	@$(INSTALL) '.[$*]'
	@touch $@

.venv/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "contactlaw needs Python 3.11 or later; try: make PYTHON=python3.11"; exit 1; }
	@$(PYTHON) -m venv .venv
