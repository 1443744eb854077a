# Everyday verbs. Needs Python 3.11 or newer and make; all else goes into .venv, once.
# What a verb runs can be given more: make test ARGS="tests/rules -x"

PYTHON ?= python3
BIN := .venv/bin
RUN := $(BIN)/python -m
PIP := $(RUN) pip --disable-pip-version-check --quiet
ARGS ?=

.PHONY: help demo test format lint type walls check build bench wheel-smoke clean
.DELETE_ON_ERROR:

help: ## Show this list.
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/\1	\2/p' Makefile | expand -t 14

demo: .venv/.server ## See a whole match: a court, two bots and a referee over the network.
	$(BIN)/lacoc demo $(ARGS)

test: .venv/.test ## Run the tests.
	$(RUN) pytest $(ARGS)

format: .venv/.lint ## Format the code.
	$(RUN) ruff format
	$(RUN) ruff check --fix

lint: .venv/.lint ## Check format and style.
	$(RUN) ruff format --check
	$(RUN) ruff check
	$(RUN) codespell_lib
	$(RUN) validate_pyproject pyproject.toml

type: .venv/.lint ## Check types.
	$(RUN) mypy

walls: .venv/.lint ## Check who imports whom (docs/architecture.md).
	$(BIN)/lint-imports

check: lint type walls test ## Everything that must be right before a commit.

build: .venv/.build ## Make the wheel and the source archive in dist/.
	rm -rf dist
	$(RUN) build

wheel-smoke: build ## Install wheel and source archive in clean environments and try them.
	$(BIN)/python tests/project/wheel_smoke.py dist

bench: .venv/.test ## Measure the court against bare physics and bare Zenoh.
	$(BIN)/python -m benchmarks $(ARGS)

clean: ## Remove everything that was made.
	rm -rf .venv build dist .mypy_cache .ruff_cache .pytest_cache .import_linter_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

# One stamp for each set of packages, out of date when pyproject.toml is newer.
.venv/.server: pyproject.toml
	$(PYTHON) -c 'import sys; v = sys.version_info; v < (3, 11) and sys.exit("LACOC needs Python 3.11 or newer: make PYTHON=python3.11 ...")'
	$(PYTHON) -m venv .venv
	$(PIP) install --upgrade "pip>=25.1"
	$(PIP) install --editable ".[server]"
	touch $@

.venv/.test .venv/.lint .venv/.build: .venv/.%: .venv/.server
	$(PIP) install --group $*
	touch $@
