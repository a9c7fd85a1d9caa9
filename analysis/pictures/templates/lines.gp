# Means over an input with their 95 % intervals, a line for each value of a second input. Thin bars add the error of
# the resolution; NaN: no bar. A mean in doubt has a "!". Block i - 1 of the data is line i: x, mean, low, high,
# thin_low, thin_high, doubtful. band[i] > 0: a line without marks in a band from low to high. places > 0: bars, at the
# words place[1], place[2], ... of the axis, of place_lines lines or turned.
if (log_x) { set logscale x }
if (log_x) { set format x (1.0 * x_high / x_low > 1e4 ? '10^{%T}' : '') }
if (log_x && 1.0 * x_high / x_low <= 1e4) {
  do for [d = floor(log10(x_low)):ceil(log10(x_high))] { set xtics add (people(10.**d) 10.**d) }
  if (1.0 * x_high / x_low < 100) { do for [d = floor(log10(x_low)):ceil(log10(x_high))] { set xtics add (people(2 * 10.**d) 2 * 10.**d, people(5 * 10.**d) 5 * 10.**d) } }
}
set xrange [x_low:x_high]
set autoscale yfix
set offsets 0, 0, graph 0.05, graph 0.05
set key below left Left reverse samplen 2.5 maxcols legend_columns noenhanced
set key title ' ' # room below the name of the axis
beside(x, i) = x + (i - (series + 1) / 2.) * 0.8 / series
# thin bars of several series would lie on each other
apart(x, i) = log_x ? x * (1.0 * x_high / x_low)**(0.008 * (i - (series + 1) / 2.)) \
                    : x + 0.008 * (x_high - x_low) * (i - (series + 1) / 2.)
if (places > 0) {
  unset logscale x
  set xtics format '' noenhanced
  set xtics ('' 0)
  if (place_turned) { set xtics rotate by 90 right } else { set xlabel offset 0, 1.2 - place_lines }
  do for [i = 1:places] { set xtics add (place[i] i) }
  set boxwidth 0.8 / series
  set yrange [*<0:0<*]
  set offsets 0, 0, graph 0.05, 0
  plot for [i = 1:series] data index i - 1 using (beside($1, i)):2 with boxes lt i dt 1 fs solid 0.4 title label[i], \
       for [i = 1:series] data index i - 1 using (beside($1, i)):($5 == $5 ? $2 : NaN):5:6 with yerrorbars lc 'black' dt 1 lw 0.6 ps 0 notitle, \
       for [i = 1:series] data index i - 1 using (beside($1, i)):($3 == $3 ? $2 : NaN):3:4 with yerrorbars lc 'black' dt 1 ps 0 notitle, \
       for [i = 1:series] data index i - 1 using (beside($1, i)):($7 > 0 ? $2 : NaN):('!') with labels offset 1.1, 0.5 notitle
} else {
plot for [i = 1:series] data index i - 1 using 1:(band[i] > 0 ? $3 : NaN):4 with filledcurves lt i fs transparent solid 0.2 noborder notitle, \
     for [i = 1:series] data index i - 1 using (apart($1, i)):($5 == $5 ? $2 : NaN):5:6 with yerrorbars lt i dt 1 lw 0.6 ps 0 notitle, \
     for [i = 1:series] data index i - 1 using 1:(band[i] == 0 && $3 == $3 ? $2 : NaN):3:4 with yerrorbars lt i dt 1 ps 1.2 notitle, \
     for [i = 1:series] data index i - 1 using 1:2 with linespoints lt i ps (band[i] > 0 ? 0 : 1.2) title label[i], \
     for [i = 1:series] data index i - 1 using 1:($7 > 0 ? $2 : NaN):('!') with labels offset 1.1, 0.5 notitle
}
