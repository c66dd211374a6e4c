#!/usr/bin/env bash
# Fuzzes one folder of the corpus after the other, each for so many seconds of processor time, and prints
# the rows of the record (tests/records/fuzz-mocap.md). A folder is named after its target, or after the
# format of captures or weights that the target `capture` is to read.
#
#   cargo +nightly fuzz build && fuzz/run.sh LOGS [FOLDER...]     all folders by default
#   fuzz/run.sh --record LOGS                                      the rows of what has been run
#
# FUZZ_SECONDS (600) of each; FUZZ_BIN is the folder of the built targets. What is found lies in
# LOGS/found, named TARGET-crash-... and the like. Rounds of a minute are run until the processor
# has worked long enough: on a busy machine that is longer than the clock says.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)

record() {
  echo "| target | processor time | runs | coverage (edges) | inputs kept | found |"
  echo "|---|---|---|---|---|---|"
  for times in "$1"/*.times; do
    target=$(basename "$times" .times)
    found=$(find "$1/found" -name "$target-*" | wc -l)
    awk -v target="$target" -v found="$found" '
      FILENAME ~ /\.times$/ { cpu += $1; runs += $2; next }
      match($0, /cov: [0-9]+/) { cov = substr($0, RSTART + 5, RLENGTH - 5) }
      match($0, /corp: [0-9]+/) { kept = substr($0, RSTART + 6, RLENGTH - 6) }
      END { printf "| `%s` | %d s | %d | %d | %d | %s |\n", target, cpu, runs, cov, kept, found ? found : "nothing" }
    ' "$times" "$1/$target.log"
  done
}

if [ "$1" = --record ]; then record "$2"; exit; fi

logs=$1; shift
bin=${FUZZ_BIN:-$here/target/x86_64-unknown-linux-gnu/release}
mkdir -p "$logs/found"
[ $# -gt 0 ] || set -- $(ls "$here/corpus")
for target; do
  program=$target
  [ -e "$here/fuzz_targets/$target.rs" ] || program=capture
  export FUZZ_FORMAT=$target
  corpus=$logs/corpus/$target
  mkdir -p "$corpus"
  : > "$logs/$target.times"
  spent=0
  while [ "$spent" -lt "${FUZZ_SECONDS:-600}" ]; do
    round=$logs/$target.round
    status=0
    TIMEFORMAT='cpu %U %S'
    { time "$bin/$program" "$corpus" "$here/corpus/$target" -max_total_time=60 -timeout=25 \
        -rss_limit_mb=2048 -artifact_prefix="$logs/found/$target-" -print_final_stats=1 \
        > "$round" 2>&1; } 2> "$round.time" || status=$?
    runs=$(awk '/stat::number_of_executed_units/ { print $2 }' "$round")
    awk -v runs="${runs:-0}" '/^cpu/ { print int($2 + $3 + 0.5), runs }' "$round.time" >> "$logs/$target.times"
    spent=$(awk '{ s += $1 } END { print s + 0 }' "$logs/$target.times")
    cat "$round" >> "$logs/$target.log"
    rm -f "$round" "$round.time"
    # A finding ends the target: it is to be mended first.
    [ "$status" -eq 0 ] || { echo "$target: exit $status, see $logs/$target.log" >&2; break; }
  done
done
record "$logs"
