# Shared by the benchmarks of this folder; to be sourced. Brings tools/setup.sh, and with it $root.
. "$(dirname "${BASH_SOURCE[0]}")/../setup.sh"

# need COMMAND PACKAGE: installs the Debian package that brings the command.
need() {
    command -v "$1" >/dev/null && return
    local as_root=()
    ((EUID == 0)) || as_root=(sudo)
    echo "installing: $2" >&2
    "${as_root[@]}" apt-get update -qq >&2 &&
        "${as_root[@]}" apt-get install -qq -y --no-install-recommends "$2" >&2 ||
        { echo "${0#"$root"/}: needs '$1', of the Debian package '$2'" >&2 && exit 3; }
}
