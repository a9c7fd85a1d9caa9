# What was measured beside what a fit predicts for one more experiment, a row for each number, measured = 1.
# The data: row, measured, its error, and the 5, 25, 50, 75 and 95 % quantiles of the prediction.
set lmargin at screen 1.0 * left_margin / page_width # whole numbers have a whole quotient
set xrange [x_low:x_high]
set yrange [-0.6:rows - 0.4]
unset ytics
unset grid
set grid xtics back ls 100
set border 1
set arrow 1 from 1, graph 0 to 1, graph 1 nohead lc rgb 0x808080 dt 3 lw 1.5 back
set key below left Left reverse samplen 2.5 maxcols legend_columns noenhanced
set key title ' ' # room below the name of the axis
set style fill solid 1.0 noborder
do for [i = 1:rows] { set label 10 + i row_label[i] at graph 0, first rows - i offset -1, 0 right noenhanced }
plot data using 4:1:4:8:(column(1) - 0.22):(column(1) + 0.22) with boxxyerror lc rgb 0xBFDCEF title label[1], \
     data using 5:1:5:7:(column(1) - 0.22):(column(1) + 0.22) with boxxyerror lc rgb colour[6] title label[2], \
     data using 6:(column(1) - 0.22):(0):(0.44) with vectors nohead lc rgb colour[1] lw 2.5 dt 1 title label[4], \
     data using 2:1:3 with xerrorbars lc rgb colour[2] pt 13 ps 1.5 lw 2 dt 1 title label[3]
