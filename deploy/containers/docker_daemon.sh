# Sourced. daemon_up: uses the Docker daemon that answers, else starts one of our own, which shares nothing with the machine's:
# its images, networks, sockets and mounts go with it. daemon_down: stops and removes that one.

daemon_folder=''
daemon_pid=''
daemon_group=''

daemon_answers() { timeout 10 docker version --format '{{.Server.Version}}' >/dev/null 2>&1; }

# In the daemon's own mount namespace, as /etc/init.d/docker does where no init has mounted them; nothing where they are.
mount_control_groups='
    mountpoint -q /sys/fs/cgroup || mount -t tmpfs -o mode=0755 cgroup /sys/fs/cgroup
    [ -e /sys/fs/cgroup/cgroup.controllers ] && exit 0
    for subsystem in $(awk "!/^#/ && \$4 == 1 {print \$1}" /proc/cgroups); do
        mountpoint -q "/sys/fs/cgroup/$subsystem" && continue
        mkdir -p "/sys/fs/cgroup/$subsystem"
        mount -n -t cgroup -o "$subsystem" cgroup "/sys/fs/cgroup/$subsystem" 2>/dev/null || rmdir "/sys/fs/cgroup/$subsystem"
    done'

# What the daemon changes on the machine beside its folder: the firewall, and forwarding.
keep_network() {
    local table
    for table in filter nat; do iptables-save -t $table 2>/dev/null | sed 's/ \[[0-9:]*\]$//' >"$daemon_folder/firewall.$table"; done
    cat /proc/sys/net/ipv4/ip_forward >"$daemon_folder/forwarding"
}

restore_network() {
    local table
    for table in filter nat; do
        [ -s "$daemon_folder/firewall.$table" ] && iptables-restore -T $table <"$daemon_folder/firewall.$table"
    done
    cat "$daemon_folder/forwarding" >/proc/sys/net/ipv4/ip_forward
}

# @param more options of dockerd.  @returns 0 once it answers.
daemon_start() {
    local attempt
    setsid unshare --mount sh -c "($mount_control_groups); exec \"\$@\"" sh dockerd --log-level=warn --host "$DOCKER_HOST" \
        --data-root "$daemon_folder/data" --exec-root "$daemon_folder/exec" --pidfile "$daemon_folder/pid" \
        --cgroup-parent "$daemon_group" --bridge=none "$@" </dev/null >>"$daemon_folder/log" 2>&1 &
    daemon_pid=$!
    for attempt in $(seq 150); do
        daemon_answers && return 0
        kill -0 "$daemon_pid" 2>/dev/null || break
        sleep 0.2
    done
    daemon_stop
    return 1
}

daemon_stop() {
    local attempt
    kill -TERM "$daemon_pid" 2>/dev/null
    for attempt in $(seq 150); do
        kill -0 "$daemon_pid" 2>/dev/null || break
        sleep 0.2
    done
    kill -KILL "$daemon_pid" 2>/dev/null
    wait "$daemon_pid" 2>/dev/null
    daemon_pid=''
}

# Where the kernel has no overlay file system, or this one is an overlay already, images are copied; where it has no firewall, none is needed
# between networks that lead nowhere.
daemon_up() {
    daemon_answers && return 0
    [ "$(id -u)" -eq 0 ] || { daemon_problem="no Docker daemon answers, and starting one needs root"; return 1; }
    daemon_folder=$(mktemp -d /var/tmp/quorient-docker.XXXXXX)
    daemon_group=/quorient-$$
    export DOCKER_HOST=unix://$daemon_folder/socket
    keep_network
    daemon_start || daemon_start --iptables=false || daemon_start --iptables=false --storage-driver=vfs || {
        daemon_problem="dockerd does not start here: $(grep -v '^$' "$daemon_folder/log" | tail -1)"
        daemon_remove
        return 1
    }
    # As the daemon sees them: on this machine they may not be mounted.
    export QUORIENT_CONTROL_GROUPS=/proc/$daemon_pid/root/sys/fs/cgroup
    prefer_containers
}

# Before whatever else this machine does: a busy machine must not look like a fault.
prefer_containers() {
    local folder=$QUORIENT_CONTROL_GROUPS/cpu$daemon_group
    [ -e "$QUORIENT_CONTROL_GROUPS/cpu/cpu.shares" ] && mkdir -p "$folder" && echo 262144 >"$folder/cpu.shares"
}

daemon_remove() {
    unset DOCKER_HOST
    restore_network
    rm -rf --one-file-system "$daemon_folder"
    daemon_folder=''
}

daemon_down() {
    [ -n "$daemon_pid" ] || return 0
    find "$QUORIENT_CONTROL_GROUPS" -depth -type d -path "*$daemon_group*" -exec rmdir {} + 2>/dev/null
    daemon_stop
    daemon_remove
}
