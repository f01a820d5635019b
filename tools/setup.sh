# Shared by tools/render and tools/test; to be sourced. Leaves the project's folder in $root.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# install_packages [LIST...]: installs the packages of tools/packages.txt, and of other lists, that are missing; asks for nothing
# if none is.
install_packages() {
    local package command missing=()
    while read -r package command; do
        [[ $package == ''  || $package == '#'* ]] && continue
        [[ $command ]] && command -v "$command" >/dev/null && continue
        [[ $(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) == installed ]] ||
            missing+=("$package")
    done < <(cat "$root/tools/packages.txt" "${@/#/$root/tools/}")
    ((${#missing[@]})) || return 0

    local as_root=()
    ((EUID == 0)) || as_root=(sudo)
    echo "installing: ${missing[*]}" >&2
    "${as_root[@]}" apt-get update -qq >&2 &&
        DEBIAN_FRONTEND=noninteractive "${as_root[@]}" apt-get install -qq -y --no-install-recommends "${missing[@]}" >&2
}

# install_npm_packages LIST FOLDER: installs what the package-lock.json of the folder LIST names into FOLDER, from npm's cache where
# it can. Does nothing if that is there.
install_npm_packages() {
    local wanted=$1/package-lock.json folder=$2
    cmp -s "$wanted" "$folder/package-lock.json" && [[ -d $folder/node_modules ]] && return 0
    mkdir -p "$folder"
    rm -f "$folder/package-lock.json"
    cp "$1/package.json" "$folder"
    # The lock comes last into its place: an installation that was interrupted begins again.
    cp "$wanted" "$folder/npm-shrinkwrap.json"
    npm ci --prefix "$folder" --ignore-scripts --no-audit --no-fund --prefer-offline --loglevel error >&2 || return
    mv "$folder/npm-shrinkwrap.json" "$folder/package-lock.json"
}

# build_web TARGET...: builds by emcc (3.1.50 or later, as the package emscripten of Debian 13 has it) what runs without an
# operating system, into build/web.
build_web() {
    command -v emcmake >/dev/null || { echo "there is no emcc: it is in the Debian 13 package emscripten" >&2 && return 3; }
    # Only these: other headers of the system are not those of the browser.
    mkdir -p "$root/build/web_headers"
    local headers
    for headers in /usr/include/{fmt,glm,boost,nlohmann,eigen3/Eigen}; do
        [[ -e $root/build/web_headers/${headers##*/} ]] || ln -s "$headers" "$root/build/web_headers"
    done
    (cd "$root" && emcmake cmake --preset web && cmake --build --preset web --target "$@") >&2
}

# Where ccache is installed, CMake is to use it.
use_ccache() {
    if command -v ccache >/dev/null; then
        export CMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER-ccache}
        # Without these it takes no source that precompiled headers come before.
        export CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS-pch_defines,time_macros}
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
