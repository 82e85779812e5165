#!/bin/bash
# `render` and `batch` under mpirun against one process, byte by byte. Usage: mpi.sh TRUESHADE MODE
#   frames       scenes by 2, 3, 4 and 8 ranks; SIMD targets that differ; what is not shared
#   all_frames   every built-in scene by 1, 2, 3, 4 and 8 ranks
#   faults       a rank is killed, is stopped; rank 0 is killed; the disk is full; another scene; no module
#   bands        one picture by 2, 3, 4 and 8 ranks: strategies, SIMD targets, a region, a view, a large picture
#   all_bands    every built-in scene and strategy by 1, 2, 3, 4 and 8 ranks
#   resumed N    kills a rank that draws a large picture at N random times; --resume ends with the same files,
#                and goes on without the hashes of planes that ranks do not send
#   batch        a list of jobs by 2, 3 and 4 ranks; a rank that is killed; a list that differs
#   bench        `bench --ranks` by 4 ranks
#   killed N     kills a rank at N random times: what is there is whole, and --continue-without-lost ends with all
set -euo pipefail
trueshade=$(realpath "$1")
if ! command -v mpirun >/dev/null || [[ ! -e ${trueshade%/*}/trueshade_mpi.so ]]; then
  echo "SKIPPED: no mpirun, or no module trueshade_mpi.so beside the command (libopenmpi-dev, openmpi-bin)"
  exit 0
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
mpi() { timeout -k 1 100 mpirun --oversubscribe "$@" </dev/null; }
die() {
  printf '%s\n' "$@"
  exit 1
}
scenes=(city cornell circle lecture atrium)

# same RANKS WORDS...: both write the same files and the same output.
same() {
  local ranks=$1
  shift
  rm -rf one many
  mkdir one many
  (cd one && "$trueshade" render "$@" >out 2>err) || die "one process: $(<one/err)"
  (cd many && mpi -n "$ranks" "$trueshade" render "$@" >out 2>err) || die "$ranks ranks, $*: $(<many/err)"
  diff -r -x err one many || die "$ranks ranks, $*"
  [[ $(wc -l <one/out) -gt 0 || -n $(ls one/*.png) ]]
}
film=(--frames 3-9 --size 96x64 -o f.####.png -o g.exr --aov depth,normal --hash)

# without_times FILE: JSON or a table of --stats, without what a clock has measured.
without_times() { sed -E 's/"[a-z_]*_ms": [0-9.e+-]+//g; /\[ms\]/d' "$1"; }

frames() {
  local counts=(2 3 4 8) i
  for i in "${!scenes[@]}"; do same "${counts[i % 4]}" "builtin:${scenes[i]}" "${film[@]}"; done
  same 1 builtin:city "${film[@]}"
  same 3 builtin:city --frames 0-3 --size 32x32 --cube-map eye -o c.png --hash
  same 3 builtin:city --frames 0-3 --size 32x32 --raw-video -o -

  # One film by ranks of different SIMD targets; a frame by a rank of another scene is refused.
  local rank=0 words=() simd
  for simd in $("$trueshade" list --json | grep -oE '"simd": \[[^]]*' | grep -oE '[a-z0-9]+' | tail -n +2); do
    words+=(${words:+:} -n 1 "$trueshade" render builtin:atrium "${film[@]}" --simd "$simd")
  done
  rm -rf one many
  mkdir one many
  (cd one && "$trueshade" render builtin:atrium "${film[@]}" >out 2>err)
  (cd many && mpi "${words[@]}" >out 2>err) || die "SIMD targets: $(<many/err)"
  diff -r -x err one many || die "SIMD targets"

  "$trueshade" render builtin:city --frames 0-5 --size 96x64 --json -q >one.json
  mpi -n 3 "$trueshade" render builtin:city --frames 0-5 --size 96x64 --json -q >many.json
  diff <(without_times one.json) <(without_times many.json) >/dev/null || die "--json"
  "$trueshade" render builtin:city --frames 0-5 --size 96x64 --stats -q >one.stats
  mpi -n 3 "$trueshade" render builtin:city --frames 0-5 --size 96x64 --stats -q >many.stats
  diff <(without_times one.stats) <(without_times many.stats) || die "--stats"

  # What is not shared rank 0 does alone.
  [[ $(mpi -n 3 "$trueshade" --version) == "$("$trueshade" --version)" ]] || die "--version"
  [[ $(mpi -n 3 "$trueshade" render --help) == "$("$trueshade" render --help)" ]] || die "--help"
  [[ $(mpi -n 3 "$trueshade" render builtin:city --size 32x32 --hash) == "$("$trueshade" render builtin:city --size 32x32 --hash)" ]] ||
    die "one picture"
  status=0
  mpi -n 3 "$trueshade" render builtin:city --frames 5 --size 32 --hash >out 2>err || status=$?
  [[ $status == 2 && $(grep -c 'trueshade: error' err) == 1 ]] || die "a wrong option: $status, $(<err)"
}

all_frames() {
  local scene count
  scenes+=(rabbits sphere red)
  for scene in "${scenes[@]}"; do
    for count in 1 2 3 4 8; do same "$count" "builtin:$scene" "${film[@]}"; done
  done
  same 3 builtin:city,lights=9 --frames 0-2 --size 6000x6000 --raw-video -o -  # 144 MB a frame: messages in pieces
}

# ranks_of NAME: numbers of processes and their ranks, of the run whose output folder is NAME.
ranks_of() {
  local process rank
  for process in $(pgrep -f "^$trueshade render builtin:lecture.*$1/"); do
    rank=$(tr '\0' '\n' 2>/dev/null </proc/"$process"/environ | sed -n 's/^OMPI_COMM_WORLD_RANK=//p') || true
    [[ -n $rank ]] && echo "$process $rank"
  done
}

# strike SIGNAL RANK SECONDS WORDS... -- MPI_WORDS...: starts a film in folder `hit` by 4 ranks, and sends one of them a
# signal. Sets status and seconds; whatever is written is what one process writes.
strike() {
  local signal=$1 rank=$2 after=$3 words=() process i
  shift 3
  while [[ $1 != -- ]]; do words+=("$1") && shift; done
  shift
  rm -rf hit
  mkdir hit
  SECONDS=0 status=0
  mpi "$@" -n 4 "$trueshade" render "${long_film[@]}" -o "$work/hit/f.####.png" "${words[@]}" >hit/out 2>hit.err &
  local job=$!
  until [[ -s hit/out ]] || ! kill -0 "$job" 2>/dev/null; do sleep 0.02; done  # the ranks have joined
  sleep "$after"
  process=$(ranks_of hit | sed -n "s/ $rank\$//p")
  [[ -n $process ]] && kill "-$signal" "$process"
  wait "$job" || status=$?
  seconds=$SECONDS
  for picture in hit/*.png; do
    [[ -e $picture ]] || continue
    cmp -s "$picture" "whole/${picture#hit/}" || die "$picture is not what one process writes"
  done
  [[ -z $(find hit -name '.trueshade-*') ]] || die "a part of a file is left"
  cmp -s <(head -n "$(wc -l <hit/out)" whole/out) hit/out || die "standard output is not the beginning of the whole"
  for i in {1..100}; do
    [[ -z $(ranks_of hit) ]] && return
    sleep 0.05
  done
  die "ranks are left: $(ranks_of hit)"
}
long_film=(builtin:lecture --frames 0-39 --size 640x480 --hash -q)
whole() {
  mkdir -p whole
  "$trueshade" render "${long_film[@]}" -o "$work/whole/f.####.png" >whole/out
}
all_there() { [[ $(ls hit/*.png | wc -l) == 40 && $(wc -l <hit/out) == 40 ]]; }

faults() {
  whole
  strike KILL 2 0.2 --
  [[ $status == 137 || $status == 5 ]] || die "a killed rank: $status, $(<hit.err)"
  strike STOP 2 0.2 --lost-after 2 --
  all_there || [[ $status == 5 && $(<hit.err) == *"rank 2 on "*": nothing was heard of it for 2 s"* ]] || die "a stopped rank: $status, $(<hit.err)"
  strike STOP 1 0.2 --lost-after 2 --continue-without-lost -- --enable-recovery
  all_there || die "a stopped rank, without it: $status, $(<hit.err)"
  strike KILL 0 0.2 -- --enable-recovery
  ((seconds < 20)) || die "rank 0 was killed, and the others took $seconds s"

  status=0
  mpi -n 1 "$trueshade" render builtin:city --frames 0-9 --hash : \
    -n 1 "$trueshade" render builtin:city,seed=4 --frames 0-9 --hash >out 2>err || status=$?
  [[ $status == 3 && $(<err) == *"rank 1 on "*": its scene is '"* ]] || die "another scene: $status, $(<err)"

  # What rank 0 finds ends the others at once.
  local words
  for words in "render nosuch.json --frames 0-3" "render builtin:red --frames 0-3 -o /dev/null/x.png" \
    "bench --ranks nosuch.json" "bench --ranks --frames 0-1 --size 17000x16 builtin:red" "batch nosuch.json"; do
    SECONDS=0 status=0
    mpi -n 3 "$trueshade" $words >out 2>err || status=$?
    [[ ($status == 5 || $status == 2) && $(grep -c 'trueshade: error' err) == 1 ]] || die "$words: $status, $(<err)"
    ((SECONDS < 9)) || die "$words: it took $SECONDS s to end"
  done

  # One rank lacks the scene.
  mpi --enable-recovery -n 1 "$trueshade" render builtin:city --size 99x99 --frames 0-3 -o r.png --continue-without-lost : \
    -n 1 "$trueshade" render nosuch.json --size 99x99 --frames 0-3 -o r.png --continue-without-lost >out 2>err
  [[ -e r.0003.png && $(<err) != *"Signal"* ]] || die "a rank without a scene: $(<err)"

  status=0
  mpi -n 3 bash -c 'ulimit -f 20; exec "$@"' bash "$trueshade" render builtin:lecture --frames 0-9 --size 640x480 -o "$work/full.png" >out 2>err || status=$?
  [[ $status == 5 && $(grep -c 'trueshade: error' err) == 1 && $(<err) == *"full.0000.png: cannot write"* ]] ||
    die "a full disk: $status, $(<err)"

  mkdir alone
  cp "$trueshade" alone
  status=0
  mpi -n 3 alone/"${trueshade##*/}" render builtin:city --frames 0-9 --hash >out 2>err || status=$?
  [[ $status == 5 && $(grep -c 'trueshade: error: trueshade_mpi.so: ' err) == 1 && ! -s out ]] || die "no module: $status, $(<err)"
}

killed() {
  local i rank after finished=0
  whole
  for ((i = 0; i < $1; ++i)); do
    rank=$((1 + RANDOM % 3)) after=0.$((RANDOM % 90 + 10))
    strike KILL "$rank" "$after" --continue-without-lost -- --enable-recovery
    all_there || die "rank $rank was killed after $after s, and the others did not finish: $(<hit.err)"
    finished=$((finished + 1))
    strike KILL $((RANDOM % 4)) "$after" --
  done
  echo "$finished runs lost a rank and ended with all frames"
}

strategies=(forward-multipass forward-loop deferred-volumes deferred-loop)
picture=(--size 150x110 -o a.png -o b.exr --aov depth,normal,light.count --hash)

bands() {
  local counts=(2 3 4 8) i words=() simd
  for i in "${!strategies[@]}"; do
    same "${counts[i]}" "builtin:${scenes[i]}" "${picture[@]}" --strategy "${strategies[i]}"
  done
  # What is measured of the whole picture before its bands: a scale, extents, a mean.
  same 3 builtin:city "${picture[@]}" --region 30,20,90x70 --view light-count
  same 2 builtin:city "${picture[@]}" --view position
  echo '{"post": {"tone_map": "reinhard", "encode": "srgb", "output": "rgba8"}}' >tones.json
  same 4 builtin:city --size 150x110 -o a.png --hash --pipeline "$work/tones.json" --target rgba16f
  same 3 builtin:city --size 16500x600 -o a.png --hash --pipeline "$work/tones.json" --target rgba16f
  same 3 builtin:city --size 16500x200 -o a.png -o b.exr --aov depth --hash
  same 2 builtin:city --size 16500x200 --frames 1-2 -o a.png --hash
  for simd in $("$trueshade" list --json | grep -oE '"simd": \[[^]]*' | grep -oE '[a-z0-9]+' | tail -n +2); do
    words+=(${words:+:} -n 1 "$trueshade" render builtin:atrium "${picture[@]}" --simd "$simd")
  done
  rm -rf one many
  mkdir one many
  (cd one && "$trueshade" render builtin:atrium "${picture[@]}" >out 2>err)
  (cd many && mpi "${words[@]}" >out 2>err) || die "SIMD targets: $(<many/err)"
  diff -r -x err one many || die "SIMD targets"
}

all_bands() {
  local scene strategy count
  scenes+=(rabbits sphere red)
  for scene in "${scenes[@]}"; do
    for strategy in "${strategies[@]}"; do
      for count in 1 2 3 4 8; do same "$count" "builtin:$scene" "${picture[@]}" --strategy "$strategy"; done
    done
  done
}

# jobs COUNT: COUNT jobs that draw, as many that read what was drawn, one that fails and one after it.
jobs() {
  local i list=""
  for ((i = 0; i < $1; ++i)); do
    list+="{\"name\": \"draw$i\", \"run\": [\"render\", \"builtin:city,seed=$i\", \"--size\", \"64x48\", \"--hash\", \"-o\", \"$i.png\"]},"
    list+="{\"name\": \"read$i\", \"after\": [\"draw$i\"], \"run\": [\"info\", \"$i.png\"]},"
  done
  list+='{"name": "none", "run": ["info", "there_is_none.png"]}, {"name": "after", "after": ["none"], "run": ["info", "builtin:red"]}'
  echo "{\"jobs\": [$list]}"
}

# without_clock FILE: the rows of a table of jobs without their seconds, and the files written without the size of those
# that hold seconds: the same whoever ran them.
without_clock() { sed -E 's/^([a-z]+ +)[0-9.]+ +/\1/; s/\(JSON, [0-9]+ kB\)/(JSON)/' "$1"; }

batch() {
  local count status
  mkdir one
  jobs 12 >one/jobs.json
  status=0
  "$trueshade" batch one/jobs.json -q >/dev/null || status=$?
  [[ $status == 1 ]] || die "one process: $status"
  (cd one && "$trueshade" batch jobs.json --state none.state --json all.json >out 2>err) || true
  for count in 2 3 4; do
    rm -rf many
    mkdir many
    cp one/jobs.json many
    status=0
    (cd many && mpi -n "$count" "$trueshade" batch jobs.json --json all.json >out 2>err) || status=$?
    [[ $status == 1 ]] || die "$count ranks: $status, $(<many/err)"
    diff <(without_clock one/out) <(without_clock many/out) || die "$count ranks: another table"
    diff -r -x '*.state' -x out -x err -x '*.json' one many || die "$count ranks: other files"
    (cd many && mpi -n "$count" "$trueshade" batch jobs.json --resume -q >out 2>err) || true
    [[ $(<many/out) == *"24 of 26 jobs passed, 24 of them unchanged, 1 failed, 1 skipped"* ]] ||
      die "$count ranks resumed: $(<many/out)"
  done

  # A rank is killed: its jobs are done by others.
  rm -rf many
  mkdir many
  jobs 40 >many/jobs.json
  status=0
  (cd many && mpi --enable-recovery -n 3 "$trueshade" batch "$work/many/jobs.json" --continue-without-lost -q >out 2>err) &
  local job=$! process=""
  until [[ -e many/5.png ]] || ! kill -0 "$job" 2>/dev/null; do sleep 0.02; done
  for process in $(pgrep -f "^$trueshade batch .*many/jobs.json"); do
    [[ $(tr '\0' '\n' 2>/dev/null </proc/"$process"/environ | sed -n 's/^OMPI_COMM_WORLD_RANK=//p') == 1 ]] && kill -KILL "$process"
  done
  wait "$job" || true
  [[ $(<many/out) == *"80 of 82 jobs passed, 1 failed, 1 skipped"* ]] || die "a killed rank: $(<many/out) $(<many/err)"

  # A rank reads another list.
  jobs 3 >other.json
  mkdir -p a b
  cp one/jobs.json a && cp other.json b/jobs.json
  status=0
  mpi -n 1 --wdir "$work/a" "$trueshade" batch jobs.json : -n 1 --wdir "$work/b" "$trueshade" batch jobs.json >out 2>err || status=$?
  [[ $status == 3 && $(<err) == *"rank 1 on "*": its list of jobs is '"* ]] || die "another list: $status, $(<err)"
}

bench() {
  mpi -n 4 "$trueshade" bench --ranks builtin:lecture --size 320x240 --json bands.json >out 2>err || die "bands: $(<err)"
  mpi -n 3 "$trueshade" bench --ranks builtin:lecture --size 64x48 --frames 1-9 --json - >frames.json 2>err || die "frames: $(<err)"
  [[ $(grep -o '"ranks": [0-9]*' bands.json | tr '\n' ' ') == '"ranks": 1 "ranks": 2 "ranks": 4 ' ]] || die "$(<bands.json)"
  [[ $(grep -o '"ranks": [0-9]*' frames.json | tr '\n' ' ') == '"ranks": 1 "ranks": 2 "ranks": 3 ' ]] || die "$(<frames.json)"
  [[ $(wc -l <frames.json) == 1 && $(ls) == $'bands.json\nerr\nframes.json\nout' ]] || die "$(ls)"
}

# A picture with planes that ranks have begun goes on, but not where --json asks for the hashes of planes.
planes_resumed() {
  local large=(builtin:lecture --size 17000x5000 --aov depth --hash)
  rm -rf whole hit
  mkdir whole hit
  "$trueshade" render "${large[@]}" -o whole/a.exr -q >whole/out
  mpi -n 3 "$trueshade" render "${large[@]}" -o "$work/hit/a.exr" -q >/dev/null 2>&1 &
  until [[ -e hit/a.exr.progress ]] || ! kill -0 $! 2>/dev/null; do sleep 0.02; done
  kill -KILL $(ranks_of hit | sed 's/ .*//') || die "no rank is left to be killed: $(ls -A hit)"
  wait $! || true
  cp -r hit begun
  "$trueshade" render "${large[@]}" -o "$work/hit/a.exr" --resume >hit.out 2>hit.err || die "$(<hit.err)"
  [[ $(<hit.err) == *"The picture goes on after "* ]] || die "it did not go on: $(<hit.err)"
  cmp whole/out hit.out && cmp whole/a.exr hit/a.exr || die "planes: another picture"
  cp begun/* hit
  "$trueshade" render "${large[@]}" -o "$work/hit/a.exr" --resume --json >hit.out 2>hit.err || die "$(<hit.err)"
  [[ $(<hit.err) == *"The picture begins anew, because the hashes of planes "* ]] || die "no reason: $(<hit.err)"
  cmp whole/a.exr hit/a.exr || die "planes: another picture with --json"
}

resumed() {
  planes_resumed
  rm -rf whole begun
  local i rank after status went_on=0 large=(builtin:lecture --size 17000x20000 --hash -q)
  mkdir whole
  "$trueshade" render "${large[@]}" -o whole/a.png -o whole/a.exr >whole/out
  for ((i = 0; i < $1; ++i)); do
    rm -rf hit
    mkdir hit
    rank=$((RANDOM % 4)) after=$((RANDOM % 6)).$((RANDOM % 90 + 10)) status=0
    mpi -n 4 "$trueshade" render "${large[@]}" -o "$work/hit/a.png" -o "$work/hit/a.exr" >hit.out 2>hit.err &
    local job=$!
    sleep "$after"
    kill -KILL $(ranks_of hit | sed -n "s/ $rank\$//p") 2>/dev/null || true
    wait "$job" || status=$?
    ((status == 0)) || [[ ! -e hit/a.exr ]] || die "a picture is there although its last rank was killed"
    [[ -e hit/a.png.progress ]] && went_on=$((went_on + 1))
    if ((i % 2 == 0)); then
      mpi -n 3 "$trueshade" render "${large[@]}" -o "$work/hit/a.png" -o "$work/hit/a.exr" --resume >hit.out 2>hit.err
    else
      "$trueshade" render "${large[@]}" -o "$work/hit/a.png" -o "$work/hit/a.exr" --resume >hit.out 2>hit.err
    fi || die "rank $rank was killed after $after s: $(<hit.err)"
    cmp whole/out hit.out || die "another hash: rank $rank was killed after $after s"
    cmp whole/a.exr hit/a.exr && cmp whole/a.png hit/a.png || die "other files: rank $rank, $after s"
    [[ $(ls -A hit | wc -l) == 2 ]] || die "more than the files is left: $(ls -A hit)"
  done
  echo "$1 pictures whose rank was killed have the same hash; $went_on of them went on from a note"
}

"${@:2}"
