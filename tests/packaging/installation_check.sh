#!/usr/bin/env bash
# Installs the packages, takes them off again, and looks at what happened. The root that they go into is
# this machine's own under an overlay, in a mount namespace: nothing is written to the machine.
#   installation_check.sh FOLDER_OF_PACKAGES
set -euo pipefail
here=$(dirname "$(readlink -f "$0")")

if [[ ${ROUNDEL_NAMESPACE:-} != yes ]]; then
  for flags in -m -rm; do
    if unshare $flags true 2>/dev/null; then
      ROUNDEL_NAMESPACE=yes exec unshare $flags "$0" "$@"
    fi
  done
  echo "installation: cannot make a mount namespace (unshare -m, unshare -rm)" >&2
  exit 1
fi

packages=$(readlink -f "$1")
work=/mnt
mount -t tmpfs tmpfs $work
mkdir $work/changes $work/overlay $work/root
mount -t overlay overlay \
  -o "lowerdir=/,upperdir=$work/changes,workdir=$work/overlay" $work/root
root=$work/root
mount -t tmpfs tmpfs $root/run
mount -t tmpfs tmpfs $root/tmp
mount --rbind /proc $root/proc
mount --rbind /dev $root/dev
cp "$packages"/*.deb "$here/installation_steps.sh" $root/tmp/
chroot $root /tmp/installation_steps.sh

# What the machine itself keeps of a package that came and went.
left=$(cd $work/changes && find . ! -type d | sed 's,^\./,,' | grep -vE \
  -e '^var/(lib/dpkg|log|cache/(man|ldconfig|debconf))/' \
  -e '^etc/(passwd|group|shadow|gshadow|subuid|subgid)-?$' \
  -e '^etc/\.pwd\.lock$' || true)
if [[ -n $left ]]; then
  printf 'installation: left after purge:\n%s\n' "$left" >&2
  exit 1
fi
for file in passwd group shadow gshadow; do
  if ! diff /etc/$file $root/etc/$file; then
    echo "installation: /etc/$file is not what it was" >&2
    exit 1
  fi
done
echo "installation: nothing is left after purge"
