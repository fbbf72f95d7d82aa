# Sourced. The base image and the product's, without a registry.

base=debian:bookworm-slim
release=bookworm

# "address suite" of every Debian package source this machine itself uses: no host name is written down here.
package_sources() {
    apt-get indextargets --format '$(REPO_URI) $(RELEASE)' 'Created-By: Packages' | sort -u | grep -E " ($release|$release-updates|$release-security)\$"
}

# A base image under the public one's name, so that an ordinary Dockerfile serves both here and where there is a registry.
# An image of that name that is already there is used.
make_base_image() {
    docker image inspect $base >/dev/null 2>&1 && return 0
    local folder mirror
    mirror=$(package_sources | awk -v release=$release '$2 == release {print $1; exit}')
    [ -n "$mirror" ] || { echo "this machine has no package source for $release" >&2; return 1; }
    folder=$(mktemp -d /var/tmp/quorient-base.XXXXXX)
    debootstrap --variant=minbase $release "$folder" "$mirror" >"$folder.log" 2>&1 || { tail -20 "$folder.log" >&2; rm -rf "$folder" "$folder.log"; return 1; }
    package_sources | awk '{print "deb " $1 " " $2 " main"}' >"$folder/etc/apt/sources.list"
    tar -C "$folder" --numeric-owner --exclude='./var/cache/apt/archives/*.deb' --exclude='./var/lib/apt/lists/*_*' --exclude='./dev/*' \
        --exclude=./etc/resolv.conf --exclude=./etc/hostname -c . | docker import -c 'CMD ["bash"]' - $base >/dev/null
    local code=$?
    rm -rf --one-file-system "$folder" "$folder.log"
    return $code
}

# @param 1 tag  @param 2 build folder, with its packages  @param 3 log file
make_image() {
    local context code package
    package=$(ls -t "$2"/quorient_*.deb | head -1)
    context=$(mktemp -d "${TMPDIR:-/tmp}/quorient-image.XXXXXX")
    cp "$package" "$context/quorient.deb" && cp "$2/bin/quorient-observer" "$context/" &&
        DOCKER_BUILDKIT=0 docker build --network=host --force-rm -t "$1" -f "$root/deploy/images/Dockerfile.packages" "$context" >"$3" 2>&1
    code=$?
    rm -rf "$context"
    [ $code -eq 0 ] || tail -20 "$3" >&2
    return $code
}
