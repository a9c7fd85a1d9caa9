# A run of particles as a user meets it: snapshots with their times, pictures of every kind, a run that is interrupted and goes
# on to the same bits, and what is said when any of it cannot be.
. "$(dirname "$0")/lib.bash"

run=(simulate basalt-sphere --seed 3 --set fidelity.particles=700 --set "stop.end_time=30 us" --quiet)
is_png() { [ "$(head -c 8 "$1" | od -An -tx1 | tr -d ' \n')" = 89504e470d0a1a0a ] || fail "$1 is no PNG"; ok "$1 is a PNG"; }

expect 0 "$clast" "${run[@]}" --json --fields end.hdf --snapshots 4 --picture end.png
cp out whole.json
is_png end.png
python - <<'PY'
import json
files = json.load(open('basalt-sphere.hdf.series'))
assert files['file-series-version'] == '1.0', files
files = files['files']
assert [f['name'] for f in files] == ['basalt-sphere_%06d.hdf' % k for k in range(4)], files
times = [f['time'] for f in files]
for k, time in enumerate(times):
    assert -1e-12 <= time - k * 10e-6 < 4e-6, times # due at k/3 of 30 us, and written at the next look: 8 steps
PY
ok "the series lists four snapshots and their times"

# All snapshots in one picture, a row of four; and a movie with as many frames as there are snapshots, each in the colours of
# the picture: the lightest of the damage is in a table of colours.
expect 0 "$clast" picture basalt-sphere.hdf.series all.png
same "$(grep -c 'marked (!).*coarse' err)" 1 "one line on doubts, of the last snapshot"
expect 0 "$clast" picture basalt-sphere.hdf.series movie.gif
same "$(grep -c 'marked (!).*coarse' err)" 1 "one line on doubts, of the last frame"
python - <<'PY'
import struct
wide, tall = struct.unpack(">II", open("all.png", "rb").read()[16:24])
assert wide > 4 * 250 and tall < 600, (wide, tall)
movie = open("movie.gif", "rb").read()
assert movie[:4] == b"GIF8" and movie.count(b"\x21\xf9\x04") >= 4
tables = [movie[13:13 + 768]] + [movie[at + 10:at + 778] for at in range(len(movie) - 778) if movie[at] == 0x2C and movie[at + 9] == 0x87]
near = min(max(abs(a - b) for a, b in zip(t[k:k + 3], (231, 224, 211))) for t in tables for k in range(0, 768, 3))
assert near <= 4, near
PY
[ "$(echo movie* all*)" = "movie.gif all.png" ] || fail "the frames of the movie stay: $(echo movie* all*)"
ok "a movie of the snapshots, and a sheet"
expect 64 "$clast" picture basalt-sphere.hdf.series movie.mp4
expect 66 "$clast" picture none.hdf none.png --what damage

expect 0 "$clast" simulate elastic-bar --set fidelity.particles=600 --set "stop.end_time=5 us" --quiet --fields bar.hdf
for what in damage pressure density energy flaws fragments; do
  expect 0 "$clast" picture end.hdf $what.png --what $what
  is_png $what.png
done
expect 0 "$clast" picture end.hdf cut.svg --what fragments --view cut --axis z --at "1 cm" --caption "a cut"
grep -q '</svg>' cut.svg || fail "no whole SVG"
expect 0 "$clast" picture basalt-sphere_000001.hdf outside.png --view outside --axis x
cmp -s damage.png pressure.png && fail "damage looks like pressure"
expect 0 "$clast" picture end.hdf profile.svg --view profile
grep -q '</svg>' profile.svg || fail "no whole SVG"
expect 0 "$clast" picture end.hdf profile.png --view profile --what pressure
is_png profile.png
cp end.hdf broken.hdf
python -c 'import h5py; h5py.File("broken.hdf", "a")["axis/pressure"][...] = float("nan")'
expect 0 "$clast" picture broken.hdf profile.png --view profile --what pressure --keep-script
says "broken.hdf: no value of pressure to draw: broken matter, which bears no tension"
grep -q '^caption_text.*No mark: broken matter, which bears no tension' profile.gp || fail "an empty profile without its reason"
expect 64 "$clast" picture end.hdf x.png --view profile --axis z
expect 65 "$clast" picture end.hdf x.png --view profile --what colour
says "it has distention, damage"
expect 65 "$clast" picture bar.hdf x.png --view profile
says "keep one"
expect 65 "$clast" picture end.hdf x.png --what colour
says "damage, pressure"
expect 64 "$clast" picture end.hdf x.png --view sideways
expect 64 "$clast" picture end.hdf x.png --axis w
expect 64 "$clast" picture end.hdf x.png --at "1 kg"
expect 64 "$clast" picture end.hdf x.png --at "3 m"
says "meets no particle"
expect 64 "$clast" picture end.hdf x.png --view outside --at "1 cm"
head -c 40000 end.hdf >cut.hdf
expect 65 "$clast" picture cut.hdf x.png
one_error
mkfifo pipe.hdf
expect 74 timeout 20 "$clast" picture pipe.hdf x.png
says "pipe.hdf: it is a folder, pipe"
# a file from someone else: the engine's name is no UTF-8, or it controls a terminal
for byte in ff 1b; do
  python - "$byte" <<'PY'
import sys
byte = bytes.fromhex(sys.argv[1])
whole = open("end.hdf", "rb").read()
at = whole.index(b"sph", whole.index(b"engine\0"))
open("alien.hdf", "wb").write(whole[:at] + byte + whole[at + 1:])
PY
  expect 65 "$clast" picture alien.hdf x.png
  says "its engine has no name that can be shown"
done
[ ! -e x.png ] || fail "a picture was left behind"
expect 0 "$clast" simulate disc-explosion --set "body.diameter=8 cm" --set "stop.end_time=0.2 ms" --quiet --fields disc.hdf
expect 64 "$clast" picture disc.hdf x.png --what damage
says "particles in space"

# Stopped as soon as it has begun (its first snapshot is there), and gone on with. On a busy machine the signal may come after
# the end: then once more.
for attempt in 1 2 3 4 5; do
  rm -f basalt-sphere*
  "$clast" "${run[@]}" --json --restart run.bin --snapshots 4 >out 2>err &
  pid=$!
  for _ in $(seq 6000); do [ -e basalt-sphere.hdf.series ] && break; sleep 0.01; done
  code=0
  kill -TERM $pid 2>/dev/null || true
  wait $pid || code=$?
  [ $code -eq 0 ] || break
done
same $code 75 "stopped by a signal"
says "the same command goes on from there"
[ -s run.bin ] || fail "no restart file"
for signal in USR1 USR2 XCPU; do # of batch systems
  rm -f disc*
  "$clast" simulate disc-explosion --restart disc.bin --snapshots 1000 --quiet >out 2>err &
  pid=$!
  for _ in $(seq 6000); do [ -e disc-explosion.hdf.series ] && break; sleep 0.01; done
  code=0
  kill -$signal $pid
  wait $pid || code=$?
  same $code 75 "stopped by SIG$signal"
  [ -s disc.bin ] || fail "no restart file after SIG$signal"
done
expect 65 "$clast" "${run[@]/#3/4}" --json --restart run.bin
says "of seed 3"
expect 65 "$clast" "${run[@]}" --json --restart run.bin --set fidelity.cfl=0.2
says "another scene"
[ -s run.bin ] || fail "the restart file was lost"
expect 0 "$clast" "${run[@]}" --json --restart run.bin --snapshots 4
cmp -s out whole.json || fail "the bits differ after a restart"
ok "the same bits after a restart"
[ ! -e run.bin ] || fail "the restart file is still there"
python - <<'PY'
import json
files = json.load(open('basalt-sphere.hdf.series'))['files']
assert [f['name'] for f in files] == ['basalt-sphere_%06d.hdf' % k for k in range(4)], files
assert files[0]['time'] == 0, files # the first is from before the stop
PY
ok "snapshots before and after the stop are in one series"
# What the run is to leave behind has no place: told before the run (a second of a million particles), not after it.
long=(simulate basalt-sphere --set fidelity.particles=1000000)
for where in "--fields none/such/folder/end.hdf" "--restart none/such/folder/run.bin" "--picture none/such/folder/end.png" \
  "--fields $work" "--restart $work"; do
  expect 74 timeout 20 "$clast" "${long[@]}" $where
  one_error
done
expect 64 timeout 20 "$clast" "${long[@]}" --picture end.jpg
got=0 # the disk fills up at the end (a limit on file size gives such an error): the results are printed all the same
(trap '' XFSZ; ulimit -f 100; exec "$clast" "${run[@]}" --json --fields full.hdf >out 2>err) || got=$?
same $got 74 "fields file too large"
cmp -s out whole.json || fail "the results are lost with the fields file"
[ -z "$(find . -name 'full.hdf*')" ] || fail "half a fields file is left"
done_after 60
