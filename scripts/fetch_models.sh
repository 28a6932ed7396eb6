#!/usr/bin/env bash
# Fetches the detector that docs/labels.md speaks of, and checks it. Neither the build nor a test needs it.
#   scripts/fetch_models.sh [DIR]       into DIR (default: models)
# TESSERA_MODEL_URL names another place of the same file, such as file:///media/yolox_nano.onnx.
set -euo pipefail

name=yolox_nano.onnx
url=${TESSERA_MODEL_URL:-https://github.com/Megvii-BaseDetection/YOLOX/releases/download/0.1.1rc0/$name}
# Of the file that docs/benchmarks/labels.md's figures were measured with (YOLOX, Megvii, Apache-2.0).
sha256=e8af074932d4ed7e232278e3055cefcdea3edf178874a3694ae292649fb464dd
folder=${1:-models}

fits() { echo "$sha256  $1" | sha256sum --check --status; }

mkdir -p "$folder"
if [ -f "$folder/$name" ] && fits "$folder/$name"; then
    echo "$folder/$name is there already"
    exit 0
fi
part=$(mktemp "$folder/$name.XXXXXX")
trap 'rm -f "$part"' EXIT
if ! curl --fail --location --silent --show-error --output "$part" "$url"; then
    echo "fetch_models.sh: $url cannot be fetched; fetch it by other means and put it into $folder" >&2
    exit 2
fi
if ! fits "$part"; then
    echo "fetch_models.sh: $url: not the file expected (sha256 $(sha256sum "$part" | cut -d' ' -f1), expected $sha256)" >&2
    exit 2
fi
chmod 644 "$part"
mv "$part" "$folder/$name"
echo "$folder/$name"
