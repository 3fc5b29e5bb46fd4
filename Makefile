# Everything that a newcomer needs: `make duel` and `make test`.
SUPPORTED := 3.13 3.12 3.11
# The newest that is there: a name alone may be a shim of nothing.
works = $(shell python$(1) -c "import venv" >/dev/null 2>&1 && echo python$(1))
PYTHON ?= $(firstword $(foreach version,$(SUPPORTED),$(call works,$(version))))
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
PLAYS := $(VENV)/.plays
INSTALL := -m pip install --disable-pip-version-check --no-warn-script-location \
	--root-user-action=ignore --constraint constraints.txt

.PHONY: setup duel test test-slow types suite python other other-setup \
	other-test mutate bench figures docs docs-run docs-setup wheel release clean constraints \
	ros2-peers test-ament test-export test-rcss

setup: $(STAMP)

$(BIN)/python:
	@test -n "$(PYTHON)" || { echo "stepaside needs \
	Python 3.13, 3.12 or 3.11 with venv, as python3.13 and so on on the path; \
	or make PYTHON=/path/to/python" >&2; exit 1; }
	@echo "making $(VENV) with $(PYTHON)"
	@$(PYTHON) -m venv $(VENV)

$(STAMP): pyproject.toml constraints.txt | $(BIN)/python
	@echo "installing what pyproject.toml names into $(VENV): some minutes"
	$(BIN)/python $(INSTALL) --editable ".[dev]"
	touch $(PLAYS) $(STAMP)

# What a duel needs: the package without extras, and no tools of developers.
$(PLAYS): pyproject.toml constraints.txt | $(BIN)/python
	@echo "installing planner, physics and figures into $(VENV): a minute"
	$(BIN)/python $(INSTALL) --editable .
	touch $(PLAYS)

duel: $(PLAYS)
	$(BIN)/stepaside duel

# What Python compiled is kept, whatever the shell says: tests start a hundred
# processes, and each would compile the package and the tests anew.
test: export PYTHONDONTWRITEBYTECODE :=
test: setup
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(MAKE) --no-print-directory --jobs 2 types suite

# Beside each other, so that no core waits.
types:
	$(BIN)/mypy

suite:
	$(BIN)/pytest --numprocesses auto -m "not slow"

# What takes over a second of processor time each, and no flow needs.
test-slow: export PYTHONDONTWRITEBYTECODE :=
test-slow: setup
	$(BIN)/pytest --numprocesses auto -m slow

# The Python that the next environment is made with.
python:
	@echo $(PYTHON)

# Another Python, as in make other PYTHON=python3.13: the wheel with nothing
# optional, and tests that need no more and take milliseconds.
OTHER := tests/cli/test_main.py tests/cli/test_options.py tests/core \
	tests/games/test_game_settings.py tests/games/test_match.py \
	tests/planning tests/robots/test_description.py \
	tests/robots/test_kinematics.py tests/theory/test_laws.py
other: other-setup other-test

other-setup:
	$(PYTHON) -m venv .venv-other
	.venv-other/bin/python $(INSTALL) --quiet . \
		hypothesis pytest pytest-timeout pytest-xdist

other-test:
	.venv-other/bin/python -m pytest --numprocesses auto $(OTHER)

# The wheel, installed with nothing optional: commands work, or say what lacks.
wheel: setup
	rm -rf dist .venv-wheel
	$(BIN)/python -m pip wheel --disable-pip-version-check --no-deps \
		--wheel-dir dist .
	$(BIN)/python -m venv .venv-wheel
	.venv-wheel/bin/python $(INSTALL) dist/*.whl
	.venv-wheel/bin/python tests/installed_package.py

# Wheel and source distribution in dist/, checked as a package index would.
release: setup
	rm -rf dist .venv-release
	$(BIN)/python -m venv .venv-release
	.venv-release/bin/python $(INSTALL) --quiet build twine
	.venv-release/bin/python -m build --outdir dist .
	.venv-release/bin/python -m twine check --strict dist/*

# Real ROS 2 nodes against our topics, on the loopback interface; their wheels
# are for Python 3.12. Humble has none: its middleware runs without ROS, with a
# wheel for Python 3.10. Those whose Python is missing are skipped.
PYTHON312 ?= $(call works,3.12)
PYTHON310 ?= $(call works,3.10)
ROS2 ?= $(if $(PYTHON312),jazzy kilted) $(if $(PYTHON310),humble)
ROS2_PACKAGES := rclpy rmw-fastrtps-cpp geometry-msgs nav-msgs sensor-msgs
ros2-peers: $(if $(strip $(ROS2)),setup $(ROS2:%=.venv-ros2-%/.installed))
ifeq ($(strip $(ROS2)),)
	@echo "skipped: real ROS 2 needs Python 3.12, as python3.12 on the path;" \
		"or make ros2-peers PYTHON312=/path/to/python3.12"
else
	$(BIN)/python tools/checks/ros2_peers.py $(foreach name,$(ROS2),\
		$(name)=$(if $(filter humble,$(name)),dds:).venv-ros2-$(name)/bin/python)
endif

.venv-ros2-humble/.installed:
	$(PYTHON310) -m venv .venv-ros2-humble
	.venv-ros2-humble/bin/python -m pip install --disable-pip-version-check \
		--quiet --only-binary :all: cyclonedds==0.10.2 numpy rosbags
	touch $@

.venv-ros2-%/.installed:
	$(PYTHON312) -m venv .venv-ros2-$*
	.venv-ros2-$*/bin/python -m pip install --disable-pip-version-check \
		--quiet $(ROS2_PACKAGES:%=ros-$*-%)
	touch $@

# The ament package of examples/ros2, built by colcon.
test-ament: setup .venv-colcon/.installed
	PATH="$(CURDIR)/.venv-colcon/bin:$$PATH" $(BIN)/python -m pytest \
		tests/documents/test_ros2_package.py

.venv-colcon/.installed:
	$(PYTHON) -m venv .venv-colcon
	.venv-colcon/bin/python -m pip install --disable-pip-version-check \
		--quiet colcon-ros colcon-bash "setuptools<80"
	touch $@

# The RoboCup simulator, which pins an older MuJoCo and runs with ours.
test-rcss: setup
	$(BIN)/python $(INSTALL) --quiet --no-deps --upgrade \
		--target .venv-rcss rcsssmj==0.2.1
	PYTHONPATH=$(CURDIR)/.venv-rcss $(BIN)/python -m pytest --numprocesses 2 \
		tests/drivers/test_rcss_robot.py

# Exported runs, read back by large libraries that `make setup` leaves out.
test-export: .venv-export/.installed
	.venv-export/bin/python -m pytest --numprocesses 2 \
		tests/report/test_export.py tests/report/test_large_exports.py \
		tests/robots/test_urdf_writer.py

.venv-export/.installed: pyproject.toml
	$(PYTHON) -m venv .venv-export
	.venv-export/bin/python $(INSTALL) --quiet --editable \
		".[export,viewer,vision]" "rerun-sdk>=0.41" \
		hypothesis mcap mcap-ros2-support pandas pytest pytest-timeout \
		pytest-xdist yourdfpy
	touch $@

# Faults that the tests of one package should notice: docs/testing.md
mutate: setup
	$(BIN)/python $(INSTALL) --quiet "mutmut>=3.8"
	$(BIN)/mutmut run
	$(BIN)/mutmut results

bench: setup
	$(BIN)/python $(INSTALL) --editable ".[bench]"
	$(BIN)/python tools/benchmarks/benchmark.py
	$(BIN)/python -m tools.documents

# Tables, numbers and figures of README and docs/, from docs/results/.
figures: setup
	$(BIN)/python -m tools.documents

# The documentation site, in build/site; open build/site/index.html.
docs: docs-setup
	$(BIN)/sphinx-build --quiet --fail-on-warning --keep-going \
		-d build/site-cache docs build/site
	$(BIN)/python -m tools.documents.recorded_page build/site/recorded.html
	$(BIN)/python -m tools.documents.site_links build/site
	@echo "the site is build/site/index.html"

# Tutorials whose outputs are older than the code, or make docs-run ONLY=name.
docs-run: docs-setup
	$(BIN)/python -m tools.documents.notebooks $(ONLY)

docs-setup: setup
	@$(BIN)/python -c "import furo, jupytext, myst_nb, sphinx_click" \
		2>/dev/null || $(BIN)/python $(INSTALL) --editable ".[docs]"

constraints:
	uv pip compile --universal --python-version 3.11 --all-extras \
		--no-emit-index-url --no-header --output-file constraints.txt \
		pyproject.toml

clean:
	rm -rf $(VENV) .venv-other .venv-wheel .venv-colcon .venv-export .venv-ros2-* dist runs
