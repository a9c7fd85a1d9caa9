#!/usr/bin/env bash
# The two commands of the README on a bare Debian 12: debootstrap makes a minimal root, a clone lies in its /root, which
# nobody else may enter, and ./setup.sh demo runs there. With CLAST_SETUP=test it is ./setup.sh test, which takes hours
# on a small machine.
#
# Needs root, debootstrap, a Debian mirror (CLAST_MIRROR), git and CLAST_FULL=1. What is mounted is seen by this test alone.
. "$(dirname "$0")/../cli/lib.bash"
skip() { echo "skipped: $1"; exit 77; }
[ -n "${CLAST_FULL:-}" ] || skip "a long form: set CLAST_FULL=1"
[ "$(id -u)" -eq 0 ] || skip "a root of its own needs root"
PATH=$PATH:/usr/sbin:/sbin
command -v debootstrap >/dev/null || skip "apt-get install debootstrap"
setup=${CLAST_SETUP:-demo} root=$work/root

debootstrap --variant=minbase bookworm "$root" "${CLAST_MIRROR:-http://deb.debian.org/debian}" >out 2>err ||
  fail "debootstrap: $(tail -n 3 out)"
ok "a minimal Debian $(cat "$root/etc/debian_version")"
git clone -q "$source" "$root/root/clast" 2>err || fail "no clone of $source"
chmod 700 "$root/root"
cp /etc/resolv.conf "$root/etc/"
if [ -n "${NODE_EXTRA_CA_CERTS:-}" ]; then # this host trusts more certificates, perhaps of a proxy: npm must do so, too
  cp "$NODE_EXTRA_CA_CERTS" "$root/etc/certificates-of-host.crt"
  certificates=NODE_EXTRA_CA_CERTS=/etc/certificates-of-host.crt
fi
same "$(chroot "$root" sh -c 'command -v gcc cmake git python3 || true')" "" "tools that are there already"

# A failing test of ./setup.sh test must be readable: all output goes to the terminal, too.
got=0
unshare --mount --pid --fork sh -c "
  mount -t proc proc '$root/proc' && mount --rbind /dev '$root/dev' &&
  exec chroot '$root' env -i HOME=/root LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin ${certificates:-} \
    sh -c 'cd && cd clast && exec ./setup.sh $setup'" </dev/null 2>&1 | tee log || got=$?
[ "$got" -eq 0 ] || fail "exit $got: ./setup.sh $setup"
ok "./setup.sh $setup in a 0700 home"
if [ "$setup" = demo ]; then
  demo=$root/root/clast/demo.db
  same "$(number "$demo" 'select count(*) from run')" 120 "runs of the demo"
  grep -q 'of .* steps' log || fail "nothing was said while it was built"
  [ ! -e "$root/root/clast/build/release/tests/unit" ] || [ -z "$(find "$root/root/clast/build/release/tests" -type f -perm -u+x -name 'test_*')" ] ||
    fail "the demo built tests"
  ok "only the program was built, and progress was shown"
  expect 0 "$clast" check "$demo"
  for run in 1 60 120; do expect 0 "$clast" replay "$demo" "$run"; done
  done_after 9
else
  same "$(grep -c '^100% tests passed' log)" 2 "builds whose tests all passed"
  done_after 4
fi
