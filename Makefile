# Two commands matter: `make demo` and `make test`. Each sets up what it needs, once, in .venv.

VENV := .venv
PYTHON_IN_VENV := $(VENV)/bin/python
PLANTAR := $(VENV)/bin/plantar
INSTALLED := $(VENV)/.installed
DOCS_INSTALLED := $(VENV)/.docs
OUT ?= out
BENCH_OPTIONS ?=
# All cores; a file stays on one of them, since some of its tests share what is slow to make. Files come in the order of
# tests/conftest.py, the slow ones first; xdist by itself puts those of few tests last, which are the slow ones.
PYTEST_OPTIONS ?= -n logical --dist loadfile --no-loadscope-reorder

.DEFAULT_GOAL := help
KERNELS := $(wildcard plantar/kernels/*.py plantar/kernels/*/*.py plantar/kernels/*/*.pxd)
BUILT := $(VENV)/.kernels

.PHONY: help setup demo test test-all bench docs pictures lint format clean

help:
	@echo "make demo      build the H1 shoe, walk on plantar feedback, analyse the recording (into $(OUT)/)"
	@echo "make test      run the tests, without the long ones"
	@echo "make test-all  run every test"
	@echo "make bench     measure run time against error (into $(OUT)/bench/); BENCH_OPTIONS=--quick"
	@echo "make docs      build the site (into $(OUT)/site/), and open every page of it in Chromium"
	@echo "make pictures  draw the pictures of README and docs again (into docs/images/)"
	@echo "make lint      ruff, mypy and the layering test"
	@echo "make format    let ruff format the code"
	@echo "make setup     only create .venv (about 2.5 GB: cadquery brings VTK)"
	@echo "make clean     delete .venv, caches and $(OUT)/"

setup: $(BUILT)

demo: $(BUILT)
	$(PLANTAR) demo -o $(OUT)

# Tests start some hundreds of processes, each of which would compile all modules where Python keeps none.
test: $(BUILT)
	env -u PYTHONDONTWRITEBYTECODE $(PYTHON_IN_VENV) -m pytest -m "not long" $(PYTEST_OPTIONS)

test-all: $(BUILT)
	env -u PYTHONDONTWRITEBYTECODE $(PYTHON_IN_VENV) -m pytest $(PYTEST_OPTIONS)

bench: $(BUILT)
	$(PLANTAR) bench all $(BENCH_OPTIONS) -o $(OUT)/bench

# The check of the pages opens Chromium; without one the site is built all the same, and that is said.
docs: $(DOCS_INSTALLED)
	$(PYTHON_IN_VENV) tools/docs_pages.py
	$(PYTHON_IN_VENV) -m mkdocs build --strict --quiet
	@sh tools/fetch-axe $(VENV)/axe || echo "axe-core cannot be fetched: it does not check the pages" >&2
	$(PYTHON_IN_VENV) tools/check_site.py --axe $(VENV)/axe/axe.min.js || [ $$? = 2 ]

pictures: export MUJOCO_GL = egl
pictures: $(BUILT)
	$(PYTHON_IN_VENV) examples/walk_picture.py docs/images/walk.png
	$(PYTHON_IN_VENV) examples/walk_picture.py docs/images/beam.png beam
	$(PYTHON_IN_VENV) tools/walk_loop.py docs/images/beam.webp
	$(PYTHON_IN_VENV) examples/gallery.py docs/images

lint: $(BUILT)
	$(PYTHON_IN_VENV) -m ruff check .
	$(PYTHON_IN_VENV) -m ruff format --check .
	$(PYTHON_IN_VENV) -m mypy
	$(PYTHON_IN_VENV) -m pytest tests/test_layering.py

format: $(INSTALLED)
	$(PYTHON_IN_VENV) -m ruff check --fix .
	$(PYTHON_IN_VENV) -m ruff format .

clean:
	rm -rf $(VENV) $(OUT) build dist plantar/kernels/*/*.so plantar/kernels/*/*.pyd *.egg-info .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

# Made again when the dependencies change; the stamp is written last, so a stopped installation is taken up again.
$(INSTALLED): pyproject.toml setup.py constraints.txt
	@sh tools/make-venv $(VENV)
	@touch $@

# The editable install compiles the kernels; a change to one of them compiles it again. No compiler is no error.
$(BUILT): $(INSTALLED) $(KERNELS)
	@$(PYTHON_IN_VENV) setup.py --quiet build_ext --inplace
	@touch $@

# What builds the site stays out of what runs Plantar.
$(DOCS_INSTALLED): $(BUILT)
	@$(PYTHON_IN_VENV) -m pip install --quiet --constraint constraints.txt --editable '.[docs]' --no-build-isolation
	@touch $@
