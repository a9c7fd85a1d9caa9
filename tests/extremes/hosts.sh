#!/usr/bin/env bash
# Several hosts: network namespaces with their own addresses, joined by a bridge; Open MPI's launcher enters a namespace
# where it would log in by ssh. One host is cut off in the middle of a campaign; the rest of it completes, and no bit
# differs from one machine's.
#
# Needs root, iproute2 and CLAST_FULL=1. Nothing leaves these namespaces: the bridge has no other port and no route.
. "$(dirname "$0")/../cli/lib.bash"
skip() { echo "skipped: $1"; exit 77; }
[ -n "${CLAST_FULL:-}" ] || skip "a long form: set CLAST_FULL=1"
[ "$(id -u)" -eq 0 ] || skip "network namespaces need root"
command -v ip >/dev/null || skip "no iproute2"

tag=c$$
hosts="a b c"
declare -A address=([a]=10.231.7.1 [b]=10.231.7.2 [c]=10.231.7.3)
# The processes of a host are killed, so its shared memory stays. On a real host the next clast removes it; no clast will
# have the name of this one.
take_down() {
  local host pid
  for host in $hosts; do
    for pid in $(ip netns pids "$tag$host" 2>/dev/null); do kill -9 "$pid" 2>/dev/null || true; done
    ip netns del "$tag$host" 2>/dev/null || true
  done
  ip netns del "$tag" 2>/dev/null || true
  rm -f /dev/shm/*_segment."$tag"[abc].*
}
trap '[ "$BASHPID" != $$ ] || { take_down; rm -rf "$work"; }' EXIT
ip netns add "$tag" 2>err || skip "no network namespaces here: $(cat err)"
ip -n "$tag" link add bridge type bridge
ip -n "$tag" link set bridge up
for host in $hosts; do
  ip netns add "$tag$host"
  ip -n "$tag$host" link set lo up
  ip -n "$tag$host" link add eth0 type veth peer name "port$host" netns "$tag"
  ip -n "$tag$host" addr add "${address[$host]}/24" dev eth0
  ip -n "$tag$host" link set eth0 up
  ip -n "$tag" link set "port$host" master bridge up
done

# What Open MPI calls instead of ssh: rsh.sh HOST COMMAND...; a host has its own name, too.
cat >rsh.sh <<END
#!/bin/bash
host=\$1
shift
case \$host in ${address[b]}) name=b ;; ${address[c]}) name=c ;; *) exit 255 ;; esac
exec ip netns exec "$tag\$name" unshare --uts sh -c "hostname $tag\$name; cd '$PWD'; \$*"
END
chmod +x rsh.sh
printf '%s slots=2\n' "${address[a]}" "${address[b]}" "${address[c]}" >hostfile
cat >mpi.sh <<END
#!/bin/bash
# mpirun ARGUMENTS, on host a
export OMPI_MCA_plm_rsh_agent=$PWD/rsh.sh OMPI_MCA_btl_tcp_if_include=eth0 OMPI_MCA_oob_tcp_if_include=eth0
exec ip netns exec ${tag}a unshare --uts sh -c 'hostname ${tag}a; exec "\$@"' mpi \
  mpirun --hostfile hostfile --map-by node --bind-to none "\$@"
END
chmod +x mpi.sh
ask() { python -c "import sqlite3, sys; print(sqlite3.connect('file:%s?mode=ro' % sys.argv[1], uri=True).execute(sys.argv[2]).fetchone()[0])" "$1" "$2"; }
runs_in() { ask "$1" 'select count(*) from run' 2>/dev/null || echo 0; }

slow slow
sed -i '/per_point/s/[0-9]\+/'"$((2 * slow_seeds))"'/' slow.yaml
expect 0 "$clast" run slow.yaml -j 2 --quiet --store alone.db
bits alone.db >reference.bits

# All three hosts: six ranks, each host computes some of it.
expect 0 ./mpi.sh -n 6 "$clast" run slow.yaml --quiet --store three.db
same "$(number three.db 'select count(distinct host) from run')" 3 "hosts that computed runs"
same_bits three.db reference.bits "three hosts"

# One host is cut off after the first runs: its cable is pulled, and nothing is closed. What it had is computed again
# elsewhere, a minute later. mpirun of Open MPI 4.1 then waits for the lost host for good: the test ends it when the store
# says that the campaign is finished.
./mpi.sh -n 6 "$clast" run slow.yaml --store cut.db >out 2>err </dev/null &
launcher=$!
for i in $(seq 1200); do [ "$(runs_in cut.db)" -gt 20 ] && break; sleep 0.05; done
before=$(runs_in cut.db)
ip -n "$tag" link set portc down
all=$(runs_in alone.db)
[ "$before" -lt "$all" ] || fail "the campaign was over before the host was cut off"
outcome() { ask cut.db "select ifnull(max(outcome), '') from session"; }
started=$SECONDS
until [ "$(outcome)" = finished ]; do
  [ $((SECONDS - started)) -lt 300 ] || fail "not finished 300 s after the cut: $(runs_in cut.db) of $all runs"
  sleep 1
done
ok "finished after the cut at $before of $all runs"
echo "(it took $((SECONDS - started)) s)"
for i in $(seq 40); do kill -0 "$launcher" 2>/dev/null || break; sleep 0.25; done
kill -KILL "$launcher" 2>/dev/null || true
wait "$launcher" 2>/dev/null || true
take_down
same "$(ls /dev/shm | grep -c "_segment\.$tag" || true)" 0 "pieces of shared memory that are left"
same "$(runs_in cut.db)" "$all" "runs after the cut"
same_bits cut.db reference.bits "one of three hosts cut off"
done_after 8
