# For the scripts in this folder: says which Debian packages are missing, and ends then.

need_packages() {
  local package state missing=()
  for package in "$@"; do
    state=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
    [[ $state == installed ]] || missing+=("$package")
  done
  ((${#missing[@]} == 0)) && return
  printf '%s: install the peers first: apt-get install %s\n' "${0##*/}" "${missing[*]}" >&2
  exit 1
}
