#!/bin/sh
# @NAME@, self-contained: unpacks itself once into a folder of the user's cache, and runs from there. Its own options:
#   --bundle-folder   print the folder that it runs from, after unpacking
# GLINT_BUNDLE_CACHE names another folder than ~/.cache/glint-bundle. Whatever is in there may be deleted at any time.
set -eu
sum=@SUM@
start=@START@

fail() {
    printf '%s: %s\n' "$0" "$*" >&2
    exit 1
}

cache=${GLINT_BUNDLE_CACHE:-}
if [ -z "$cache" ]; then
    [ -n "${XDG_CACHE_HOME:-}${HOME:-}" ] || fail "neither HOME nor XDG_CACHE_HOME is set; GLINT_BUNDLE_CACHE=DIR says where to unpack"
    cache=${XDG_CACHE_HOME:-${HOME:-}/.cache}/glint-bundle
fi
folder=$cache/$sum

# What others could put there would be run.
check() {
    [ ! -L "$cache" ] || fail "$cache is a symbolic link; GLINT_BUNDLE_CACHE=DIR names another folder"
    set -- $(stat -c '%u %A' "$cache")
    [ "$1" = "$(id -u)" ] || [ "$1" = 0 ] || fail "$cache belongs to another user; GLINT_BUNDLE_CACHE=DIR names another folder"
    case $2 in ?????w* | ????????w*) fail "others may write to $cache; GLINT_BUNDLE_CACHE=DIR names another folder" ;; esac
}

# Complete or not there: what is unpacked gets its name, the checksum of the contents, last. Of several that start at once, one is first.
unpack() {
    found=$(tail -c +$start "$0" | sha256sum | cut -c 1-64) || fail "cannot read itself"
    [ "$found" = "$sum" ] || fail "is damaged or not whole: expected the checksum $sum, found $found"
    (umask 077 && mkdir -p "$cache") 2>/dev/null || fail "cannot make the folder $cache; GLINT_BUNDLE_CACHE=DIR names another one"
    check
    part=$(mktemp -d "$cache/part-XXXXXX") || fail "cannot write to $cache; GLINT_BUNDLE_CACHE=DIR names another folder"
    trap 'rm -rf "$part"' EXIT
    trap 'exit 130' INT
    trap 'exit 143' TERM HUP
    [ ! -t 2 ] || printf '%s: unpacking into %s\n' "$0" "$folder" >&2
    tail -c +$start "$0" | tar -xz -C "$part" -f - || fail "cannot unpack into $cache (@MEGABYTES@ MB)"
    chmod 755 "$part"
    mv -T "$part" "$folder" 2>/dev/null || [ -x "$folder/@PROGRAM@" ] || fail "cannot name the folder $folder"
    rm -rf "$part"
    trap - EXIT INT TERM HUP
}

if [ -x "$folder/@PROGRAM@" ]; then check; else unpack; fi
if [ "${1-}" = --bundle-folder ]; then
    printf '%s\n' "$folder"
    exit
fi
exec "$folder/@PROGRAM@" "$@"
