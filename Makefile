# make demo    build the nail machine's gears into output/ (installs into .venv first)
# make test    every test that is not slow (installs both extras, STEP files and charts, 440 MB, and
#              on Debian, as root, the browser chromium)
# make lint    style, types, import contracts
# make slow    the slow tests    make bench   measure, and write benchmarks/results/performance.md
# make needs   what each output computes and imports, into benchmarks/results/performance.md
# make peers   compare flanks with those of another package
# make growth   how time and memory grow with the size of designs; write benchmarks/results/growth.md
# make accuracy  compare methods, error against run time, and write benchmarks/results/accuracy.md
# make compare BASE=COMMIT [N=50] [SEED=1] [MORE=...]   what both make of N random designs of each
#              kind and of the gallery; MORE goes to tools/compare.py, which tells of its options
# make matrix  the tests with every supported Python found, and with the lowest and the newest versions
# make notebooks   run the notebooks of docs/notebooks and store what they show
# make lock    renew requirements.lock    make clean   remove environments, caches and output
#
# Needs Python 3.11 or later and a network for the first call. `make PYTHON=/path/to/python demo` chooses one.

SHELL  := /bin/sh
VENV   := .venv
BIN    := $(VENV)/bin
PIP    := $(BIN)/python -m pip --disable-pip-version-check --quiet
DEMO   := profiles/nail_machine_two_phase.toml
PYTHON ?=

# Sections of the lock that an environment takes; `make matrix` takes others.
RUN    := run install
TEST   := $(RUN) step plot test

.DELETE_ON_ERROR:
.PHONY: demo test lint slow bench needs growth peers accuracy compare matrix notebooks lock clean help

help:
	@sed -n '/^$$/q; s/^# \{0,1\}//p' Makefile

demo: $(VENV)/.run
	$(BIN)/gearcam build $(DEMO) -o output

test: $(VENV)/.test
	tools/browser
	$(BIN)/python -m pytest -n 2 -m "not slow"

lint: $(VENV)/.lint
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/pyright
	$(BIN)/lint-imports

slow: $(VENV)/.test
	tools/browser
	$(BIN)/python -m pytest -n 2 -m slow

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

compare: $(VENV)/.test
	$(BIN)/python tools/compare.py $(BASE) --count $(or $(N),50) --seed $(or $(SEED),1) $(MORE)

matrix:
	@MAKE="$(MAKE)" tools/matrix

notebooks: $(VENV)/.test
	$(BIN)/python tools/notebooks.py

lock: $(VENV)/.lock
	$(BIN)/python tools/lock.py

clean:
	rm -rf $(VENV) .matrix .pytest_cache .ruff_cache .hypothesis .import_linter_cache build dist
	find src tests benchmarks tools -name __pycache__ -type d -prune -exec rm -rf {} +
	[ ! -d output ] || find output -mindepth 1 ! -name .gitkeep -delete

# The stamps: a second call finds them fresh and needs neither pip nor network.
# The candidates are run, not only looked up: a name on the path may be a shim for nothing.
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

# Only what the lock holds, by its hashes; wheels only, since what builds them would not be locked.
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

$(VENV)/.lock: requirements.lock $(VENV)/.made
	$(call locked,lock)
	@touch $@
