# Two quantities of several sizes over one scaled input, one panel above the other, on logarithmic axes.
# Block i - 1 of the data is size i: x, then mean, low, high of each panel. y_low, y_high: the range of each panel.
head = (1.8 + 1.5 * title_lines + 1.0 * caption_lines) * 18. / page_height
foot = (62. + legend_height) / page_height
tall = (1.0 - head - foot) / 2
set lmargin at screen 110. / page_width
set rmargin at screen 1 - 25. / page_width
set xrange [x_low:x_high]
set logscale y
set multiplot
do for [k = 1:2] {
  set yrange [y_low[k]:y_high[k]]
  set tmargin at screen 1 - head - (k - 1) * tall
  set bmargin at screen 1 - head - k * tall + (k < 2 ? 0.03 : 0)
  set ylabel panel[k] noenhanced
  if (k < 2) { set xlabel ''; set format x ''; unset key } else {
    unset label 1; unset label 2
    set xlabel x_label noenhanced
    set format x '%h'
    set key below left Left reverse samplen 2.5 maxcols legend_columns noenhanced
    set key title " \n " # room for the name of the axis
  }
  plot for [i = 1:series] data index i - 1 using 1:(column(3 * k - 1)):(column(3 * k)):(column(3 * k + 1)) with yerrorbars lt i dt 1 title label[i]
}
unset multiplot
