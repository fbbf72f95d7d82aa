# Sourced. daemon_up: uses a running Docker daemon, else starts one; daemon_down: stops only what daemon_up started.

daemon_pid=''
daemon_log=${TMPDIR:-/tmp}/quorient-dockerd.$$.log

daemon_answers() { timeout 10 docker version --format '{{.Server.Version}}' >/dev/null 2>&1; }

# As /etc/init.d/docker does where no init has mounted them; nothing where they are.
mount_control_groups() {
    local subsystem
    mountpoint -q /sys/fs/cgroup || mount -t tmpfs -o mode=0755 cgroup /sys/fs/cgroup || return 1
    [ -e /sys/fs/cgroup/cgroup.controllers ] && return 0
    for subsystem in $(awk '!/^#/ && $4 == 1 {print $1}' /proc/cgroups); do
        mountpoint -q "/sys/fs/cgroup/$subsystem" && continue
        mkdir -p "/sys/fs/cgroup/$subsystem"
        mount -n -t cgroup -o "$subsystem" cgroup "/sys/fs/cgroup/$subsystem" 2>/dev/null || rmdir "/sys/fs/cgroup/$subsystem"
    done
}

daemon_up() {
    daemon_answers && return 0
    [ "$(id -u)" -eq 0 ] || { daemon_problem="no Docker daemon answers, and starting one needs root"; return 1; }
    mount_control_groups
    # A pid file of a daemon that is gone keeps the next one from starting once the number belongs to somebody else.
    local file=/var/run/docker.pid attempt
    if [ -s $file ] && ! grep -qsx dockerd "/proc/$(cat $file)/comm"; then rm -f $file; fi
    setsid dockerd --log-level=warn </dev/null >"$daemon_log" 2>&1 &
    daemon_pid=$!
    for attempt in $(seq 150); do
        daemon_answers && return 0
        kill -0 "$daemon_pid" 2>/dev/null || break
        sleep 0.2
    done
    daemon_down
    daemon_problem="dockerd does not start here: $(grep -v '^$' "$daemon_log" | tail -1)"
    return 1
}

daemon_down() {
    [ -n "$daemon_pid" ] || return 0
    local attempt
    kill -TERM "$daemon_pid" 2>/dev/null
    for attempt in $(seq 100); do
        kill -0 "$daemon_pid" 2>/dev/null || break
        sleep 0.2
    done
    kill -KILL "$daemon_pid" 2>/dev/null
    wait "$daemon_pid" 2>/dev/null
    daemon_pid=''
    rm -f "$daemon_log"
}
