#!/usr/bin/env bash
# Builds the fuzz programs with clang and runs the importer on spoilt files.
#
# usage: run.sh SOURCE BUILD [SECONDS]     SECONDS: 60, or what TREPHINE_FUZZ_SECONDS says
# Exit code 77: cannot be run here, with the reason.
set -euo pipefail
source=$1
build=$2
seconds=${3:-${TREPHINE_FUZZ_SECONDS:-60}}

skip() {
  echo "fuzz: skipped: $*"
  exit 77
}
[[ -n ${TREPHINE_TEST_DATA:-} ]] || skip "TREPHINE_TEST_DATA is not set: seeds are taken from it"
[[ -d $TREPHINE_TEST_DATA/hard ]] || skip "TREPHINE_TEST_DATA holds no folder 'hard'"
command -v clang++ >/dev/null || skip "there is no clang++: install the packages clang and libclang-rt-14-dev"

cmake -S "$source" -B "$build" -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ \
  -DCMAKE_BUILD_TYPE=RelWithDebInfo -DTREPHINE_FUZZ=ON -DTREPHINE_WINDOW=OFF -DTREPHINE_TESTS=OFF
cmake --build "$build" --target fuzz_import fuzz_seeds --parallel 2

# Each input is a folder of files: in memory where there is a place for them.
work=$(mktemp -d "$([[ -w /dev/shm ]] && echo /dev/shm || echo "${TMPDIR:-/tmp}")/trephine-fuzz-XXXXXX")
trap 'rm -rf "$work"' EXIT
export TMPDIR=$work
here=$source/tests/fuzz
export ASAN_OPTIONS=malloc_context_size=8:quarantine_size_mb=64:allocator_may_return_null=1:detect_odr_violation=0
export LSAN_OPTIONS=suppressions=$here/leaks.supp:print_suppressions=0
export UBSAN_OPTIONS=print_stacktrace=1

corpus=$build/corpus
mkdir -p "$corpus" "$build/findings"
"$build/bin/fuzz_seeds" "$work/seeds" "$source/tests/unit/imaging/data" "$TREPHINE_TEST_DATA/hard"

# -timeout is time by the clock; fuzz_import itself bounds the processor time (README.md).
"$build/bin/fuzz_import" "$corpus" "$work/seeds" -dict="$here/import.dict" \
  -max_total_time="$seconds" -max_len=65536 -timeout=30 -malloc_limit_mb=600 -rss_limit_mb=2048 \
  -artifact_prefix="$build/findings/" -print_final_stats=1 -use_value_profile=0
