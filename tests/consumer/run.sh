#!/bin/bash
# Installs a build into a fresh prefix, and builds programs against it with find_package(trueshade): tests/consumer, which is
# run, built by pkg-config too, and every program (`cpp`) of a guide that has a `cmake` block, which are built with that block and run. Usage: run.sh BUILD_FOLDER SOURCE_FOLDER COMPILER CXX_FLAGS
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$1" --prefix "$work/prefix" >"$work/install.log" || { cat "$work/install.log"; exit 1; }

# build FOLDER NAME COMPILER CXX_FLAGS: the project in FOLDER, into $work/build/NAME.
build() {
  cmake -S "$1" -B "$work/build/$2" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$3" \
    -DCMAKE_CXX_FLAGS="$4" -DCMAKE_PREFIX_PATH="$work/prefix"
  cmake --build "$work/build/$2"
}

build "$2/tests/consumer" consumer "$3" "$4"
read -r hash lit < <("$work/build/consumer/consumer" "$work/picture.png")
echo "hash $hash, $lit pixels lit"
[[ $hash =~ ^[0-9a-f]{64}$ && $lit -gt 400 && -s $work/picture.png ]]
"$work/prefix/bin/trueshade" info "$work/picture.png"

# By pkg-config, in a prefix that was moved: the same picture. TSan's and ASan's flags are in CXX_FLAGS.
mv "$work/prefix" "$work/moved"
pc=$(find "$work/moved" -name trueshade-image-io.pc -printf '%h\n')
by_pkg_config() { PKG_CONFIG_PATH=$pc pkg-config "$@" trueshade-image-io; }
# shellcheck disable=SC2046  # flags are words
"$3" $4 -O2 $(by_pkg_config --cflags) "$2/tests/consumer/main.cpp" -o "$work/by_pkg_config" $(by_pkg_config --libs)
[[ $("$work/by_pkg_config" "$work/again.png") == "$hash $lit" ]]
mv "$work/moved" "$work/prefix"
for schema in $(grep -o '[a-z]*\.schema\.json' < <("$work/prefix/bin/trueshade" list)); do
  [[ -s $work/prefix/share/trueshade/$schema ]]
done
[[ -s $work/prefix/share/trueshade/scene.schema.json ]]

# block LANGUAGE NUMBER PAGE: the lines of the page's block of that language and number, from 1.
block() {
  awk -v tag="\`\`\`$1" -v wanted="$2" '$0 == "```" { inside = 0 } inside { print } $0 == tag { inside = ++seen == wanted }' "$3"
}

programs=0
while IFS=: read -r page count; do
  for ((number = 1; number <= count; ++number)); do
    name=program$((++programs))
    mkdir "$work/$name"
    { printf 'cmake_minimum_required(VERSION 3.25)\nproject(shown LANGUAGES CXX)\nadd_executable(program main.cpp)\n'
      block cmake 1 "$page"; } >"$work/$name/CMakeLists.txt"
    block cpp "$number" "$page" >"$work/$name/main.cpp"
    echo "$page, program $number:"
    build "$work/$name" "$name" "$3" "$4"
    (cd "$work/$name" && "$work/build/$name/program")
  done
done < <(grep -l '^```cmake$' "$2/README.md" "$2"/docs/*.md | xargs grep -cH '^```cpp$')
((programs > 0)) || { echo "no guide shows a program"; exit 1; }
