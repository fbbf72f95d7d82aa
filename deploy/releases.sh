# Sourced. Debian releases: their packages, and roots of them made from this machine's own package sources.

supported_releases='bookworm trixie'

is_supported() { case " $supported_releases " in *" $1 "*) true ;; *) false ;; esac; }

# The release that this machine runs, by its code name.
own_release() { (. /etc/os-release && echo "${VERSION_CODENAME:-}"); }

# The names in deploy/packages.txt for a release. @param 1 release
packages_of() {
    sed -e '/^#/d' -e "s/^$1: *//" -e '/:/d' "$root/deploy/packages.txt"
}

# "address suite" of every Debian package source this machine itself uses, for a release: no host name is written down here.
# @param 1 release
package_sources() {
    local own
    own=$(own_release)
    apt-get indextargets --format '$(REPO_URI) $(RELEASE)' 'Created-By: Packages' | sort -u |
        sed -nE "s/ $own(-updates|-security)?\$/ $1\\1/p"
}

# A minimal Debian in a new folder, with this machine's package sources. What debootstrap mounts ends with it.
# @param 1 release  @param 2 folder
make_debian() {
    local mirror
    mirror=$(package_sources "$1" | awk -v release="$1" '$2 == release {print $1; exit}')
    [ -n "$mirror" ] || { echo "this machine has no package source for $1" >&2; return 1; }
    unshare --mount debootstrap --variant=minbase "$1" "$2" "$mirror" >"$2.log" 2>&1 || { tail -20 "$2.log" >&2; rm -rf --one-file-system "$2" "$2.log"; return 1; }
    rm -f "$2.log"
    package_sources "$1" | awk '{print "deb " $1 " " $2 " main"}' >"$2/etc/apt/sources.list"
}
