# shellcheck shell=bash
# What play, check and docker/prove share: calm one-line steps, and children that never outlive their
# script. To be sourced, after `set -euo pipefail`.

export LC_ALL=C.UTF-8

die() {
    printf '%s: %s\n' "${0##*/}" "$1" >&2
    exit "${2:-1}"
}

duration_text() {
    if [ "$1" -ge 60 ]; then
        printf '%dm %02ds' $(($1 / 60)) $(($1 % 60))
    else
        printf '%ds' "$1"
    fi
}

# As many compilers as there are cores, and fewer where memory would not hold them.
job_count() {
    local cores by_memory
    cores=$(nproc)
    by_memory=$(awk '/^MemAvailable:/ { print int($2 / 1200000) }' /proc/meminfo)
    if [ "$by_memory" -lt 1 ]; then by_memory=1; fi
    if [ "$by_memory" -lt "$cores" ]; then printf '%d' "$by_memory"; else printf '%d' "$cores"; fi
}

children=()
on_exit=()  # functions to call once the children have ended

# start_child COMMAND...: runs it in a process group of its own; the group's id is in $child. Whatever
# becomes of this script, even a kill -9, the command is told to end.
start_child() {
    setsid setpriv --pdeathsig TERM "$@" </dev/null 8>&- &
    child=$!
    children+=("$child")
}

group_lives() {
    kill -0 -- "-$1" 2>/dev/null
}

# stop_child PID SECONDS: asks the group to end, and insists when the time is over.
stop_child() {
    local waited_ds=0
    kill -TERM -- "-$1" 2>/dev/null || return 0
    while group_lives "$1" && [ "$waited_ds" -lt $(($2 * 10)) ]; do
        sleep 0.1
        waited_ds=$((waited_ds + 1))
    done
    kill -KILL -- "-$1" 2>/dev/null || true
}

leave() {
    local pid action
    trap '' INT TERM HUP
    for pid in "${children[@]}"; do stop_child "$pid" 20; done
    for action in "${on_exit[@]}"; do "$action"; done
}
trap leave EXIT
trap 'printf "\nStopped.\n"; exit 130' INT
trap 'printf "\nStopped.\n"; exit 143' TERM HUP

# wait_child PID [SECONDS]: its exit status; 124 when it had to be stopped because the time was over.
wait_child() {
    local pid=$1 limit_s=${2:-0} began_s=$SECONDS status=0
    while [ "$limit_s" -gt 0 ] && kill -0 "$pid" 2>/dev/null; do
        if [ $((SECONDS - began_s)) -ge "$limit_s" ]; then
            stop_child "$pid" 5
            return 124
        fi
        sleep 0.1
    done
    { wait "$pid"; } 2>/dev/null || status=$?
    return "$status"
}

# On a terminal a long step shows how far ninja or ctest has come; elsewhere nothing is overwritten.
show_progress() {
    local pid=$1 log=$2 title=$3 progress
    [ -t 1 ] || return 0
    while kill -0 "$pid" 2>/dev/null; do
        progress=$(tail -c 400 "$log" 2>/dev/null |
            grep -aoE '\[[0-9]+/[0-9]+\]|[0-9]+/[0-9]+ Test' | tail -n 1) || true
        printf '\r%-36s %-16s' "$title" "${progress% Test}"
        sleep 0.3
    done
    printf '\r%-36s %16s\r%-36s ' "$title" '' "$title"
}

# end_of LOG: its last lines, without those that only tell what went well.
end_of() {
    grep -vE '^\[[0-9]+/[0-9]+\] |^ *(Start +[0-9]+:|[0-9]+/[0-9]+ Test .* Passed )' "$1" | tail -n "${2:-40}" || true
}

# step TITLE LOG COMMAND...: one line: the title, then `ok` or `FAILED` and how long it took. Output goes
# to the log. $step_s is the duration; the status is the command's.
step() {
    local title=$1 log=$2 began_s=$SECONDS status=0
    shift 2
    mkdir -p "$(dirname "$log")"
    printf '%-36s ' "$title"
    start_child "$@" >"$log" 2>&1
    show_progress "$child" "$log" "$title"
    wait_child "$child" || status=$?
    step_s=$((SECONDS - began_s))
    if [ "$status" -eq 0 ]; then
        printf 'ok      %s\n' "$(duration_text "$step_s")"
    else
        printf 'FAILED  %s\n' "$(duration_text "$step_s")"
    fi
    return "$status"
}
