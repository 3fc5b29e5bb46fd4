# Everything that a newcomer needs: `make duel` and `make test`.
PYTHON ?= python3.11
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed

.PHONY: setup duel test mutate bench figures clean constraints

setup: $(STAMP)

$(STAMP): pyproject.toml constraints.txt
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check \
		--constraint constraints.txt --editable ".[dev]"
	touch $(STAMP)

duel: setup
	$(BIN)/stepaside duel

test: setup
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/pytest --numprocesses auto

# Faults that the tests should notice; goes on where it was cut short.
mutate: setup
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.mutation --write

bench: setup
	$(BIN)/python -m pip install --quiet --disable-pip-version-check \
		--constraint constraints.txt --editable ".[bench]"
	$(BIN)/python benchmarks/run.py
	$(BIN)/python benchmarks/kernel.py
	$(BIN)/python -m documents

# Tables, numbers and figures of README and docs/, from docs/results/.
figures: setup
	$(BIN)/python -m documents

constraints:
	uv pip compile --universal --python-version 3.11 --all-extras \
		--no-emit-index-url --no-header --output-file constraints.txt \
		pyproject.toml

clean:
	rm -rf $(VENV) runs
