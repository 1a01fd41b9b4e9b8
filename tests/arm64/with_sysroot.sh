#!/bin/sh
# Runs a command where the libraries of a sysroot lie as if they were installed, with its package
# database: so dpkg-shlibdeps, which CPack calls, works for another processor. In a mount namespace;
# the machine does not change.
#   with_sysroot.sh SYSROOT COMMAND...
set -eu
sysroot=$(readlink -f "$1")
shift
export DPKG_ADMINDIR="$sysroot/var/lib/dpkg" DEB_HOST_ARCH=arm64
for flags in -m -rm; do
  if unshare $flags true 2>/dev/null; then
    # shellcheck disable=SC2016  # for the shell inside
    exec unshare $flags sh -c '
      mount -t overlay overlay -o "lowerdir=$0/lib:$0/usr/lib:/usr/lib" /usr/lib && exec "$@"' \
      "$sysroot" "$@"
  fi
done
echo "with_sysroot.sh: cannot make a mount namespace (unshare -m, unshare -rm)" >&2
exit 1
