# Shared by the benchmarks of this folder; to be sourced with their arguments: . common.sh "$@". Brings tools/setup.sh,
# and with it $root; leaves in the array $arguments what is not for all of them:
#
#   --write    puts the tables into their page of docs/, with the commit that they were measured at
#   --check    compares with what the page says, where that does not depend on the machine
#   --smoke    tries whether everything runs, on models so small that it takes a moment; measures nothing
#   --help     says what the benchmark measures
. "$(dirname "${BASH_SOURCE[0]}")/../setup.sh"

write=false check=false smoke=false arguments=()
for argument; do
    case $argument in
    --write) write=true ;;
    --check) check=true ;;
    --smoke) smoke=true ;;
    -h | --help) # what the file says of itself
        awk 'NR > 1 && !/^#/ { exit } NR > 1 { sub(/^# ?/, ""); print }' "$0"
        exit
        ;;
    *) arguments+=("$argument") ;;
    esac
done
if $write && $smoke; then
    echo "${0#"$root"/}: --smoke measures nothing that could be written" >&2
    exit 2
fi

# programs TARGET...: installs the packages that are missing and builds them; leaves the folder of the build in $built, and
# $graftal. Where GRAFTAL_BUILD names a folder they are there already.
programs() {
    built=${GRAFTAL_BUILD:-$root/build/release}
    if [[ -z ${GRAFTAL_BUILD:-} ]]; then
        install_packages
        build release "$@"
    fi
    graftal=$built/graftal
    # What is measured is what was built, whatever becomes of the sources meanwhile.
    if $write; then
        MEASURED_COMMIT=$(python3 "$root/tools/bench/commits.py")
        export MEASURED_COMMIT
    fi
}

# need COMMAND PACKAGE: installs the Debian package that brings the command. For a mere try nothing is installed: fails
# then, and says what is left out.
need() {
    command -v "$1" >/dev/null && return
    if $smoke; then
        echo "without $1: it is not installed"
        return 1
    fi
    local as_root=()
    ((EUID == 0)) || as_root=(sudo)
    echo "installing: $2" >&2
    "${as_root[@]}" apt-get update -qq >&2 &&
        "${as_root[@]}" apt-get install -qq -y --no-install-recommends "$2" >&2 ||
        { echo "${0#"$root"/}: needs '$1', of the Debian package '$2'" >&2 && exit 3; }
}

# timed FILE COMMAND...: runs it, and writes its seconds of wall, its seconds of processors and its peak KiB into FILE. No
# seconds are 0, since others are divided by them. Fails as the command does.
timed() {
    local file=$1 status=0 TIMEFORMAT='%3R %3U %3S' wall user system kib
    shift
    { time /usr/bin/time -q -o "$file" -f %M "$@" 2>&3; } 3>&2 2>"$file.seconds" || status=$?
    read -r wall user system <"$file.seconds"
    read -r kib <"$file"
    awk -v w="$wall" -v c="$user" -v s="$system" -v k="$kib" \
        'BEGIN { c += s; print (w ? w : 0.001), (c ? c : 0.001), k }' >"$file"
    return $status
}

# publish PAGE PART [WORD...] <TABLE: shows the table; with --write puts it into that part of docs/PAGE.md, with --check
# compares it. WORDs are those that make the command measure this part alone.
publish() {
    local page=$1 part=$2 table
    shift 2
    table=$(cat)
    printf '%s\n\n' "$table"
    [[ -n $table ]] || { echo "${0#"$root"/}: nothing came of '$part'" >&2 && exit 1; }
    if $check; then "$root/tools/bench/page" --same "docs/$page.md" "$part" <<<"$table"; fi
    if $write; then
        local command="tools/bench/${0##*/}"
        (($# == 0)) || command+=" $*"
        "$root/tools/bench/page" "docs/$page.md" "$part" "$command" <<<"$table"
    fi
}
