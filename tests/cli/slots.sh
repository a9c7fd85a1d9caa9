#!/usr/bin/env bash
# One campaign, however it is computed, is one store: 1 and 2 slots alone, in process, 3 ranks, 2 ranks of 2 slots, and
# grown from a smaller campaign.
. "$(dirname "$0")/lib.bash"

tiny tiny
expect 0 "$clast" run tiny.yaml -j 1 --quiet
bits tiny.db >reference.bits
[ "$(wc -l <reference.bits)" -gt 12 ] || fail "the reference is too small"

expect 0 "$clast" run tiny.yaml --store two.db -j 2 --quiet;                same_bits two.db reference.bits "2 slots"
expect 0 "$clast" run tiny.yaml --store in.db -j 2 --in-process --quiet;    same_bits in.db reference.bits "2 slots in process"
expect 0 mpirun --oversubscribe -n 3 "$clast" run tiny.yaml --store three.db --quiet;          same_bits three.db reference.bits "3 ranks"
same "$(number three.db "select count(distinct rank) > 1 from run")" 1 "more than one rank computed"
expect 0 mpirun --oversubscribe -n 2 "$clast" run tiny.yaml --store four.db -j 2 --quiet;      same_bits four.db reference.bits "2 ranks of 2 slots"
expect 0 mpirun --oversubscribe -n 1 "$clast" run tiny.yaml --store one.db --quiet;            same_bits one.db reference.bits "1 rank"

sed 's/per_point: 3/per_point: 1/; s/\[2 %, 5 %\]/[5 %]/' tiny.yaml >small.yaml
expect 0 "$clast" run small.yaml --store grown.db --quiet
expect 0 mpirun --oversubscribe -n 2 "$clast" run tiny.yaml --store grown.db
says "M_1/M: mass share"; says "runs computed"; ! grep -q "mass share" out || fail "a remark in stdout"
says "2 found in the store"
same_bits grown.db reference.bits "grown from a part"

# errors under mpirun: said once, with the code
expect 66 mpirun --oversubscribe -n 3 "$clast" run missing.yaml
[ "$(grep -c 'clast: error' err)" -eq 1 ] || fail "not said once"
echo 'name: [' >bad.yaml
expect 65 mpirun --oversubscribe -n 3 "$clast" run bad.yaml
[ "$(grep -c 'bad.yaml:.*error' err)" -eq 1 ] || fail "not said once"
expect 64 "$clast" run tiny.yaml -j 0x
done_after 18
