# The page of every chart: size, letters, colours, marks, title. Each chart's own lines follow.
set encoding utf8
letters = 'DejaVu Sans'
if (ending eq 'png') { set terminal pngcairo size page_width,page_height font letters.',11' background rgb 'white' }
if (ending eq 'svg') { set terminal svg size page_width,page_height font letters.',15' background rgb 'white' dynamic }
if (ending eq 'pdf') { set terminal pdfcairo size page_width/96.,page_height/96. font letters.',11' background rgb 'white' }
set output output_file

# Okabe and Ito's colours: they can be told apart without colour vision, and so can the marks and the dashes.
array colour[8] = [0x0072B2, 0xD55E00, 0x009E73, 0xCC79A7, 0xE69F00, 0x56B4E9, 0x000000, 0x7F7F7F]
array mark[8] = [7, 5, 9, 13, 11, 6, 4, 8]
array dash[8] = [1, 2, 4, 3, 5, 1, 2, 4]
do for [i = 1:8] { set linetype i lc rgb colour[i] pt mark[i] ps 1.1 lw 1.6 dt dash[i] }

set style line 100 lc rgb 0xDDDDDD lw 0.7
set grid xtics ytics back ls 100
set border 3 lw 1.1 lc rgb 0x404040
set tics nomirror out scale 0.7
set errorbars small
set bars 0.6

# Text of users is never interpreted: noenhanced.
set label 1 title_text at screen 0, screen 1 offset 1.5, -1.2 left font letters.(ending eq 'svg' ? ',18' : ',13') tc rgb 0x202020 noenhanced
set label 2 caption_text at screen 0, screen 1 offset 1.5, -1.0 - 1.35 * title_lines left font letters.(ending eq 'svg' ? ',13' : ',9.5') tc rgb 0x606060 noenhanced
set tmargin 1.4 + 1.35 * title_lines + 0.95 * caption_lines
set xlabel x_label noenhanced offset 0, 0.2
set ylabel y_label noenhanced offset -0.5
set rmargin 3
# 5*10^33 as people write it
power(x) = floor(log10(abs(x)) + 1e-9)
rest(x) = sprintf('%.4g', x / 10.**power(x))
people(x) = x == 0 || (abs(x) >= 1e-3 && abs(x) < 1e5) ? sprintf('%.4g', x) : (rest(x) eq '1' ? '' : rest(x) . '×') . sprintf('10^{%d}', power(x))
if (exists('legend_lines')) { set key spacing legend_lines }
