# A quantity over two inputs: one tile for each pair of values. scattered > 0: a mark for each point on two scales; its
# only block of data is x, y, value, 1 for one in doubt, decimals (-1: three digits, -4: four), 1 where there is no value,
# 1 for a weak one.
# Blocks of the data: 0 the tiles (column, row, value, 1 for one in doubt, decimals, 0 a value, 1 none, 2 between panels, 1 for a weak one), 1 the
# values of the columns, 2 the values of the rows. panels > 0: panels of panel_columns columns side by side, a panel_label above each.
# Cividis: readable in grey and without colour vision.
set palette defined (0 '#00224e', 1 '#123570', 2 '#3b496c', 3 '#575d6d', 4 '#707173', 5 '#8a8779', 6 '#a69d75', 7 '#c4b56c', 8 '#e4cf5b', 9 '#fee838')
set cbrange [low:high]
set cblabel quantity noenhanced offset 1
number(value, doubtful, decimals, weak) = sprintf(decimals == -1 ? '%.3g' : sprintf(decimals < 0 ? '%%.%dg' : '%%.%df', abs(decimals)), value) . (weak > 0 ? '~' : '') . (doubtful > 0 ? ' !' : '')
if (scattered > 0) {
  if (log_x) { set logscale x }
  if (log_y) { set logscale y }
  set xrange [x_low:x_high]
  set yrange [y_low:y_high]
  set border 15
  set rmargin 14
  few = rows <= 30
  plot data using 1:2:(column(3)) with points pt 7 ps 2 palette notitle, \
       data using 1:(column(6) == 0 ? column(2) : NaN) with points lt 1 pt 6 ps 2 lc rgb 0x606060 notitle, \
       data using 1:2:(column(6) > 0 ? '' : few ? number(column(3), column(4), column(5), column(7)) : (column(7) > 0 ? '~' : '') . (column(4) > 0 ? '!' : '')) with labels offset 0, 0.9 font letters.',9' tc rgb 0x404040 noenhanced notitle, \
       data using 1:(column(6) == 1 ? column(2) : NaN) with points lt 1 pt 2 ps 2 lc rgb 0x909090 notitle
} else {
set xrange [-0.5:columns - 0.5]
set yrange [-0.5:rows - 0.5]
unset grid
set border 15
set tics scale 0
set rmargin 14
every_x = columns > 12 && panels == 0 ? ceil(columns / 12.) : 1
every_y = ceil(rows / 18.)
set xtics () ; set ytics ()
# Numbers beside the tiles, as many as fit.
wide = page_width * 0.7 / columns
fits = wide > 34 && page_height * 0.7 / rows > 16
small = wide > 60 ? 1.0 : 0.75
number_font = letters.sprintf(',%g', (ending eq 'svg' ? 14 : 10.5) * small)
middle = (low + high) / 2.
if (panels > 0) { set tmargin 3 + 1.35 * title_lines + 0.95 * caption_lines }
do for [p = 1:panels] {
  set label 10 + p panel_label[p] at (p - 1) * (panel_columns + 1) + (panel_columns - 1) / 2., rows - 0.5 offset 0, 0.7 center tc rgb 0x202020 noenhanced
}
plot data index 0 using 1:2:(column(3)) with image pixels notitle, \
     data index 0 using 1:2:(fits && column(6) == 0 && column(3) >= middle ? number(column(3), column(4), column(5), column(7)) : '') with labels font number_font tc rgb 0x101010 noenhanced notitle, \
     data index 0 using 1:2:(fits && column(6) == 0 && column(3) < middle ? number(column(3), column(4), column(5), column(7)) : '') with labels font number_font tc rgb 0xFFFFFF noenhanced notitle, \
     data index 0 using 1:(column(6) == 1 ? column(2) : NaN) with points lt 1 pt 2 ps 2 lc rgb 0x909090 notitle, \
     data index 1 using 1:(NaN):xticlabels(int(column(1)) % every_x ? '' : people(column(2))) with points notitle, \
     data index 2 using (NaN):1:yticlabels(int(column(1)) % every_y ? '' : people(column(2))) with points notitle
}
