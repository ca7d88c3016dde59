#!/bin/sh
# The first commands of README.md on a machine that has nothing yet: a new minimal Debian 12 in a folder of its own, into which the
# committed tree comes, and .ci/run, or what GLINT_FRESH_RUN names (`dev readme`: all of README.md's commands). Speaks TAP on stdout; what
# the commands say goes to stderr. ./dev fresh calls this.
#
# fresh_machine.sh FILE.deb, which ./dev package calls, installs that package there instead, by apt alone, and runs what it holds.
#
# Needs root, debootstrap, git, and 10 GB in $TMPDIR (/var/tmp when unset). Mirrors, proxies and keys are those of this machine's apt.
# GLINT_FRESH_KEEP=1 leaves the folder behind when something fails.
set -eu
release=bookworm
tree=$(cd "$(dirname "$0")/.." && pwd)

bail() {
    printf 'Bail out! %s\n' "$*"
    exit 1
}

# URI and suite of Debian's own sources, with this machine's release replaced by the one wanted: main, its updates, its security.
sources() {
    here=$(. /etc/os-release && echo "${VERSION_CODENAME-}")
    apt-get indextargets --format '$(ORIGIN) $(REPO_URI) $(CODENAME) $(COMPONENT)' 'Created-By: Packages' |
        awk -v here="$here" -v wanted="$release" '
            $1 == "Debian" && $2 ~ /^https?:/ && $4 == "main" && index($3, here) == 1 {
                kind = substr($3, length(here) + 1)
                line = $2 " " wanted kind
                if ((kind == "" || kind == "-updates" || kind == "-security") && !seen[line]++) print line
            }'
}

# The same as apt's on this machine, for wget, which debootstrap uses.
use_proxies() {
    eval "$(apt-config shell http Acquire::http::Proxy https Acquire::https::Proxy)"
    case ${http-} in http*) export http_proxy="$http" ;; esac
    case ${https-} in http*) export https_proxy="$https" ;; esac
}

# How packages get there: where from, through which proxy, signed by whom. Which files of it are kept, and hooks of programs that the
# new machine does not have, are no part of that.
configure_apt() {
    awk '{ print "deb " $1 " " $2 " main" }' "$work/sources" >"$root/etc/apt/sources.list"
    apt-config dump | grep '^Acquire::' | grep -Ev '^Acquire::(IndexTargets|CompressionTypes|Changelogs|cdrom)|Auto-?Detect' \
        >"$root/etc/apt/apt.conf.d/90from-outside"
    for file in /etc/apt/trusted.gpg /etc/apt/trusted.gpg.d /etc/apt/auth.conf /etc/apt/auth.conf.d; do
        [ ! -e $file ] || cp -rpL $file "$root/etc/apt/"
    done
    if grep -q ^https: "$work/sources" && [ -e /etc/ssl/certs/ca-certificates.crt ]; then
        cp -L /etc/ssl/certs/ca-certificates.crt "$root/etc/apt/outside.crt"
        echo 'Acquire::https::CaInfo "/etc/apt/outside.crt";' >>"$root/etc/apt/apt.conf.d/90from-outside"
    fi
    echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/unsafe-io" # the machine is thrown away: no waiting for the disk
    for file in /etc/resolv.conf /etc/hosts; do
        [ ! -e $file ] || cp -L $file "$root/etc/"
    done
}

put_tree() {
    tar -x -C "$root/root/glint" -f "$work/tree.tar"
    what="the first commands of README.md" run="/root/glint/${GLINT_FRESH_RUN:-.ci/run}"
}

# Nothing but the package and what it depends on and recommends comes in. Man pages are among what a minimal Debian keeps from its disk.
put_package() {
    what="the package installs, runs, and is removed without a trace" run="sh -e /root/glint/use"
    cp "$work/glint.deb" "$root/root/glint/"
    cat >"$root/root/glint/use" <<'END'
cd /root/glint
apt-get update -q
DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 apt-get install -y -q ./glint.deb
dpkg --verify glint
glint --version
glint devices
glint sample room --size 96x54 --cube-size 16 -o room.exr
glint validate room.exr
glint replay room.exr -o run
glint view run -o run.png
glint extract room.exr -o textures
glint pack textures/manifest.json -o again.exr
cmp room.exr again.exr
glint export run -o run.exr --multilayer
zcat /usr/share/man/man1/glint-replay.1.gz | grep -q '^.Dt GLINT-REPLAY 1'
apt-get purge -y -q glint
[ -z "$(find / -xdev -path /root -prune -o -path /proc -prune -o -name '*glint*' ! -path '/var/lib/apt/*' ! -path '/var/log/*' ! -path '/var/cache/*' -print)" ]
echo "1 passed, 0 failed"
END
}

# Runs in namespaces of its own: what it mounts and starts is gone when it ends, however that comes about.
inside() {
    work=$1 root=$1/root
    mirror=$(awk -v wanted="$release" '$2 == wanted { print $1; exit }' "$work/sources")
    use_proxies
    debootstrap --variant=minbase "$release" "$root" "$mirror" >&2 || bail "debootstrap $release from $mirror ended with $?"
    configure_apt
    mkdir "$root/root/glint"
    if [ -e "$work/glint.deb" ]; then put_package; else put_tree; fi
    mount -t proc proc "$root/proc"
    for folder in dev sys; do mount --rbind /$folder "$root/$folder"; done
    echo "ok 1 - a new Debian ($release)"
    { env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root TERM=dumb \
        ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} ${no_proxy:+no_proxy="$no_proxy"} \
        ${GLINT_PATIENCE:+GLINT_PATIENCE="$GLINT_PATIENCE"} \
        chroot "$root" $run 2>&1 </dev/null && : >"$work/passed"; } | tee "$work/said" >&2
    last=$(tail -n 1 "$work/said")
    if [ -e "$work/passed" ]; then
        printf 'ok 2 - %s\n# %s\n' "$what" "$last"
    else
        printf 'not ok 2 - %s\n' "$what"
        tail -n 30 "$work/said" | sed 's/^/# /'
        exit 1
    fi
}

clean_up() {
    status=$?
    trap - EXIT
    [ -z "${child-}" ] || kill -KILL "$child" 2>/dev/null || true
    if [ $status != 0 ] && [ -n "${GLINT_FRESH_KEEP-}" ]; then
        echo "# left to look at: $work/root"
        exit $status
    fi
    rm -rf --one-file-system "$work" || { sleep 2; rm -rf --one-file-system "$work"; } # what was killed may still have been writing
    exit $status
}

outside() {
    for program in debootstrap git unshare; do
        command -v $program >/dev/null || bail "$program is not installed: ./dev fresh installs it"
    done
    work=$(mktemp -d "${TMPDIR:-/var/tmp}/glint-fresh-XXXXXX")
    trap clean_up EXIT
    trap 'exit 130' INT
    trap 'exit 143' TERM HUP
    chmod 755 "$work" # apt downloads as another user
    [ "$(df -k --output=avail "$work" | tail -n 1)" -gt 10000000 ] || bail "less than 10 GB are free in ${work%/*}: TMPDIR=ELSEWHERE"
    unshare --mount --pid --fork true 2>/dev/null || bail "this system does not let root mount (a container without privileges?)"
    # The tree may belong to somebody else than root.
    if [ $# = 1 ]; then
        cp "$1" "$work/glint.deb" || bail "cannot read the package $1"
    else
        git -c safe.directory='*' -C "$tree" archive HEAD >"$work/tree.tar" || bail "$tree is no clone"
        [ -z "$(git -c safe.directory='*' -C "$tree" status --porcelain)" ] || echo "# what is not committed is left out"
    fi
    sources >"$work/sources"
    grep -q " $release\$" "$work/sources" ||
        printf '%s\n' "http://deb.debian.org/debian $release" "http://deb.debian.org/debian-security $release-security" >"$work/sources"
    echo 1..2
    unshare --mount --propagation private --pid --fork --kill-child "$0" inside "$work" &
    child=$!
    wait $child
    child=
}

if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || bail "needs root, and there is no sudo"
    exec sudo env ${TMPDIR:+TMPDIR="$TMPDIR"} ${GLINT_FRESH_KEEP:+GLINT_FRESH_KEEP=1} ${GLINT_PATIENCE:+GLINT_PATIENCE="$GLINT_PATIENCE"} \
        ${GLINT_FRESH_RUN:+GLINT_FRESH_RUN="$GLINT_FRESH_RUN"} "$0" "$@"
fi
if [ "${1-}" = inside ]; then inside "$2"; else outside "$@"; fi
