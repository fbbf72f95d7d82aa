# Sourced, behind deploy/common.sh. The base image and the product's, without a registry.

base=debian:bookworm-slim
release=bookworm

# A base image under the public one's name, so that an ordinary Dockerfile serves both here and where there is a registry.
# An image of that name that is already there is used.
make_base_image() {
    docker image inspect $base >/dev/null 2>&1 && return 0
    local folder
    folder=$(mktemp -d /var/tmp/quorient-base.XXXXXX)
    make_debian $release "$folder" || return 1
    tar -C "$folder" --numeric-owner --exclude='./var/cache/apt/archives/*.deb' --exclude='./var/lib/apt/lists/*_*' --exclude='./dev/*' \
        --exclude=./etc/resolv.conf --exclude=./etc/hostname -c . | docker import -c 'CMD ["bash"]' - $base >/dev/null
    local code=$?
    rm -rf --one-file-system "$folder"
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
