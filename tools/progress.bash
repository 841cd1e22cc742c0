# shellcheck shell=bash
# One line that says how far something is, on standard error: rewritten on a terminal, and elsewhere
# one for each tenth part, as a log is read later.
#   progress_begin building steps;  progress 12 560;  progress_clear

progress_begin() {
  progress_what=$1 progress_of=$2
  progress_done=0 progress_total=0 progress_tenth=-1 progress_since=$SECONDS
}

progress() {
  progress_done=$1 progress_total=$2
  [ -t 2 ] && { progress_draw; return; }
  local tenth=$((10 * $1 / $2))
  [ "$tenth" -gt "$progress_tenth" ] || return 0
  progress_tenth=$tenth
  progress_say
  echo "armature: $progress_text" >&2
}

# Puts the line into progress_text. The time left supposes that the rest goes as what is done went.
progress_say() {
  progress_text="$progress_what ..."
  [ "$progress_total" -gt 0 ] || return 0
  local passed=$((SECONDS - progress_since)) left=
  if [ "$passed" -ge 5 ] && [ "$progress_done" -gt 0 ]; then
    local seconds=$((passed * (progress_total - progress_done) / progress_done))
    left=", about $seconds s left"
    [ "$seconds" -lt 100 ] || left=", about $(((seconds + 30) / 60)) min left"
  fi
  progress_text="$progress_what: $((100 * progress_done / progress_total)) %,"
  progress_text+=" $progress_done of $progress_total $progress_of$left"
}

progress_draw() {
  progress_say
  printf '\r\033[Karmature: %s' "$progress_text" >&2
}

# Before anything else is printed.
progress_clear() {
  [ ! -t 2 ] || printf '\r\033[K' >&2
}

# Calls "$1" with each line of standard input; the time left goes on between them.
each_line() {
  local piece part='' ended
  while true; do
    ended=0
    IFS= read -r -t 1 piece || ended=$?
    part+=$piece
    if [ "$ended" -eq 0 ]; then
      "$1" "$part"
      part=
    elif [ "$ended" -le 128 ]; then  # the end; above, a second has passed
      [ -z "$part" ] || "$1" "$part"
      return 0
    elif [ -t 2 ]; then
      progress_draw
    fi
  done
}
