# How every command of the launcher speaks: one line for each step, a log for its noise, one sentence for an error.

readonly exit_failure=1 exit_usage=2 exit_prerequisite=3

# fail CODE SENTENCE: says what went wrong and leaves.
fail() {
  fail_code=$1
  shift
  printf 'mesograin: %s\n' "$*" >&2
  exit "$fail_code"
}

# as_root COMMAND...: runs it with root's rights; sudo's own question for a password reaches the terminal.
as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  else
    sudo "$@"
  fi
}

# may_become_root WHAT BY_HAND: leaves with what to run by hand when there is no way to become root.
may_become_root() {
  if [ "$(id -u)" -ne 0 ] && ! command -v sudo >/dev/null; then
    fail "$exit_prerequisite" "$1 needs root and there is no sudo. As root, run: $2"
  fi
}

# follow TITLE LOG: shows a step's title and, on a terminal, keeps the last "[done/total]" of its log at the line's end.
# It waits a moment first, so that a step that finds nothing to do stays silent.
follow() {
  sleep 0.5
  : >"$2.shown"
  printf '%s ... ' "$1" >&2
  while [ -t 2 ] && sleep 1; do
    done_of_total=$(tail -n 1 "$2" | sed -n 's/^\(\[[0-9]*\/[0-9]*\]\).*/\1/p')
    [ -z "$done_of_total" ] || printf '\r%s ... %s ' "$1" "$done_of_total" >&2
  done
}

# step TITLE LOG_NAME COMMAND...: runs a command with its output in a log; 0 or the command's exit code.
step() {
  step_title=$1
  step_log=$logs/$2.log
  shift 2
  mkdir -p "$logs"
  : >"$step_log"
  rm -f "$step_log.shown"
  step_start=$(date +%s)
  follow "$step_title" "$step_log" &
  step_follower=$!
  step_code=0
  "$@" >"$step_log" 2>&1 </dev/null || step_code=$?
  kill "$step_follower" 2>/dev/null || :
  wait "$step_follower" 2>/dev/null || :
  if [ ! -e "$step_log.shown" ]; then
    [ "$step_code" -ne 0 ] || [ "$(tail -n 1 "$step_log")" != "ninja: no work to do." ] || return 0
    printf '%s ... ' "$step_title" >&2
  fi
  rm -f "$step_log.shown"
  [ ! -t 2 ] || printf '\r\033[K%s ... ' "$step_title" >&2
  if [ "$step_code" -eq 0 ]; then
    printf '%d s\n' $(($(date +%s) - step_start)) >&2
  else
    printf 'failed\n' >&2
  fi
  return "$step_code"
}

# step_failed CODE SENTENCE: shows what matters of the last step's log, Ninja's first failure or the end, then leaves.
step_failed() {
  step_failed_code=$1
  shift
  if grep -q '^FAILED: ' "$step_log"; then
    sed -n '/^FAILED: /,$p' "$step_log" | head -n 40 >&2
  else
    tail -n 40 "$step_log" >&2
  fi
  fail "$step_failed_code" "$* The whole log: $step_log"
}
