# `make demo` and `make test` need only git, make and Python >= 3.11; they create what they use.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet

.PHONY: demo test check pytest verify bench town page picture screenshots clean

demo: $(VENV)/.installed
	$(BIN)/tmpud demo

test: check pytest

check: $(VENV)/.developing
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports

pytest: $(VENV)/.developing $(VENV)/.browser $(VENV)/.client
	$(BIN)/pytest -n 2

verify: $(VENV)/.developing
	$(BIN)/python -m tools.verify

bench: $(VENV)/.benching
	$(BIN)/python -m benchmarks all

town: $(VENV)/.developing
	$(BIN)/python tools/build_towns.py

$(BIN)/python:
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "tmpud needs Python 3.11 or newer; name one with make PYTHON=...")'
	$(PYTHON) -m venv $(VENV) || (apt-get update && apt-get install -y python3-venv && $(PYTHON) -m venv $(VENV))

$(VENV)/.installed: $(BIN)/python pyproject.toml constraints.txt
	$(PIP) install --constraint constraints.txt --editable .
	touch $@

$(VENV)/.developing: $(BIN)/python pyproject.toml constraints.txt
	$(PIP) install --constraint constraints.txt --editable '.[dev]'
	touch $@ $(VENV)/.installed

$(VENV)/.benching: $(BIN)/python pyproject.toml constraints.txt
	$(PIP) install --constraint constraints.txt --editable '.[bench]'
	touch $@ $(VENV)/.installed

# The replay's page is tried in Debian's Chromium; where it cannot be had those tests are skipped.
$(VENV)/.browser: | $(BIN)/python
	command -v chromium >/dev/null || (apt-get update && apt-get install -y chromium) || echo "no chromium: its tests are skipped"
	touch $@

# The real CARLA client drives against a loopback server; where it cannot be had those tests are skipped.
$(VENV)/.client: $(VENV)/.developing
	$(PIP) install --constraint constraints.txt --editable '.[carla]' || echo "no CARLA client: its tests are skipped"
	touch $@

# Only this needs Node: the page's sources in frontend/, built into the package.
page:
	cd frontend && npm ci && npm run check && npm run build

picture: $(VENV)/.installed
	$(BIN)/python -m tools.picture

# The pictures of docs/replay.md.
screenshots: $(VENV)/.developing $(VENV)/.browser
	$(BIN)/python -m tools.screenshots

clean:
	rm -rf $(VENV) frontend/node_modules runs .mypy_cache .ruff_cache .pytest_cache .import_linter_cache .hypothesis
