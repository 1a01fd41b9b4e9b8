#!/bin/sh
# In the root where packages are tried: install, change, upgrade, remove, purge.
set -eu
PATH=/usr/sbin:/usr/bin:/sbin:/bin
export DEBIAN_FRONTEND=noninteractive LC_ALL=C
cd /tmp

fail() {
  echo "installation: $*" >&2
  exit 1
}
enabled=/etc/systemd/system/multi-user.target.wants/roundeld.service

dpkg -i ./*.deb
getent passwd roundel >/dev/null || fail "there is no user roundel"
id -nG roundel | grep -qw video || fail "the user roundel is not in the group video"
[ -L $enabled ] || fail "the service is not enabled"
roundeld --check-config --config /etc/roundel/roundel.yaml || fail "the installed configuration is wrong"
roundeld --print-config | diff - /etc/roundel/roundel.yaml >differences || true
sed -n '/^[<>]/p' differences | tr '\n' ' ' >changed_lines
[ "$(cat changed_lines)" = '< source: simulator > source: camera ' ] ||
  fail "the installed configuration is not the default with a camera: $(cat differences)"
roundel detect --help >/dev/null || fail "roundel does not run"
man -w roundel roundeld roundel.yaml roundel-lcm >/dev/null || fail "a manual page is missing"
bash -c '. /usr/share/bash-completion/completions/roundel && complete -p roundel' >/dev/null ||
  fail "bash does not complete roundel"
python3 -c 'import roundel; roundel.frame_t().encode()' || fail "the Python types can't be imported"

echo '# mine' >>/etc/roundel/roundel.yaml
echo mine >/etc/roundel/camera.yaml
mkdir -p /var/lib/roundel/east
echo mine >/var/lib/roundel/east/arena.yaml
rm $enabled  # as systemctl disable does
dpkg -i ./*.deb
grep -qx '# mine' /etc/roundel/roundel.yaml || fail "an upgrade has changed the configuration"
[ ! -e $enabled ] || fail "an upgrade has enabled the service again"

dpkg --remove roundel libroundel-dev python3-roundel
grep -qx '# mine' /etc/roundel/roundel.yaml || fail "removing has removed the configuration"
[ -e /var/lib/roundel/east/arena.yaml ] || fail "removing has removed the calibration"
[ ! -e /usr/bin/roundeld ] || fail "roundeld is still there"

dpkg -i ./roundel_*.deb
[ ! -e $enabled ] || fail "installing again has enabled the service that was disabled"
dpkg --purge roundel libroundel-dev python3-roundel
