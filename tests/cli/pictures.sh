# Pictures and plots as a user meets them: spectra, maps and bodies from a store that a campaign filled, and what is said
# when they cannot be drawn.
. "$(dirname "$0")/lib.bash"

tiny small
expect 0 "$clast" run small.yaml -j 2

expect 0 "$clast" spectrum small.db --point 1 --plot
prints "from kg"
prints "●"
expect 0 "$clast" spectrum small.db --point 1 --plot --ascii
prints "*"
LC_ALL=C grep -q '[^ -~]' out && fail "not ASCII only"
ok "--ascii is ASCII"

is_png() { [ "$(head -c 8 "$1" | od -An -tx1 | tr -d ' \n')" = 89504e470d0a1a0a ] || fail "$1 is no PNG"; ok "$1 is a PNG"; }
is_svg() { head -c 200 "$1" | grep -q '<svg\|<?xml' && tail -c 20 "$1" | grep -q '</svg>' || fail "$1 is no whole SVG"; ok "$1 is an SVG"; }

expect 0 "$clast" spectrum small.db --picture spectrum.png
is_png spectrum.png
expect 0 "$clast" map small.db map.svg -x strain -y angle
is_svg map.svg
expect 0 "$clast" map small.db beta.png -x strain -y angle -q dust_fraction
is_png beta.png

expect 0 "$clast" plot small.db lines.png -x strain --by angle
is_png lines.png
expect 0 "$clast" plot small.db dust.svg -x strain -q dust_fraction
is_svg dust.svg
expect 64 "$clast" plot small.db m.png
says "--x"
expect 64 "$clast" plot small.db m.png -x strain --by strain
expect 64 "$clast" plot small.db m.png -x strain,angle
expect 64 "$clast" plot small.db m.png -x strain -q largest_fraction,dust_fraction
says "one quantity"
expect 64 "$clast" plot small.db m.png -x strain -q nothing
says "largest_fraction"
expect 64 "$clast" plot small.db m.jpg -x strain
expect 74 "$clast" plot small.db no/such/folder/m.png -x strain

expect 64 "$clast" map small.db m.png -x strain
expect 64 "$clast" map small.db m.png -x strain -y strain
expect 64 "$clast" map small.db m.png -x strain -y nothing
says "threshold.angle"
expect 64 "$clast" map small.db m.jpg -x strain -y angle
says ".png or .svg"
expect 74 "$clast" map small.db no/such/folder/m.png -x strain -y angle
says "no/such/folder/m.png"
expect 66 "$clast" map none.db m.png -x strain -y angle
[ ! -e m.png ] && [ ! -e m.jpg ] || fail "a picture was left behind"
ok "nothing was left behind"

expect 0 "$clast" simulate disc-explosion --seed 3 --set 'body.diameter=8 cm' --set 'stop.end_time=1 ms' --fields disc.h5
expect 0 "$clast" picture disc.h5 disc.png --caption "seed 3"
is_png disc.png
expect 66 "$clast" picture none.h5 none.png
echo "not HDF5" >text.h5
expect 65 "$clast" picture text.h5 none.png
says "text.h5"
head -c 3000 disc.h5 >cut.h5
expect 65 "$clast" picture cut.h5 none.png
[ ! -e none.png ] || fail "a picture was left behind"
[ -z "$(find . -name '*.part')" ] || fail "a .part file was left behind"
done_after 34
