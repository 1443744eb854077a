# Everyday verbs. Needs Python 3.11 or newer and make; all else goes into .venv, once.
# What a verb runs can be given more: make test ARGS="tests/rules -x"

PYTHON ?= python3
BIN := .venv/bin
RUN := $(BIN)/python -m
PIP := $(RUN) pip --disable-pip-version-check --quiet
ARGS ?=
# Processes that share the tests: more than the two cores, because a test often waits.
WORKERS ?= 4
# A test that fails runs once more: the summary names it, and what a busy machine decided is mended.
PYTEST := $(RUN) pytest --numprocesses $(WORKERS) --dist worksteal --reruns 1 -raR

# Our code is compiled once: else each of the tests' many processes compiles it again.
unexport PYTHONDONTWRITEBYTECODE
COMPILE := $(RUN) compileall -q shared robots arenas server client

# The C library computes as on an older processor, so sines and cosines have other last bits.
OLDER_PROCESSOR := glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-FMA_Usable,-FMA4_Usable,-AVX2_Usable
PHYSICS_TESTS := $(addprefix tests/server/test_,$(addsuffix .py,world replay recovery simulate damaged_record left_behind))

PAGES := client/lacoc_client/pages/index.html
PAGES_FROM := $(shell find client/web/src client/web/public -type f) \
	$(addprefix client/web/,index.html package-lock.json vite.config.ts)
NPM := PATH="$(CURDIR)/$(BIN):$$PATH" npm --prefix client/web --loglevel=error

.PHONY: help demo test test-all arithmetic format lint type walls core check build bench fuzz mutants soak wheel-smoke web clean
.DELETE_ON_ERROR:

help: ## Show this list.
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/\1	\2/p' Makefile | expand -t 14

demo: .venv/.server $(PAGES) ## See a whole match: a court, two bots and a referee over the network.
	$(BIN)/lacoc demo $(ARGS)

test: .venv/.test .venv/.web $(PAGES) ## Run the tests.
	$(COMPILE)
	$(PYTEST) $(ARGS)

test-all: arithmetic ## Run all tests: also the long ones, with more examples of each property.
	$(MAKE) test ARGS="--long $(ARGS)"

arithmetic: .venv/.test ## Run the tests of physics in the arithmetic of an older processor.
	$(COMPILE)
	GLIBC_TUNABLES=$(OLDER_PROCESSOR) $(PYTEST) $(PHYSICS_TESTS)

web: .venv/.web ## Build the pages and build them again whenever they change.
	$(NPM) run build -- --watch

format: .venv/.lint .venv/.web ## Format the code.
	$(RUN) ruff format
	$(RUN) ruff check --fix
	$(NPM) run format

lint: .venv/.lint .venv/.web ## Check format and style.
	$(RUN) ruff format --check
	$(RUN) ruff check
	$(RUN) codespell_lib
	$(BIN)/python docs/references.py
	$(RUN) validate_pyproject pyproject.toml
	$(NPM) run lint

type: .venv/.lint .venv/.web ## Check types.
	$(RUN) mypy
	$(RUN) mypy --platform win32 --cache-dir .mypy_cache/win32
	$(NPM) run type

walls: .venv/.lint ## Check who imports whom (docs/architecture.md).
	$(BIN)/lint-imports

core: .venv/.test ## Delete all satellites in a copy, and run the core's tests there.
	$(BIN)/python tests/project/core_alone.py $(or $(ARGS),-n 2)

check: lint type walls core test ## Everything that must be right before a commit.

build: .venv/.build ## Make the wheel and the source archive in dist/.
	rm -rf dist
	$(RUN) build

wheel-smoke: build ## Install wheel and source archive in clean environments and try them.
	$(BIN)/python tests/project/wheel_smoke.py dist

bench: .venv/.test ## Measure the court against bare physics and bare Zenoh.
	$(RUN) benchmarks $(ARGS)

fuzz: .venv/.test ## Feed a million hostile packets and 100,000 hostile files to all that reads them.
	$(RUN) tests.campaigns.fuzz $(ARGS)

mutants: .venv/.mutation ## Change the code of rules, match, drive and codec bit by bit: do tests notice?
	$(RUN) tests.campaigns.mutation $(ARGS)

soak: .venv/.test ## Play matches end to start for an hour: nothing may grow or be left over.
	$(RUN) tests.campaigns.long.soak $(ARGS)

clean: ## Remove everything that was made.
	rm -rf .venv build dist client/web/node_modules client/lacoc_client/pages .mypy_cache .ruff_cache .pytest_cache .import_linter_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

# One stamp for each set of packages, out of date when pyproject.toml is newer.
.venv/.server: pyproject.toml
	$(PYTHON) -c 'import sys; v = sys.version_info; v < (3, 11) and sys.exit("LACOC needs Python 3.11 or newer: make PYTHON=python3.11 ...")'
	$(PYTHON) -m venv .venv
	$(PIP) install --upgrade "pip>=25.1"
	$(PIP) install --editable ".[server]"
	touch $@

# Installing builds them; this is for those who change them.
$(PAGES): $(PAGES_FROM) | .venv/.server
	$(MAKE) .venv/.web
	$(NPM) run build

.venv/.web: client/web/package-lock.json | .venv/.server
	$(PIP) install --group web
	$(NPM) ci --no-audit --no-fund
	touch $@

.venv/.test .venv/.lint .venv/.build .venv/.mutation: .venv/.%: .venv/.server
	$(PIP) install --group $*
	touch $@
