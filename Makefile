# The two commands: `make demo` and `make test`, each from a fresh clone on Debian 12, as root or with sudo.
# Everything else is a step of theirs, or a longer check.

PRESET ?= release
BUILD := build/$(PRESET)
VIEWER_SOURCES := $(shell find viewer -path viewer/node_modules -prune -o -path viewer/dist -prune -o -type f -print 2>/dev/null)
export SKYBAKE_COMPILER_LAUNCHER ?= $(shell command -v ccache 2>/dev/null)

.PHONY: demo test build program viewer packages unit asan tsan fuzz bench format tidy clean

demo: program
	$(BUILD)/bin/skybake demo demo $(DEMO_FLAGS)

test: build
	tools/test $(BUILD)

build: program
	cmake --build --preset $(PRESET)

program: packages viewer
	cmake --preset $(PRESET) >/dev/null
	cmake --build --preset $(PRESET) --target skybake_program

packages:
	tools/install-packages

viewer: viewer/dist/index.html
# Not `npm ci`: npm 11 refuses a lock file when the registry does not list the optional packages of other platforms.
viewer/dist/index.html: $(VIEWER_SOURCES) schema/manifest.schema.json | packages
	cd viewer && npm install --no-save --no-audit --no-fund && npm run build

unit: build
	ctest --preset $(PRESET) -L unit

asan:
	$(MAKE) sanitized PRESET=asan
tsan:
	$(MAKE) sanitized PRESET=tsan
.PHONY: sanitized
sanitized: build
	ctest --preset $(PRESET) -L 'unit|stat'

# The readers on damaged files, FUZZ_SECONDS each: tools/fuzz says what it found.
FUZZ_SECONDS ?= 60
fuzz: packages
	cmake --preset fuzz >/dev/null
	cmake --build --preset fuzz
	tools/fuzz build/fuzz $(FUZZ_SECONDS)

bench: build
	bench/run $(BUILD)

format:
	git ls-files '*.h' '*.cpp' | xargs clang-format -i
tidy: build
	git ls-files 'src/*.cpp' 'apps/*.cpp' | xargs -P 2 -n 1 clang-tidy -p $(BUILD) --quiet

clean:
	rm -rf build viewer/dist
