# Sourced by run.

# @param 1 the file to write: the run's log with times, and the observer's trace around each fault.
write_report() {
    {
        echo "# The system in containers under faults"
        echo
        echo "Made by \`deploy/containers/run --report integration_tests/results/containers.md\`, $(uname -m), $(nproc) processors, $(date -u +%Y-%m-%d)."
        echo
        echo '```'
        cat "$logs/steps.log"
        echo "$passed passed, $failed failed"
        echo '```'
        echo
        echo "## The packages"
        echo
        echo '```'
        for package in "$build"/quorient_*.deb "$build"/quorient-dev_*.deb; do
            dpkg-deb --info "$package" | sed -n 's/^ \(Package\|Version\|Depends\|Suggests\|Installed-Size\)/\1/p'
            dpkg-deb --contents "$package" | awk '$1 !~ /^d/ {print "  " $6}' | grep -v '/include/'
        done
        echo '```'
        echo
        if command -v lintian >/dev/null; then
            echo "\`lintian quorient_*.deb quorient-dev_*.deb\`:"
            echo
            echo '```'
            lintian --tag-display-limit 0 "$build"/quorient_*.deb "$build"/quorient-dev_*.deb 2>&1
            echo '```'
            echo
        fi
        echo "What the plain subscriber in the container \`observer\` received around each fault; bounds: integration_tests/containers/scenario.py."
        echo
        cat "$logs/trace.md"
    } >"$1"
}
