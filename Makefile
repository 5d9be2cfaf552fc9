# Two commands do everything, their own set-up included: `make demo` and `make test`.
.PHONY: demo test tested collected setup lint peers lock pictures package audit docs fuzz

PYTHON = .venv/bin/python
COMPILING = tests/test_docs.py tests/fingertip/array/test_contours.py tests/fingertip/array/test_layer.py

demo: setup
	.venv/bin/skinfab make meshes/robot_finger.obj -o demo_out
	@echo
	@echo "Results are in demo_out/: open demo_out/report.html in a browser; G-code is in demo_out/gcode/, moulds in demo_out/mould/."

# The many processes that tests start find what they import compiled; of two workers each computes on one core.
# With -j the tests begin while the types are still being looked at.
test: lint tested

tested: export PYTHONDONTWRITEBYTECODE =
tested: export OMP_NUM_THREADS = 1
tested: export OPENBLAS_NUM_THREADS = 1
tested: peers collected
	@# Stealing leaves files whole but for a few: what the tests of a file share is made once. (loadgroup groups nothing with pytest 9.2 and xdist 3.8.)
	@# What was run to have it compiled is not run once more.
	$(PYTHON) -m pytest -q -W error -n 2 --dist worksteal --doctest-modules $(COMPILING:%=--ignore=%) skinfab gcode calibration tests

# The tests' files are compiled here, while the linters and the peers leave a core free: both workers at once would do it twice.
# So are the loops that numba compiles, by the tests that need most of them.
collected: setup
	@$(PYTHON) -m pytest -q -W error --collect-only --doctest-modules skinfab gcode calibration tests >.venv/collected || { cat .venv/collected; exit 1; }
	@$(PYTHON) -m pytest -q -W error $(COMPILING) >.venv/collected || { cat .venv/collected; exit 1; }

# Programs of others that tests compare with.
peers: setup
	@for one in tests/setup_*.sh; do $$one || { [ -z "$$CI" ] && echo "test: going on without $$one; the tests that need it are skipped"; } || exit 1; done

lint: setup
	$(PYTHON) -m ruff check .
	$(PYTHON) -m ruff format --check .
	$(PYTHON) -m mypy

setup:
	@tools/setup.sh

lock:
	$(PYTHON) tools/lock.py
	$(PYTHON) tools/licences.py

# Source distribution and wheel into dist/, and the wheel tried outside the source tree, with the dependencies that it asks for.
package: setup
	$(PYTHON) tools/package.py dist --clean

# Known weaknesses of the locked packages, asked of PyPI: pip-audit in an environment of its own. It fails, too, where PyPI cannot be asked.
audit: setup
	@test -x .venv-audit/bin/pip-audit || { $(PYTHON) -m venv .venv-audit && .venv-audit/bin/python -m pip install --quiet --only-binary :all: pip-audit; }
	.venv-audit/bin/pip-audit --strict --disable-pip --no-deps -r requirements.lock

# The reference of all that can be called from Python, into site/ (26 s of processor time).
docs: setup
	@$(PYTHON) -c "import mkdocs, mkdocstrings" 2>/dev/null || tools/extra.sh docs
	$(PYTHON) tools/api.py site

# Each parser searched for a minute, or as long as `make fuzz SECONDS=...` says; findings lie in .fuzz/.
SECONDS = 60
fuzz: setup
	@$(PYTHON) -c "import atheris" 2>/dev/null || tools/extra.sh fuzz
	@$(PYTHON) tests/fuzz/search.py $(SECONDS)

pictures: demo
	@mkdir -p docs/pictures
	cp demo_out/preview.png docs/pictures/robot_finger.png
	$(PYTHON) tools/draw_patterns.py
	$(PYTHON) tools/draw_commands.py
	@tests/setup_gui.sh && $(PYTHON) tools/draw_gui.py
