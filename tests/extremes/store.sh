#!/usr/bin/env bash
# Stores that are not ours, newer, damaged, read-only, locked or on a full disk: a clear message, the documented code, and
# the file as it was.
. "$(dirname "$0")/../cli/lib.bash"

tiny tiny
unchanged() { same "$(sha256sum <"$1" | cut -c1-12)" "$2" "$1 is as it was"; }
refuses() { # refuses CODE FILE: to write and to read
  local sum
  sum=$(sha256sum <"$2" | cut -c1-12)
  expect "$1" "$clast" run tiny.yaml --store "$2" --quiet; one_error; says "$2"
  expect "$1" "$clast" status "$2"; one_error; says "$2"
  unchanged "$2" "$sum"
}
echo "not a database at all, but long enough to be one" >text.db; refuses 65 text.db
head -c 40000 /dev/urandom >noise.db; refuses 65 noise.db
python -c "import sqlite3; d = sqlite3.connect('other.db'); d.execute('create table run (a)'); d.commit()"; refuses 65 other.db
expect 0 "$clast" run tiny.yaml --quiet
bits tiny.db >reference.bits
cp tiny.db newer.db; python -c "import sqlite3; d = sqlite3.connect('newer.db'); d.execute('pragma user_version = 1000'); d.commit()"
refuses 65 newer.db; says "newer"
head -c 60000 tiny.db >cut.db
expect 65 "$clast" check cut.db
mkdir folder.db
expect 74 "$clast" run tiny.yaml --store folder.db --quiet
expect 66 "$clast" status missing.db
says "missing.db"
expect 74 "$clast" run tiny.yaml --store none/such/x.db --quiet; one_error
for command in status estimates stats spectrum check; do expect 66 "$clast" $command missing.db; one_error; done
[ ! -e missing.db ] || fail "a reading command made a store"

# an empty file is what a disk that was full leaves behind: it becomes a store
: >empty.db
expect 0 "$clast" run tiny.yaml --store empty.db --quiet
same_bits empty.db reference.bits "an empty file"

# a byte of a mass flipped: check finds it
cp tiny.db flipped.db
python -c "
import sqlite3
d = sqlite3.connect('flipped.db')
(run, masses), = d.execute('select run_id, masses from fragment_mass order by run_id limit 1')
masses = bytearray(masses); masses[5] ^= 1
d.execute('update fragment_mass set masses = ? where run_id = ?', (bytes(masses), run)); d.commit()"
expect 65 "$clast" check flipped.db
[ -s out ] || fail "check does not say what is wrong"
expect 65 "$clast" replay flipped.db 1
prints "fragment masses"

# texts from someone else do not control the terminal
cp tiny.db texts.db
python - <<'PY'
import json, sqlite3
d = sqlite3.connect("texts.db")
text = "\x1b]0;x\x07\x1b[2J\x08\x7f\u009b2J"
for column in ("campaign.name", "session.host", "session.outcome", "point.scene_name", "run.message", "run.fields_path", "column_doc.unit"):
    d.execute("update {} set {} = ?".format(*column.split(".")), (text,))
d.execute("update session set facts = ?", (json.dumps({"version": text, "commit": text, "compiler": text}),))
d.commit()
PY
for command in "status texts.db" "estimates texts.db" "stats texts.db" "extremes texts.db" "compare texts.db texts.db" "replay texts.db 1" \
  "check texts.db" "merge texts.db missing.db" "run tiny.yaml --store texts.db" "plot texts.db x.png -x threshold.strain"; do
  "$clast" $command >out 2>err || true
  [ -s out ] || [ -s err ] || fail "$command prints nothing"
  cat out err >both
  ! LC_ALL=C grep -qP '[\x00-\x08\x0b-\x1f\x7f]|\xc2[\x80-\x9f]' both || fail "$command prints control characters"
done
ok "no control characters"

# points of an engine that the store has no table of
cp tiny.db engine.db
python -c "import sqlite3; d = sqlite3.connect('engine.db'); d.execute('update point set engine = \'none\' where point_id = 2'); d.commit()"
expect 65 "$clast" check engine.db

# read-only: needs a user other than root
chmod 755 .
cp tiny.db locked.db; chmod 444 locked.db; mkdir fixed; cp tiny.db fixed/; chmod 555 fixed
if [ "$(id -u)" -ne 0 ]; then as=(); elif setpriv --reuid=65534 --clear-groups test -x "$work" 2>/dev/null && setpriv --reuid=65534 --clear-groups test -x "$clast"; then as=(setpriv --reuid=65534 --clear-groups); else as=(none); fi
if [ "${as[*]:-}" != none ]; then
  sed -i 's/per_point: 3/per_point: 4/' tiny.yaml
  expect 74 "${as[@]}" "$clast" run tiny.yaml --store locked.db --quiet; one_error
  expect 74 "${as[@]}" "$clast" run tiny.yaml --store fixed/tiny.db --quiet; one_error
  expect 0 "${as[@]}" "$clast" status locked.db
  expect 0 "${as[@]}" "$clast" status fixed/tiny.db
  sed -i 's/per_point: 4/per_point: 3/' tiny.yaml
else
  for i in 1 2 3 4; do ok "(not tried: permissions do not bind here)"; done
fi

# one writer: the second gets a message that names the first; readers can read meanwhile
waiting slow
sed -i 's/20 ms/90 ms/' stick.yaml # it must outlive two that wait 4 s each for it
"$toy" run slow.yaml -j 1 --quiet >/dev/null 2>&1 &
pid=$!
for i in $(seq 100); do "$toy" status slow.db 2>/dev/null | grep -q slow && break; sleep 0.05; done
expect 74 "$toy" run slow.yaml --quiet
says "$pid"; one_error
expect 74 "$toy" merge slow.db tiny.db
expect 0 "$toy" status slow.db
prints "slow"
kill -TERM "$pid"; code=0; wait "$pid" || code=$?
same "$code" 75 "the first writer was not disturbed"

# a full disk: in a separate file system if permitted, otherwise by a limit on file sizes
expect_full() { [ "$got" -eq 74 ] || fail "exit $got on a full disk"; says "$1"; one_error; ok "exit 74: $2"; }
mkdir small
sed -i 's/20 ms/0 s/' stick.yaml
sed -i 's/per_point: [0-9]*/per_point: 40/' slow.yaml
if unshare --mount true 2>/dev/null && unshare --mount sh -c 'mount -t tmpfs -o size=300k tmpfs small' 2>/dev/null; then
  got=0
  unshare --mount sh -c "mount -t tmpfs -o size=300k tmpfs small && '$toy' run slow.yaml --store small/x.db --quiet >out 2>err; code=\$?; cp small/x.db* . 2>/dev/null; exit \$code" || got=$?
  expect_full "small/x.db" "a full disk"
else
  got=0
  (trap '' XFSZ; ulimit -f 250; exec "$toy" run slow.yaml --store x.db --quiet >out 2>err) || got=$?
  expect_full "x.db" "a file that may not grow"
fi
rm -f slow.db*
expect 0 "$toy" run slow.yaml --quiet
bits slow.db >slow.bits
if [ -s x.db ]; then expect 0 "$toy" run slow.yaml --store x.db --quiet; same_bits x.db slow.bits "after room was made"; else ok "nothing"; ok "committed"; ok "yet"; fi

# ---- another program holds the store for longer than SQLite waits: the runs go on, and their results wait in memory
waiting held
# The holder needs a gap between two batches. Where results come fast, the next one waits already when a batch ends, and
# there is none: runs take 0.3 s.
sed -i 's/20 ms/300 ms/' stick.yaml
sed -i "s/per_point: .*}/per_point: 40}/" held.yaml
cat >hold.py <<'PY'
import sqlite3, time
while True:  # the writer lets go for some milliseconds between two batches: SQLite's own waiting would miss them
    try:
        store = sqlite3.connect("file:held.db?mode=rw", uri=True, timeout=0, isolation_level=None)
        while not store.execute("select count(*) from run").fetchone()[0]:
            time.sleep(0.05)
        break
    except sqlite3.OperationalError:
        time.sleep(0.05)
while not store.in_transaction:
    try:
        store.execute("begin immediate")
    except sqlite3.OperationalError:
        time.sleep(0.001)
time.sleep(14)
before = store.execute("select count(*) from run").fetchone()[0]
store.execute("commit")
print(before)
PY
python hold.py >before &
holder=$!
expect 0 "$toy" run held.yaml -j 2
wait $holder
says "another program holds the store"
[ "$(cat before)" -lt 110 ] || fail "the store was held too late: $(cat before) runs"
same "$(number held.db "select count(*) from run")" 120 "runs of a store that was held"
expect 0 "$toy" check held.db

# A store that another program has locked is waited for, longer than SQLite waits. A signal ends the waiting at once; results
# that wait in memory are tried for 10 s.
cat >lock.py <<'PY'
import sqlite3, sys, time
store = sqlite3.connect(sys.argv[1], timeout=0, isolation_level=None)
while not store.in_transaction:
    try:
        store.execute("begin immediate")
    except sqlite3.OperationalError:
        time.sleep(0.0005)
open("locked", "w").close()
time.sleep(float(sys.argv[2]))
store.execute("commit")
PY
lock() { # lock SECONDS
  rm -f locked
  python lock.py held.db "$1" &
  holder=$!
  until [ -e locked ]; do sleep 0.05; done
}
sed -i 's/per_point: .*}/per_point: 60}/' held.yaml
lock 60
rm err
"$toy" run held.yaml -j 2 >out 2>err </dev/null &
until cat err 2>/dev/null | tr '\n' ' ' | grep -q "clast waits until it lets go"; do sleep 0.1; done
kill -TERM $!
wait $! && code=0 || code=$?
same "$code" 75 "exit of a run that waits for the store"
rm err
"$toy" merge held.db tiny.db >out 2>err </dev/null &
until cat err 2>/dev/null | tr '\n' ' ' | grep -q "clast waits until it lets go"; do sleep 0.1; done
kill -TERM $!
wait $! && code=0 || code=$?
same "$code" 75 "exit of a merge that waits for the store"
kill $holder
wait $holder 2>/dev/null || true
"$toy" run held.yaml -j 2 >out 2>err </dev/null &
runner=$!
sleep 1.5
lock 60
sleep 2
begun=$SECONDS
kill -TERM $runner
wait $runner && code=0 || code=$?
same "$code" 75 "exit of a run with results that wait"
[ $((SECONDS - begun)) -le 15 ] || fail "the run went on for $((SECONDS - begun)) s"
says "clast tries for 10 s to store"
says "results were not stored"
kill $holder
wait $holder 2>/dev/null || true
expect 0 "$toy" check held.db
lock 12
expect 0 "$toy" run held.yaml -j 2
says "clast waits until it lets go"
same "$(number held.db "select count(*) from run")" 180 "runs of a store that was held"
done_after 49
