#!/usr/bin/env bash
# Does a law that a scene does not name cost anything? Builds the haptics twice, as they are and with
# the law's file removed, and times a tick of a scene without it, taking turns.
#   tests/bench/without_law.sh [coulomb|rupture]
set -euo pipefail
law=${1:-coulomb}
type=${law^}Law
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for kind in with without; do
  mkdir "$work/$kind"
  cp -r "$root"/{CMakeLists.txt,packaging,modules,plugins,tests} "$work/$kind"
  [[ -d $root/app ]] && cp -r "$root"/{app,ui,resources} "$work/$kind"
done
cd "$work/without/modules/haptics"
rm "laws/$law.h" "laws/$law.cpp"
sed -i "s# *laws/$law.cpp##" CMakeLists.txt
sed -i -e "\#laws/$law.h#d" -e "s/, $type//; s/$type, //" -e "s/, $law}/}/; s/$law, //" \
  -e "/{\"$law\", LawKind::$law}/s/{\"$law\", LawKind::$law},\{0,1\}//" laws.h
for kind in with without; do
  cmake -S "$work/$kind" -B "$work/build-$kind" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DTREPHINE_WINDOW=OFF >/dev/null
  cmake --build "$work/build-$kind" --target bench_laws >/dev/null
done
find "$work" -name bench_laws -type f | sort >"$work/programs"
for _ in 1 2 3 4 5 6 7 8 9; do
  for kind in with without; do
    "$(grep "/build-$kind/" "$work/programs")" >>"$work/$kind.ns"
  done
done
median() { sort -n "$1" | sed -n 5p; }
echo "$law: with its file $(median "$work/with.ns") ns a tick, without it $(median "$work/without.ns") ns"
