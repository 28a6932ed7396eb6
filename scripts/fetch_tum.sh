#!/usr/bin/env bash
# Fetches TUM RGB-D sequences (CC BY 4.0, Sturm et al. 2012) from their makers and unpacks them. Goes on where a broken
# download ended; a sequence's folder appears only when it is whole.
#   scripts/fetch_tum.sh SEQUENCE... [--to DIR] [--from ADDRESS]      into DIR (default: tum)
# SEQUENCE: rgbd_dataset_freiburg1_desk, freiburg1_desk or fr1/desk. ADDRESS, or TESSERA_TUM_URL, is another place of
# the same folders freiburg1/ to freiburg3/, such as file:///media/tum. TESSERA_TUM_SUMS is another list of checksums.
set -euo pipefail

address=${TESSERA_TUM_URL:-https://cvg.cit.tum.de/rgbd/dataset}
sums=${TESSERA_TUM_SUMS:-$(dirname "$0")/tum_sha256.txt}
folder=tum
names=()

fail() {
    echo "fetch_tum.sh: $1" >&2
    exit 2
}

while [ $# -gt 0 ]; do
    case $1 in
        --to | --from)
            [ $# -ge 2 ] || fail "$1: needs a value"
            if [ "$1" = --to ]; then folder=$2; else address=$2; fi
            shift
            ;;
        -h | --help)
            sed -n '2,7s/^# \{0,1\}//p' "$0"
            exit 0
            ;;
        -*) fail "$1: no such option; there are --to DIR and --from ADDRESS" ;;
        *) names+=("$1") ;;
    esac
    shift
done
[ ${#names[@]} -gt 0 ] || fail "which sequence? For example: scripts/fetch_tum.sh fr1/desk fr3/long_office_household"

# freiburgN_NAME of the three ways to write it.
full_name() {
    local name=${1#rgbd_dataset_}
    name=${name/#fr1\//freiburg1_}
    name=${name/#fr2\//freiburg2_}
    name=${name/#fr3\//freiburg3_}
    [[ $name =~ ^freiburg[123]_[a-z0-9_]+$ ]] || fail "$1: no name of a TUM RGB-D sequence, such as fr1/desk"
    echo "rgbd_dataset_$name"
}

# The archive must be the one in the list. A sequence that the list lacks gets its checksum written down beside it.
check() {
    local archive=$1 name=$2 seen expected
    seen=$(sha256sum "$archive" | cut -d' ' -f1)
    expected=$([ -f "$sums" ] && awk -v file="$name.tgz" '$2 == file { print $1 }' "$sums" || true)
    if [ -z "$expected" ]; then
        echo "$seen  $name.tgz" >"$folder/$name.tgz.sha256"
        echo "$name: checksum not known here, so not checked; what was fetched is in $folder/$name.tgz.sha256"
    elif [ "$seen" != "$expected" ]; then
        mv "$archive" "$archive.refused"
        fail "$name: not the file expected (sha256 $seen, expected $expected); it is kept as $archive.refused"
    fi
}

fetch() {
    local name=$1 archive=$folder/$1.tgz.part url unpacked
    if [ -d "$folder/$name" ]; then
        echo "$folder/$name is there already"
        return
    fi
    url=$address/$(cut -d_ -f3 <<<"$name")/$name.tgz
    curl --fail --location --silent --show-error --continue-at - --retry 3 --output "$archive" "$url" ||
        fail "$url cannot be fetched; run the same again to go on, or name another place by --from"
    check "$archive" "$name"
    unpacked=$(mktemp -d "$folder/$name.XXXXXX")
    if ! tar -xzf "$archive" -C "$unpacked" || [ ! -d "$unpacked/$name" ]; then
        rm -rf "$unpacked"
        rm -f "$archive"
        fail "$url: no archive of $name; it is removed, run the same again"
    fi
    mv -T "$unpacked/$name" "$folder/$name"
    rm -rf "$unpacked" "$archive"
    echo "$folder/$name"
}

mkdir -p "$folder"
for name in "${names[@]}"; do
    full=$(full_name "$name")
    fetch "$full"
done
