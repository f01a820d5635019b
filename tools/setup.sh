# Shared by tools/render and tools/test; to be sourced. Leaves the project's folder in $root.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# Installs the packages of tools/packages.txt that are missing; asks for nothing if none is.
install_packages() {
    local package missing=()
    while read -r package; do
        [[ $package == ''  || $package == '#'* ]] && continue
        [[ $(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) == installed ]] ||
            missing+=("$package")
    done <"$root/tools/packages.txt"
    ((${#missing[@]})) || return 0

    local as_root=()
    ((EUID == 0)) || as_root=(sudo)
    echo "installing: ${missing[*]}" >&2
    "${as_root[@]}" apt-get update -qq >&2 &&
        DEBIAN_FRONTEND=noninteractive "${as_root[@]}" apt-get install -qq -y --no-install-recommends "${missing[@]}" >&2
}

# Where ccache is installed, CMake is to use it.
use_ccache() {
    if command -v ccache >/dev/null; then
        export CMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER-ccache}
    fi
}

# build PRESET [TARGET...]: configures on first use, then builds what has changed.
build() {
    local preset=$1
    shift
    use_ccache
    if [[ ! -f $root/build/$preset/build.ninja ]]; then
        (cd "$root" && cmake --preset "$preset" >&2) || return
    fi
    cmake --build "$root/build/$preset" ${1+--target "$@"} >&2
}
