# Each target installs what it needs into a local .venv at its first call.
PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
# Python compiles modules as they are imported; pip would take 13 s for all of numba and matplotlib.
INSTALL := $(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile --editable

# Without byte code on disk each process would compile numba's sources again, for 2 s.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: demo test test-long test-engines extras matrix mutations coverage lint docs package validation bench \
  pictures release clean

demo: $(VENV)/demo.done  ## rain beads on thin plates; the page is rain/index.html
	$(BIN)/dem-demo rain --out rain

PYTEST := $(BIN)/python -m pytest --numprocesses auto --dist worksteal --durations=10

test: $(VENV)/test.done  ## run the tests, but for those of `test-long`; of a part: PART=tests/laws
	$(PYTEST) -m "not long" $(PART)

test-long: $(VENV)/test.done  ## run long validations: whole fits, statistics, elements, the catalogue
	$(PYTEST) -m long

ENGINES := liggghts libliggghts-dev libopenmpi-dev g++ yade

test-engines: $(VENV)/engines.done  ## run the tests of LAMMPS's fix, LIGGGHTS, YADE, CUDA, OpenCL; none may be skipped
	@dpkg-query --show $(ENGINES) >/dev/null || \
	  { echo "for LIGGGHTS and YADE: apt-get install --no-install-recommends $(ENGINES)"; exit 1; }
	$(BIN)/python -m pytest tests/export/test_lammps_fix.py tests/export/test_liggghts.py tests/export/test_gpu.py \
	  tests/engines/test_yade.py \
	  --junitxml=$(VENV)/engines.xml
	@! grep -o '<skipped [^>]*' $(VENV)/engines.xml

EXTRAS := lammps demo fit

extras: export NUMBA_CACHE_DIR = $(CURDIR)/.pytest_cache/machine-code
extras:  ## use each extra of users in an environment of its own: attach, record, save, read, report
	@for extra in $(EXTRAS); do \
	  $(MAKE) --no-print-directory VENV=.venv/$$extra .venv/$$extra/$$extra.done || exit 1; \
	done
	.venv/fit/bin/contactlaw fit docs/examples/rebounds.csv --sphere gamma-alumina --plate glass \
	  --radius 0.9mm --thickness 1mm --unknown yield_strength
	.venv/demo/bin/dem-demo rain --beads 5 --plates 1mm --duration 0.05 --out .venv/demo/rain
	.venv/demo/bin/contactlaw report .venv/demo/rain/rain.h5 --out .venv/demo/report
	.venv/lammps/bin/python docs/examples/plates_lammps.py
	.venv/lammps/bin/python docs/examples/own_loop.py  # reads a mesh
	.venv/lammps/bin/contactlaw report .venv/demo/rain/rain.h5 --out .venv/lammps/report

PYTHONS := 3.11 3.12 3.13
QUICK := tests/physical tests/laws/test_laws.py tests/test_model.py tests/cli/test_cor.py

matrix:  ## run a quick part of the tests on each of Python 3.11 to 3.13 that is on PATH
	@for version in $(PYTHONS); do \
	  if python$$version -c '' 2>/dev/null; then \
	    echo "Python $$version:"; \
	    $(MAKE) --no-print-directory test VENV=.venv/$$version PYTHON=python$$version \
	      PART="$(QUICK)" || exit 1; \
	  else echo "Python $$version is not on PATH: not tested"; fi; \
	done

mutations: $(VENV)/test.done  ## make faults in a copy, one by one, and see tests fail; of some rooms: ROOMS="laws walls"
	$(BIN)/python tests/mutations/mutate.py $(ROOMS)

coverage: $(VENV)/coverage.done  ## print which lines of contactlaw `make test` reaches, but for compiled kernels
	$(PYTEST) -m "not long" --cov=contactlaw --cov-report=term:skip-covered $(PART)

lint: $(VENV)/dev.done  ## check style and types
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

docs: $(VENV)/docs.done  ## build the site of the documentation: build/docs/index.html
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --strict --quiet

WITH := $(PYTHON)
FILES := *.whl

package: $(VENV)/dev.done  ## build wheel and source archive, and use the wheel outside of the clone: WITH=python3.12 FILES=*.tar.gz
	rm -rf dist
	$(BIN)/python -m build --outdir dist
	$(BIN)/twine check --strict dist/*
	@for python in $(WITH); do \
	  if ! $$python -c '' 2>/dev/null; then echo "$$python is not on PATH: not tested"; continue; fi; \
	  for file in $(addprefix $(CURDIR)/dist/,$(FILES)); do \
	    echo "$$python, $$file:"; \
	    sh tests/installed.sh $$python $$file || exit 1; \
	  done; \
	done

validation: $(VENV)/validation.done  ## write the report, validation/report/index.html, in a minute; of a part: PART=paper
	$(BIN)/python -m validation $(PART)

bench: $(VENV)/bench.done  ## measure each performance target beside a comparable program
	$(BIN)/python -m validation.bench

PICTURES := $(VENV)/pictures

pictures: $(VENV)/test.done  ## draw the pictures of docs again, in about 10 minutes
	$(BIN)/dem-demo rain --out $(PICTURES)/rain
	$(BIN)/mpirun -np 2 $(BIN)/dem-demo sieve --out $(PICTURES)/sieve
	$(BIN)/python -m validation --out $(PICTURES)/report
	cp $(PICTURES)/rain/restitution.png docs
	$(BIN)/dem-demo rain --plate aluminium-6061-t6 --beads 1000 --out $(PICTURES)/metal
	PYTHONPATH=tests/shared $(BIN)/python docs/film.py $(PICTURES)/metal/index.html docs/rain.gif
	cp $(PICTURES)/sieve/dissipation.png docs/sieve.png
	cp $(PICTURES)/report/fig15_restitution.png docs/fem_restitution.png
	cp $(PICTURES)/report/fig26_oblique.png docs/oblique.png
	cp $(PICTURES)/report/fig28_edges.png docs/edges.png
	cp $(PICTURES)/report/fig31_walls.png docs/walls.png
	mkdir -p $(PICTURES)/docs/examples && cp docs/examples/rebounds.csv $(PICTURES)/docs/examples
	cd $(PICTURES) && awk '/^```sh/ {on = 1; next} /^```/ {on = 0} on' $(CURDIR)/docs/gallery.md | \
	  PATH="$(CURDIR)/$(BIN):$$PATH" sh -e
	$(BIN)/dem-demo sieve --beads 300 --sphere gamma-alumina --out $(PICTURES)/small
	$(BIN)/contactlaw report $(PICTURES)/small/sieve.h5 --out $(PICTURES)/small/report
	cp $(PICTURES)/small/report/places.png docs/gallery/report.png
	cp $(PICTURES)/rain/constant_cor.png docs/gallery/constant.png
	cd $(PICTURES) && cp thickness.png speed.png both.png oblique.png fit.png $(CURDIR)/docs/gallery
	$(BIN)/contactlaw explore --sphere bearing-steel-52100-ball --plate aluminium-6061-t6 --out docs/explore.html

# What a person would forget: each line stops with what to do.
release:  ## check the tree, the version and the changelog, test, build and use both archives, and tag: VERSION=1.1.0
	@stop() { echo "release: $$1" >&2; exit 1; }; \
	[ -n "$(VERSION)" ] || stop "say which: make release VERSION=1.1.0"; \
	[ -z "$$(git status --porcelain)" ] || stop "commit, or remove, what git status lists"; \
	grep -qxF 'VERSION = "$(VERSION)"' contactlaw/_version.py || \
	  stop "contactlaw/_version.py has another version"; \
	grep -qxF 'version: $(VERSION)' CITATION.cff || stop "CITATION.cff has another version"; \
	grep -qE '^## \[$(VERSION)\] - 20[0-9]{2}-[0-9]{2}-[0-9]{2}$$' CHANGELOG.md || \
	  stop "CHANGELOG.md has no '## [$(VERSION)] - DATE': rename [Unreleased]"; \
	! git rev-parse --quiet --verify "refs/tags/v$(VERSION)" >/dev/null || \
	  stop "the tag v$(VERSION) exists"
	$(MAKE) test test-long matrix lint docs
	$(MAKE) package WITH="$(PYTHONS:%=python%)" FILES="*.whl *.tar.gz"
	git tag --annotate "v$(VERSION)" --message "contactlaw $(VERSION)"
	@echo "now: git push origin v$(VERSION) && $(BIN)/twine upload dist/*.whl dist/*.tar.gz"

clean:  ## remove the environments, the wheels and the site
	rm -rf .venv dist build

# One stamp file per extra; the extra is installed again when pyproject.toml is newer.
$(VENV)/%.done: pyproject.toml | $(VENV)/bin/python
	@echo "Installing contactlaw[$*] into $(VENV) ..."
	@$(INSTALL) '.[$*]'
	@touch $@

$(VENV)/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "contactlaw needs Python 3.11 or later; try: make PYTHON=python3.11"; exit 1; }
	@$(PYTHON) -m venv $(VENV)
