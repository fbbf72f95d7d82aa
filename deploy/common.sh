# What deploy/demo and deploy/test share: sourced, not run.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build/release
. "$root/deploy/releases.sh"

say() { printf '== %s\n' "$*"; }
fail() {
    printf 'failed: %s\n' "$*" >&2
    exit 1
}

as_root() {
    if [ "$(id -u)" -eq 0 ]; then "$@"
    elif command -v sudo >/dev/null; then sudo "$@"
    else fail "needs root or sudo to run: $*"; fi
}

# Installs the packages of deploy/packages.txt for this machine's release that are missing, and nothing when none is.
install_packages() {
    local missing release
    release=$(own_release)
    is_supported "$release" || fail "this machine runs '$release'; deploy/packages.txt knows the packages of $supported_releases"
    mapfile -t missing < <(LC_ALL=C comm -23 <(packages_of "$release" | LC_ALL=C sort) \
        <(dpkg-query -W -f '${db:Status-Status} ${Package}\n' | sed -n 's/^installed //p' | LC_ALL=C sort -u))
    [ ${#missing[@]} -eq 0 ] && return
    say "installing ${#missing[@]} Debian packages: ${missing[*]}"
    as_root apt-get update -qq || fail "apt-get update: is the machine's package source reachable?"
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null ||
        fail "apt-get install: see the message above"
}

# Configures and builds the release preset. @param target  what to build; all if absent.
build_release() {
    say "building the release preset in build/release"
    cd "$root" || exit 1
    cmake --preset release >/dev/null || fail "cmake --preset release: see the message above"
    cmake --build --preset release "$@" || fail "the build"
}
