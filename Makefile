# make demo       build the gears of a nail machine into output/
# make test       run the tests that are not slow
# make slow       run the slow tests
# make lint       check style, types and import contracts
# make matrix     run the tests with each Python found, and with the lowest and newest packages
# make docs       write docs/reference and build the site of docs/ in build/docs
# make notebooks  run the notebooks of docs/notebooks and store their output
# make bench      measure run times; write benchmarks/results/performance.md
# make needs      measure the cost of each kind of file; update performance.md
# make growth     measure time and memory against the size of designs; write growth.md
# make accuracy   measure error against run time of several methods; write accuracy.md
# make peers      compare tooth flanks and motions with those of other packages
# make fuzz       test with random designs: MORE="--count N --seed N ..." (--help lists more);
#                 write their score into docs/validation.md
# make compare    compare random designs with those of an older commit: BASE=COMMIT [N=50] [SEED=1]
# make lock       renew requirements.lock
# make clean      remove environments, caches and output
# make help       list these targets
#
# The first call needs a network and Python 3.11 or later; PYTHON=/path/to/python selects one.
# `make test` installs about 830 MB, and chromium if it runs as root on Debian.

SHELL  := /bin/sh
VENV   := .venv
BIN    := $(VENV)/bin
PIP    := $(BIN)/python -m pip --disable-pip-version-check --quiet
DEMO   := profiles/nail_machine_two_phase.toml
PYTHON ?=

# Sections of requirements.lock to install; `make matrix` sets others.
RUN    := run install
TEST   := $(RUN) step plot sweep optimize stress dynamics test

# Two processes with a thread each, as the command has; what was compiled is kept, as compiling the
# tests anew takes 10 s. Each process has half of the tests, in order, so that what tests of a file
# share is computed once; the one that ends first takes half of what the other has left.
PYTEST := OPENBLAS_NUM_THREADS=1 PYTHONDONTWRITEBYTECODE= $(BIN)/python -m pytest -n 2 --dist worksteal

.DELETE_ON_ERROR:
.PHONY: demo test lint slow bench needs growth peers accuracy fuzz compare matrix docs notebooks lock clean help

help:
	@sed -n '/^$$/q; s/^# \{0,1\}//p' Makefile

demo: $(VENV)/.run
	$(BIN)/gearcam build $(DEMO) -o output

test: $(VENV)/.test
	tools/browser
	$(PYTEST) -m "not slow"

lint: $(VENV)/.lint
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/pyright
	$(BIN)/lint-imports

slow: $(VENV)/.test
	tools/browser
	$(PYTEST) -m slow

bench: $(VENV)/.bench
	$(BIN)/python benchmarks/run.py

needs: $(VENV)/.test
	$(BIN)/python tools/needs.py

growth: $(VENV)/.test
	$(BIN)/python benchmarks/growth.py

peers: $(VENV)/.bench
	$(BIN)/python benchmarks/agreement.py

accuracy: $(VENV)/.bench
	$(BIN)/python benchmarks/accuracy/run.py

fuzz: $(VENV)/.test
	PYTHONPATH=tests:tools $(BIN)/python -m fuzz --score docs/validation.md $(MORE)

compare: $(VENV)/.test
	PYTHONPATH=tests $(BIN)/python tools/compare.py $(BASE) --count $(or $(N),50) --seed $(or $(SEED),1) $(MORE)

matrix:
	@MAKE="$(MAKE)" tools/matrix

docs: $(VENV)/.docs
	$(BIN)/python tools/reference.py
	$(BIN)/python -m sphinx --fail-on-warning --keep-going --quiet --fresh-env --write-all \
	  docs build/docs

notebooks: $(VENV)/.test
	$(BIN)/python tools/notebooks.py

lock: $(VENV)/.lock
	$(BIN)/python tools/lock.py

clean:
	rm -rf $(VENV) .matrix .pytest_cache .ruff_cache .hypothesis .import_linter_cache build dist
	find src tests benchmarks tools -name __pycache__ -type d -prune -exec rm -rf {} +
	[ ! -d output ] || find output -mindepth 1 ! -name .gitkeep -delete

# Stamp files: a second call finds them up to date and needs neither pip nor network.
# Each candidate is run, since a name on the path may be a shim without a Python.
$(VENV)/.made:
	@python=; \
	for candidate in $(PYTHON) $(if $(PYTHON),,python3.13 python3.12 python3.11 python3 python); do \
	  if "$$candidate" -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))' \
	      >/dev/null 2>&1; then python="$$candidate"; break; fi; \
	done; \
	if [ -z "$$python" ]; then \
	  echo "gearcam needs Python 3.11 or later with its venv module, and" \
	    "$(if $(PYTHON),$(PYTHON) is none or does not run,none was found)." >&2; \
	  echo "Install one (Debian, Ubuntu: apt install python3 python3-venv)," >&2; \
	  echo "or name one that runs: make PYTHON=/path/to/python demo" >&2; exit 1; \
	fi; \
	echo "making $(VENV) with $$("$$python" --version)"; \
	"$$python" -m venv --clear $(VENV)
	@touch $@

# Install locked packages by their hashes; wheels only, since build tools would not be locked.
define locked
	@awk -v wanted=" $(1) " '/^# for /{on = index(wanted, " " $$3 " ")} on' requirements.lock > $@.txt
	$(PIP) install --only-binary :all: --require-hashes --requirement $@.txt
endef

$(VENV)/.run: pyproject.toml requirements.lock $(VENV)/.made
	$(call locked,$(RUN))
	$(PIP) install --no-deps --no-build-isolation --editable .
	@touch $@

$(VENV)/.test: $(VENV)/.run
	$(call locked,$(TEST))
	@touch $@

$(VENV)/.lint: $(VENV)/.test
	$(call locked,$(TEST) lint)
	@touch $@

$(VENV)/.bench: $(VENV)/.test
	$(call locked,$(TEST) bench)
	@touch $@

$(VENV)/.docs: $(VENV)/.test
	$(call locked,$(TEST) docs)
	@touch $@

$(VENV)/.lock: requirements.lock $(VENV)/.made
	$(call locked,lock)
	@touch $@
