# Lidarena on a fresh machine: needs Python 3.11 or later and make; everything else goes into .venv.
#
#   make compare   train a small agent and compare it with the classical methods: table and pictures
#   make test      the tests
#   make lint      style and types
#   make docs      the pages of docs/, into site/
#
# make compare PYTHON=python3.12   uses another Python

PYTHON ?= python3
TEST_PROCESSES ?= 2
BIN := .venv/bin
INSTALLED := .venv/.installed

.PHONY: compare test lint docs install

compare: $(INSTALLED)
	@# Earlier runs are kept: the last one moves to runs/quick.1, runs/quick.2, …
	@if [ -e runs/quick ]; then \
		n=1; while [ -e "runs/quick.$$n" ]; do n=$$((n + 1)); done; \
		mv runs/quick "runs/quick.$$n"; echo "the earlier run is now in runs/quick.$$n"; \
	fi
	$(BIN)/python train.py --config configs/train/quick.yaml --out runs/quick
	$(BIN)/python evaluate.py --config configs/compare/quick.yaml

test: $(INSTALLED)
	$(BIN)/python -m pytest -n $(TEST_PROCESSES) --dist loadfile --hypothesis-profile=ci

lint: $(INSTALLED)
	$(BIN)/ruff check .
	$(BIN)/mypy lidarena train.py evaluate.py

docs: $(INSTALLED)
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --strict

install: $(INSTALLED)

# The stamp is written last, so an installation that was cut off starts again.
$(INSTALLED): requirements.lock pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit("Lidarena needs Python 3.11 or later; set PYTHON" if sys.version_info < (3, 11) else 0)'
	test -x $(BIN)/python || $(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --requirement requirements.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --editable .
	@touch $@
