#!/bin/bash
# scripts/aarch64.sh, which is ./check aarch64: the golden frames of 200x150 pixels, drawn by a build for aarch64 (NEON)
# under qemu, have the golden hashes. Compiler, libraries and emulator lie in a bare Debian of this machine's release that
# debootstrap makes. TRUESHADE_DEBIAN=FOLDER keeps the Debian there, and goes on with it.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/setup.sh
source scripts/bare_debian.sh
source scripts/golden_frames.sh
[[ $(uname -m) != aarch64 ]] || die "./check aarch64: this machine is one, so ./check tries it"
open_bare_debian "$(suite_of_this_machine)"
copy_tree
here='cd /root/trueshade'
quietly "the packages for aarch64" inside "dpkg --add-architecture arm64 && apt-get -qq update && apt-get -qq -y --no-install-recommends install \
  g++-aarch64-linux-gnu qemu-user-static cmake ninja-build pkg-config nlohmann-json3-dev libglm-dev libhwy-dev:arm64 libtbb-dev:arm64 libdeflate-dev:arm64 zlib1g-dev:arm64"
say "building for aarch64 on $(nproc) cores"
quietly "the build for aarch64" inside "$here && cmake -S . --preset release --toolchain cmake/aarch64-linux-gnu.cmake -DTRUESHADE_PARTS=picture -DTRUESHADE_TESTS=OFF &&
  cmake --build build/release --parallel $(nproc) --target trueshade_picture"
by_qemu() { inside "$here && qemu-aarch64-static build/release/cli/trueshade-picture $*"; }
export -f by_qemu inside  # frames are drawn by shells of their own
export root here
without_light_programs=true draw_golden_frames 1 by_qemu  # a build of the picture alone has no glslang
say "aarch64 is right"
