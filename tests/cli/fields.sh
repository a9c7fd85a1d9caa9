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
mv "here/kept-fields/$gone" first.h5
expect 65 "$clast" check here/kept.db
prints "$gone"
expect 0 "$clast" run kept.yaml --store here/kept.db -j 2
says "is missing"
cmp -s first.h5 "here/kept-fields/$gone" || fail "the fields file was not made again"
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
done_after 15
