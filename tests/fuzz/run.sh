#!/usr/bin/env bash
# Builds the fuzz programs with clang and runs one of them on spoilt files.
#
# usage: run.sh import|exercise SOURCE BUILD [SECONDS]
#   SECONDS: 60, or what TREPHINE_FUZZ_SECONDS says
# Exit code 77: cannot be run here, with the reason.
set -euo pipefail
what=$1
source=$2
build=$3
seconds=${4:-${TREPHINE_FUZZ_SECONDS:-60}}

skip() {
  echo "fuzz: skipped: $*"
  exit 77
}
case $what in
  import)
    [[ -n ${TREPHINE_TEST_DATA:-} ]] || skip "TREPHINE_TEST_DATA is not set: seeds are taken from it"
    [[ -d $TREPHINE_TEST_DATA/hard ]] || skip "TREPHINE_TEST_DATA holds no folder 'hard'"
    corpus=$build/corpus
    seeds=(fuzz_seeds "$source/tests/unit/imaging/data" "$TREPHINE_TEST_DATA/hard")
    options=(-dict="$source/tests/fuzz/import.dict" -max_len=65536 -malloc_limit_mb=600
             -rss_limit_mb=2048)
    ;;
  exercise)
    corpus=$build/corpus_exercise
    seeds=(fuzz_exercise_seeds)
    options=(-max_len=400000 -malloc_limit_mb=2048 -rss_limit_mb=4096)
    ;;
  *) echo "run.sh: there is no fuzzer '$what'" >&2; exit 2 ;;
esac
command -v clang++ >/dev/null || skip "there is no clang++: install the packages clang and libclang-rt-14-dev"

cmake -S "$source" -B "$build" -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ \
  -DCMAKE_BUILD_TYPE=RelWithDebInfo -DTREPHINE_FUZZ=ON -DTREPHINE_WINDOW=OFF -DTREPHINE_TESTS=OFF
cmake --build "$build" --target "fuzz_$what" "${seeds[0]}" --parallel 2

# Each input is a file or a folder of files: in memory where there is a place for them.
work=$(mktemp -d "$([[ -w /dev/shm ]] && echo /dev/shm || echo "${TMPDIR:-/tmp}")/trephine-fuzz-XXXXXX")
trap 'rm -rf "$work"' EXIT
export TMPDIR=$work
# The guard of allocations (base/rt) has operators of its own, which libFuzzer's meet halfway.
export ASAN_OPTIONS=alloc_dealloc_mismatch=0:malloc_context_size=8:quarantine_size_mb=64:allocator_may_return_null=1:detect_odr_violation=0
export LSAN_OPTIONS=suppressions=$source/tests/fuzz/leaks.supp:print_suppressions=0
export UBSAN_OPTIONS=print_stacktrace=1

mkdir -p "$corpus" "$build/findings"
"$build/bin/${seeds[0]}" "$work/seeds" "${seeds[@]:1}"

# -timeout is time by the clock; the program itself bounds the processor time (README.md).
"$build/bin/fuzz_$what" "$corpus" "$work/seeds" "${options[@]}" -max_total_time="$seconds" \
  -timeout=30 -artifact_prefix="$build/findings/" -print_final_stats=1 -use_value_profile=0
