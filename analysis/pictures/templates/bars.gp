# Named values with intervals, as bars in groups. Block g - 1 of the data is group g: bar, value, low, high.
set yrange [bars - 0.5:-0.5]
thick = 0.8 / series
set ytics () noenhanced
set grid noytics
do for [i = 1:bars] { set ytics add (name[i] i - 1) }
set ylabel ''
set lmargin name_letters + 3
set xrange [*:*]
set autoscale xfixmin
set style fill solid 0.85 border lc rgb 0x404040
set arrow 1 from 0, graph 0 to 0, graph 1 nohead lc rgb 0x404040 lw 1.1 front
set key below left Left reverse samplen 1.5 maxcols legend_columns noenhanced
set offsets graph 0.02, graph 0.04, 0, 0
shift(g) = (g - (series + 1) / 2.) * thick
plot for [g = 1:series] data index g - 1 using (column(2) / 2):(column(1) + shift(g)):(column(2) / 2):(thick * 0.46) with boxxyerror lt g dt 1 title label[g], \
     for [g = 1:series] data index g - 1 using 2:(column(1) + shift(g)):3:4 with xerrorbars lc rgb 0x202020 dt 1 lw 1.4 pt 7 ps 0.3 notitle
