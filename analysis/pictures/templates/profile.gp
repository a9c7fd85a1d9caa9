# Quantities along a line, one panel above the other.
# The data: x and the value of each panel. low, high: the range of each panel.
head = (1.8 + 1.5 * title_lines + 1.0 * caption_lines) * 18. / page_height
foot = 62. / page_height
tall = (1.0 - head - foot) / panels
set lmargin at screen 115. / page_width
set rmargin at screen 1 - 25. / page_width
set xrange [x_low:x_high]
set multiplot
do for [k = 1:panels] {
  set yrange [low[k]:high[k]]
  set tmargin at screen 1 - head - (k - 1) * tall
  set bmargin at screen 1 - head - k * tall + 0.03
  if (k > 1) { unset label 1; unset label 2 }
  if (k < panels) { set xlabel ''; set format x '' } else { set xlabel x_label noenhanced; set format x '%h' }
  set label 3 label[k] at screen 16. / page_width, graph 0.5 center rotate by 90 noenhanced # beside any ticks
  plot data using 1:(column(k + 1)) with linespoints lt k dt 1 pt (points > 120 ? 0 : mark[k]) ps 0.7 notitle
}
unset multiplot
