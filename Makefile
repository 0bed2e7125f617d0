# Set-up and the main jobs. Each target is complete on a fresh Debian 12 machine that has Rust, gcc and make.
#
#   make demo                      build, validate three scenes of scenes/, bench one, and put all on one page, out/report.html
#   make test                      every test
#   make test-scenes SCENES=DIR    the tests over scenes that are not part of this repository
#   make lint                      formatting and warnings
#   make aimed-rays RAYS=1700000   the tests of rays aimed at edges, corners and the like, with so many of each kind
#   make hard-cases                the 47 hard cases at 17 resolutions from 1 to 2048, by one and two threads, in debug and release
#   make differential-fuzzing SECONDS=3600   random small scenes for so long, all testers against each other
#   make fuzz RUNS=1200000        every loader under libFuzzer, with so many executions of each
#   make farm                      shards, resuming and merging under Slurm (one node, as root) and GNU parallel, for real
#   make planted-bugs              plant known bugs one by one and show which tests catch them
#   make mutants MUTANTS=...       cargo-mutants over geometry, light buffer and verdicts; MUTANTS are more of its options
#   make deny                      licences, sources and known holes of all dependencies
#   make c-library                 header, static and shared library and lightbuffer.pc for C and C++, in target/c
#   make install-c PREFIX=/usr/local   the same below a prefix; LIBDIR and DESTDIR as usual
#   make deb                       Debian packages of the program and the C library, in target/debian
#   make packages                  install the Debian packages that are missing, and nothing else
#   make clean-demo                remove what `make demo` left

CARGO ?= cargo
DEMO_SIZE := 1280x720
# Brute force would take as long as all others together.
DEMO_TESTERS := bounding-volumes,light-buffer,irregular-z-buffer,shadow-buffer,embree,embree-fast

# A fresh rustup is not in PATH before the next login.
export PATH := $(PATH):$(HOME)/.cargo/bin

.DEFAULT_GOAL := help
.PHONY: help packages build-packages demo test test-scenes lint deny aimed-rays hard-cases differential-fuzzing fuzz planted-bugs mutants farm c-library install-c deb clean-demo

help:
	@sed -n 's/^#   //p' Makefile

packages:
	@bash scripts/packages.sh

# Without what only tests need.
build-packages:
	@bash scripts/packages.sh --build-only

# Neither a compiler nor an arbiter at work says much by itself.
RUN := bash scripts/with_heartbeat.sh
PROGRAM := target/release/lightbuffer

demo: build-packages
	@$(RUN) "building lightbuffer" $(CARGO) build --release
	@HEARTBEAT=without-bars $(RUN) "validating blocks" $(PROGRAM) validate scenes/blocks.obj --size $(DEMO_SIZE) -o out/blocks
	@HEARTBEAT=without-bars $(RUN) "validating courtyard" $(PROGRAM) validate scenes/courtyard.glb --size $(DEMO_SIZE) \
		--testers $(DEMO_TESTERS) -o out/courtyard
	@HEARTBEAT=without-bars $(RUN) "validating blocks-lights" $(PROGRAM) validate scenes/blocks-lights.toml --size $(DEMO_SIZE) -o out/blocks-lights
	@$(RUN) "measuring courtyard" $(PROGRAM) bench scenes/courtyard.glb --size 480x270 --repeats 3 \
		--finalists 2 --resolution 64,128,256,512 -o out/bench
	@$(PROGRAM) report out -q -o out/report.html
	@echo "Images, difference maps and verdicts are in $(CURDIR)/out/: blocks, courtyard, blocks-lights, bench"
	@echo "All of it on one page, for a browser: $(CURDIR)/out/report.html"

# The library's own tests run in debug too: overflow checks and assertions see what release does not. So does the
# one that holds the masks of both profiles against each other.
test: packages
	$(CARGO) test --release --no-fail-fast
	$(CARGO) test --lib
	$(CARGO) test --test cross_check masks_do_not_depend_on_the_build_profile

# One test after another: they print times, and each of them uses all threads.
test-scenes: packages
	@if [ -z "$(SCENES)" ]; then \
		echo "make test-scenes needs a folder with scenes: make test-scenes SCENES=folder" >&2; exit 2; fi
	@if [ ! -d "$(SCENES)" ]; then \
		echo "make test-scenes: there is no folder $(SCENES); say make test-scenes SCENES=folder" >&2; exit 2; fi
	SCENES="$$(cd "$(SCENES)" && pwd)" \
		$(CARGO) test --release --features test-scenes --test shared_scenes --test shared_databases --test shared_ray_trees -- --nocapture --test-threads=1

lint: packages
	$(CARGO) fmt --check
	$(CARGO) fmt --check --manifest-path fuzz/Cargo.toml
	$(CARGO) clippy --all-targets -- -D warnings
	@tests/planted_bugs.sh --where

# A good part of them see nothing or face away: so many leave a million queries of each kind.
RAYS ?= 1700000
aimed-rays: packages
	AIMED_RAYS=$(RAYS) $(CARGO) test --release --test aimed_rays -- --nocapture --test-threads=1

hard-cases: packages
	HARD_CASES_EVERY_RESOLUTION=1 $(CARGO) test --release --test hard_cases -- --test-threads=1
	HARD_CASES_EVERY_RESOLUTION=1 $(CARGO) test --test hard_cases -- --test-threads=1

# Not a part of `make lint`: building cargo-deny takes longer than all tests, and its database of holes needs a network.
deny:
	@bash scripts/deny.sh

SECONDS ?= 60
differential-fuzzing: packages
	$(CARGO) run --release -- fuzz --seconds $(SECONDS) -o out/findings

RUNS ?= 1200000
fuzz: packages
	RUNS=$(RUNS) bash fuzz/run.sh

# Needs Debian's slurmctld, slurmd, slurm-client, munge and parallel, and root.
farm: build-packages
	$(CARGO) build --release
	@bash scripts/farm/test.sh $(PROGRAM)

planted-bugs: packages
	bash tests/planted_bugs.sh

# Hours. `MUTANTS="-f src/geometry/cone.rs"` looks at one file. What it leaves out and why is in
# .cargo/mutants.toml. Without shrinking a failed property costs no more than a passed one.
MUTANTS ?= -f 'src/geometry/**' -f 'src/shadow/light_buffer/**' -f 'src/verdict/**'
mutants: packages
	@$(CARGO) mutants --version > /dev/null 2>&1 || { \
		echo "make mutants needs cargo-mutants: cargo install --locked cargo-mutants" >&2; exit 2; }
	PROPTEST_MAX_SHRINK_ITERS=0 PROPTEST_DISABLE_FAILURE_PERSISTENCE=1 \
		$(CARGO) mutants --output out $(MUTANTS)

c-library: build-packages
	@bash scripts/c_library.sh target/c
	@echo "The C library is in $(CURDIR)/target/c"

# Root need not build anything.
PREFIX ?= /usr/local
LIBDIR ?= lib
install-c:
	@[ -f target/c/lib/liblightbuffer.a ] || { echo "make install-c: first say make c-library" >&2; exit 2; }
	@PREFIX="$(PREFIX)" LIBDIR="$(LIBDIR)" DESTDIR="$(DESTDIR)" bash scripts/install_c.sh target/c

deb: build-packages
	@bash scripts/deb.sh

clean-demo:
	rm -rf out/blocks out/courtyard out/blocks-lights out/bench out/report.html
