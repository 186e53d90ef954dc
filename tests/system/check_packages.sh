#!/bin/sh
# usage: check_packages.sh SOURCE_DIR
# packages.txt holds its three sections, none empty, each in order, and no name twice.
list="$1/packaging/packages.txt"
bad=0
say() {
  echo "packages.txt: $1"
  bad=1
}

names=$(grep -v -e '^#' -e '^\[' -e '^$' "$list")
[ -n "$names" ] || say "holds no package"
[ "$(grep '^\[' "$list" | tr '\n' ' ')" = "[run] [build] [test] " ] || say "sections differ"
for name in $(echo "$names" | sort | uniq -d); do say "$name stands there twice"; done
for section in run build test; do
  part=$(sed -n "/^\[$section\]/,/^\[/p" "$list" | grep -v -e '^#' -e '^\[' -e '^$')
  [ -n "$part" ] || say "[$section] is empty"
  [ "$part" = "$(echo "$part" | LC_ALL=C sort)" ] || say "[$section] is not in alphabetical order"
done
echo "$(echo "$names" | wc -l) packages checked"
exit $bad
