# Spectra on logarithmic axes. Blocks of the data: first the series (mass, value, low, high, 1 where complete), then the
# fits (both ends of a line).
set logscale xy
set xrange [x_low:x_high]
set yrange [y_low:y_high]
set format xy '10^{%T}'
set mxtics 10
set mytics 10
set key below left Left reverse samplen 2.5 maxcols legend_columns noenhanced
set key title ' ' # room below the name of the axis
faint = 0xB8B8B8
# Series side by side in a bin, so that their bars can be seen.
side(i) = 10**(0.009 * (i - (series + 1) / 2.))
plot for [i = 1:series] data index i - 1 using (column(1) * side(i)):2:3:4 with yerrorbars lt i dt 1 lw 1 pt 0 notitle, \
     for [i = 1:series] data index i - 1 using (column(1) * side(i)):(column(5) == 0 ? column(2) : NaN) with points lc rgb faint pt mark[i] ps 1 notitle, \
     for [i = 1:series] data index i - 1 using (column(1) * side(i)):(column(5) == 1 ? column(2) : NaN) with points lt i ps 1 notitle, \
     for [j = 1:fits] data index series + j - 1 using 1:2 with lines lc rgb colour[fit_of[j]] dt dash[fit_dash[j]] lw 2 notitle, \
     for [i = 1:series] keyentry with points lt i ps 1.1 title label[i], \
     for [j = 1:fits] keyentry with lines lc rgb colour[fit_of[j]] dt dash[fit_dash[j]] lw 2 title label[fits ? series + j : 1]
