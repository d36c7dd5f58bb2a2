# Install a package in an empty environment outside of the clone, and see README's first commands print what README
# shows, and its first lines of Python run: sh tests/installed.sh PYTHON FILE
set -eu
readme=$PWD/README.md
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
"$1" -m venv env
env/bin/python -m pip install --quiet --disable-pip-version-check "$2"
PATH=$folder/env/bin:$PATH CONTACTLAW_CACHE_DIR=$folder/cache
export CONTACTLAW_CACHE_DIR
first() {
  awk -v fence="\`\`\`$1" '$0 == fence {on = 1; next} /^```/ {if (on) exit} on' "$readme"
}
first sh | grep -v -e '^python3 -m venv' -e '^pip install' | sh -eu > printed
first text | diff - printed
first python | python -W error -
contactlaw table check
