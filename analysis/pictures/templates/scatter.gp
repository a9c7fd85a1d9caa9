# Histograms above, distribution functions below. Blocks of the data: first the histograms (value, share of the runs),
# then the distribution functions (value, share of the runs up to it).
head = (1.8 + 1.5 * title_lines + 1.0 * caption_lines) * 18. / page_height
legend = legend_height * (ending eq 'svg' ? 1.2 : 1.) + 12 # letters of SVG are taller
foot = (58 + legend) / page_height
tall = (1.0 - head - foot) / 2
set lmargin at screen 100. / page_width
set rmargin at screen 1 - 25. / page_width
set xrange [x_low:x_high]
set style fill transparent solid 0.12 noborder
set multiplot
set tmargin at screen 1 - head
set bmargin at screen 1 - head - tall + 0.03
set yrange [0:*]
set xlabel ''
set format x ''
set ylabel 'share of the runs'
plot for [i = 1:series] data index i - 1 using 1:2 with filledcurves y1=0 lc rgb colour[i] notitle, \
     for [i = 1:series] data index i - 1 using 1:2 with lines lc rgb colour[i] dt dash[i] lw 1.6 notitle
unset label 1
unset label 2
set tmargin at screen 1 - head - tall
set bmargin at screen foot
set yrange [0:1]
set format x '%h'
set xlabel x_label noenhanced
set ylabel 'share of the runs up to here'
set arrow 1 from graph 0, first 0.5 to graph 1, first 0.5 nohead dt 3 lc rgb 0x808080
set key at screen 100. / page_width, screen legend / page_height left top horizontal
set key Left reverse samplen 2.5 maxcols legend_columns noenhanced
plot for [i = 1:series] data index series + i - 1 using 1:2 with steps lc rgb colour[i] dt dash[i] lw 1.6 notitle, \
     for [i = 1:series] keyentry with lines lc rgb colour[i] dt dash[i] lw 2 title label[i]
unset multiplot
