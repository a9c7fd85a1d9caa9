#!/usr/bin/env bash
# Fields files of stored runs: a missing one is said and made again; a merged and an exported store find those of
# another folder.
. "$(dirname "$0")/lib.bash"

tiny kept "keep: {fields: all}" "parallel: {slots: 2}"
sed -i '/^parallel/d; s/per_point: 3/per_point: 1/' kept.yaml
mkdir here
expect 0 "$clast" run kept.yaml --store here/kept.db -j 2
same "$(ls here/kept-fields | wc -l)" 4 "fields files"
expect 0 "$clast" check here/kept.db

expect 0 "$clast" run kept.yaml --store here/kept.db -j 2
says "0 runs computed"
gone=$(ls here/kept-fields | head -1)
# A picture has the scene's name, which the store beside the fields knows.
title=$(python -c "import h5py, sys; run = h5py.File(sys.argv[1])['run'].attrs; print('seed %d, %.4g ms' % (run['seed'], 1e3 * float(run['time'])))" "here/kept-fields/$gone")
expect 0 "$clast" picture "here/kept-fields/$gone" named.png
expect 0 "$clast" picture "here/kept-fields/$gone" by-hand.png --caption "disc-explosion: $title"
cmp -s named.png by-hand.png || fail "the picture of stored fields has not the scene's name"
mv "here/kept-fields/$gone" first.h5
expect 65 "$clast" check here/kept.db
prints "$gone"
expect 0 "$clast" run kept.yaml --store here/kept.db -j 2
says "is missing"
cmp -s first.h5 "here/kept-fields/$gone" || fail "the fields file was not made again"
expect 0 "$clast" check here/kept.db

# A damaged file: cut short, other bytes of the same length, one bit.
damaged() {
  expect 65 "$clast" check here/kept.db
  prints "$gone is damaged"
  expect 0 "$clast" run kept.yaml --store here/kept.db -j 2
  says "is damaged"
  cmp -s first.h5 "here/kept-fields/$gone" || fail "the damaged fields file was not made again"
  expect 0 "$clast" check here/kept.db
}
truncate -s 5000 "here/kept-fields/$gone"
damaged
head -c "$(stat -c %s first.h5)" /dev/zero | tr '\0' x >"here/kept-fields/$gone"
damaged
python -c "
f = open('here/kept-fields/$gone', 'r+b')
f.seek(-100, 2); byte = f.read(1)[0]; f.seek(-100, 2); f.write(bytes([byte ^ 1]))"
damaged
# Damage of the run itself still shows when its file is made again.
cp here/kept.db whole.db
python -c "
import sqlite3
db = sqlite3.connect('here/kept.db')
db.execute(\"update run set largest_fraction = largest_fraction * 0.99 where fields_path like '%$gone'\")
db.commit()"
rm "here/kept-fields/$gone"
expect 0 "$clast" run kept.yaml --store here/kept.db -j 2
expect 65 "$clast" check here/kept.db
prints "has changed since it was stored"
cp whole.db here/kept.db
expect 0 "$clast" check here/kept.db

# The stores of another folder: the files stay where they are.
expect 0 "$clast" merge all.db here/kept.db
same "$(number all.db "select count(*) from runs where fields_path like 'here/kept-fields/%'")" 4 "paths in the merged store"
expect 0 "$clast" check all.db
mkdir there
expect 0 "$clast" export all.db there/copy.db
expect 0 "$clast" check there/copy.db
expect 0 "$clast" merge there/again.db here/kept.db
same "$(number there/again.db "select count(*) from runs where fields_path like '../here/kept-fields/%'")" 4 "paths upwards"
expect 0 "$clast" check there/again.db

# The same runs in both stores: the one without fields, or without the file, takes the way to the other's.
sed '/keep/d' kept.yaml >bare.yaml
expect 0 "$clast" run bare.yaml --store bare.db -j 2
same "$(number bare.db "select count(fields_path) from runs")" 0 "paths of a store without fields"
expect 0 "$clast" merge bare.db here/kept.db
says "0 runs added"
same "$(number bare.db "select count(*) from runs where fields_path like 'here/kept-fields/%'")" 4 "paths of runs in both"
expect 0 "$clast" check bare.db
mkdir second
cp here/kept.db second/kept.db
expect 65 "$clast" check second/kept.db
expect 0 "$clast" merge second/kept.db here/kept.db
expect 0 "$clast" check second/kept.db
expect 0 "$clast" merge here/kept.db second/kept.db
same "$(number here/kept.db "select count(*) from runs where fields_path like 'kept-fields/%'")" 4 "paths that lead to files"

# A file name cannot lead to another folder.
sed 's,^name:.*,name: ../kept,; /^store/d' kept.yaml >out.yaml
expect 65 "$clast" plan out.yaml
says "slash"
done_after 40
