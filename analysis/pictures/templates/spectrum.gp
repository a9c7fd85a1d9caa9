# Spectra on logarithmic axes. Blocks of the data: first the series (mass or size, value, low, high, 1 where complete),
# then thin lines (single runs, the same columns), then the fits (place, value).
set logscale xy
set xrange [x_low:x_high]
set yrange [y_low:y_high]
set format xy '10^{%T}'
set mxtics 10
set mytics 10
# A short axis needs more than its powers of ten.
if (x_high < 40 * x_low) {
  set format x ''
  do for [d = floor(log10(x_low)):ceil(log10(x_high))] { set xtics add (people(10.**d) 10.**d, people(2 * 10.**d) 2 * 10.**d, people(5 * 10.**d) 5 * 10.**d) }
}
set key below left Left reverse samplen 2.5 maxcols legend_columns noenhanced
set key title ' ' # room below the name of the axis
faint = 0xB8B8B8
black = 0x202020
colour_of(i) = measured[i] ? black : colour[(i - 1) % 8 + 1]
mark_of(i) = measured[i] ? 6 : mark[(i - 1) % 8 + 1]
dash_of(i) = measured[i] ? 3 : 1
# Densities stand side by side in a bin, so that their bars can be seen. Cumulative numbers have bands.
side(i) = cumulative ? 1 : 10**(0.009 * (i - (series + 1) / 2.))
set style fill transparent solid 0.18 noborder
plot for [i = 1:cumulative * series] data index i - 1 using 1:3:4 with filledcurves lc rgb colour_of(i) notitle, \
     for [j = 1:thin] data index series + j - 1 using 1:2 with lines lc rgb (0xA0000000 + colour_of(thin_of[j])) dt 1 lw 0.7 notitle, \
     for [i = 1:series] data index i - 1 using 1:(cumulative || measured[i] ? column(2) : NaN) with lines lc rgb colour_of(i) dt dash_of(i) lw 1.2 notitle, \
     for [i = 1:series] data index i - 1 using (column(1) * side(i)):(cumulative ? NaN : column(2)):3:4 with yerrorbars lc rgb colour_of(i) dt 1 lw 1 pt 0 notitle, \
     for [i = 1:series] data index i - 1 using (column(1) * side(i)):(column(5) == 0 ? column(2) : NaN) with points lc rgb faint pt mark_of(i) ps 1 notitle, \
     for [i = 1:series] data index i - 1 using (column(1) * side(i)):(column(5) == 1 ? column(2) : NaN) with points lc rgb colour_of(i) pt mark_of(i) ps 1 lw 1.4 notitle, \
     for [j = 1:fits] data index series + thin + j - 1 using 1:2 with lines lc rgb colour_of(fit_of[j]) dt dash[fit_dash[j]] lw 2 notitle, \
     for [i = 1:series] keyentry with points lc rgb colour_of(i) pt mark_of(i) ps 1.1 lw 1.4 title label[i], \
     for [j = 1:fits] keyentry with lines lc rgb colour_of(fit_of[j]) dt dash[fit_dash[j]] lw 2 title label[fits ? series + j : 1]
