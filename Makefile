# make demo    build the nail machine's gears into output/ (installs into .venv first)
# make test    everything that CI runs (installs the extra for STEP files, 380 MB, too)
# make slow    the slow tests    make bench   measure, and write docs/performance.md
# make peers   compare flanks with those of another package
# make lint    style, types, import contracts    make clean   remove .venv, caches and output
#
# Needs Python 3.11 or later and a network for the first call. `make PYTHON=/path/to/python demo` chooses one.

SHELL  := /bin/sh
VENV   := .venv
BIN    := $(VENV)/bin
PIP    := $(BIN)/python -m pip --disable-pip-version-check --quiet
DEMO   := profiles/nail_machine_two_phase.toml
PYTHON ?=

.DELETE_ON_ERROR:
.PHONY: demo test lint slow bench peers clean help

help:
	@sed -n 's/^# //p' Makefile

demo: $(VENV)/.run
	$(BIN)/gearcam build $(DEMO) -o output

test: lint
	$(BIN)/python -m pytest -n 2 -m "not slow"

lint: $(VENV)/.dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/pyright
	$(BIN)/lint-imports

slow: $(VENV)/.dev
	$(BIN)/python -m pytest -m slow

bench: $(VENV)/.bench
	$(BIN)/python benchmarks/run.py

peers: $(VENV)/.bench
	$(BIN)/python benchmarks/agreement.py

clean:
	rm -rf $(VENV) .pytest_cache .ruff_cache .hypothesis .import_linter_cache build dist
	find src tests benchmarks -name __pycache__ -type d -prune -exec rm -rf {} +
	find output -mindepth 1 ! -name .gitkeep -delete

# The stamps: a second call finds them fresh and needs neither pip nor network.
# The candidates are run, not only looked up: a name on the path may be a shim for nothing.
$(VENV)/.made:
	@python=; \
	for candidate in $(PYTHON) $(if $(PYTHON),,python3.13 python3.12 python3.11 python3 python); do \
	  if "$$candidate" -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))' \
	      >/dev/null 2>&1; then python="$$candidate"; break; fi; \
	done; \
	if [ -z "$$python" ]; then \
	  echo "gearcam needs Python 3.11 or later with its venv module, and none was found." >&2; \
	  echo "Install one (Debian, Ubuntu: apt install python3 python3-venv)," >&2; \
	  echo "or name it: make PYTHON=/path/to/python demo" >&2; exit 1; \
	fi; \
	echo "making $(VENV) with $$("$$python" --version)"; \
	"$$python" -m venv --clear $(VENV)
	$(PIP) install --upgrade "pip>=25.1"   # the first that knows dependency groups
	@touch $@

$(VENV)/.run: pyproject.toml $(VENV)/.made
	$(PIP) install --editable .
	@touch $@

$(VENV)/.dev: pyproject.toml $(VENV)/.run
	$(PIP) install --editable ".[step]" --group dev
	@touch $@

$(VENV)/.bench: pyproject.toml $(VENV)/.dev
	$(PIP) install --editable . --group test --group bench
	@touch $@
