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
expect 0 "$clast" map small.db beta.png -x strain -y angle -q beta_binned_from_2
is_png beta.png

expect 0 "$clast" plot small.db lines.png -x strain --by angle
is_png lines.png
expect 0 "$clast" plot small.db dust.svg -x strain -q dust_fraction
is_svg dust.svg
expect 0 "$clast" plot small.db apart.svg -x strain --by angle -q dust_fraction
python - <<'PY'
import re
def title(name): # its letters: the highest line of text
    ys = [float(y) for y in re.findall(r'<use[^>]* y="([0-9.]+)"', open(name).read())]
    return ys.count(min(ys))
assert title('dust.svg') - title('apart.svg') == len(' and threshold.angle'), 'a mean over angles, too, does not say so'
PY
expect 0 "$clast" plot small.db beta.svg -x strain --by angle -q beta_masses_from_2
expect 0 "$clast" estimates small.db --json
# The lines of the picture stand as high as the numbers of the table: all on one scale.
python - <<'PY'
import json, re
rows = [r for r in json.load(open('out')) if r['window'] == 'from_2']
text = open('beta.svg').read()
path = lambda kind: [[tuple(map(float, p)) for p in re.findall(r'[ML] (\S+) (\S+)', d)] for d in re.findall(r'<path style="fill:none;[^"]*' + kind + r'[^"]*" d="([^"]*)"', text)]
lines = path('stroke-opacity:0.6')
angles = sorted({r['threshold_angle'] for r in rows})
assert len(lines) == len(angles) == 2, lines
dots = [(r['beta_masses'], y) for a, line in zip(angles, lines)
        for r, (x, y) in zip(sorted((r for r in rows if r['threshold_angle'] == a), key=lambda r: r['threshold_strain']), line, strict=True)]
dots.sort()
(v0, y0), (v1, y1) = dots[0], dots[-1]
assert len(dots) == 4 and v1 > v0 + 0.01 and y1 < y0 - 50, dots
height = lambda v: y0 + (y1 - y0) * (v - v0) / (v1 - v0)
for v, y in dots:
    assert abs(y - height(v)) < 0.01, dots  # points of a page, which holds six decimals of them
PY
ok "the picture shows the table's exponents"
expect 64 "$clast" plot small.db m.png -x strain -q beta
says "--by"
expect 64 "$clast" plot small.db m.png -x strain --by angle -q beta_ks_from_2
says "beta_METHOD_WINDOW"
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
done_after 40
